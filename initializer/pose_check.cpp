#include "initializer/pose_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "models/terrain/wheel_rest.hpp"

namespace wex {
namespace {

constexpr double kJointMarginRad = 0.02;    // keeps hip flexion off its end stops
constexpr double kHeightToleranceM = 1e-5;  // wheel centre against the ground
constexpr double kBellySpacingM = 0.2;      // two cells of the usual map
constexpr double kUngroundedCost = 1000.0;  // dominates every other term of Algorithm 1
constexpr int kMaxGroundingSteps = 40;
constexpr int kMaxSettlingSteps = 6;
constexpr double kMinLiftPerRad = 0.3;  // m/rad that hip flexion raises a wheel at least
constexpr int kNumHeightSteps = 3;      // 0, 0.2 and 0.4 m above the standing height
constexpr double kHeightStepM = 0.2;
constexpr double kTableErrorM = 1e-4;  // added to every demand: tables err by less

}  // namespace

std::string describe(Rejection rejection) {
  switch (rejection) {
    case Rejection::kNone:
      return "nothing";
    case Rejection::kOffMap:
      return "off the map";
    case Rejection::kUnknownGround:
      return "unknown ground";
    case Rejection::kTilt:
      return "too much tilt";
    case Rejection::kUntraversable:
      return "a wheel on untraversable ground";
    case Rejection::kNearUntraversable:
      return "a wheel too close to untraversable ground";
    case Rejection::kOutOfReach:
      return "ground out of a wheel's reach";
    case Rejection::kSteeringLimit:
      return "steering at its limit";
    case Rejection::kBelly:
      return "too little clearance under the chassis";
    case Rejection::kUnstable:
      return "too little stability margin";
  }
  return "an unnamed reason";
}

std::string describe(const StandingPose& pose, const Eigen::Vector2d& map_origin_m) {
  const Eigen::Vector2d place = pose.where_world_xy + map_origin_m;
  char at[64];
  std::snprintf(at, sizeof at, " at (%.2f, %.2f)", place.x(), place.y());
  const std::string who =
      pose.wheel >= 0
          ? "wheel " + std::string(kLimbNames[static_cast<std::size_t>(pose.wheel)]) + " would be "
          : std::string("the machine would be ");
  switch (pose.rejection) {
    case Rejection::kOffMap:
      return who + "off the map" + at;
    case Rejection::kUnknownGround:
      return who + "over unknown ground" + at;
    case Rejection::kUntraversable:
      return who + "in an untraversable spot" + at;
    case Rejection::kNearUntraversable:
      return who + "too close to an untraversable spot" + at;
    case Rejection::kOutOfReach:
      return who + "out of reach of the ground" + at;
    case Rejection::kSteeringLimit:
      return who + "beyond its steering limit" + at;
    default:
      return describe(pose.rejection) + at;
  }
}

double support_margin_m(const Eigen::Vector2d& p,
                        const std::array<Eigen::Vector2d, kNumWheels>& contacts) {
  constexpr std::array<Limb, kNumWheels> kCounterClockwise{Limb::kLF, Limb::kLH, Limb::kRH,
                                                           Limb::kRF};
  double margin_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    const Eigen::Vector2d& a = contacts[static_cast<std::size_t>(kCounterClockwise[i])];
    const Eigen::Vector2d& b =
        contacts[static_cast<std::size_t>(kCounterClockwise[(i + 1) % kNumWheels])];
    const Eigen::Vector2d edge = (b - a).normalized();
    margin_m = std::min(margin_m, edge.x() * (p.y() - a.y()) - edge.y() * (p.x() - a.x()));
  }
  return margin_m;
}

Tilt tilt_from_normal(const Eigen::Vector3d& normal_world, double yaw_rad) {
  const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
  const double forward = c * normal_world.x() + s * normal_world.y();
  const double left = -s * normal_world.x() + c * normal_world.y();
  return {-std::asin(std::clamp(left, -1.0, 1.0)), std::atan2(forward, normal_world.z())};
}

Result<PoseCheck> PoseCheck::build(const TerrainMap& terrain, const MachineModel& machine,
                                   const PlanSettings& settings) {
  auto legs = build_leg_tables(machine);
  if (!legs) return tl::unexpected<Error>(legs.error());
  return PoseCheck(terrain, machine, settings, *std::move(legs));
}

PoseCheck::PoseCheck(const TerrainMap& terrain, const MachineModel& machine,
                     const PlanSettings& settings, std::array<LegTable, kNumWheels> legs)
    : terrain_(&terrain), machine_(&machine), settings_(settings), legs_(std::move(legs)) {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(machine.num_coordinates());
  q.tail(machine.num_joints()) = machine.transport_posture();
  for (const WheeledLeg& leg : machine.legs) {
    q[leg.hfe] = 0.0;
    if (leg.steer >= 0) q[leg.steer] = 0.0;
  }
  KinematicTree::Workspace w = machine.tree.make_workspace();
  machine.tree.update(q, w);
  settings_.min_stability_margin_m += kTableErrorM;
  settings_.min_signed_distance_m += kTableErrorM;
  settings_.belly_clearance_m += kTableErrorM;
  mass_kg_ = machine.tree.total_mass_kg();
  moment_base_ = mass_kg_ * machine.tree.com(w);

  const Eigen::Vector2d size = machine.belly_max_m - machine.belly_min_m;
  const Eigen::Array2i steps = (size.array() / kBellySpacingM).ceil().max(1.0).cast<int>();
  for (int i = 0; i <= steps.x(); ++i) {
    for (int j = 0; j <= steps.y(); ++j) {
      p_base_belly_.emplace_back(machine.belly_min_m.x() + size.x() * i / steps.x(),
                                 machine.belly_min_m.y() + size.y() * j / steps.y(),
                                 -machine.belly_below_base_m);
    }
  }
}

std::array<double, kNumWheels> PoseCheck::default_hfe_rad() const {
  std::array<double, kNumWheels> hfe{};
  for (std::size_t i = 0; i < kNumWheels; ++i) hfe[i] = legs_[i].hfe_default_rad();
  return hfe;
}

PoseCheck::Steering PoseCheck::steering_for(double curvature_1_m,
                                            const std::array<double, kNumWheels>& hfe_rad) const {
  Steering steering;
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    steering[i] = LegTable::Steer(legs_[i].steering_rad(hfe_rad[i], curvature_1_m));
  }
  return steering;
}

Rejection PoseCheck::ground_under(const Eigen::Vector2d& p_world_xy) const {
  if (!terrain_->contains(p_world_xy)) return Rejection::kOffMap;
  if (!terrain_->known(p_world_xy)) return Rejection::kUnknownGround;
  if (!terrain_->traversable_at(p_world_xy)) return Rejection::kUntraversable;
  // Negated so that an unknown distance is a rejection as well.
  if (!(terrain_->signed_distance_m(p_world_xy) >= settings_.min_signed_distance_m)) {
    return Rejection::kNearUntraversable;
  }
  return Rejection::kNone;
}

// Hip flexion that puts the wheel centre one radius above the tyre-dilated ground, then the disc on
// it: Newton with the table's slope first, then secant steps kept inside a shrinking bracket.
// Positive gap: too high.
PoseCheck::Grounding PoseCheck::ground_leg(const Eigen::Isometry3d& T_world_base, int leg,
                                           const LegTable::Steer& steer) const {
  const LegTable& table = legs_[static_cast<std::size_t>(leg)];
  const double radius_m = machine_->legs[static_cast<std::size_t>(leg)].radius_m;
  const double lower = table.hfe_lower_rad() + kJointMarginRad;
  const double upper = table.hfe_upper_rad() - kJointMarginRad;
  double too_low = lower, too_high = upper;  // bracket: gap < 0 at too_low, > 0 at too_high
  bool lower_tried = false, upper_tried = false;
  double hfe = std::clamp(table.hfe_default_rad(), lower, upper);
  double last_hfe = hfe, last_gap = 0.0;

  Grounding grounding;
  for (int i = 0; i < kMaxGroundingSteps; ++i) {
    const Eigen::Vector3d p_world = T_world_base * table.p_base_wheel(hfe, steer);
    const double gap = p_world.z() - radius_m - terrain_->dilated_height_m(p_world.head<2>());
    grounding.hfe_rad = hfe;
    grounding.p_world_wheel = p_world;
    if (std::isnan(gap)) {
      grounding.rejection =
          terrain_->contains(p_world.head<2>()) ? Rejection::kUnknownGround : Rejection::kOffMap;
      return grounding;
    }
    if (std::abs(gap) < kHeightToleranceM) {
      settle(T_world_base, leg, steer, grounding);
      return grounding;
    }
    if ((gap > 0.0 && hfe <= lower) || (gap < 0.0 && hfe >= upper)) break;
    (gap > 0.0 ? too_high : too_low) = hfe;
    lower_tried |= hfe <= lower;
    upper_tried |= hfe >= upper;

    const double table_slope = T_world_base.linear().row(2).dot(table.dp_base_wheel(hfe, steer));
    double slope = table_slope;
    if (i > 0 && hfe != last_hfe) {
      const double secant = (gap - last_gap) / (hfe - last_hfe);
      if (secant > 0.3 * table_slope) slope = secant;
    }
    last_hfe = hfe;
    last_gap = gap;
    hfe -= gap / slope;
    // An end of the range may be the answer as long as it has not been tried.
    const bool below = hfe <= too_low, above = hfe >= too_high;
    if (below && too_low <= lower && !lower_tried) {
      hfe = lower;
    } else if (above && too_high >= upper && !upper_tried) {
      hfe = upper;
    } else if (below || above || !std::isfinite(hfe)) {
      hfe = 0.5 * (too_low + too_high);
    }
  }
  grounding.rejection = ground_under(grounding.p_world_wheel.head<2>());
  if (grounding.rejection == Rejection::kNone) grounding.rejection = Rejection::kOutOfReach;
  return grounding;
}

// From where a ball would rest to where the disc does, a few centimetres on ground tilted along the
// axle.
void PoseCheck::settle(const Eigen::Isometry3d& T_world_base, int leg, const LegTable::Steer& steer,
                       Grounding& grounding) const {
  const LegTable& table = legs_[static_cast<std::size_t>(leg)];
  const WheeledLeg& wheel = machine_->legs[static_cast<std::size_t>(leg)];
  double& hfe = grounding.hfe_rad;
  for (int i = 0; i < kMaxSettlingSteps; ++i) {
    const Eigen::Vector3d p_world = T_world_base * table.p_base_wheel(hfe, steer);
    const Eigen::Vector3d axle_world = T_world_base.linear() * table.axle_base(hfe, steer);
    const WheelRest rest =
        wheel_rest(*terrain_, p_world.head<2>(), axle_world, wheel.radius_m, wheel.half_width_m);
    grounding.p_world_wheel = p_world;
    const double gap = p_world.z() - rest.height_m;
    if (std::abs(gap) < kHeightToleranceM) break;
    const Eigen::Vector3d by_hfe = T_world_base.linear() * table.dp_base_wheel(hfe, steer);
    hfe -= gap / std::max(kMinLiftPerRad, by_hfe.z() - rest.by_xy.dot(by_hfe.head<2>()));
  }
  grounding.rejection = ground_under(grounding.p_world_wheel.head<2>());
  const bool reached = hfe >= table.hfe_lower_rad() + kJointMarginRad &&
                       hfe <= table.hfe_upper_rad() - kJointMarginRad;
  if (grounding.rejection == Rejection::kNone && !reached) {
    grounding.rejection = Rejection::kOutOfReach;
  }
}

PoseCheck::Trial PoseCheck::try_base(const BaseCoordinates& base,
                                     const Eigen::Isometry3d& T_world_base,
                                     const Steering& steering) const {
  Trial trial;
  double stroke_deviation = 0.0;
  for (int i = 0; i < kNumWheels; ++i) {
    const LegTable& table = legs_[static_cast<std::size_t>(i)];
    Grounding& leg = trial.legs[static_cast<std::size_t>(i)];
    leg = ground_leg(T_world_base, i, steering[static_cast<std::size_t>(i)]);
    if (leg.rejection != Rejection::kNone) ++trial.num_ungrounded;
    const double half_stroke = 0.5 * (table.hfe_upper_rad() - table.hfe_lower_rad());
    const double middle = 0.5 * (table.hfe_upper_rad() + table.hfe_lower_rad());
    stroke_deviation += std::pow((leg.hfe_rad - middle) / half_stroke, 2) / kNumWheels;
  }
  const double tilt = (std::pow(base[kBaseRoll], 2) + std::pow(base[kBasePitch], 2)) /
                      std::pow(settings_.max_tilt_rad, 2);
  trial.cost = kUngroundedCost * trial.num_ungrounded + tilt + stroke_deviation;
  return trial;
}

Rejection PoseCheck::ground_under_belly(const Eigen::Isometry3d& T_world_base) const {
  for (const Eigen::Vector3d& p_base : p_base_belly_) {
    const Eigen::Vector3d p = T_world_base * p_base;
    const double clearance_m = p.z() - terrain_->height_m(p.head<2>());
    if (std::isnan(clearance_m)) {
      return terrain_->contains(p.head<2>()) ? Rejection::kUnknownGround : Rejection::kOffMap;
    }
    if (clearance_m < settings_.belly_clearance_m) return Rejection::kBelly;
  }
  return Rejection::kNone;
}

double PoseCheck::stability_margin(const Eigen::Isometry3d& T_world_base, const Trial& trial,
                                   const Steering& steering) const {
  Eigen::Vector3d moment = moment_base_;
  std::array<Eigen::Vector2d, kNumWheels> contacts;
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    moment += legs_[i].moment_base(trial.legs[i].hfe_rad, steering[i]);
    contacts[i] = trial.legs[i].p_world_wheel.head<2>();
  }
  const Eigen::Vector3d com = T_world_base * (moment / mass_kg_);
  return support_margin_m(com.head<2>(), contacts);
}

StandingPose PoseCheck::judge(const BaseCoordinates& base, const Eigen::Isometry3d& T_world_base,
                              const Trial& trial, const Steering& steering) const {
  StandingPose pose;
  pose.base = base;
  pose.where_world_xy = base.head<2>();
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    const Grounding& leg = trial.legs[i];
    pose.hfe_rad[i] = leg.hfe_rad;
    pose.steer_rad[i] = steering[i].angle_rad();
    const bool steerable = pose.steer_rad[i] >= legs_[i].steer_lower_rad() &&
                           pose.steer_rad[i] <= legs_[i].steer_upper_rad();
    if (!pose.ok() || (leg.rejection == Rejection::kNone && steerable)) continue;
    pose.rejection = steerable ? leg.rejection : Rejection::kSteeringLimit;
    pose.wheel = static_cast<int>(i);
    pose.where_world_xy = leg.p_world_wheel.head<2>();
  }
  if (!pose.ok()) return pose;
  pose.stability_margin_m = stability_margin(T_world_base, trial, steering);
  if (!(pose.stability_margin_m >= settings_.min_stability_margin_m)) {
    pose.rejection = Rejection::kUnstable;
  } else {
    pose.rejection = ground_under_belly(T_world_base);
  }
  return pose;
}

StandingPose PoseCheck::check(const BaseCoordinates& base, const Steering& steering) const {
  if (std::abs(base[kBaseRoll]) > settings_.max_tilt_rad ||
      std::abs(base[kBasePitch]) > settings_.max_tilt_rad) {
    StandingPose tilted;
    tilted.rejection = Rejection::kTilt;
    tilted.base = base;
    tilted.where_world_xy = base.head<2>();
    return tilted;
  }
  const Eigen::Isometry3d T_world_base = T_world_base_from(base);
  return judge(base, T_world_base, try_base(base, T_world_base, steering), steering);
}

StandingPose PoseCheck::stand(const Pose2& pose, const Steering& steering) const {
  const Eigen::Vector2d here(pose.x_m, pose.y_m);
  StandingPose best;
  best.where_world_xy = here;
  if (!terrain_->contains(here)) {
    best.rejection = Rejection::kOffMap;
    return best;
  }

  std::array<double, 4> heights{terrain_->height_m(here), terrain_->filtered_height_m(here)};
  std::array<Eigen::Vector3d, 4> normals{terrain_->normal(here), terrain_->filtered_normal(here)};
  std::size_t num_candidates = 2;
  // On traversable ground the nearest traversable place is here, with the same four values.
  if (!terrain_->traversable_at(here)) {
    const Eigen::Vector2d nearest = terrain_->nearest_traversable(here);
    heights[2] = terrain_->height_m(nearest);
    heights[3] = terrain_->filtered_height_m(nearest);
    normals[2] = terrain_->normal(nearest);
    normals[3] = terrain_->filtered_normal(nearest);
    num_candidates = 4;
  }

  best.rejection = Rejection::kUnknownGround;
  double lowest_cost = std::numeric_limits<double>::infinity();
  bool tilted_only = true;
  const auto propose = [&](const Tilt& tilt, double height_m) {
    if (std::isnan(height_m) || std::abs(tilt.roll_rad) > settings_.max_tilt_rad ||
        std::abs(tilt.pitch_rad) > settings_.max_tilt_rad) {
      return;
    }
    tilted_only = false;
    BaseCoordinates base;
    base << pose.x_m, pose.y_m, height_m + machine_->default_base_height_m, pose.yaw_rad,
        tilt.pitch_rad, tilt.roll_rad;
    const Eigen::Isometry3d T_world_base = T_world_base_from(base);
    const Trial trial = try_base(base, T_world_base, steering);
    if (best.ok() && trial.cost >= lowest_cost) return;
    const StandingPose candidate = judge(base, T_world_base, trial, steering);
    if (candidate.ok() || (!best.ok() && trial.cost < lowest_cost)) {
      best = candidate;
      lowest_cost = trial.cost;
    }
  };
  for (std::size_t n = 0; n < num_candidates; ++n) {
    const Tilt tilt = tilt_from_normal(normals[n], pose.yaw_rad);
    for (std::size_t h = 0; h < num_candidates; ++h) propose(tilt, heights[h]);
  }

  // A bump or a twist between the wheels is in none of the sixteen: ask the wheels themselves, and
  // raise the chassis if need be.
  if (!best.ok()) {
    const auto [tilt, height_m] = plane_under_wheels(pose);
    for (int i = 0; i < kNumHeightSteps && !best.ok(); ++i) {
      propose(tilt, height_m + i * kHeightStepM);
    }
  }
  if (!best.ok() && tilted_only) best.rejection = Rejection::kTilt;
  return best;
}

PoseCheck::GroundPlane PoseCheck::plane_under_wheels(const Pose2& pose) const {
  const Eigen::Isometry2d T_world_level =
      Eigen::Translation2d(pose.x_m, pose.y_m) * Eigen::Rotation2Dd(pose.yaw_rad);
  // Least squares of height = plane . (1, forward, left) over the four wheels.
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sums = Eigen::Vector3d::Zero();
  for (const LegTable& leg : legs_) {
    const Eigen::Vector3d p_base = leg.p_base_wheel(leg.hfe_default_rad(), LegTable::Steer());
    const Eigen::Vector3d row(1.0, p_base.x(), p_base.y());
    squares += row * row.transpose();
    sums += row * terrain_->dilated_height_m(T_world_level * p_base.head<2>());
  }
  const Eigen::Vector3d plane = squares.inverse() * sums;
  return {tilt_from_normal(Eigen::Vector3d(-plane[1], -plane[2], 1.0).normalized(), 0.0), plane[0]};
}

}  // namespace wex
