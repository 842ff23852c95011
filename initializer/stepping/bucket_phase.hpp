#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "initializer/stepping/arm_kinematics.hpp"
#include "initializer/stepping/base_motion.hpp"
#include "initializer/stepping/footing.hpp"

namespace wex {

/// How the arm holds the bucket on a fixed point while the base moves: telescope and attitude, the
/// freedom that inverse kinematics leaves, over the run's way.
struct BucketPath {
  struct Sample {
    double sigma_m = 0.0, tele_m = 0.0, attitude_rad = 0.0;
  };
  std::vector<Sample> samples;  ///< one per knot
  double min_margin_m = 0.0;

  [[nodiscard]] Sample at(double sigma_m) const;
};

/// What one knot of the run stands on. Where wheels lift off or land, on all four as well.
struct BucketStance {
  Footing footing;
  std::optional<Footing> on_wheels;
};

struct BucketPathSettings {
  double min_margin_m = 0.30;
  double comfortable_margin_m = 0.50;  ///< below it, margin is paid for
  double tele_step_m = 0.15, attitude_step_rad = 0.1308996938995747;  ///< 7.5 degrees
  double max_attitude_rad = 0.7853981633974483;                       ///< 45 degrees
};

/// Whether a posture may be taken at a knot.
using PostureJudge = std::function<bool(std::size_t knot, const ArmPosture& posture)>;

/// What postures must pass beside reach and stability; asked only where the way leads.
struct PostureJudges {
  PostureJudge clear;       ///< of ground and own limbs
  PostureJudge accessible;  ///< at both ends: the arm gets there and away on four wheels
};

/// The smoothest way of the arm through a grid of telescope length and attitude, one cell a knot,
/// with margins paid for: dynamic programming over knots, cost in squared shares of joint rates.
/// Cells of which the judges say no are left out, and the way is sought again.
///   stances  one per knot of the run
///   errors   the knot beyond which no way goes on
[[nodiscard]] Result<BucketPath, MotionFailure> bucket_path(
    const ArmKinematics& arm, const StanceGround& ground, const BaseRun& run,
    const std::vector<BucketStance>& stances, const Eigen::Vector3d& p_world_bucket,
    const BucketPathSettings& settings, const PostureJudges& judges);

}  // namespace wex
