// What MotionBuilder decides before it makes nodes: base motion, how high wheels are lifted, how
// the arm is held.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "initializer/stepping/internal/motion_builder.hpp"
#include "initializer/stepping/tyre_patch.hpp"

namespace wex {
namespace {

constexpr double kTableErrorM = 1e-4;  // added to demands: tables err by less
// Of the tyres, for what is between the poses looked at; the first that the legs reach.
constexpr std::array<double, 4> kSwingReservesM = {0.05, 0.035, 0.02, 0.01};
constexpr double kBeamClearanceM = 0.05, kStandingClawClearM = 0.02;
constexpr double kLegSpacingM = 0.1;  // between the points of a leg held against the ground
constexpr double kLiftStepRad = 0.05;

std::string name_of(int wheel) {
  return wheel < 0 ? "the chassis"
                   : "wheel " + std::string(kLimbNames[static_cast<std::size_t>(wheel)]);
}

}  // namespace

Result<WheelPlacement, PlacementFailure> MotionBuilder::placed(const BaseRun::Point& point,
                                                               std::uint8_t lifted,
                                                               const Hips& lifted_hfe_rad) {
  auto placement =
      parts_.placer.place(point.base, point.curvature_1_m, lifted, lifted_hfe_rad, guess_rad_);
  if (!placement) return placement;
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    if ((lifted >> i & 1) == 0) guess_rad_[i] = placement->hfe_rad[i];
  }
  return placement;
}

bool MotionBuilder::leg_clear(std::size_t leg, double clearance_m, bool claw_only) const {
  const StanceGround& ground = parts_.placer.ground();
  const auto height_at = [&](const Eigen::Vector2d& p) { return ground.highest_m(p.x(), p.y()); };
  const auto part =
      static_cast<CollisionModel::Part>(static_cast<std::size_t>(CollisionModel::Part::kLF) + leg);
  const int carrier = parts_.machine.legs[leg].carrier_body;
  const auto& capsules = parts_.collision.capsules();
  for (std::size_t c = 0; c < capsules.size(); ++c) {
    if (capsules[c].part != part || capsules[c].load_bearing) continue;
    if (claw_only && !parts_.machine.tree.descends_from(capsules[c].body, carrier)) continue;
    if (parts_.collision.ground_clearance_m(workspace_, static_cast<int>(c), kLegSpacingM,
                                            height_at) < clearance_m) {
      return false;
    }
  }
  return true;
}

bool MotionBuilder::tyre_rests(std::size_t wheel) const {
  constexpr double kReserveM = 0.001;  // for what is between knots
  const WheeledLeg& leg = parts_.machine.legs[wheel];
  const KinematicTree& tree = parts_.machine.tree;
  const auto height_at = [&](double x, double y) { return parts_.terrain.height_m({x, y}); };
  const double clearance_m =
      tread_clearance_m(height_at, tree.position(workspace_, leg.carrier_body, leg.p_carrier_wheel),
                        tree.direction(workspace_, leg.carrier_body, leg.axle_carrier),
                        leg.radius_m, leg.half_width_m);
  return std::abs(clearance_m) <= kTreadErrorM - kReserveM;
}

std::optional<std::string> MotionBuilder::judge(const BaseRun& run, const BaseKnot& knot) {
  Hips upper{};
  for (int i = 0; i < kNumWheels; ++i) {
    upper[static_cast<std::size_t>(i)] = parts_.placer.upper_rad(i);
  }
  const std::uint8_t lifted = run.support.lifted;
  const auto placement = placed({knot.base, knot.curvature_1_m}, lifted, upper);
  if (!placement) return name_of(placement.error().wheel) + " " + placement.error().why;
  if (!parts_.placer.belly_clear(knot.base)) return "the chassis is too close to the ground";
  parts_.machine.tree.update(
      posture({knot.base, knot.curvature_1_m}, *placement, parts_.arm.transport()), workspace_);
  for (int i = 0; i < kNumWheels; ++i) {
    if ((lifted >> i & 1) == 0) {
      if (!tyre_rests(static_cast<std::size_t>(i))) {
        return "the tyre of leg " + std::string(kLimbNames[static_cast<std::size_t>(i)]) +
               " is not quite on the ground";
      }
      if (!leg_clear(static_cast<std::size_t>(i), kStandingClawClearM, true)) {
        return "the claw of leg " + std::string(kLimbNames[static_cast<std::size_t>(i)]) +
               " is too close to the ground";
      }
      continue;
    }
    if (!parts_.placer.lowest_clear_rad(knot.base, knot.curvature_1_m, i,
                                        parts_.motion.swing_clearance_m)) {
      return name_of(i) + " cannot be lifted clear of the ground";
    }
  }
  if (lifted == 0) {
    const Footing footing = footing_on(knot.base, *placement, 0, nullptr, parts_.placer.mass_kg());
    const double margin_m = footing.margin_m(parts_.arm.moment_base(parts_.arm.transport()));
    if (margin_m < parts_.settings.min_stability_margin_m + kTableErrorM) {
      return "only " + std::to_string(margin_m) + " m of stability on four wheels";
    }
  }
  return std::nullopt;
}

Result<std::vector<BucketStance>, MotionFailure> MotionBuilder::stances(const BaseRun& run) {
  std::vector<BucketStance> stances(run.knots.size());
  const Eigen::Vector3d* bucket =
      run.support.bucket < 0
          ? nullptr
          : &sequence_.bucket_points[static_cast<std::size_t>(run.support.bucket)];
  for (std::size_t i = 0; i < run.knots.size(); ++i) {
    const BaseRun::Point point{run.knots[i].base, run.knots[i].curvature_1_m};
    const auto placement = placed(point, run.support.lifted, run.lifted_hfe_rad);
    if (!placement) {
      missed_ground_ = true;
      return tl::unexpected<MotionFailure>(
          {run.knots[i].state, name_of(placement.error().wheel) + " " + placement.error().why});
    }
    stances[i].footing =
        footing_on(point.base, *placement, run.support.lifted, bucket, parts_.placer.mass_kg());
    if (i == 0 || i + 1 == run.knots.size()) {
      const auto on_wheels = footing(run, i, 0);
      if (!on_wheels) return tl::unexpected<MotionFailure>(on_wheels.error());
      stances[i].on_wheels = *on_wheels;
    }
  }
  return stances;
}

// The wheels' clearance decides how high legs are lifted; their beams may ask for more.
MotionBuilder::Done MotionBuilder::raise_legs_clear(BaseRun& run) {
  for (std::size_t leg = 0; leg < kNumWheels; ++leg) {
    if ((run.support.lifted >> leg & 1) == 0) continue;
    double& hfe = run.lifted_hfe_rad[leg];
    for (const BaseKnot& knot : run.knots) {
      const BaseRun::Point point{knot.base, knot.curvature_1_m};
      while (true) {
        const auto placement = placed(point, run.support.lifted, run.lifted_hfe_rad);
        if (!placement) return tl::unexpected<MotionFailure>({knot.state, placement.error().why});
        parts_.machine.tree.update(posture(point, *placement, parts_.arm.transport()), workspace_);
        if (leg_clear(leg, kBeamClearanceM, false)) break;
        const double upper = parts_.placer.upper_rad(static_cast<int>(leg));
        if (hfe >= upper) {
          return tl::unexpected<MotionFailure>(
              {knot.state,
               "leg " + std::string(kLimbNames[leg]) + " cannot be lifted clear of the ground"});
        }
        hfe = std::min(hfe + kLiftStepRad, upper);
      }
    }
  }
  return {};
}

MotionBuilder::Done MotionBuilder::prepare_support(PreparedRun& run) {
  if (run.base.support.lifted == 0 && run.base.support.bucket < 0) {
    run.held = {{0, parts_.arm.transport()}};
    return {};
  }
  Done lifts;
  for (const double reserve_m : kSwingReservesM) {
    lifts = lift_wheels(run.base, parts_.placer, parts_.motion.swing_clearance_m + reserve_m);
    if (lifts) break;
  }
  if (!lifts) return lifts;
  if (auto raised = raise_legs_clear(run.base); !raised) return raised;

  const auto standing = stances(run.base);
  if (!standing) return tl::unexpected<MotionFailure>(standing.error());
  const std::vector<BucketStance>& stance = *standing;
  std::vector<Eigen::VectorXd> q(stance.size());
  for (std::size_t i = 0; i < q.size(); ++i) {
    const BaseRun::Point point{run.base.knots[i].base, run.base.knots[i].curvature_1_m};
    q[i] = posture(point, *placed(point, run.base.support.lifted, run.base.lifted_hfe_rad),
                   parts_.arm.transport());
  }
  const bool bucket = run.base.support.bucket >= 0;
  std::string no_access;
  // At both ends the bucket comes down and goes up again, on four wheels.
  const PostureJudge accessible = [&](std::size_t knot, const ArmPosture& standing) {
    const Footing& on_wheels = *stance[knot].on_wheels;
    const BaseRun::Point point{run.base.knots[knot].base, run.base.knots[knot].curvature_1_m};
    const Eigen::VectorXd q_wheels =
        posture(point, *placed(point, 0, run.base.lifted_hfe_rad), parts_.arm.transport());
    const auto lowering = mover_.lowering(on_wheels, q_wheels, standing);
    if (!lowering) {
      no_access = lowering.error();
      return false;
    }
    const auto path = mover_.path(on_wheels, q_wheels, parts_.arm.transport(), lowering->front());
    if (!path) no_access = path.error();
    return path.has_value();
  };
  const PostureJudge clear = [&](std::size_t knot, const ArmPosture& posture) {
    return mover_.fault(stance[knot].footing, q[knot], posture, bucket) == nullptr;
  };
  const double margin_m = parts_.settings.min_stability_margin_m + kTableErrorM;
  if (bucket) {
    BucketPathSettings settings;
    settings.min_margin_m = margin_m;
    auto path =
        bucket_path(parts_.arm, parts_.placer.ground(), run.base, stance,
                    sequence_.bucket_points[static_cast<std::size_t>(run.base.support.bucket)],
                    settings, {clear, accessible});
    if (!path) {
      MotionFailure failure = path.error();
      if (!no_access.empty()) failure.why += "; before that, " + no_access;
      return tl::unexpected<MotionFailure>(std::move(failure));
    }
    run.bucket = *std::move(path);
    return {};
  }
  std::vector<ArmPosture> candidates;
  for (const BaseKnot& knot : run.base.knots) {
    candidates.push_back(sequence_.states[knot.state].arm);
  }
  auto held = counterweights(parts_.arm, run.base, stance, candidates, margin_m, clear);
  if (!held) {  // the certificate does not know all that the arm can run into
    candidates = counterweight_postures(parts_.arm);
    held = counterweights(parts_.arm, run.base, stance, candidates, margin_m, clear);
  }
  if (!held) return tl::unexpected<MotionFailure>(held.error());
  run.held = *std::move(held);
  return {};
}

// Smoothed where that works; as decided where the arm or the lifted wheels cannot follow it.
MotionBuilder::Done MotionBuilder::prepare(PreparedRun& run) {
  const std::vector<BaseKnot> decided = run.base.knots;
  const auto judged = [&](const BaseKnot& knot) { return judge(run.base, knot); };
  guess_rad_ = parts_.placer.default_hfe_rad();
  if (auto smooth = smooth_base(run.base, parts_.motion.base_window_m, judged); !smooth) {
    missed_ground_ = true;
    return smooth;
  }
  if (prepare_support(run)) return {};
  run.base.knots = decided;
  return prepare_support(run);
}

}  // namespace wex
