#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>

#include "initializer/planner_kind.hpp"
#include "models/excavator/machine_model.hpp"
#include "models/terrain/terrain_map.hpp"
#include "models/types/plan.hpp"
#include "models/types/result.hpp"

namespace wex {

/// How a plan is made.
enum class PlanMode {
  kCertified,  ///< driving where it can, stepping by the layered graph where it must
  kDriveOnly,  ///< on four wheels or not at all
  kPaper,      ///< the paper's initialization step: Algorithms 1 and 2, RRT#, post-processing
};

/// Mechanisms that can be switched off to see what they are worth.
struct PlanAblation {
  bool certificate_first = true;  ///< the direct path is certified before anything is searched
  bool alignment = true;          ///< RRT# heads squarely at what must be stepped over
  bool blocking = true;           ///< places where certificates die are closed to later trees
  bool certified_tree = true;     ///< the tree of certified four-wheel states as fallback
  // Of the paper's mode:
  bool filtered_heights = true;     ///< Algorithm 1 may take the heavily filtered terrain
  bool nearest_traversable = true;  ///< ... and that of the nearest traversable place
  bool arm_centring = true;         ///< the arm as counterweight with three wheels on the ground
  bool arm_support = true;          ///< the bucket as third contact with two
};

/// Defaults are the decisions' values; one set for every terrain.
struct PlanSettings {
  PlanMode mode = PlanMode::kCertified;
  PlanAblation ablation;
  PlannerKind planner = PlannerKind::kRrtSharp;  ///< of the paper's mode
  double stepping_penalty = 1.0;  ///< factor on what stepping costs beside its way; 0: nothing
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
  const Plan* better = nullptr;  ///< a plan just found, the best so far; valid during the call
  int num_paths = 0;             ///< of the base, found so far in the paper's mode; plans or not
};

/// A plan from task.start to task.goal (local world frame): driving where it can, stepping where it
/// must.
///   errors  kBadInput: start or goal off the map, on unknown ground, in an untraversable spot, not
///           finite; kNoPlan: nothing found within the budget, with what blocked it, counted
///   source  RRT# over SE(2) with Reeds-Shepp curves, base pose by the paper's Algorithm 1;
///   stepping
///           by a layered graph along the path (stepping/certificate.hpp)
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
