#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <vector>

#include "models/excavator/machine_model.hpp"
#include "models/types/limbs.hpp"
#include "models/types/plan.hpp"
#include "models/types/result.hpp"

namespace wex::check {

/// Whole-body postures over time, as plan.csv, refined.csv and executed.csv hold them. Positions
/// are local: map frame minus the map's origin.
struct Motion {
  struct Row {
    double t_s = 0.0;
    Eigen::Vector3d p_base = Eigen::Vector3d::Zero();
    Eigen::Quaterniond R_base = Eigen::Quaterniond::Identity();
    Eigen::VectorXd joints;  ///< in the order of joint_names
    ContactFlags contacts{};
  };
  std::vector<std::string> joint_names;
  std::vector<Row> rows;
};

/// Reads a CSV by its column names; the order of columns does not matter.
///   joint_names   scalar joints that must be there; the rows hold them in this order
///   map_origin_m  subtracted from base_x, base_y
///   errors        kBadInput naming file, line and column: missing or unknown column, a row that is
///                 too short or too long, letters, a number that is not finite, a quaternion that
///                 is not of unit length, a contact other than 0 or 1, fewer than two rows
[[nodiscard]] Result<Motion> read_motion(const std::filesystem::path& csv_file,
                                         const std::vector<std::string>& joint_names,
                                         const Eigen::Vector2d& map_origin_m);

/// start and goal out of result.json, map frame.
///   errors  kBadInput naming file and key
[[nodiscard]] Result<Task> read_result_task(const std::filesystem::path& json_file);

/// The same out of a planner's nodes, every node a row (local frame).
///   errors  kInternal: the machine cannot be exported
[[nodiscard]] Result<Motion> motion_from(const MachineModel& machine,
                                         const std::vector<WholeBodyNode>& nodes);

}  // namespace wex::check
