#include "initializer/stepping/arm_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace wex {
namespace {

enum { kTurn, kBoom, kDipper, kTele, kPitch };

constexpr double kNodeStep = 0.1, kCheckStep = 0.05;  // rad or m
constexpr double kDirectTurnRad = 0.5;   // slews up to this may happen along with everything else
constexpr double kCapsuleSpacingM = 0.3;
constexpr double kRaiseRad = 0.5;        // of the boom, to get out of what is around the bucket
constexpr double kEndStop = 0.02;
constexpr double kShortestApproachM = 0.15;  // where the whole one does not fit

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
                   const CollisionModel& collision, const StanceGround& ground,
                   double min_margin_m, const SteppingMotionSettings& motion)
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
  if (!arm_.within_limits(posture)) return "an arm joint is beyond its limits";
  if (!(footing.margin_m(arm_.moment_base(posture)) >= min_margin_m_)) {
    return "the arm takes too much stability";
  }
  arm_.write(posture, q);
  machine_.tree.update(q, workspace_);
  const auto height_at = [&](const Eigen::Vector2d& p) { return ground_.height_m(p.x(), p.y()); };
  for (const int capsule : arm_capsules_) {
    const bool may_touch =
        bucket_on_ground && collision_.capsules()[static_cast<std::size_t>(capsule)].load_bearing;
    if (may_touch) continue;
    const double clearance_m =
        collision_.ground_clearance_m(workspace_, capsule, kCapsuleSpacingM, height_at);
    if (clearance_m < (bucket_on_ground ? 0.0 : motion_.swing_clearance_m)) {
      return "the arm is too close to the ground";
    }
  }
  if (!collision_.clear(workspace_, CollisionModel::Part::kArm, motion_.self_collision_m) ||
      !collision_.clear(workspace_, CollisionModel::Part::kCabin, motion_.self_collision_m)) {
    return "the arm is too close to the machine itself";
  }
  return nullptr;
}

bool ArmMover::append_clear_line(const Footing& footing, const Joints& to,
                                 std::vector<Joints>& path) {
  const Joints from = path.back();
  const int nodes = std::max(1, static_cast<int>(std::ceil(largest_step(from, to) / kNodeStep - 1e-9)));
  const int checks = 2 * nodes;
  static_assert(kNodeStep == 2.0 * kCheckStep);
  const std::size_t kept = path.size();
  for (int i = 1; i <= checks; ++i) {
    const Joints joints = between(from, to, static_cast<double>(i) / checks);
    if (const char* why = fault(footing, q_, ArmKinematics::posture_of(joints), false)) {
      last_fault_ = why;
      path.resize(kept);
      return false;
    }
    if (i % 2 == 0) path.push_back(joints);
  }
  return true;
}

// Between a folded posture and another at the same turn: in one go, or by way of a raised boom at
// the unfolded end, or with the telescope retracted there as well.
bool ArmMover::append_change(const Footing& footing, const Joints& to, bool unfolding,
                             std::vector<Joints>& path) {
  const std::size_t kept = path.size();
  const Joints from = path.back();
  Joints raised = unfolding ? to : from;
  raised[kBoom] = std::min(arm_.upper()[kBoom] - kEndStop, raised[kBoom] + kRaiseRad);
  Joints retracted = raised;
  retracted[kTele] = std::min(raised[kTele], arm_.transport().tele_m);
  Joints folded_boom_up = unfolding ? from : to;
  folded_boom_up[kBoom] = arm_.upper()[kBoom] - kEndStop;
  const std::vector<std::vector<Joints>> ways{
      {}, {raised}, {raised, retracted}, {raised, folded_boom_up},
      {raised, retracted, folded_boom_up}};
  for (std::vector<Joints> way : ways) {
    if (unfolding) std::reverse(way.begin(), way.end());
    way.push_back(to);
    bool clear = true;
    for (const Joints& joints : way) clear = clear && append_clear_line(footing, joints, path);
    if (clear) return true;
    path.resize(kept);
  }
  return false;
}

bool ArmMover::append_slew(const Footing& footing, double turn_rad, std::vector<Joints>& path) {
  Joints to = path.back();
  const double other_way_rad =
      turn_rad + (turn_rad > to[kTurn] ? -2.0 : 2.0) * std::numbers::pi;
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
  const auto postures = [&](const std::vector<Joints>& path) {
    std::vector<ArmPosture> result;
    for (const Joints& joints : path) result.push_back(ArmKinematics::posture_of(joints));
    return result;
  };
  std::vector<Joints> path{begin};
  if (std::abs(end[kTurn] - begin[kTurn]) <= kDirectTurnRad &&
      append_clear_line(footing, end, path)) {
    return postures(path);
  }
  const Joints transport = ArmKinematics::joints_of(arm_.transport());
  Joints higher = transport;
  higher[kBoom] = arm_.upper()[kBoom] - kEndStop;
  for (Joints fold : {transport, higher}) {
    path.resize(1);
    fold[kTurn] = begin[kTurn];
    Joints unfolded = end;
    if (largest_step(fold, begin) > 0.0 && !append_change(footing, fold, false, path)) continue;
    if (!append_slew(footing, end[kTurn], path)) continue;
    unfolded[kTurn] = path.back()[kTurn];
    if (largest_step(unfolded, path.back()) > 0.0 && !append_change(footing, unfolded, true, path)) {
      continue;
    }
    return postures(path);
  }
  return tl::unexpected<std::string>(std::string("the arm finds no way: ") + last_fault_);
}

Result<std::vector<ArmPosture>, std::string> ArmMover::lowering(const Footing& footing,
                                                                const Eigen::VectorXd& q,
                                                                const ArmPosture& standing) {
  constexpr double kStepM = 0.05;
  q_ = q;
  const Eigen::Vector3d p_world = footing.T_world_base * arm_.shape(standing).p_base_contact;
  const Eigen::Isometry3d T_base_world = footing.T_world_base.inverse();
  double tele_m = standing.tele_m, attitude_rad = arm_.attitude_rad(standing);
  std::vector<ArmPosture> upwards{standing};
  if (const char* why = fault(footing, q_, standing, true)) {
    return tl::unexpected<std::string>(std::string("the bucket cannot stand: ") + why);
  }
  const int steps = static_cast<int>(std::ceil(motion_.bucket_approach_m / kStepM - 1e-9));
  for (int i = 1; i <= steps; ++i) {
    const Eigen::Vector3d p_base =
        T_base_world * (p_world + Eigen::Vector3d(0.0, 0.0, motion_.bucket_approach_m * i / steps));
    // The null space gives way only where an end stop or the ground asks for it.
    const char* why = "the arm is at an end stop";
    bool found = false;
    for (const double tele_step : {0.0, -0.05, 0.05}) {
      for (const double attitude_step : {0.0, -0.05, 0.05}) {
        auto posture = arm_.reach(p_base, tele_m + tele_step, attitude_rad + attitude_step, kEndStop);
        if (!posture) continue;
        posture->turn_rad =
            standing.turn_rad + wrap_angle(posture->turn_rad - standing.turn_rad);
        if (const char* fault_here = fault(footing, q_, *posture, true)) {
          why = fault_here;
          continue;
        }
        tele_m += tele_step;
        attitude_rad += attitude_step;
        upwards.push_back(*posture);
        found = true;
        break;
      }
      if (found) break;
    }
    if (found) continue;
    if ((i - 1) * motion_.bucket_approach_m / steps >= kShortestApproachM) break;
    return tl::unexpected<std::string>(std::string("the bucket cannot come down: ") + why);
  }
  std::reverse(upwards.begin(), upwards.end());
  return upwards;
}

}  // namespace wex
