#include "mpc/nlp/motion_cost.hpp"

#include <algorithm>
#include <array>

namespace wex {
namespace {

constexpr std::array<double, 3> kStencil{1.0, -2.0, 1.0};  // of x_k-1, x_k, x_k+1 in dt^2 a_k

}  // namespace

MotionCost::MotionCost(NodeVector rate_weights, NodeVector acceleration_weights, double dt_s,
                       bool end_at_rest)
    : rate_weights_(std::move(rate_weights)),
      acceleration_weights_(std::move(acceleration_weights)),
      dt_s_(dt_s),
      end_at_rest_(end_at_rest) {}

double MotionCost::value(const std::vector<NodeVector>& nodes, const NodeVector& before_first,
                         const std::vector<NodeVector>& reference) const {
  const int last = static_cast<int>(nodes.size()) - 1;
  const double dt2 = dt_s_ * dt_s_;
  double sum = 0.0;
  for (int k = 0; k < last; ++k) {
    const NodeVector rate_error =
        ((nodes[k + 1] - nodes[k]) - (reference[k + 1] - reference[k])) / dt_s_;
    sum += rate_weights_.dot(rate_error.cwiseAbs2());
  }
  for (int k = 0; k <= (end_at_rest_ ? last : last - 1); ++k) {
    const NodeVector& previous = k == 0 ? before_first : nodes[k - 1];
    const NodeVector& next = k == last ? nodes[last] : nodes[k + 1];
    const NodeVector acceleration = (next - 2.0 * nodes[k] + previous) / dt2;
    sum += acceleration_weights_.dot(acceleration.cwiseAbs2());
  }
  return 0.5 * dt_s_ * sum;
}

void MotionCost::add_gradient(const std::vector<NodeVector>& nodes, const NodeVector& before_first,
                              const std::vector<NodeVector>& reference,
                              Eigen::Ref<Eigen::VectorXd> gradient) const {
  const int last = static_cast<int>(nodes.size()) - 1;
  const Eigen::Index n = rate_weights_.size();
  const double dt2 = dt_s_ * dt_s_;
  const auto add = [&](int k, const NodeVector& term) {
    if (k >= 1) gradient.segment((std::min(k, last) - 1) * n, n) += term;
  };
  for (int k = 0; k < last; ++k) {
    const NodeVector term = rate_weights_.cwiseProduct(
        ((nodes[k + 1] - nodes[k]) - (reference[k + 1] - reference[k])) / dt_s_);
    add(k + 1, term);
    add(k, -term);
  }
  for (int k = 0; k <= (end_at_rest_ ? last : last - 1); ++k) {
    const NodeVector& previous = k == 0 ? before_first : nodes[k - 1];
    const NodeVector& next = k == last ? nodes[last] : nodes[k + 1];
    const NodeVector term =
        dt_s_ / dt2 * acceleration_weights_.cwiseProduct((next - 2.0 * nodes[k] + previous) / dt2);
    for (int s = 0; s < 3; ++s) add(k - 1 + s, kStencil[s] * term);
  }
}

double MotionCost::hessian(int i, int k, int lag, int num_nodes) const {
  const double dt3 = dt_s_ * dt_s_ * dt_s_;
  double sum = 0.0;
  if (lag == 0) sum += rate_weights_[i] / dt_s_ * (k < num_nodes ? 2.0 : 1.0);
  if (lag == 1) sum -= rate_weights_[i] / dt_s_;
  // Each acceleration term j touches nodes j-1, j, j+1 (the one past the end is the last node
  // again).
  const auto coefficient = [&](int j, int node) {
    double c = 0.0;
    for (int s = 0; s < 3; ++s) {
      if (std::min(j - 1 + s, num_nodes) == node) c += kStencil[s];
    }
    return c;
  };
  for (int j = k - 1; j <= k + 1; ++j) {
    if (j < 0 || j > (end_at_rest_ ? num_nodes : num_nodes - 1)) continue;
    sum += acceleration_weights_[i] / dt3 * coefficient(j, k) * coefficient(j, k + lag);
  }
  return sum;
}

}  // namespace wex
