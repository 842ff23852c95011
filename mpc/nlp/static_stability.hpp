#pragma once

#include "mpc/nlp/constraint.hpp"

namespace wex {

/// Centre of mass inside the polygon of the four wheel contacts: signed distance to each edge
/// (LF-LH, LH-RH, RH-RF, RF-LF) >= min_margin_m, in the horizontal plane. Four rows.
class StaticStability final : public NodeConstraint {
 public:
  StaticStability(const NlpLayout& layout, double min_margin_m);
  [[nodiscard]] std::string_view name() const override { return "stability_margin_m"; }
  [[nodiscard]] int num_rows() const override { return 4; }
  [[nodiscard]] BlockPattern pattern() const override;
  void bounds(Eigen::Ref<Eigen::VectorXd> lower, Eigen::Ref<Eigen::VectorXd> upper) const override;
  void evaluate(const NodeKinematics& node, Eigen::Ref<Eigen::VectorXd> value,
                Eigen::Ref<Eigen::MatrixXd> jacobian) const override;

 private:
  int node_size_;
  double min_margin_m_;
};

/// Smallest of the four edge distances of a node [m].
[[nodiscard]] double stability_margin_m(const NodeKinematics& node);

}  // namespace wex
