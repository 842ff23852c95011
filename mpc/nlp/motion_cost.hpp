#pragma once

#include <vector>

#include "mpc/nlp/tracking_cost.hpp"

namespace wex {

/// Smooth motion: 1/2 dt sum_k [ w_v . (v_k - v_ref,k)^2 + w_a . a_k^2 ] over intervals and nodes,
///   v_k = (x_k+1 - x_k) / dt,  a_k = (x_k+1 - 2 x_k + x_k-1) / dt^2,
/// with x_-1 before the first node given (start velocity) and, if end_at_rest, x_N+1 = x_N.
class MotionCost {
 public:
  MotionCost(NodeVector rate_weights, NodeVector acceleration_weights, double dt_s,
             bool end_at_rest);
  [[nodiscard]] double value(const std::vector<NodeVector>& nodes, const NodeVector& before_first,
                             const std::vector<NodeVector>& reference) const;
  void add_gradient(const std::vector<NodeVector>& nodes, const NodeVector& before_first,
                    const std::vector<NodeVector>& reference,
                    Eigen::Ref<Eigen::VectorXd> gradient) const;
  /// Constant Hessian entry between variable i of node k and of node k + lag, lag 0, 1 or 2.
  [[nodiscard]] double hessian(int i, int k, int lag, int num_nodes) const;

 private:
  NodeVector rate_weights_, acceleration_weights_;
  double dt_s_;
  bool end_at_rest_;
};

}  // namespace wex
