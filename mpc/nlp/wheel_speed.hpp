#pragma once

#include "mpc/nlp/constraint.hpp"

namespace wex {

/// Rolling speed within what the wheel drive can turn: |forward . (p_k+1 - p_k)| / dt <= r w_max f
/// [m/s], a row per wheel, with the horizontal forward direction across the mean axle.
class WheelSpeed final : public IntervalConstraint {
 public:
  WheelSpeed(const MachineModel& machine, const NlpLayout& layout, double dt_s,
             double rate_fraction);
  [[nodiscard]] std::string_view name() const override { return "wheel_speed_m_s"; }
  [[nodiscard]] int num_rows() const override { return kNumWheels; }
  [[nodiscard]] BlockPattern pattern() const override { return pattern_; }
  void bounds(Eigen::Ref<Eigen::VectorXd> lower, Eigen::Ref<Eigen::VectorXd> upper) const override;
  void evaluate(const NodeKinematics& from, const NodeKinematics& to,
                Eigen::Ref<Eigen::VectorXd> value, Eigen::Ref<Eigen::MatrixXd> jacobian_from,
                Eigen::Ref<Eigen::MatrixXd> jacobian_to) const override;

 private:
  BlockPattern pattern_;
  std::array<double, kNumWheels> max_speed_m_s_;
  double dt_s_;
};

}  // namespace wex
