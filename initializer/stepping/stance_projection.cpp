#include "initializer/stepping/stance_projection.hpp"

#include <algorithm>
#include <cmath>

#include "initializer/stepping/layered_graph.hpp"
#include "initializer/stepping/path_layers.hpp"

namespace wex {
namespace {

constexpr int kEnoughSteppingPoses = 12;  // after these four wheels are not looked for any longer
constexpr double kBucketFirstM = 3.0, kBucketStepM = 0.4;

bool bucket_helps(const StanceCheck& check, const PlanSettings& plan, const Pose2& pose,
                  const BaseFrame& base, const Stance& stance, const SupportClass& support) {
  if (check.tables().arm.empty()) return false;
  const double c = std::cos(pose.yaw_rad), s = std::sin(pose.yaw_rad);
  const double side = support.bucket_side == 0 ? 1.0 : -1.0;
  for (double d = kBucketFirstM; d <= check.tables().arm.max_reach_m() + kBucketStepM;
       d += kBucketStepM) {
    const double x = pose.x_m + side * d * c, y = pose.y_m + side * d * s;
    if (!check.bucket_spot(x, y, pose.yaw_rad, plan.min_signed_distance_m)) continue;
    const auto on_bucket =
        check.margin_on_bucket(base, stance, support.lifted, {x, y, check.ground().height_m(x, y)},
                               plan.min_stability_margin_m, -2.0);
    if (on_bucket.margin_m >= plan.min_stability_margin_m) return true;
  }
  return false;
}

bool steps(const StanceCheck& check, const PlanSettings& plan, const Pose2& pose,
           const BaseFrame& base, const Stance& stance) {
  for (const SupportClass& support : kSupportClasses) {
    if (support.lifted == 0 || !stance.allows(support.lifted)) continue;
    if (support.bucket_side >= 0) {
      if (bucket_helps(check, plan, pose, base, stance, support)) return true;
    } else if (check.margin_with_counter_weight(base, stance, support.lifted).margin_m >=
               plan.min_stability_margin_m) {
      return true;
    }
  }
  return false;
}

// 0, 1, -1, 2, -2, ...
int alternating(int k) { return k % 2 == 0 ? -k / 2 : (k + 1) / 2; }

}  // namespace

Certifier::Admission project_stance(const StanceCheck& check, const PlanSettings& plan,
                                    const CertificateSettings& settings, const Pose2& pose,
                                    double curvature_1_m) noexcept {
  const GroundUnder under = ground_under(check, pose);
  if (!under.any || std::abs(under.roll_rad) > plan.max_tilt_rad) {
    return Certifier::Admission::kRefused;
  }
  const int steering = check.steering(curvature_1_m);
  const StanceClearances plain{plan.min_signed_distance_m, StanceClearances{}.swing_m,
                               plan.belly_clearance_m};
  const double nominal_m =
      std::clamp(under.height_m + check.tables().default_base_height_m, under.lowest_base_m,
                 std::max(under.lowest_base_m, under.highest_base_m));
  const int num_z = 2 * static_cast<int>(std::ceil((under.highest_base_m - under.lowest_base_m) /
                                                   settings.height_step_m)) +
                    1;
  // Pitch cells from the nominal one outwards, as far as the graph's grid goes.
  const double low = std::min(0.0, under.pitch_rad) - settings.max_pitch_offset_rad,
               high = std::max(0.0, under.pitch_rad) + settings.max_pitch_offset_rad;
  const int num_pitch = 2 * static_cast<int>(std::ceil((high - low) / settings.pitch_step_rad)) + 1;
  int stepping_poses = 0;
  for (int i = 0; i < num_z; ++i) {
    const double z = nominal_m + settings.height_step_m * alternating(i);
    if (z < under.lowest_base_m - settings.height_step_m ||
        z > under.highest_base_m + settings.height_step_m) {
      continue;
    }
    for (int j = 0; j < num_pitch; ++j) {
      const double pitch =
          std::round(under.pitch_rad / settings.pitch_step_rad) * settings.pitch_step_rad +
          settings.pitch_step_rad * alternating(j);
      if (pitch < low - 1e-9 || pitch > high + 1e-9 || std::abs(pitch) > plan.max_tilt_rad)
        continue;
      BaseCoordinates coordinates;
      coordinates << pose.x_m, pose.y_m, z, pose.yaw_rad, pitch, under.roll_rad;
      const BaseFrame base = BaseFrame::from(coordinates);
      const Stance stance = check.stance(base, steering, plain);
      if (stance.allows(0) && check.margin_on_wheels(base, stance) >= plan.min_stability_margin_m) {
        return Certifier::Admission::kOnFourWheels;
      }
      if (stepping_poses > 0) {
        if (++stepping_poses > kEnoughSteppingPoses) return Certifier::Admission::kNeedsStepping;
      } else if (steps(check, plan, pose, base, stance)) {
        stepping_poses = 1;
      }
    }
  }
  return stepping_poses > 0 ? Certifier::Admission::kNeedsStepping : Certifier::Admission::kRefused;
}

}  // namespace wex
