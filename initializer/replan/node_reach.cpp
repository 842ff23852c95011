#include "initializer/replan/node_reach.hpp"

namespace wex {
namespace {

// The smooth surface below a tyre follows cells up to half a metre and its spline's tail away.
constexpr double kTyreReachM = 0.8;
constexpr double kCellM =
    0.2;  // what is read beside a point: the cells around, and a motion's bend

}  // namespace

std::vector<NodeReach> reach_of(const MachineModel& machine, const CollisionModel& shape,
                                const std::vector<WholeBodyNode>& nodes) {
  using Part = CollisionModel::Part;
  KinematicTree::Workspace w = machine.tree.make_workspace();
  std::vector<NodeReach> all;
  all.reserve(nodes.size());
  for (const WholeBodyNode& node : nodes) {
    machine.tree.update(node.q, w);
    const Eigen::Vector2d here = node.q.head<2>();
    NodeReach reach;
    reach.fill({here, here});
    const auto add = [&](Part part, const Eigen::Vector3d& p, double radius_m) {
      GroundRect& rect = reach[static_cast<std::size_t>(part)];
      rect = rect.united(GroundRect{p.head<2>(), p.head<2>()}.inflated(radius_m));
    };
    // Legs and arm need not have ground below the base's origin.
    for (std::size_t i = 0; i < kNumWheels; ++i) {
      const WheeledLeg& leg = machine.legs[i];
      const Eigen::Vector3d p = machine.tree.position(w, leg.carrier_body, leg.p_carrier_wheel);
      const auto part = static_cast<Part>(static_cast<std::size_t>(Part::kLF) + i);
      reach[static_cast<std::size_t>(part)] = {p.head<2>(), p.head<2>()};
      add(part, p, kTyreReachM);
    }
    if (machine.arm) {
      const Eigen::Vector3d p =
          machine.tree.position(w, machine.arm->contact_body, machine.arm->p_body_contact);
      reach[static_cast<std::size_t>(Part::kArm)] = {p.head<2>(), p.head<2>()};
      add(Part::kArm, p, kCellM);
    }
    for (const double x : {machine.belly_min_m.x(), machine.belly_max_m.x()}) {
      for (const double y : {machine.belly_min_m.y(), machine.belly_max_m.y()}) {
        add(Part::kChassis,
            machine.tree.position(w, 0, Eigen::Vector3d(x, y, -machine.belly_below_base_m)),
            kCellM);
      }
    }
    for (const CollisionModel::Capsule& capsule : shape.capsules()) {
      const Eigen::Isometry3d& T = w.T_world_body[static_cast<std::size_t>(capsule.body)];
      add(capsule.part, T * capsule.p_body_a, capsule.radius_m + kCellM);
      add(capsule.part, T * capsule.p_body_b, capsule.radius_m + kCellM);
    }
    all.push_back(reach);
  }
  return all;
}

unsigned touched_parts(const std::vector<NodeReach>& reach, const GroundChange& change,
                       std::size_t node) {
  const NodeReach& before = reach[node > 0 ? node - 1 : node];
  const NodeReach& after = reach[node + 1 < reach.size() ? node + 1 : node];
  unsigned parts = 0;
  for (std::size_t part = 0; part < reach[node].size(); ++part) {
    if (change.meets(reach[node][part].united(before[part]).united(after[part]))) {
      parts |= 1U << part;
    }
  }
  return parts;
}

std::vector<std::size_t> touched_nodes(const std::vector<NodeReach>& reach,
                                       const GroundChange& change) {
  std::vector<std::size_t> touched;
  if (change.none()) return touched;
  for (std::size_t i = 0; i < reach.size(); ++i) {
    if (touched_parts(reach, change, i) != 0) touched.push_back(i);
  }
  return touched;
}

}  // namespace wex
