#include "initializer/verify_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <vector>

#include "models/excavator/collision_model.hpp"
#include "models/terrain/wheel_rest.hpp"

namespace wex {
namespace {

constexpr double kHeightToleranceM = 1e-3;
constexpr double kBallToleranceM = 0.02;      // a disc just off the ground, judged as a ball
constexpr double kDistanceToleranceM = 0.02;  // of a distance known by cells of 0.1 m
constexpr double kBucketToleranceM = 0.02;
constexpr double kBucketSlipM = 0.01;
constexpr double kPoseTolerance = 1e-4;  // m and rad, at both ends
constexpr double kRounding = 1e-6;       // relative or absolute slack for sums of doubles
constexpr double kBellySpacingM = 0.2, kArmSpacingM = 0.2;

std::string with_number(const std::string& text, double value) {
  char number[32];
  std::snprintf(number, sizeof number, "%.4g", value);
  return text + " " + number;
}

class Verifier {
 public:
  Verifier(const TerrainMap& terrain, const MachineModel& machine, const PlanSettings& settings)
      : terrain_(terrain),
        machine_(machine),
        settings_(settings),
        shape_(CollisionModel::build(machine)),
        transport_(machine.transport_posture()),
        workspace_(machine.tree.make_workspace()) {}

  // The first violation of a node by itself.
  std::optional<std::string> violation(const WholeBodyNode& node, PlanVerdict& verdict) {
    if (node.q.size() != machine_.num_coordinates()) return "wrong number of coordinates";
    if (!node.q.allFinite() || !std::isfinite(node.t_s)) return "not finite";
    machine_.tree.update(node.q, workspace_);
    for (const int i : {kBasePitch, kBaseRoll}) {
      if (std::abs(node.q[i]) > settings_.max_tilt_rad + kRounding) {
        return with_number("tilt [rad]", node.q[i]);
      }
    }
    for (int j = 0; j < machine_.num_joints(); ++j) {
      const Joint& joint = machine_.joints[static_cast<std::size_t>(j)];
      const double value = node.q[kNumBaseCoordinates + j];
      if (!joint.continuous &&
          !(value >= joint.lower - kRounding && value <= joint.upper + kRounding)) {
        return with_number(joint.name + " beyond its limits:", value);
      }
    }
    if (auto contact = contact_violation(node.contacts, verdict)) return contact;
    if (auto belly = belly_violation()) return belly;
    return carried_arm_violation(node);
  }

  // The bucket of a node that was just looked at.
  [[nodiscard]] Eigen::Vector3d p_world_bucket() const {
    return machine_.tree.position(workspace_, machine_.arm->contact_body,
                                  machine_.arm->p_body_contact);
  }

 private:
  std::optional<std::string> contact_violation(const ContactFlags& contacts,
                                               PlanVerdict& verdict) const {
    std::vector<Eigen::Vector2d> support;
    for (std::size_t i = 0; i < kNumWheels; ++i) {
      const WheeledLeg& leg = machine_.legs[i];
      const std::string name = "wheel " + std::string(kLimbNames[i]);
      const Eigen::Vector3d p =
          machine_.tree.position(workspace_, leg.carrier_body, leg.p_carrier_wheel);
      if (!terrain_.known(p.head<2>())) return name + " off the map or over unknown ground";
      if (!contacts[i]) {
        // Here the tyre is a ball: near steep edges the smooth ground of a resting disc is not.
        const double height_m = p.z() - leg.radius_m - terrain_.dilated_height_m(p.head<2>());
        if (!(height_m >= -kBallToleranceM)) {
          return with_number("lifted " + name + " in the ground [m]:", height_m);
        }
        continue;
      }
      if (!terrain_.traversable_at(p.head<2>())) return name + " on untraversable ground";
      const double distance_m = terrain_.signed_distance_m(p.head<2>());
      if (!(distance_m >= settings_.min_signed_distance_m - kDistanceToleranceM)) {
        return with_number(name + " close to untraversable ground [m]:", distance_m);
      }
      const Eigen::Vector3d axle =
          machine_.tree.direction(workspace_, leg.carrier_body, leg.axle_carrier);
      const double error_m =
          p.z() - wheel_rest(terrain_, p.head<2>(), axle, leg.radius_m, leg.half_width_m).height_m;
      verdict.worst_height_error_m = std::max(verdict.worst_height_error_m, std::abs(error_m));
      if (!(std::abs(error_m) <= kHeightToleranceM)) {
        return with_number(name + " off the ground [m]:", error_m);
      }
      support.push_back(p.head<2>());
    }
    if (contacts[static_cast<std::size_t>(Limb::kArm)]) {
      const Eigen::Vector3d p = p_world_bucket();
      const double error_m = p.z() - terrain_.height_m(p.head<2>());
      if (!(std::abs(error_m) <= kBucketToleranceM)) {
        return with_number("bucket off the ground [m]:", error_m);
      }
      support.push_back(p.head<2>());
    }
    if (support.size() < 3) return "fewer than three contacts";
    const double margin_m = hull_margin(machine_.tree.com(workspace_).head<2>(), support);
    verdict.min_stability_margin_m = std::min(verdict.min_stability_margin_m, margin_m);
    if (!(margin_m >= settings_.min_stability_margin_m - kRounding)) {
      return with_number("stability margin [m]", margin_m);
    }
    return std::nullopt;
  }

  // By areas, unlike the planner's edge normals: distance = twice a triangle's area over its base.
  // Edges of the hull are the pairs with every other contact to their left.
  static double hull_margin(const Eigen::Vector2d& p,
                            const std::vector<Eigen::Vector2d>& contacts) {
    const auto twice_area = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                               const Eigen::Vector2d& c) {
      Eigen::Matrix2d sides;
      sides << b - a, c - a;
      return sides.determinant();
    };
    double margin_m = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector2d& a : contacts) {
      for (const Eigen::Vector2d& b : contacts) {
        if (&a == &b) continue;
        const bool is_edge = std::all_of(contacts.begin(), contacts.end(), [&](const auto& c) {
          return &c == &a || &c == &b || twice_area(a, b, c) >= 0.0;
        });
        if (is_edge) margin_m = std::min(margin_m, twice_area(a, b, p) / (b - a).norm());
      }
    }
    return margin_m;
  }

  std::optional<std::string> belly_violation() const {
    const Eigen::Vector2d size = machine_.belly_max_m - machine_.belly_min_m;
    const Eigen::Array2i steps = (size.array() / kBellySpacingM).ceil().max(1.0).cast<int>();
    for (int i = 0; i <= steps.x(); ++i) {
      for (int j = 0; j <= steps.y(); ++j) {
        const Eigen::Vector3d p_base(machine_.belly_min_m.x() + size.x() * i / steps.x(),
                                     machine_.belly_min_m.y() + size.y() * j / steps.y(),
                                     -machine_.belly_below_base_m);
        const Eigen::Vector3d p = machine_.tree.position(workspace_, 0, p_base);
        const double clearance_m = p.z() - terrain_.height_m(p.head<2>());
        if (!(clearance_m >= settings_.belly_clearance_m - kRounding)) {
          return with_number("clearance under the chassis [m]", clearance_m);
        }
      }
    }
    return std::nullopt;
  }

  // The arm as it is carried while driving; where it moves, its paths were checked as it did.
  std::optional<std::string> carried_arm_violation(const WholeBodyNode& node) const {
    if (!machine_.arm || !is_carried(node)) return std::nullopt;
    const auto height_at = [&](const Eigen::Vector2d& p) { return terrain_.height_m(p); };
    for (std::size_t c = 0; c < shape_.capsules().size(); ++c) {
      const CollisionModel::Capsule& capsule = shape_.capsules()[c];
      if (capsule.part != CollisionModel::Part::kArm) continue;
      const double clearance_m =
          shape_.ground_clearance_m(workspace_, static_cast<int>(c), kArmSpacingM, height_at);
      if (clearance_m < 0.0) {
        return with_number(capsule.name + " in the ground [m]:", clearance_m);
      }
    }
    return std::nullopt;
  }

  [[nodiscard]] bool is_carried(const WholeBodyNode& node) const {
    if (node.contacts[static_cast<std::size_t>(Limb::kArm)]) return false;
    for (const int c : machine_.arm->coordinates) {
      const int j = c - kNumBaseCoordinates;
      double off = node.q[c] - transport_[j];
      if (machine_.joints[static_cast<std::size_t>(j)].continuous) off = wrap_angle(off);
      if (std::abs(off) > kPoseTolerance) return false;
    }
    return true;
  }

  const TerrainMap& terrain_;
  const MachineModel& machine_;
  const PlanSettings& settings_;
  CollisionModel shape_;
  Eigen::VectorXd transport_;
  KinematicTree::Workspace workspace_;
};

std::optional<std::string> step_violation(const MachineModel& machine, const WholeBodyNode& a,
                                          const WholeBodyNode& b, const PlanSettings& settings) {
  const double dt_s = b.t_s - a.t_s;
  if (!(dt_s > 0.0)) return "time does not increase";
  int num_changes = 0;
  for (std::size_t i = 0; i < kNumLimbs; ++i) num_changes += a.contacts[i] != b.contacts[i];
  if (num_changes > 1) return "two contacts change at once";
  const double step_m = (b.q - a.q).head<2>().norm();
  if (step_m > settings.subnode_spacing_m + kRounding) {
    return with_number("distance to the next node [m]", step_m);
  }
  for (int j = 0; j < machine.num_joints(); ++j) {
    const Joint& joint = machine.joints[static_cast<std::size_t>(j)];
    const double rate = std::abs((b.q - a.q)[kNumBaseCoordinates + j]) / dt_s;
    if (rate > settings.rate_fraction * joint.max_rate * (1.0 + kRounding)) {
      return with_number("rate of " + joint.name, rate);
    }
  }
  return std::nullopt;
}

bool is_at(const Eigen::VectorXd& q, const Pose2& pose) {
  return std::hypot(q[kBaseX] - pose.x_m, q[kBaseY] - pose.y_m) < kPoseTolerance &&
         std::abs(wrap_angle(q[kBaseYaw] - pose.yaw_rad)) < kPoseTolerance;
}

}  // namespace

PlanVerdict verify_plan(const TerrainMap& terrain, const MachineModel& machine, const Plan& plan,
                        const PlanSettings& settings) {
  PlanVerdict verdict;
  verdict.min_stability_margin_m = std::numeric_limits<double>::infinity();
  const auto reject = [&](std::size_t node, std::string what) {
    verdict.node = node;
    verdict.violation = "node " + std::to_string(node) + ": " + std::move(what);
    return verdict;
  };
  if (plan.nodes.empty()) return reject(0, "there is none");
  Verifier verifier(terrain, machine, settings);
  bool bucket_stands = false;
  Eigen::Vector3d bucket = Eigen::Vector3d::Zero();  // where it stands
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
    if (auto what = verifier.violation(plan.nodes[i], verdict)) return reject(i, *std::move(what));
    if (plan.nodes[i].contacts[static_cast<std::size_t>(Limb::kArm)]) {
      const Eigen::Vector3d p = verifier.p_world_bucket();
      if (!bucket_stands) bucket = p;
      bucket_stands = true;
      if ((p - bucket).norm() > kBucketSlipM) {
        return reject(i, with_number("the standing bucket moves [m]:", (p - bucket).norm()));
      }
    } else {
      bucket_stands = false;
    }
    if (i == 0) continue;
    if (auto what = step_violation(machine, plan.nodes[i - 1], plan.nodes[i], settings)) {
      return reject(i, *std::move(what));
    }
  }
  if (plan.nodes.front().t_s != 0.0) return reject(0, "does not start at t = 0");
  if (!is_at(plan.nodes.front().q, plan.task.start)) return reject(0, "is not at the start");
  if (!is_at(plan.nodes.back().q, plan.task.goal)) {
    return reject(plan.nodes.size() - 1, "is not at the goal");
  }
  verdict.ok = true;
  return verdict;
}

std::vector<std::size_t> unsound_nodes(const TerrainMap& terrain, const MachineModel& machine,
                                       const Plan& plan, const std::vector<std::size_t>& nodes,
                                       const PlanSettings& settings) {
  Verifier verifier(terrain, machine, settings);
  PlanVerdict verdict;
  std::vector<std::size_t> unsound;
  for (const std::size_t i : nodes) {
    if (verifier.violation(plan.nodes[i], verdict)) unsound.push_back(i);
  }
  return unsound;
}

}  // namespace wex
