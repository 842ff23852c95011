#include "initializer/stepping/arm_motion.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <utility>

namespace wex {
namespace {

enum { kTurn, kBoom, kDipper, kTele, kPitch };

constexpr double kNodeStep = 0.1, kCheckStep = 0.05;  // rad or m
constexpr double kDirectTurnRad = 0.5;  // slews up to this may happen along with everything else
constexpr double kCapsuleSpacingM = 0.3;
constexpr double kRaiseRad = 0.5;  // of the boom, to get out of what is around the bucket
constexpr std::array<std::pair<double, double>, 4> kDetoursM{
    // of the bucket: up, outwards
    {{0.6, 0.0}, {0.6, 0.5}, {1.2, 0.0}, {1.2, 0.5}}};
constexpr std::array<double, 4> kAsideRad{0.6, -0.6, 1.0, -1.0};  // slews with the arm unfolded
constexpr std::array<double, 2> kHighDipperRad{-0.3, 0.3};
constexpr double kHighPitchRad = -1.2;
constexpr const char* kTooClose = "the arm or the cabin is too close to the machine itself";
constexpr double kEndStop = 0.02;
constexpr double kRiseStepM = 0.05;
constexpr double kStraightRiseM = 0.1;       // nothing but straight up so far
constexpr double kShortestApproachM = 0.15;  // where the whole one does not fit
constexpr double kHighestApproachM = 0.8;

double largest_step(const ArmKinematics::Joints& a, const ArmKinematics::Joints& b) {
  double step = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) step = std::max(step, std::abs(b[k] - a[k]));
  return step;
}

ArmKinematics::Joints between(const ArmKinematics::Joints& a, const ArmKinematics::Joints& b,
                              double share) {
  ArmKinematics::Joints joints = a;
  for (std::size_t k = 0; k < a.size(); ++k) joints[k] += share * (b[k] - a[k]);
  return joints;
}

}  // namespace

ArmMover::ArmMover(const MachineModel& machine, const ArmKinematics& arm,
                   const CollisionModel& collision, const StanceGround& ground, double min_margin_m,
                   const SteppingMotionSettings& motion)
    : machine_(machine),
      arm_(arm),
      collision_(collision),
      ground_(ground),
      min_margin_m_(min_margin_m),
      motion_(motion),
      workspace_(machine.tree.make_workspace()) {
  for (std::size_t i = 0; i < collision.capsules().size(); ++i) {
    if (collision.capsules()[i].part == CollisionModel::Part::kArm) {
      arm_capsules_.push_back(static_cast<int>(i));
    }
  }
}

const char* ArmMover::fault(const Footing& footing, Eigen::VectorXd& q, const ArmPosture& posture,
                            bool bucket_on_ground) {
  const char* found = find_fault(footing, q, posture, bucket_on_ground);
  if (found != nullptr) {
    last_fault_ = found;
    q_fault_ = q;
  }
  return found;
}

const char* ArmMover::find_fault(const Footing& footing, Eigen::VectorXd& q,
                                 const ArmPosture& posture, bool bucket_on_ground) {
  if (!arm_.within_limits(posture)) return "an arm joint is beyond its limits";
  if (!(footing.margin_m(arm_.moment_base(posture)) >= min_margin_m_)) {
    return "the arm takes too much stability";
  }
  arm_.write(posture, q);
  machine_.tree.update(q, workspace_);
  const auto height_at = [&](const Eigen::Vector2d& p) { return ground_.height_m(p.x(), p.y()); };
  for (const int capsule : arm_capsules_) {
    const CollisionModel::Capsule& shape = collision_.capsules()[static_cast<std::size_t>(capsule)];
    const bool bucket = shape.body == machine_.arm->contact_body;
    if (bucket && bucket_on_ground) continue;
    // The bucket's hull is a box that dips below its edge when it leans: only what carries load is
    // kept away by the whole clearance.
    const bool hull = bucket && !shape.load_bearing;
    const double demand_m = bucket_on_ground || hull ? 0.0 : motion_.swing_clearance_m;
    const double clearance_m =
        collision_.ground_clearance_m(workspace_, capsule, kCapsuleSpacingM, height_at);
    if (clearance_m < demand_m) {
      return "the arm is too close to the ground";
    }
  }
  if (!collision_.clear(workspace_, CollisionModel::Part::kArm, motion_.self_collision_m) ||
      !collision_.clear(workspace_, CollisionModel::Part::kCabin, -motion_.cabin_overlap_m)) {
    return kTooClose;
  }
  return nullptr;
}

bool ArmMover::append_clear_line(const Footing& footing, const Joints& to,
                                 std::vector<Joints>& path) {
  const Joints from = path.back();
  const int nodes =
      std::max(1, static_cast<int>(std::ceil(largest_step(from, to) / kNodeStep - 1e-9)));
  const int checks = 2 * nodes;
  static_assert(kNodeStep == 2.0 * kCheckStep);
  const std::size_t kept = path.size();
  for (int i = 1; i <= checks; ++i) {
    const Joints joints = between(from, to, static_cast<double>(i) / checks);
    if (fault(footing, q_, ArmKinematics::posture_of(joints), false) != nullptr) {
      path.resize(kept);
      return false;
    }
    if (i % 2 == 0) path.push_back(joints);
  }
  return true;
}

// From anywhere to a folded posture, turned as it comes: in one go, or by way of somewhere higher
// and farther out, or with the boom raised and the telescope retracted first, or high over
// everything, or beside what is in the way: hind claws stand as high as the folded bucket hangs.
bool ArmMover::append_fold(const Footing& footing, Joints fold, std::vector<Joints>& path) {
  const std::size_t kept = path.size();
  const Joints from = path.back();
  fold[kTurn] = from[kTurn];
  if (largest_step(from, fold) == 0.0) return true;
  const auto follow = [&](std::initializer_list<Joints> way) {
    for (const Joints& joints : way) {
      if (append_clear_line(footing, joints, path)) continue;
      path.resize(kept);
      return false;
    }
    return true;
  };
  if (follow({fold})) return true;
  const ArmPosture posture = ArmKinematics::posture_of(from);
  std::vector<Joints> higher;
  for (const auto& [up_m, out_m] : kDetoursM) {
    if (const auto there = shifted(footing, posture, up_m, out_m, 0.0, 0.0)) {
      higher.push_back(ArmKinematics::joints_of(*there));
      if (follow({higher.back(), fold})) return true;
    }
  }
  Joints raised = from;
  raised[kBoom] = std::min(arm_.upper()[kBoom] - kEndStop, raised[kBoom] + kRaiseRad);
  Joints retracted = raised;
  retracted[kTele] = std::min(raised[kTele], arm_.transport().tele_m);
  if (follow({raised, fold}) || follow({raised, retracted, fold})) return true;
  Joints highest = from, fold_highest = fold;
  highest[kBoom] = fold_highest[kBoom] = arm_.upper()[kBoom] - kEndStop;
  if (follow({highest, fold_highest, fold})) return true;
  higher.push_back(raised);
  for (const double aside_rad : kAsideRad) {
    Joints folded = fold;
    folded[kTurn] += aside_rad;
    for (const Joints& way : higher) {
      Joints aside = way;
      aside[kTurn] += aside_rad;
      if (follow({way, aside, folded})) return true;
    }
  }
  return false;
}

bool ArmMover::append_slew(const Footing& footing, double turn_rad, std::vector<Joints>& path) {
  Joints to = path.back();
  const double other_way_rad = turn_rad + (turn_rad > to[kTurn] ? -2.0 : 2.0) * std::numbers::pi;
  to[kTurn] = turn_rad;
  if (append_clear_line(footing, to, path)) return true;
  to[kTurn] = other_way_rad;
  return append_clear_line(footing, to, path);
}

Result<std::vector<ArmPosture>, std::string> ArmMover::path(const Footing& footing,
                                                            const Eigen::VectorXd& q,
                                                            const ArmPosture& from,
                                                            const ArmPosture& to) {
  q_ = q;
  const Joints begin = ArmKinematics::joints_of(from);
  Joints end = ArmKinematics::joints_of(to);
  end[kTurn] = begin[kTurn] + wrap_angle(end[kTurn] - begin[kTurn]);
  // Half a turn may go either way: stay near zero, so that slews do not add up.
  if (std::abs(end[kTurn]) > std::numbers::pi + kDirectTurnRad) {
    end[kTurn] -= std::copysign(2.0 * std::numbers::pi, end[kTurn]);
  }
  if (fault(footing, q_, to, false) != nullptr) {
    return tl::unexpected<std::string>("the arm cannot be where it should go: " + why());
  }
  std::vector<Joints> path{begin};
  bool found = std::abs(end[kTurn] - begin[kTurn]) <= kDirectTurnRad &&
               append_clear_line(footing, end, path);
  // The transport posture, or the boom up and the dipper farther and farther out, until the bucket
  // swings above everything.
  std::vector<Joints> folds{ArmKinematics::joints_of(arm_.transport())};
  Joints high = folds.front();
  high[kBoom] = arm_.upper()[kBoom] - kEndStop;
  folds.push_back(high);
  high[kPitch] = kHighPitchRad;
  for (const double dipper_rad : kHighDipperRad) {
    high[kDipper] = dipper_rad;
    folds.push_back(high);
  }
  for (const Joints& fold : folds) {
    if (found) break;
    // Unfolding is folding backwards: what is in the way is near the unfolded end.
    std::vector<Joints> unfolding{end};
    path.resize(1);
    found = append_fold(footing, fold, unfolding) && append_fold(footing, fold, path) &&
            append_slew(footing, unfolding.back()[kTurn], path);
    if (!found) continue;
    const double turns_rad = path.back()[kTurn] - unfolding.back()[kTurn];
    for (auto joints = unfolding.rbegin() + 1; joints != unfolding.rend(); ++joints) {
      (*joints)[kTurn] += turns_rad;
      path.push_back(*joints);
    }
  }
  if (!found) return tl::unexpected<std::string>("the arm finds no way: " + why());
  std::vector<ArmPosture> postures;
  for (const Joints& joints : path) postures.push_back(ArmKinematics::posture_of(joints));
  return postures;
}

std::optional<ArmPosture> ArmMover::shifted(const Footing& footing, const ArmPosture& posture,
                                            double up_m, double out_m, double tele_step_m,
                                            double attitude_step_rad) const {
  const Eigen::Vector3d p_base = arm_.shape(posture).p_base_contact;
  const Eigen::Vector3d out =
      (footing.T_world_base.linear() * p_base).cwiseProduct(Eigen::Vector3d(1.0, 1.0, 0.0));
  const Eigen::Vector3d shift_world = out_m * out.normalized() + up_m * Eigen::Vector3d::UnitZ();
  auto there = arm_.reach(p_base + footing.T_world_base.linear().transpose() * shift_world,
                          posture.tele_m + tele_step_m,
                          arm_.attitude_rad(posture) + attitude_step_rad, kEndStop);
  if (there) {
    there->turn_rad = posture.turn_rad + wrap_angle(there->turn_rad - posture.turn_rad);
  }
  return there;
}

Result<std::vector<ArmPosture>, std::string> ArmMover::lowering(const Footing& footing,
                                                                const Eigen::VectorXd& q,
                                                                const ArmPosture& standing) {
  q_ = q;
  std::vector<ArmPosture> upwards{standing};
  if (fault(footing, q_, standing, true) != nullptr) {
    return tl::unexpected<std::string>("the bucket cannot stand: " + why());
  }
  // Straight up; the null space, and then the line itself, give way only where they must.
  const auto step_up = [&](double height_m) {
    for (const double out_m : {0.0, 0.5 * kRiseStepM, kRiseStepM}) {
      if (out_m > 0.0 && height_m < kStraightRiseM) break;
      for (const double tele_step_m : {0.0, -0.05, 0.05}) {
        for (const double attitude_step_rad : {0.0, -0.05, 0.05}) {
          const auto posture =
              shifted(footing, upwards.back(), kRiseStepM, out_m, tele_step_m, attitude_step_rad);
          if (!posture || fault(footing, q_, *posture, true) != nullptr) continue;
          upwards.push_back(*posture);
          return true;
        }
      }
    }
    return false;
  };
  double height_m = 0.0;
  while (height_m < motion_.bucket_approach_m - 1e-9 ||
         fault(footing, q_, upwards.back(), false) != nullptr) {
    if (height_m > kHighestApproachM || !step_up(height_m)) break;
    height_m += kRiseStepM;
  }
  if (height_m < kShortestApproachM) {
    return tl::unexpected<std::string>("the bucket cannot come down: " + why());
  }
  std::reverse(upwards.begin(), upwards.end());
  return upwards;
}

std::string ArmMover::why() {
  if (last_fault_ != kTooClose) return last_fault_;
  machine_.tree.update(q_fault_, workspace_);
  const auto arm = collision_.nearest(workspace_, CollisionModel::Part::kArm);
  const auto cabin = collision_.nearest(workspace_, CollisionModel::Part::kCabin);
  const bool cabin_decides =
      cabin.distance_m + motion_.cabin_overlap_m < arm.distance_m - motion_.self_collision_m;
  const CollisionModel::Pair& pair =
      collision_.pairs()[static_cast<std::size_t>(cabin_decides ? cabin.pair : arm.pair)];
  const auto name = [&](int capsule) {
    return collision_.capsules()[static_cast<std::size_t>(capsule)].name;
  };
  return std::string(last_fault_) + " (" + name(pair.first) + ", " + name(pair.second) + ")";
}

}  // namespace wex
