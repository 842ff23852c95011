#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "models/types/limbs.hpp"
#include "models/types/pose.hpp"

namespace wex {

/// What is asked for: drive the base from start to goal (local world frame of the TerrainMap).
struct Task {
  Pose2 start;
  Pose2 goal;
  bool operator==(const Task&) const = default;
};

/// One whole-body sample. `q` = base coordinates (pose.hpp) then one value per actuated joint in
/// machine order (MachineModel::joints), SI units; yaw and wheel angles are unwrapped (continuous).
struct WholeBodyNode {
  double t_s = 0.0;
  Eigen::VectorXd q;
  ContactFlags contacts = kDrivingContacts;
};

/// Product of the initializer: statically stable nodes at most 0.2 m apart, timed so that no rate
/// limit is exceeded, first node at t = 0.
struct Plan {
  Task task;
  std::uint64_t seed = 0;
  std::vector<WholeBodyNode> nodes;
  double path_length_m = 0.0;
  double cost = 0.0;                   ///< planner cost of the path (metres of driving, weighted)
  double first_solution_time_s = 0.0;  ///< thread CPU time until a first path was known
  double total_time_s = 0.0;           ///< thread CPU time of the whole stage
  int iterations = 0;
  double min_stability_margin_m = 0.0;
};

/// How an optimization ended.
struct SolveReport {
  bool feasible = false;  ///< every row within its tolerance, checked outside the solver
  std::string status;     ///< solver's own words
  int iterations = 0;
  double cpu_time_s = 0.0;
  double objective = 0.0;
  std::map<std::string, double> worst_residual;  ///< per constraint name, in that row's unit
};

/// Product of the refinement: uniformly spaced nodes, same layout as Plan.
struct RefinedTrajectory {
  double dt_s = 0.0;
  std::vector<WholeBodyNode> nodes;
  SolveReport report;
  double min_stability_margin_m = 0.0;
};

/// Linear interpolation between nodes (clamped at both ends); contacts of the node at or before t.
///   nodes  sorted by t_s, not empty (contract)
[[nodiscard]] WholeBodyNode sample(const std::vector<WholeBodyNode>& nodes, double t_s);

}  // namespace wex
