#pragma once

#include <string>
#include <vector>

#include "models/excavator/machine_model.hpp"
#include "models/types/result.hpp"

// The one place that turns a MachineModel into a MuJoCo model. mjSpec stays inside the .cpp; users
// that simulate take the XML text or the compiled model through models/excavator/mujoco_model.hpp.

namespace wex {

/// The machine alone as MJCF text (no terrain), as `wex model --mjcf` writes it.
[[nodiscard]] Result<std::string> machine_mjcf(const MachineModel& machine);

/// Names of the scalar joints of that model in its order (passive joints and tyre slides included).
[[nodiscard]] Result<std::vector<std::string>> scalar_joint_names(const MachineModel& machine);

/// Values of those joints for a planner's q: passive ones follow, tyres at static sag.
[[nodiscard]] Eigen::VectorXd scalar_joint_values(const MachineModel& machine,
                                                  const Eigen::VectorXd& q);

}  // namespace wex
