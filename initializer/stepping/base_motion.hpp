#pragma once

#include <array>
#include <functional>
#include <vector>

#include "initializer/stepping/certificate.hpp"
#include "initializer/stepping/stepping_motion.hpp"
#include "initializer/stepping/wheel_placer.hpp"

namespace wex {

/// One decided pose of the base, where it is along its stretch.
struct BaseKnot {
  double sigma_m = 0.0;  ///< way of base and wheels together, strictly increasing
  std::size_t state = 0;
  BaseCoordinates base = BaseCoordinates::Zero();
  double curvature_1_m = 0.0;  ///< as steered
  bool stop = false;           ///< a change of direction
};

/// A stretch of a sequence on one support, its base motion smoothed.
struct BaseRun {
  Support support;
  std::vector<BaseKnot> knots;  ///< at least one
  std::array<double, kNumWheels> lifted_hfe_rad{};

  struct Point {
    BaseCoordinates base;
    double curvature_1_m;
  };
  /// Linear between knots, clamped at both ends.
  [[nodiscard]] Point at(double sigma_m) const;
};

/// Splits a sequence where its support changes; successive runs share the pose between them.
[[nodiscard]] std::vector<BaseRun> base_runs(const CertifiedSequence& sequence,
                                             double steering_window_m);

/// Whether a pose may be taken on the run's support; nothing means yes.
using PoseJudge = std::function<std::optional<std::string>(const BaseKnot& knot)>;

/// Height, pitch and roll as moving averages along the run, as far as every knot passes. Both ends
/// keep their pose.
///   errors  the knot that does not even pass as decided
[[nodiscard]] Result<void, MotionFailure> smooth_base(BaseRun& run, double window_m,
                                                      const PoseJudge& judge);

/// How high the lifted wheels of the run must be to clear the ground all along, knots and half-way.
[[nodiscard]] Result<void, MotionFailure> lift_wheels(BaseRun& run, const WheelPlacer& placer,
                                                      double clearance_m);

}  // namespace wex
