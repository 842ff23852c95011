#pragma once

#include <functional>

#include "models/excavator/machine_model.hpp"
#include "models/terrain/terrain_map.hpp"
#include "models/types/plan.hpp"
#include "models/types/result.hpp"

namespace wex {

/// Tolerances are what the finished trajectory is checked against, outside the solver.
struct RefinementSettings {
  double dt_s = 0.25;
  double min_stability_margin_m = 0.25;
  double min_signed_distance_m = 0.15;
  double max_tilt_rad = 0.3490658503988659;
  double rate_fraction = 0.9;      ///< share of each joint's rate limit
  double joint_margin_rad = 0.03;  ///< to the end stops, left to whoever tracks the result
  int max_iterations = 200;
  double max_cpu_time_s = 60.0;
  double height_tolerance_m = 1e-3;
  double slip_tolerance_m_s = 1e-3;
};

struct SolveIteration {
  int iteration = 0;
  double objective = 0.0, infeasibility = 0.0;
};

/// Whole-plan trajectory optimization (paper, refinement stage) by Ipopt. The start is q of the
/// first node, the goal is the last node's x, y, yaw.
///   errors  kRefinementFailed with the solver's status and the worst row
[[nodiscard]] Result<RefinedTrajectory> refine(
    const TerrainMap& terrain, const MachineModel& machine, const Plan& plan,
    const RefinementSettings& settings = {},
    const std::function<void(const SolveIteration&)>& observer = {});

}  // namespace wex
