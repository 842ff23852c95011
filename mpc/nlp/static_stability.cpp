#include "mpc/nlp/static_stability.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace wex {
namespace {

// Counter-clockwise seen from above, so that the inside is on the left of each edge.
constexpr std::array<std::array<int, 2>, 4> kEdges{{{0, 2}, {2, 3}, {3, 1}, {1, 0}}};

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double edge_distance_m(const NodeKinematics& node, int edge) {
  const Eigen::Vector2d& start = node.p_world_contact_xy[kEdges[edge][0]];
  const Eigen::Vector2d along = node.p_world_contact_xy[kEdges[edge][1]] - start;
  return cross(along, node.p_world_com.head<2>() - start) / along.norm();
}

}  // namespace

StaticStability::StaticStability(const NlpLayout& layout, double min_margin_m)
    : node_size_(layout.node_size()), min_margin_m_(min_margin_m) {}

BlockPattern StaticStability::pattern() const {
  return BlockPattern::Constant(num_rows(), node_size_, true);
}

void StaticStability::bounds(Eigen::Ref<Eigen::VectorXd> lower,
                             Eigen::Ref<Eigen::VectorXd> upper) const {
  lower.setConstant(min_margin_m_);
  upper.setConstant(std::numeric_limits<double>::infinity());
}

void StaticStability::evaluate(const NodeKinematics& node, Eigen::Ref<Eigen::VectorXd> value,
                               Eigen::Ref<Eigen::MatrixXd> jacobian) const {
  for (int edge = 0; edge < 4; ++edge) {
    const int i = kEdges[edge][0], j = kEdges[edge][1];
    const Eigen::Vector2d e = node.p_world_contact_xy[j] - node.p_world_contact_xy[i];
    const Eigen::Vector2d w = node.p_world_com.head<2>() - node.p_world_contact_xy[i];
    const double length = e.norm();
    const double distance = cross(e, w) / length;
    value[edge] = distance;
    // d(e x w / |e|) = (de x w + e x dw) / |e| - distance e.de / |e|^2
    const Eigen::RowVector2d by_e(w.y() / length - distance * e.x() / (length * length),
                                  -w.x() / length - distance * e.y() / (length * length));
    const Eigen::RowVector2d by_w(-e.y() / length, e.x() / length);
    jacobian.row(edge) = by_e * node.J_contact[j].topRows<2>() -
                         (by_e + by_w) * node.J_contact[i].topRows<2>() +
                         by_w * node.J_com.topRows<2>();
  }
}

double stability_margin_m(const NodeKinematics& node) {
  double margin = std::numeric_limits<double>::infinity();
  for (int edge = 0; edge < 4; ++edge) margin = std::min(margin, edge_distance_m(node, edge));
  return margin;
}

}  // namespace wex
