#include "initializer/stepping/internal/motion_builder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace wex {
namespace {

constexpr double kLimbStep = 0.1;  // rad or m from node to node
constexpr double kRounding = 1e-9;
constexpr int kMaxDepth = 4;               // of halving between knots
constexpr double kMiddleWheelRad = 0.004;  // about 6 mm of a standing wheel's height
constexpr double kMiddleBucketM = 0.003;
constexpr double kEndStop = 0.005;
constexpr double kSweepM = 0.05;  // what a wheel may seem to touch on its way down
constexpr double kSweepRad = 0.01;
constexpr auto kArmIndex = static_cast<std::size_t>(Limb::kArm);

std::string name_of(std::size_t wheel) { return "wheel " + std::string(kLimbNames[wheel]); }

}  // namespace

MotionBuilder::MotionBuilder(const MotionParts& parts, const CertifiedSequence& sequence,
                             double steering_window_m)
    : parts_(parts),
      sequence_(sequence),
      mover_(parts.machine, parts.arm, parts.collision, parts.placer.ground(),
             parts.settings.min_stability_margin_m, parts.motion),
      workspace_(parts.machine.tree.make_workspace()),
      transport_(Eigen::VectorXd::Zero(parts.machine.num_coordinates())),
      guess_rad_(parts.placer.default_hfe_rad()),
      speed_m_s_(parts.settings.nominal_speed_m_s),
      steering_window_m_(steering_window_m) {
  transport_.tail(parts.machine.num_joints()) = parts.machine.transport_posture();
}

Eigen::VectorXd MotionBuilder::posture(const BaseRun::Point& point, const WheelPlacement& placement,
                                       const ArmPosture& arm) const {
  Eigen::VectorXd q = transport_;
  q.head<kNumBaseCoordinates>() = point.base;
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    const WheeledLeg& leg = parts_.machine.legs[i];
    q[leg.hfe] = placement.hfe_rad[i];
    if (leg.steer >= 0) q[leg.steer] = placement.steer_rad[i];
  }
  parts_.arm.write(arm, q);
  return q;
}

Result<Footing, MotionFailure> MotionBuilder::footing(const BaseRun& run, std::size_t knot,
                                                      std::uint8_t lifted) {
  const BaseRun::Point point{run.knots[knot].base, run.knots[knot].curvature_1_m};
  const auto placement = placed(point, lifted, run.lifted_hfe_rad);
  if (!placement) {
    missed_ground_ = true;
    return tl::unexpected<MotionFailure>(
        {run.knots[knot].state,
         name_of(static_cast<std::size_t>(placement.error().wheel)) + " " + placement.error().why});
  }
  return footing_on(point.base, *placement, lifted, nullptr, parts_.placer.mass_kg());
}

ArmPosture MotionBuilder::bucket_posture(const PreparedRun& run, std::size_t knot) const {
  const BucketPath::Sample& sample = run.bucket->samples[knot];
  const auto& point = sequence_.bucket_points[static_cast<std::size_t>(run.base.support.bucket)];
  const auto posture =
      parts_.arm.reach(T_world_base_from(run.base.knots[knot].base).inverse() * point,
                       sample.tele_m, sample.attitude_rad, kEndStop);
  WEX_EXPECTS(posture.has_value());  // that is what the path was made of
  return *posture;
}

Result<Eigen::VectorXd, std::string> MotionBuilder::posture_at(const PreparedRun& run,
                                                               double sigma_m,
                                                               const ArmPosture* held) {
  const BaseRun::Point point = run.base.at(sigma_m);
  const auto placement = placed(point, run.base.support.lifted, run.base.lifted_hfe_rad);
  if (!placement) {
    missed_ground_ = true;
    return tl::unexpected<std::string>("between nodes a wheel " +
                                       std::string(placement.error().why));
  }
  if (held != nullptr) return posture(point, *placement, *held);
  const BucketPath::Sample sample = run.bucket->at(sigma_m);
  const auto& bucket = sequence_.bucket_points[static_cast<std::size_t>(run.base.support.bucket)];
  auto arm = parts_.arm.reach(T_world_base_from(point.base).inverse() * bucket, sample.tele_m,
                              sample.attitude_rad, kEndStop);
  if (!arm) return tl::unexpected<std::string>("between nodes the bucket's point is out of reach");
  const double turn_rad = arm_now().turn_rad;
  arm->turn_rad = turn_rad + wrap_angle(arm->turn_rad - turn_rad);
  return posture(point, *placement, *arm);
}

void MotionBuilder::add(const Eigen::VectorXd& q, double duration_s) {
  if (!nodes_.empty()) nodes_.back().min_duration_s = duration_s;
  MotionNode node;
  node.q = q;
  node.contacts = contacts_;
  node.base_speed_m_s = speed_m_s_;
  node.state = state_;
  nodes_.push_back(std::move(node));
}

void MotionBuilder::lift_contact(std::size_t limb) {
  nodes_.back().stop = true;
  contacts_[limb] = false;
  add(Eigen::VectorXd(nodes_.back().q), parts_.motion.contact_change_pause_s);
  nodes_.back().stop = true;
}

void MotionBuilder::set_contact(std::size_t limb) {
  contacts_[limb] = true;
  nodes_.back().contacts = contacts_;
  nodes_.back().stop = true;
}

bool MotionBuilder::needs_a_node_between(const PreparedRun& run, const Eigen::VectorXd& q_0,
                                         const Eigen::VectorXd& q_1,
                                         const Eigen::VectorXd& q_middle) const {
  if ((q_1 - q_0).head<3>().norm() > parts_.motion.max_node_step_m + 1e-6) return true;
  const Eigen::VectorXd step = (q_1 - q_0).tail(parts_.machine.num_joints());
  if (step.cwiseAbs().maxCoeff() > kLimbStep + kRounding) return true;
  const Eigen::VectorXd middle = 0.5 * (q_0 + q_1);
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    const int hfe = parts_.machine.legs[i].hfe;
    if (std::abs(middle[hfe] - q_middle[hfe]) > kMiddleWheelRad) return true;
  }
  if (run.base.support.bucket < 0) return false;
  const auto& bucket = sequence_.bucket_points[static_cast<std::size_t>(run.base.support.bucket)];
  const Eigen::Vector3d p_base = parts_.arm.shape(parts_.arm.posture_of(middle)).p_base_contact;
  const BaseCoordinates base = middle.head<kNumBaseCoordinates>();
  return (T_world_base_from(base) * p_base - bucket).norm() > kMiddleBucketM;
}

MotionBuilder::Done MotionBuilder::drive_between(const PreparedRun& run, const ArmPosture* held,
                                                 double sigma_0, const Eigen::VectorXd& q_0,
                                                 double sigma_1, const Eigen::VectorXd& q_1,
                                                 int depth) {
  const double sigma = 0.5 * (sigma_0 + sigma_1);
  if (depth < kMaxDepth) {
    const auto middle = posture_at(run, sigma, held);
    if (!middle) return failure(middle.error());
    if (needs_a_node_between(run, q_0, q_1, *middle)) {
      if (auto first = drive_between(run, held, sigma_0, q_0, sigma, *middle, depth + 1); !first) {
        return first;
      }
      return drive_between(run, held, sigma, *middle, sigma_1, q_1, depth + 1);
    }
  }
  add(q_1);
  return {};
}

MotionBuilder::Done MotionBuilder::drive(const PreparedRun& run) {
  const std::vector<BaseKnot>& knots = run.base.knots;
  speed_m_s_ = run.base.support.lifted == 0 ? parts_.settings.nominal_speed_m_s
                                            : parts_.motion.stepping_speed_m_s;
  nodes_.back().base_speed_m_s = speed_m_s_;
  nodes_.back().stop = true;
  std::size_t held = 0;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    state_ = knots[i].state;
    if (held + 1 < run.held.size() && run.held[held + 1].first_knot == i) {
      ++held;
      const auto standing = footing(run.base, i, run.base.support.lifted);
      if (!standing) return tl::unexpected<MotionFailure>(standing.error());
      if (auto moved = move_arm(*standing, run.held[held].posture); !moved) return moved;
    }
    const ArmPosture arm = run.bucket ? ArmPosture{} : arm_now();
    const ArmPosture* fixed = run.bucket ? nullptr : &arm;
    const Eigen::VectorXd q_0 = nodes_.back().q;
    const auto q_1 = posture_at(run, knots[i + 1].sigma_m, fixed);
    if (!q_1) return failure(q_1.error());
    if (auto driven =
            drive_between(run, fixed, knots[i].sigma_m, q_0, knots[i + 1].sigma_m, *q_1, 0);
        !driven) {
      return driven;
    }
    if (knots[i + 1].stop) nodes_.back().stop = true;
  }
  state_ = knots.back().state;
  nodes_.back().stop = true;
  return {};
}

MotionBuilder::Done MotionBuilder::move_arm(const Footing& footing, const ArmPosture& to) {
  const auto path = mover_.path(footing, nodes_.back().q, arm_now(), to);
  if (!path) return arm_failure(path.error());
  nodes_.back().stop = true;
  for (std::size_t i = 1; i < path->size(); ++i) {
    Eigen::VectorXd q = nodes_.back().q;
    parts_.arm.write((*path)[i], q);
    add(q);
  }
  nodes_.back().stop = true;
  return {};
}

// One wheel after the other, straight up or down by hip flexion, the base at rest.
MotionBuilder::Done MotionBuilder::move_wheels(const PreparedRun& run, std::size_t knot, bool up) {
  const BaseRun::Point point{run.base.knots[knot].base, run.base.knots[knot].curvature_1_m};
  const std::uint8_t lifted = run.base.support.lifted;
  const auto in_air = placed(point, lifted, run.base.lifted_hfe_rad);
  const auto standing = placed(point, 0, run.base.lifted_hfe_rad);
  if (!in_air || !standing) {
    const PlacementFailure& missed = in_air ? standing.error() : in_air.error();
    missed_ground_ = true;
    return failure(name_of(static_cast<std::size_t>(missed.wheel)) + " " + missed.why);
  }
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    if ((lifted >> i & 1) == 0) continue;
    const auto clear = parts_.placer.lowest_clear_rad(point.base, point.curvature_1_m,
                                                      static_cast<int>(i), -kSweepM);
    if (!clear || *clear > standing->hfe_rad[i] + kSweepRad) {
      return failure(name_of(i) + " meets ground on its way " + (up ? "up" : "down"));
    }
    if (up) lift_contact(i);
    const WheeledLeg& leg = parts_.machine.legs[i];
    const WheelPlacement& target = up ? *in_air : *standing;
    const Eigen::VectorXd from = nodes_.back().q;
    Eigen::VectorXd to = from;
    to[leg.hfe] = target.hfe_rad[i];
    if (leg.steer >= 0) to[leg.steer] = target.steer_rad[i];
    const double step = (to - from).cwiseAbs().maxCoeff();
    const int nodes = std::max(1, static_cast<int>(std::ceil(step / kLimbStep - kRounding)));
    for (int k = 1; k <= nodes; ++k) add(from + (to - from) * (static_cast<double>(k) / nodes));
    if (!up) set_contact(i);
  }
  nodes_.back().stop = true;
  return {};
}

MotionBuilder::Done MotionBuilder::step_onto(const PreparedRun& run) {
  state_ = run.base.knots.front().state;
  const auto standing = footing(run.base, 0, 0);
  if (!standing) return tl::unexpected<MotionFailure>(standing.error());
  const Footing& on_wheels = *standing;
  if (run.bucket) {
    auto lowering = mover_.lowering(on_wheels, nodes_.back().q, bucket_posture(run, 0));
    if (!lowering) return arm_failure(lowering.error());
    if (auto moved = move_arm(on_wheels, lowering->front()); !moved) return moved;
    const double turn_rad = arm_now().turn_rad - lowering->front().turn_rad;
    double height_m = bucket_height_m(on_wheels, lowering->front());
    for (std::size_t i = 1; i < lowering->size(); ++i) {
      ArmPosture arm = (*lowering)[i];
      arm.turn_rad += turn_rad;
      Eigen::VectorXd q = nodes_.back().q;
      parts_.arm.write(arm, q);
      const double lower_m = bucket_height_m(on_wheels, arm);
      add(q, (height_m - lower_m) / parts_.motion.bucket_lowering_m_s);
      height_m = lower_m;
    }
    set_contact(kArmIndex);
  } else if (auto moved = move_arm(on_wheels, run.held.front().posture); !moved) {
    return moved;
  }
  return move_wheels(run, 0, true);
}

MotionBuilder::Done MotionBuilder::step_off(const PreparedRun& run, const ArmPosture& next) {
  const std::size_t last = run.base.knots.size() - 1;
  if (auto landed = move_wheels(run, last, false); !landed) return landed;
  const auto standing = footing(run.base, last, 0);
  if (!standing) return tl::unexpected<MotionFailure>(standing.error());
  const Footing& on_wheels = *standing;
  if (run.bucket) {
    auto rising = mover_.lowering(on_wheels, nodes_.back().q, arm_now());
    if (!rising) return arm_failure(rising.error());
    std::reverse(rising->begin(), rising->end());
    lift_contact(kArmIndex);
    for (std::size_t i = 1; i < rising->size(); ++i) {
      Eigen::VectorXd q = nodes_.back().q;
      parts_.arm.write((*rising)[i], q);
      // Load goes off the bucket slowly; once in the air it is free to hurry.
      const double rise_m =
          bucket_height_m(on_wheels, (*rising)[i]) - bucket_height_m(on_wheels, (*rising)[i - 1]);
      add(q, i == 1 ? rise_m / parts_.motion.bucket_lowering_m_s : 0.0);
    }
  }
  return move_arm(on_wheels, next);
}

double MotionBuilder::bucket_height_m(const Footing& footing, const ArmPosture& arm) const {
  return (footing.T_world_base * parts_.arm.shape(arm).p_base_contact).z();
}

// Where the arm goes when a run on wheels alone begins: to transport posture, unless that run is
// only a change from one support to another.
Result<ArmPosture, MotionFailure> MotionBuilder::arm_after(const std::vector<PreparedRun>& runs,
                                                           std::size_t on_wheels) {
  const bool drives = runs[on_wheels].base.knots.size() > 1;
  if (drives || on_wheels + 1 == runs.size()) return parts_.arm.transport();
  const PreparedRun& next = runs[on_wheels + 1];
  if (!next.bucket) return next.held.front().posture;
  const auto standing = footing(next.base, 0, 0);
  if (!standing) return tl::unexpected<MotionFailure>(standing.error());
  const auto lowering = mover_.lowering(*standing, nodes_.back().q, bucket_posture(next, 0));
  if (!lowering) return arm_failure(lowering.error());
  return lowering->front();
}

Result<std::vector<MotionNode>, MotionFailure> MotionBuilder::build() {
  std::vector<PreparedRun> runs;
  for (BaseRun& run : base_runs(sequence_, steering_window_m_)) {
    runs.push_back({std::move(run), std::nullopt, {}});
    if (auto prepared = prepare(runs.back()); !prepared) {
      return tl::unexpected<MotionFailure>(prepared.error());
    }
  }
  guess_rad_ = parts_.placer.default_hfe_rad();
  state_ = 0;
  const ArmPosture transport = parts_.arm.transport();
  const auto start = posture_at(runs.front(), 0.0, &transport);
  if (!start) return failure(start.error());
  add(*start);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    Done done = drive(runs[i]);
    if (done && i + 1 < runs.size()) {
      const bool on_wheels = runs[i].base.support == Support{};
      if (on_wheels == (runs[i + 1].base.support == Support{})) {
        return failure("supports change without all four wheels between them");
      }
      if (on_wheels) {
        done = step_onto(runs[i + 1]);
      } else if (const auto next = arm_after(runs, i + 1)) {
        done = step_off(runs[i], *next);
      } else {
        return tl::unexpected<MotionFailure>(next.error());
      }
    }
    if (!done) return tl::unexpected<MotionFailure>(done.error());
  }
  return std::move(nodes_);
}

}  // namespace wex
