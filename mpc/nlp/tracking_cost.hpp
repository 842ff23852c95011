#pragma once

#include <vector>

#include "mpc/nlp/nlp_layout.hpp"

namespace wex {

/// Weights per kind of coordinate; squared SI units are scaled by dt, so values do not depend on
/// it.
struct CoordinateWeights {
  double base_xy = 0.0, base_z = 0.0, yaw = 0.0, tilt = 0.0, haa = 0.0, hfe = 0.0, steer = 0.0;
};

/// One weight per node variable.
[[nodiscard]] NodeVector expand(const CoordinateWeights& weights, const MachineModel& machine,
                                const NlpLayout& layout);

/// Deviation from a reference: 1/2 dt sum_k w . (x_k - r_k)^2 over k = 1..num_nodes.
class TrackingCost {
 public:
  TrackingCost(NodeVector weights, double dt_s) : weights_(std::move(weights)), dt_s_(dt_s) {}
  /// reference[k] belongs to node k; nodes and reference have num_nodes + 1 entries.
  [[nodiscard]] double value(const std::vector<NodeVector>& nodes,
                             const std::vector<NodeVector>& reference) const;
  /// Adds the gradient with respect to nodes 1..num_nodes, in layout order.
  void add_gradient(const std::vector<NodeVector>& nodes, const std::vector<NodeVector>& reference,
                    Eigen::Ref<Eigen::VectorXd> gradient) const;
  /// Constant Hessian entry on the diagonal of variable i of any node.
  [[nodiscard]] double hessian(int i) const { return dt_s_ * weights_[i]; }

 private:
  NodeVector weights_;
  double dt_s_;
};

}  // namespace wex
