#include "tools/wex/support_margin.hpp"

#include <algorithm>
#include <limits>

namespace wex::app {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Andrew's monotone chain, counter-clockwise.
std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  std::vector<Eigen::Vector2d> hull;
  const auto add_chain = [&hull](const auto& ordered) {
    const std::size_t base = hull.size();
    for (const Eigen::Vector2d& p : ordered) {
      while (hull.size() >= base + 2 &&
             cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0.0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();  // it begins the other chain
  };
  add_chain(points);
  std::reverse(points.begin(), points.end());
  add_chain(points);
  return hull;
}

}  // namespace

double support_margin_m(const MachineModel& machine, const Eigen::VectorXd& q,
                        const ContactFlags& contacts) {
  WEX_EXPECTS(q.size() == machine.num_coordinates());
  KinematicTree::Workspace workspace = machine.tree.make_workspace();
  machine.tree.update(q, workspace);
  std::vector<Eigen::Vector2d> feet;
  for (int i = 0; i < kNumWheels; ++i) {
    if (!contacts[i]) continue;
    const WheeledLeg& leg = machine.legs[i];
    const Eigen::Vector3d p_world_centre =
        machine.tree.position(workspace, leg.carrier_body, leg.p_carrier_wheel);
    const Eigen::Vector3d axle =
        machine.tree.direction(workspace, leg.carrier_body, leg.axle_carrier);
    // Lowest point of the wheel's disc: down within the plane normal to the axle.
    Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
    down -= down.dot(axle) * axle;
    feet.push_back((p_world_centre + leg.radius_m * down.normalized()).head<2>());
  }
  if (machine.arm && contacts[static_cast<std::size_t>(Limb::kArm)]) {
    feet.push_back(
        machine.tree.position(workspace, machine.arm->contact_body, machine.arm->p_body_contact)
            .head<2>());
  }
  if (feet.size() < 3) return -std::numeric_limits<double>::infinity();
  const Eigen::Vector2d com = machine.tree.com(workspace).head<2>();
  const std::vector<Eigen::Vector2d> hull = convex_hull(std::move(feet));
  double margin = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d edge = hull[(i + 1) % hull.size()] - hull[i];
    margin = std::min(margin, cross(edge, com - hull[i]) / edge.norm());
  }
  return margin;
}

}  // namespace wex::app
