#pragma once

#include <vector>

#include "models/types/plan.hpp"

namespace wex::app {

struct ReferenceProgressSettings {
  double free_lag_m = 0.15;   ///< the reference does not wait for a lag below this
  double full_stop_m = 0.45;  ///< and stands still from this lag on
  double tangent_window_s = 0.5;
  double head_start_s = 0.3;  ///< before the reference moves: first solve, dead time and lag
};

/// Which time on the refined trajectory belongs to now. Runs with real time, never backwards, and
/// waits when the machine falls behind along its path, so that the reference never runs away from
/// a machine that is slowed down (hydraulics, slope, a stalled wheel).
class ReferenceProgress {
 public:
  /// nodes: the refined trajectory, not empty (contract).
  explicit ReferenceProgress(std::vector<WholeBodyNode> nodes,
                             const ReferenceProgressSettings& settings = {});

  /// Advances by dt_s >= 0 (contract) given the measured base.
  void advance(double dt_s, const BaseCoordinates& base);
  /// Begins head_start_s before the first node.
  [[nodiscard]] double time_s() const noexcept { return time_s_; }
  [[nodiscard]] bool finished() const noexcept { return time_s_ >= nodes_.back().t_s; }
  /// Share of the trajectory's duration that is behind, 0 to 1.
  [[nodiscard]] double fraction() const noexcept;
  /// How far the machine is behind the reference along the direction of travel [m], < 0 if ahead.
  [[nodiscard]] double lag_m(const BaseCoordinates& base) const;
  /// Distance to the reference in the plane [m].
  [[nodiscard]] double error_m(const BaseCoordinates& base) const;

 private:
  std::vector<WholeBodyNode> nodes_;
  ReferenceProgressSettings settings_;
  double time_s_;
};

}  // namespace wex::app
