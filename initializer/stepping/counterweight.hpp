#pragma once

#include <vector>

#include "initializer/stepping/arm_kinematics.hpp"
#include "initializer/stepping/base_motion.hpp"
#include "initializer/stepping/bucket_phase.hpp"

namespace wex {

/// From which knot of a run on the arm is held in a posture.
struct HeldPosture {
  std::size_t first_knot = 0;
  ArmPosture posture;
};

/// Postures over all cabin yaws and some reaches, all of them above the machine and level ground.
[[nodiscard]] std::vector<ArmPosture> counterweight_postures(const ArmKinematics& arm);

/// As few postures as possible that keep a run stable, the arm in the air as a counterweight: each
/// of the candidates is held as far as it lasts. Where postures change, both hold.
///   stances  one per knot of the run
///   errors   the knot at which no candidate holds
[[nodiscard]] Result<std::vector<HeldPosture>, MotionFailure> counterweights(
    const ArmKinematics& arm, const BaseRun& run, const std::vector<BucketStance>& stances,
    const std::vector<ArmPosture>& candidates, double min_margin_m, const PostureJudge& judge);

}  // namespace wex
