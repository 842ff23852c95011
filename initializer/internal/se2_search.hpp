#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "initializer/drive_path.hpp"
#include "initializer/planner_kind.hpp"
#include "models/types/pose.hpp"
#include "models/types/result.hpp"

// OMPL stays behind this file: Reeds-Shepp curves, RRT# and its like.

namespace wex {

struct SearchSettings {
  PlannerKind planner = PlannerKind::kRrtSharp;
  double turning_radius_m = 4.5;
  double range_m = 10.0;  ///< in the distance the tree is grown by
  double subnode_spacing_m = 0.2;
  double yaw_weight_m_rad = 1.5;
  double goal_bias = 0.05;
  double x_min_m = 0.0, x_max_m = 0.0, y_min_m = 0.0, y_max_m = 0.0;
  PathCostWeights cost;
};

/// Can the machine be at a pose, steering for a curvature [1/m]?
using PoseValidity = std::function<bool(const Pose2& pose, double curvature_1_m)>;

/// Shortest Reeds-Shepp path; its first pose is `from`, its last is `to` up to whole turns.
[[nodiscard]] DrivePath reeds_shepp_path(const Pose2& from, const Pose2& to,
                                         double turning_radius_m);

/// Is every pose at most `spacing_m` apart valid? Coarse to fine, so that bad paths fail early.
[[nodiscard]] bool path_is_valid(const DrivePath& path, double spacing_m,
                                 const PoseValidity& is_valid);

/// One tree (RRT# unless the settings name another planner) from start to goal. Nearest neighbours
/// by distance plus weighted yaw, edges by Reeds-Shepp curves, cost as PathCostWeights. All
/// randomness comes from the seed. One thread.
class Se2Search {
 public:
  Se2Search(const Pose2& start, const Pose2& goal, const SearchSettings& settings,
            PoseValidity is_valid, std::uint64_t seed);
  ~Se2Search();
  Se2Search(const Se2Search&) = delete;
  Se2Search& operator=(const Se2Search&) = delete;

  /// Grows the tree until it holds a path cheaper than `cost_m`, or `stop` (asked once per
  /// iteration) says so.
  ///   returns  the path, nullopt if stopped before; a path that only comes near the goal is none
  ///   errors   kInternal: OMPL failed
  [[nodiscard]] Result<std::optional<DrivePath>> find_cheaper_than(
      double cost_m, const std::function<bool()>& stop);

  [[nodiscard]] int iterations() const;
  /// Cost of the best path in the tree, without cusps where its edges meet; infinity if none.
  [[nodiscard]] double best_cost_m() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wex
