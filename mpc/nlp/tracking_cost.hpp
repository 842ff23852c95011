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

/// Deviation from a reference: 1/2 sum_k d_k w . (x_k - r_k)^2 over k = 1..num_nodes, where d_k =
/// dt but for the last node: its deviation counts as though it stayed for `tail_s` more.
class TrackingCost {
 public:
  TrackingCost(NodeVector weights, double dt_s, double tail_s)
      : weights_(std::move(weights)), dt_s_(dt_s), tail_s_(tail_s) {}
  /// reference[k] belongs to node k; nodes and reference have num_nodes + 1 entries.
  [[nodiscard]] double value(const std::vector<NodeVector>& nodes,
                             const std::vector<NodeVector>& reference) const;
  /// Adds the gradient with respect to nodes 1..num_nodes, in layout order.
  void add_gradient(const std::vector<NodeVector>& nodes, const std::vector<NodeVector>& reference,
                    Eigen::Ref<Eigen::VectorXd> gradient) const;
  /// Constant Hessian entry on the diagonal of variable i of a node, the last one or another.
  [[nodiscard]] double hessian(int i, bool last) const { return duration_s(last) * weights_[i]; }

 private:
  [[nodiscard]] double duration_s(bool last) const { return last ? dt_s_ + tail_s_ : dt_s_; }

  NodeVector weights_;
  double dt_s_, tail_s_;
};

}  // namespace wex
