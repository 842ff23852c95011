#include "initializer/stepping/stance_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "initializer/stepping/stance_polygon.hpp"
#include "initializer/stepping/tyre_patch.hpp"

namespace wex {
namespace {

constexpr double kBellySpacingM = 0.29;  // with the 3 x 3 maximum no cell is left out
constexpr double kBeamHalfM = 0.17;      // half thickness of a leg beam and 5 cm
constexpr double kForearmHalfM = 0.25;   // dipper and telescope with clearance
constexpr double kBucketClearM = 0.05;   // of the bucket's back while its edge is down
constexpr double kCounterWeightClearM = 0.3;
constexpr double kBucketHalfWidthM = 0.6;  // where the ends of its edge are looked at
constexpr double kBucketUnevenM = 0.15;    // ground under the ends against the middle
constexpr double kClawClearM = 0.05;
constexpr double kBallM = 0.02;  // a tyre lowered as a ball beside steep edges
constexpr int kClawSamples = 5;  // a claw is 0.9 m long
constexpr int kBeamSamples = 3, kForearmSamples = 4, kBucketSamples = 3;
constexpr double kResidualM = 0.004;  // wheel centre against the ground, before it is refined
constexpr int kMaxRefinements = 12;
constexpr int kMaxCounterWeights = 256, kMaxRejectedCounterWeights = 12;

/// How far the middle of the touching patch is from the tyre's middle when the ground is tilted
/// along the axle: the patch is what is pressed in by a few centimetres.
double patch_shift_m(double tilt, double half_width_m) {
  constexpr double kPressedM = 0.02;
  const double whole_width =
      kPressedM / (2.0 * half_width_m);  // tilt up to which all of it touches
  return tilt < whole_width ? half_width_m / 3.0 * tilt / whole_width
                            : half_width_m - kPressedM / (3.0 * tilt);
}

}  // namespace

BaseFrame BaseFrame::from(const BaseCoordinates& base) {
  const Eigen::Isometry3d T = T_world_base_from(base);
  return {T.linear(), T.translation()};
}

StanceCheck::StanceCheck(const StanceGround& ground, const StanceTables& tables)
    : ground_(&ground), tables_(&tables) {
  const Eigen::Vector2d size = tables.belly_max_m - tables.belly_min_m;
  const Eigen::Array2i steps = (size.array() / kBellySpacingM).ceil().max(1.0).cast<int>();
  for (int i = 0; i <= steps.x(); ++i) {
    for (int j = 0; j <= steps.y(); ++j) {
      p_base_belly_.emplace_back(tables.belly_min_m.x() + size.x() * i / steps.x(),
                                 tables.belly_min_m.y() + size.y() * j / steps.y(),
                                 -tables.belly_below_base_m);
      belly_radius_m_ = std::max(belly_radius_m_, p_base_belly_.back().head<2>().norm());
    }
  }
}

bool StanceCheck::belly_clear(const BaseFrame& base, double clearance_m) const noexcept {
  const double tilt = base.R_world_base.row(2).head<2>().norm();
  const double lowest =
      base.p_world_base.z() - tables_->belly_below_base_m - belly_radius_m_ * tilt - clearance_m;
  const Eigen::Vector3d& p_base_origin = base.p_world_base;
  if (lowest > ground_->ground_top_m(p_base_origin.x(), p_base_origin.y())) return true;
  for (const Eigen::Vector3d& p_base : p_base_belly_) {
    const Eigen::Vector3d p = base * p_base;
    if (p.z() - clearance_m < ground_->highest_m(p.x(), p.y())) return false;
  }
  return true;
}

bool StanceCheck::beams_clear(const BaseFrame& base, const LegSample& high, const LegSample& low,
                              double share, int num_points) const noexcept {
  std::array<Eigen::Vector3d, LegSample::kMaxBeamPoints> p;
  double lowest = 1e9;
  for (int b = 0; b < num_points; ++b) {
    const auto at = static_cast<std::size_t>(b);
    p[at] = base * ((1.0 - share) * high.p_base_beam[at] + share * low.p_base_beam[at]);
    lowest = std::min(lowest, p[at].z());
  }
  // A leg lies within the reach of the top about its middle.
  const Eigen::Vector3d middle = 0.5 * (p[0] + p[static_cast<std::size_t>(num_points) - 1]);
  if (lowest - kBeamHalfM > ground_->ground_top_m(middle.x(), middle.y())) return true;
  for (int b = 1; b < num_points; ++b) {
    const Eigen::Vector3d& from = p[static_cast<std::size_t>(b) - 1];
    const Eigen::Vector3d step = (p[static_cast<std::size_t>(b)] - from) / kBeamSamples;
    for (int k = b == 1 ? 0 : 1; k <= kBeamSamples; ++k) {
      const Eigen::Vector3d x = from + k * step;
      if (x.z() - kBeamHalfM < ground_->highest_m(x.x(), x.y())) return false;
    }
  }
  return true;
}

bool StanceCheck::claw_clear(const BaseFrame& base, const LegSample& high, const LegSample& low,
                             double share, double radius_m) const noexcept {
  const auto at = [&](std::size_t end) -> Eigen::Vector3d {
    return base * ((1.0 - share) * high.p_base_claw[end] + share * low.p_base_claw[end]);
  };
  const Eigen::Vector3d from = at(0), to = at(1), step = (to - from) / kClawSamples;
  const Eigen::Vector3d middle = 0.5 * (from + to);
  if (std::min(from.z(), to.z()) - radius_m - kClawClearM >
      ground_->ground_top_m(middle.x(), middle.y())) {
    return true;
  }
  for (int k = 0; k <= kClawSamples; ++k) {
    const Eigen::Vector3d x = from + k * step;
    if (x.z() - radius_m - kClawClearM < ground_->highest_m(x.x(), x.y())) return false;
  }
  return true;
}

// Between the highest sample and the one before `end`, where the wheel stands: beside its foothold
// the wheel keeps its clearance, and a claw stands out farthest while it is level.
bool StanceCheck::sweep_is_clear(const BaseFrame& base, const LegSweep& sweep, int leg, int end,
                                 const Eigen::Vector3d& p_world_wheel,
                                 double swing_m) const noexcept {
  const auto i = static_cast<std::size_t>(leg);
  for (int n = 0; n < end; ++n) {
    const LegSample& passed = sweep.samples[static_cast<std::size_t>(n)];
    if (sweep.has_claw && !claw_clear(base, passed, passed, 0.0, tables_->claw_radius_m[i])) {
      return false;
    }
    const Eigen::Vector3d p = base * passed.p_base_wheel;
    const bool swings = (p - p_world_wheel).head<2>().norm() >= kFootholdM;
    const double clearance_m = swings ? swing_m + kBallM : -kBallM;
    if (p.z() - tables_->radius_m[i] - clearance_m < ground_->dilated_top_side_m(p.x(), p.y())) {
      return false;
    }
  }
  return true;
}

LegFault StanceCheck::lower_leg(const BaseFrame& base, const LegSweep& sweep, int leg,
                                const StanceClearances& clearances, Stance& stance) const noexcept {
  const auto i = static_cast<std::size_t>(leg);
  const double radius_m = tables_->radius_m[i];
  const auto world = [&](const Eigen::Vector3d& p_base) -> Eigen::Vector3d {
    return base * p_base;
  };
  const auto gap = [&](const Eigen::Vector3d& p) {
    return p.z() - radius_m - ground_->dilated_m(p.x(), p.y());
  };
  const Eigen::Vector3d up = base.R_world_base.row(2).transpose();
  // The whole sweep stays within the reach of the top about its middle.
  const Eigen::Vector3d middle = world(sweep.samples[LegSweep::kSamples / 2].p_base_wheel);
  const double skip_above =
      ground_->dilated_top_m(middle.x(), middle.y()) + radius_m - base.p_world_base.z();

  double last_gap = 0.0;
  for (int n = 0; n < LegSweep::kSamples; ++n) {
    const LegSample& sample = sweep.samples[static_cast<std::size_t>(n)];
    // Nothing can be met up here; the last such sample is needed as the start of an interval.
    if (n + 1 < LegSweep::kSamples &&
        up.dot(sweep.samples[static_cast<std::size_t>(n) + 1].p_base_wheel) > skip_above) {
      continue;
    }
    const Eigen::Vector3d p = world(sample.p_base_wheel);
    const double g = gap(p);
    if (g > 0.0) {
      last_gap = g;
      continue;
    }
    if (n == 0) return LegFault::kNoGround;
    const LegSample& above = sweep.samples[static_cast<std::size_t>(n) - 1];
    if (last_gap <= 0.0) last_gap = gap(world(above.p_base_wheel));
    if (last_gap <= 0.0) return LegFault::kNoGround;
    // Between two samples: straight, or by halving where the ground jumps under the wheel.
    double share = last_gap / (last_gap - g);
    Eigen::Vector3d p_base =
        above.p_base_wheel + share * (sample.p_base_wheel - above.p_base_wheel);
    Eigen::Vector3d p_wheel = world(p_base);
    double rest = gap(p_wheel);
    double low = 0.0, high = 1.0;
    for (int k = 0; k < kMaxRefinements && std::abs(rest) > kResidualM; ++k) {
      (rest > 0.0 ? low : high) = share;
      share = 0.5 * (low + high);
      p_base = above.p_base_wheel + share * (sample.p_base_wheel - above.p_base_wheel);
      p_wheel = world(p_base);
      rest = gap(p_wheel);
    }
    if (ground_->clear_m(p_wheel.x(), p_wheel.y()) <= clearances.edge_m) return LegFault::kEdge;
    // A disc on ground that is tilted along its axle stands on its edge (wheel_rest).
    const Eigen::Vector2d slope = ground_->dilated_gradient(p_wheel.x(), p_wheel.y());
    Eigen::Vector3d normal(-slope.x(), -slope.y(), 1.0);
    const double length = normal.norm();
    normal /= length;
    const Eigen::Vector3d axle = base.R_world_base * sample.axle_base;
    const double along_axle = axle.dot(normal), tilt = std::abs(along_axle);
    const Eigen::Vector3d in_wheel = normal - along_axle * axle;
    const double cosine = in_wheel.norm();
    const double raised_m = length * (radius_m * (cosine - 1.0) + tables_->half_width_m[i] * tilt);
    const double fall_m = up.dot(above.p_base_wheel - sample.p_base_wheel);
    share -= (raised_m - rest) / fall_m;
    if (n == 1 && share < 0.0) return LegFault::kNoGround;
    if (n + 1 == LegSweep::kSamples && share > 1.0) return LegFault::kTooLow;
    if (!leg_clear(base, sweep, leg, above, sample, share)) {
      return LegFault::kBeam;
    }
    p_base = above.p_base_wheel + share * (sample.p_base_wheel - above.p_base_wheel);
    stance.p_world_wheel[i] = world(p_base);
    stance.axle_world[i] = axle;
    stance.p_world_patch[i] =
        stance.p_world_wheel[i] - radius_m / cosine * in_wheel -
        std::copysign(patch_shift_m(tilt, tables_->half_width_m[i]), along_axle) * axle;
    stance.moment_grounded_base[i] =
        above.moment_base + share * (sample.moment_base - above.moment_base);
    if (sweep_is_clear(base, sweep, leg, n, stance.p_world_wheel[i], clearances.swing_m)) {
      stance.sweep_clear |= static_cast<std::uint8_t>(1U << i);
    }
    return LegFault::kNone;
  }
  return LegFault::kTooLow;
}

Stance StanceCheck::stance(const BaseFrame& base, int steering,
                           const StanceClearances& clearances) const noexcept {
  Stance stance;
  stance.belly_clear = belly_clear(base, clearances.belly_m);
  if (!stance.belly_clear) return stance;
  for (int leg = 0; leg < kNumWheels; ++leg) {
    const auto i = static_cast<std::size_t>(leg);
    const LegSweep& sweep = tables_->legs[i][static_cast<std::size_t>(steering)];
    stance.fault[i] = lower_leg(base, sweep, leg, clearances, stance);
    if (stance.fault[i] == LegFault::kNone) stance.grounded |= static_cast<std::uint8_t>(1U << i);

    const LegSample& highest = sweep.samples.front();
    stance.moment_lifted_base[i] = highest.moment_base;
    const Eigen::Vector3d p = base * highest.p_base_wheel;
    const double lowest = p.z() - tables_->radius_m[i] - clearances.swing_m;
    if (lowest >= ground_->dilated_top_side_m(p.x(), p.y()) &&
        leg_clear(base, sweep, leg, highest, highest, 0.0)) {
      stance.swing_clear |= static_cast<std::uint8_t>(1U << i);
    }
  }
  return stance;
}

bool StanceCheck::tyres_rest(const Stance& stance, std::uint8_t lifted) const noexcept {
  const auto height_at = [&](double x, double y) { return ground_->height_m(x, y); };
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    if ((lifted >> i & 1U) != 0) continue;
    const double clearance_m =
        tread_clearance_m(height_at, stance.p_world_wheel[i], stance.axle_world[i],
                          tables_->radius_m[i], tables_->half_width_m[i]);
    if (std::abs(clearance_m) > kTreadErrorM) return false;
  }
  return true;
}

Eigen::Vector3d StanceCheck::moment_of_legs(const Stance& stance,
                                            std::uint8_t lifted) const noexcept {
  Eigen::Vector3d moment = tables_->moment_chassis_base;
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    moment +=
        (lifted >> i & 1U) != 0 ? stance.moment_lifted_base[i] : stance.moment_grounded_base[i];
  }
  return moment;
}

double StanceCheck::margin_on_wheels(const BaseFrame& base, const Stance& stance) const noexcept {
  const StancePolygon polygon(stance.p_world_patch, 0);
  const StancePolygon::InBase edges =
      polygon.in_base(base, moment_of_legs(stance, 0), tables_->mass_kg);
  double margin_m = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& moment : tables_->moment_folded_base) {
    margin_m = std::min(margin_m, edges.margin_m(moment));
  }
  return margin_m;
}

StanceCheck::Balanced StanceCheck::margin_with_counter_weight(const BaseFrame& base,
                                                              const Stance& stance,
                                                              std::uint8_t lifted) const noexcept {
  const std::size_t count =
      std::min<std::size_t>(tables_->counter_weights.size(), kMaxCounterWeights);
  const StancePolygon polygon(stance.p_world_patch, lifted);
  const StancePolygon::InBase edges =
      polygon.in_base(base, moment_of_legs(stance, lifted), tables_->mass_kg);
  std::array<double, kMaxCounterWeights> margins;
  for (std::size_t k = 0; k < count; ++k) {
    margins[k] = edges.margin_m(tables_->counter_weights[k].moment_base);
  }
  for (int tries = 0; tries < kMaxRejectedCounterWeights && count > 0; ++tries) {
    const auto best =
        std::max_element(margins.begin(), margins.begin() + static_cast<std::ptrdiff_t>(count));
    if (*best < 0.0) break;
    const CounterWeight& weight =
        tables_->counter_weights[static_cast<std::size_t>(best - margins.begin())];
    const Eigen::Vector3d elbow = base * weight.p_base_elbow, wrist = base * weight.p_base_wrist,
                          bucket = base * weight.p_base_bucket;
    if (beam_clear(elbow, wrist, kForearmSamples, 1.0, kForearmHalfM) &&
        beam_clear(wrist, bucket, kBucketSamples, 1.0, kCounterWeightClearM)) {
      return {*best, static_cast<int>(best - margins.begin())};
    }
    *best = -1e9;
  }
  return {};
}

bool StanceCheck::beam_clear(const Eigen::Vector3d& a, const Eigen::Vector3d& b, int samples,
                             double share, double thickness_m) const noexcept {
  for (int k = 0; k <= samples; ++k) {
    const Eigen::Vector3d p = a + (b - a) * (share * k / samples);
    if (p.z() - thickness_m < ground_->highest_m(p.x(), p.y())) return false;
  }
  return true;
}

StanceCheck::OnBucket StanceCheck::margin_on_bucket(const BaseFrame& base, const Stance& stance,
                                                    std::uint8_t lifted,
                                                    const Eigen::Vector3d& p_world_bucket,
                                                    double enough_m,
                                                    double stretched_m) const noexcept {
  constexpr double kBackShare = 0.8;  // of the way from hinge to edge: the rest is at the ground
  OnBucket result;
  if (tables_->arm.empty()) return result;
  const ArmPlane& plane = tables_->arm.plane();
  const Eigen::Vector3d p_base =
      base.R_world_base.transpose() * (p_world_bucket - base.p_world_base);
  const auto place = plane.in_plane(p_base);
  if (!place) return result;
  const ArmTable::Span postures = tables_->arm.postures(place->contact);
  if (postures.empty()) return result;
  result.turn_rad = place->turn_rad;
  const double c = std::cos(place->turn_rad), s = std::sin(place->turn_rad);

  const StancePolygon polygon(stance.p_world_patch, lifted, p_world_bucket, base);
  const StancePolygon::InBase edges =
      polygon.in_base(base, moment_of_legs(stance, lifted), tables_->mass_kg);
  const bool ask_stretched = stretched_m > -1.0;
  StancePolygon::InBase wheels;
  if (ask_stretched) {
    wheels = StancePolygon(stance.p_world_patch, 0)
                 .in_base(base, moment_of_legs(stance, 0), tables_->mass_kg);
  }
  for (const ArmTable::Posture* posture = postures.begin; posture != postures.end; ++posture) {
    const Eigen::Vector3d moment =
        plane.moment_base({posture->moment_forward, posture->moment_up}, c, s);
    const double margin_m = edges.margin_m(moment);
    if (margin_m <= result.margin_m) continue;
    double on_wheels_m = -1e9;
    if (ask_stretched) {
      on_wheels_m = wheels.margin_m(moment);
      if (on_wheels_m < stretched_m) continue;
    }
    const Eigen::Vector3d elbow =
        base * plane.p_base({posture->elbow_forward, posture->elbow_up}, c, s);
    const Eigen::Vector3d wrist =
        base * plane.p_base({posture->wrist_forward, posture->wrist_up}, c, s);
    if (!beam_clear(elbow, wrist, kForearmSamples, 1.0, kForearmHalfM) ||
        !beam_clear(wrist, p_world_bucket, kBucketSamples, kBackShare, kBucketClearM)) {
      continue;
    }
    result.margin_m = margin_m;
    result.stretched_m = on_wheels_m;
    result.posture = posture;
    if (margin_m >= enough_m) break;
  }
  return result;
}

bool StanceCheck::bucket_spot(double x, double y, double yaw_rad, double edge_m) const noexcept {
  const double height_m = ground_->height_m(x, y);
  for (int side = -1; side <= 1; ++side) {
    const double a = x - side * kBucketHalfWidthM * std::sin(yaw_rad);
    const double b = y + side * kBucketHalfWidthM * std::cos(yaw_rad);
    if (ground_->clear_m(a, b) <= edge_m) return false;
    if (std::abs(ground_->height_m(a, b) - height_m) > kBucketUnevenM) return false;
  }
  return true;
}

}  // namespace wex
