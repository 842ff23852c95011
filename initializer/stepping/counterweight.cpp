#include "initializer/stepping/counterweight.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace wex {

std::vector<ArmPosture> counterweight_postures(const ArmKinematics& arm) {
  // Boom, dipper, telescope and pitch as shares of their ranges, from far out to near.
  constexpr std::array<std::array<double, 4>, 3> kShares{
      {{0.72, 0.62, 0.57, 0.50}, {0.87, 0.66, 0.30, 0.37}, {0.72, 0.38, 0.30, 0.27}}};
  constexpr int kNumYaws = 24;
  std::vector<ArmPosture> postures;
  for (int yaw = 0; yaw < kNumYaws; ++yaw) {
    ArmKinematics::Joints joints = ArmKinematics::joints_of(arm.transport());
    joints[0] = wrap_angle(2.0 * std::numbers::pi * yaw / kNumYaws);
    postures.push_back(ArmKinematics::posture_of(joints));
    for (const auto& shares : kShares) {
      for (std::size_t k = 1; k < joints.size(); ++k) {
        joints[k] = std::lerp(arm.lower()[k], arm.upper()[k], shares[k - 1]);
      }
      postures.push_back(ArmKinematics::posture_of(joints));
    }
  }
  return postures;
}

Result<std::vector<HeldPosture>, MotionFailure> counterweights(
    const ArmKinematics& arm, const BaseRun& run, const std::vector<BucketStance>& stances,
    const std::vector<ArmPosture>& candidates, double min_margin_m, const PostureJudge& judge) {
  // The knot after the last one that a candidate lasts for, and the least margin on the way.
  struct Hold {
    std::size_t end;
    double margin_m;
  };
  const auto hold = [&](const ArmPosture& posture, std::size_t first) {
    const Eigen::Vector3d moment = arm.moment_base(posture);
    Hold hold{first, 1e9};
    for (; hold.end < stances.size(); ++hold.end) {
      const BucketStance& stance = stances[hold.end];
      double margin_m = stance.footing.margin_m(moment);
      if (stance.on_wheels) margin_m = std::min(margin_m, stance.on_wheels->margin_m(moment));
      if (margin_m < min_margin_m || !judge(hold.end, posture)) break;
      hold.margin_m = std::min(hold.margin_m, margin_m);
    }
    return hold;
  };

  std::vector<HeldPosture> held;
  std::size_t knot = 0;
  while (true) {
    const ArmPosture* best = nullptr;
    Hold longest{knot, -1e9};
    for (const ArmPosture& posture : candidates) {
      const Hold here = hold(posture, knot);
      if (here.end > longest.end ||
          (here.end == longest.end && best != nullptr && here.margin_m > longest.margin_m)) {
        longest = here;
        best = &posture;
      }
    }
    // A change needs a knot where both hold, so every posture but the last must gain one.
    if (best == nullptr || (longest.end < stances.size() && longest.end <= knot + 1)) {
      return tl::unexpected<MotionFailure>(
          {run.knots[knot].state, "no arm posture keeps the machine stable on three wheels"});
    }
    held.push_back({knot, *best});
    if (longest.end == stances.size()) return held;
    knot = longest.end - 1;
  }
}

}  // namespace wex
