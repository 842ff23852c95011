#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "models/excavator/machine_model.hpp"
#include "models/types/plan.hpp"
#include "tools/wex/drive_record.hpp"

namespace wex::app {

/// Planned motion as CSV, at least 20 rows a second: t, base_x .. base_qz, one column per scalar
/// joint of model.xml, contact_LF .. contact_ARM. Positions in the map frame.
///   joint_names   scalar_joint_names(machine)
///   map_origin_m  map frame = local + this
[[nodiscard]] std::string planned_motion_csv(const MachineModel& machine,
                                             const std::vector<std::string>& joint_names,
                                             const std::vector<WholeBodyNode>& nodes,
                                             const Eigen::Vector2d& map_origin_m);

/// Executed motion in the same columns.
[[nodiscard]] std::string executed_motion_csv(const std::vector<std::string>& joint_names,
                                              const std::vector<DriveSample>& samples,
                                              const Eigen::Vector2d& map_origin_m);

}  // namespace wex::app
