#pragma once

#include <vector>

#include "mpc/nlp/constraint.hpp"

namespace wex {

/// Leg joint rates within limits: |q_k+1 - q_k| / dt <= rate_fraction * max_rate, a row per
/// optimized joint [rad/s or m/s].
class JointRates final : public IntervalConstraint {
 public:
  JointRates(const MachineModel& machine, const NlpLayout& layout, double dt_s,
             double rate_fraction);
  [[nodiscard]] std::string_view name() const override { return "joint_rate_rad_s"; }
  [[nodiscard]] int num_rows() const override { return static_cast<int>(max_rate_.size()); }
  [[nodiscard]] BlockPattern pattern() const override;
  void bounds(Eigen::Ref<Eigen::VectorXd> lower, Eigen::Ref<Eigen::VectorXd> upper) const override;
  void evaluate(const NodeKinematics& from, const NodeKinematics& to,
                Eigen::Ref<Eigen::VectorXd> value, Eigen::Ref<Eigen::MatrixXd> jacobian_from,
                Eigen::Ref<Eigen::MatrixXd> jacobian_to) const override;

 private:
  int node_size_;
  std::vector<double> max_rate_;  ///< of node variable kNumBaseCoordinates + row
  double dt_s_;
};

}  // namespace wex
