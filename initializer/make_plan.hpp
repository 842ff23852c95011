#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>

#include "models/excavator/machine_model.hpp"
#include "models/terrain/terrain_map.hpp"
#include "models/types/plan.hpp"
#include "models/types/result.hpp"

namespace wex {

/// Defaults are the decisions' values; one set for every terrain.
struct PlanSettings {
  double time_budget_s = 4.0;     ///< ignored when iterations is set
  std::optional<int> iterations;  ///< fixed number of planner iterations: deterministic by seed
  std::uint64_t seed = 1;
  double range_m = 10.0;  ///< longest step of the tree, in distance plus weighted yaw
  double subnode_spacing_m = 0.2;
  double yaw_weight_m_rad = 1.5;
  double max_tilt_rad = 0.3490658503988659;  ///< 20 degrees, roll and pitch
  double min_stability_margin_m = 0.30;
  double min_signed_distance_m = 0.15;  ///< delta
  double belly_clearance_m = 0.05;
  double nominal_speed_m_s = 0.6;
  double rate_fraction = 0.8;  ///< share of each joint's rate limit the timing may use
};

/// Progress of the search, for the caller's display.
struct PlanProgress {
  double elapsed_s = 0.0;
  std::optional<double> best_cost;
};

/// A driving plan from task.start to task.goal (local world frame).
///   errors  kBadInput: start or goal off the map, on unknown ground, in an untraversable spot, not
///           finite; kNoPlan: nothing found within the budget, with what blocked it, counted
///   source  RRT# over SE(2) with Reeds-Shepp curves, base pose by the paper's Algorithm 1
[[nodiscard]] Result<Plan> make_plan(const TerrainMap& terrain, const MachineModel& machine,
                                     const Task& task, const PlanSettings& settings = {},
                                     const std::function<void(const PlanProgress&)>& observer = {});

/// Standing whole-body posture at an SE(2) pose: base height, roll and pitch by Algorithm 1, wheels
/// on the ground by hip flexion, everything else in transport posture, steering straight.
///   returns  q (MachineModel::num_coordinates)
///   errors   kBadInput with the reason (which wheel, which limit)
[[nodiscard]] Result<Eigen::VectorXd> standing_posture(const TerrainMap& terrain,
                                                       const MachineModel& machine,
                                                       const Pose2& pose,
                                                       const PlanSettings& settings = {});

}  // namespace wex
