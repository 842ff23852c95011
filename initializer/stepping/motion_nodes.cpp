#include "initializer/stepping/motion_nodes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "initializer/stepping/support_polygon.hpp"
#include "initializer/stepping/tyre_patch.hpp"

namespace wex {
namespace {

constexpr double kRounding = 1e-6;
constexpr double kStandstillM = 1e-9;
constexpr double kMaxSlipM_s = 0.25;  // of a standing tyre along its axle
constexpr double kLegSpacingM = 0.1;  // between the points of a leg held against the ground

double travel_m(const Eigen::Vector3d& moved, const Eigen::Vector3d& axle_world, bool grounded) {
  const Eigen::Vector3d forward = axle_world.cross(Eigen::Vector3d::UnitZ()).normalized();
  if (!grounded) return moved.dot(forward);
  const Eigen::Vector3d rolled = moved - moved.dot(axle_world) * axle_world;
  return std::copysign(rolled.norm(), rolled.dot(forward));
}

// Whether any point of a ball's lower half is in the ground: beside a step its flank can be while
// its middle is not.
bool ball_in_ground(const TerrainMap& terrain, const Eigen::Vector3d& centre, double radius_m) {
  constexpr int kDirections = 8, kRings = 3;
  constexpr double kRingRad = 0.5;
  if (!(centre.z() - radius_m >= terrain.height_m(centre.head<2>()))) return true;
  for (int ring = 1; ring <= kRings; ++ring) {
    const double down_m = radius_m * std::cos(ring * kRingRad),
                 out_m = radius_m * std::sin(ring * kRingRad);
    for (int k = 0; k < kDirections; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / kDirections;
      const Eigen::Vector2d p =
          centre.head<2>() + out_m * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      if (!(centre.z() - down_m >= terrain.height_m(p))) return true;
    }
  }
  return false;
}

bool capsule_in_ground(const TerrainMap& terrain, const CollisionModel::Capsule& capsule,
                       const KinematicTree::Workspace& w) {
  const Eigen::Isometry3d& T = w.T_world_body[static_cast<std::size_t>(capsule.body)];
  const Eigen::Vector3d a = T * capsule.p_body_a, b = T * capsule.p_body_b;
  const int steps = static_cast<int>((b - a).norm() / kLegSpacingM) + 1;
  for (int k = 0; k <= steps; ++k) {
    const Eigen::Vector3d p = a + (b - a) * (static_cast<double>(k) / steps);
    if (ball_in_ground(terrain, p, capsule.radius_m)) return true;
  }
  return false;
}

const CollisionModel::Capsule* leg_in_ground(const TerrainMap& terrain, const StanceGround& ground,
                                             const CollisionModel& collision,
                                             const KinematicTree::Workspace& w) {
  using Part = CollisionModel::Part;
  // Of the cells around, so that most capsules need no closer look.
  const auto highest_at = [&](const Eigen::Vector2d& p) { return ground.highest_m(p.x(), p.y()); };
  for (std::size_t c = 0; c < collision.capsules().size(); ++c) {
    const CollisionModel::Capsule& capsule = collision.capsules()[c];
    if (capsule.load_bearing || capsule.part < Part::kLF || capsule.part > Part::kRH) continue;
    const double least_m =
        collision.ground_clearance_m(w, static_cast<int>(c), kLegSpacingM, highest_at);
    if (!(least_m >= 0.0) && capsule_in_ground(terrain, capsule, w)) return &capsule;
  }
  return nullptr;
}

// Wheels in the air away from where they stood last and will stand next, at nodes and half-way
// between them.
class SwingCheck {
 public:
  SwingCheck(const TerrainMap& terrain, const MachineModel& machine,
             const std::vector<MotionNode>& nodes, double clearance_m)
      : terrain_(terrain),
        machine_(machine),
        nodes_(nodes),
        clearance_m_(clearance_m),
        w_(machine.tree.make_workspace()) {}

  [[nodiscard]] std::optional<NodeFault> run() {
    for (std::size_t k = 0; k < kNumWheels; ++k) {
      for (std::size_t i = 1; i < nodes_.size(); ++i) {
        if (nodes_[i].contacts[k] || !nodes_[i - 1].contacts[k]) continue;
        const std::size_t from = i;
        while (i + 1 < nodes_.size() && !nodes_[i].contacts[k]) ++i;
        if (auto fault = in_flight(k, from, i)) return fault;
      }
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] Eigen::Vector3d centre(std::size_t wheel, const Eigen::VectorXd& q) {
    const WheeledLeg& leg = machine_.legs[wheel];
    machine_.tree.update(q, w_);
    return machine_.tree.position(w_, leg.carrier_body, leg.p_carrier_wheel);
  }

  // At node `from` the wheel has only just left the ground, at `to` it is on it again.
  [[nodiscard]] std::optional<NodeFault> in_flight(std::size_t wheel, std::size_t from,
                                                   std::size_t to) {
    constexpr int kAngles = 21;
    constexpr double kHalfAngleRad = 1.4, kBetweenAnglesM = 0.002;
    const WheeledLeg& leg = machine_.legs[wheel];
    const Eigen::Vector3d spot_from = centre(wheel, nodes_[from].q);
    const Eigen::Vector3d spot_to = centre(wheel, nodes_[to].q);
    const auto height_at = [&](double x, double y) { return terrain_.height_m({x, y}); };
    for (std::size_t i = from; i < to; ++i) {
      const Eigen::VectorXd half_way = 0.5 * (nodes_[i].q + nodes_[i + 1].q);
      for (const Eigen::VectorXd* q : {&nodes_[i].q, &half_way}) {
        const Eigen::Vector3d p = centre(wheel, *q);
        if ((p - spot_from).head<2>().norm() < kFootholdM ||
            (p - spot_to).head<2>().norm() < kFootholdM) {
          continue;
        }
        const Eigen::Vector3d axle =
            machine_.tree.direction(w_, leg.carrier_body, leg.axle_carrier);
        const double clear_m = tread_clearance_m(height_at, p, axle, leg.radius_m, leg.half_width_m,
                                                 kAngles, kHalfAngleRad);
        if (!(clear_m >= clearance_m_ + kBetweenAnglesM)) {
          return NodeFault{
              i, "wheel " + std::string(kLimbNames[wheel]) + " swings too close to the ground"};
        }
      }
    }
    return std::nullopt;
  }

  const TerrainMap& terrain_;
  const MachineModel& machine_;
  const std::vector<MotionNode>& nodes_;
  double clearance_m_;
  KinematicTree::Workspace w_;
};

}  // namespace

void turn_wheels(const MachineModel& machine, std::vector<MotionNode>& nodes) {
  KinematicTree::Workspace before = machine.tree.make_workspace();
  KinematicTree::Workspace after = machine.tree.make_workspace();
  machine.tree.update(nodes.front().q, before);
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    machine.tree.update(nodes[i].q, after);
    const Eigen::Vector3d base_moved = (nodes[i].q - nodes[i - 1].q).head<3>();
    const bool driving = base_moved.head<2>().norm() > kStandstillM;
    for (std::size_t k = 0; k < kNumWheels; ++k) {
      const WheeledLeg& leg = machine.legs[k];
      if (leg.wheel < 0) continue;
      const bool grounded = nodes[i - 1].contacts[k];
      nodes[i].q[leg.wheel] = nodes[i - 1].q[leg.wheel];
      if (!grounded && !driving) continue;
      const auto axle = [&](const KinematicTree::Workspace& w) {
        return machine.tree.direction(w, leg.carrier_body, leg.axle_carrier);
      };
      const Eigen::Vector3d axle_world = (axle(before) + axle(after)).normalized();
      const Eigen::Vector3d moved =
          machine.tree.position(after, leg.carrier_body, leg.p_carrier_wheel) -
          machine.tree.position(before, leg.carrier_body, leg.p_carrier_wheel);
      double turn_rad = travel_m(moved, axle_world, grounded) / leg.radius_m;
      if (grounded) {
        double& least_s = nodes[i - 1].min_duration_s;
        least_s = std::max(least_s, std::abs(moved.dot(axle_world)) / kMaxSlipM_s);
      }
      if (grounded) {
        const auto carrier = static_cast<std::size_t>(leg.carrier_body);
        const Eigen::AngleAxisd carried(before.T_world_body[carrier].linear().transpose() *
                                        after.T_world_body[carrier].linear());
        turn_rad -= carried.angle() * carried.axis().dot(leg.axle_carrier);
      }
      nodes[i].q[leg.wheel] += leg.wheel_sign * turn_rad;
    }
    std::swap(before, after);
  }
}

std::optional<NodeFault> find_fault(const TerrainMap& terrain, const StanceGround& ground,
                                    const MachineModel& machine, const CollisionModel& collision,
                                    const std::vector<MotionNode>& nodes, double min_margin_m,
                                    double swing_clearance_m) {
  if (auto fault = SwingCheck(terrain, machine, nodes, swing_clearance_m).run()) return fault;
  KinematicTree::Workspace w = machine.tree.make_workspace();
  const auto height_at = [&](double x, double y) { return terrain.height_m({x, y}); };
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const MotionNode& node = nodes[i];
    for (int j = 0; j < machine.num_joints(); ++j) {
      const Joint& joint = machine.joints[static_cast<std::size_t>(j)];
      const double value = node.q[kNumBaseCoordinates + j];
      if (joint.continuous) continue;
      if (!(value >= joint.lower - kRounding && value <= joint.upper + kRounding)) {
        return NodeFault{i, joint.name + " is beyond its limits"};
      }
    }
    machine.tree.update(node.q, w);
    std::array<Eigen::Vector2d, kNumLimbs> contacts;
    std::size_t num_contacts = 0;
    for (std::size_t k = 0; k < kNumWheels; ++k) {
      if (!node.contacts[k]) continue;
      const WheeledLeg& leg = machine.legs[k];
      const Eigen::Vector3d p = machine.tree.position(w, leg.carrier_body, leg.p_carrier_wheel);
      const Eigen::Vector3d axle = machine.tree.direction(w, leg.carrier_body, leg.axle_carrier);
      if (!(std::abs(tread_clearance_m(height_at, p, axle, leg.radius_m, leg.half_width_m)) <=
            kTreadErrorM)) {
        return NodeFault{
            i, "the tyre of leg " + std::string(kLimbNames[k]) + " is not quite on the ground"};
      }
      contacts[num_contacts++] =
          tyre_patch(terrain, p, axle, leg.radius_m, leg.half_width_m).head<2>();
    }
    if (node.contacts[static_cast<std::size_t>(Limb::kArm)]) {
      contacts[num_contacts++] =
          machine.tree.position(w, machine.arm->contact_body, machine.arm->p_body_contact)
              .head<2>();
    }
    const double margin_m =
        hull_margin_m(machine.tree.com(w).head<2>(), std::span(contacts.data(), num_contacts));
    if (!(margin_m >= min_margin_m)) {
      return NodeFault{i, "only " + std::to_string(margin_m) + " m of stability"};
    }
    if (const auto* capsule = leg_in_ground(terrain, ground, collision, w)) {
      return NodeFault{i, capsule->name + " is in the ground"};
    }
  }
  return std::nullopt;
}

}  // namespace wex
