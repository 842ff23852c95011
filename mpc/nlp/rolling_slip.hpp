#pragma once

#include "mpc/nlp/constraint.hpp"

namespace wex {

/// Rolling without side slip over an interval: the tyre's touching patch does not move along the
/// axle,
///   [ (a_k + a_k+1)/2 . (p_k+1 - p_k) + r (camber_k+1 - camber_k) ] / dt = 0   [m/s], a row per
///   wheel
/// with axle a, wheel centre p, camber = asin(a_z). The mean axle makes circular arcs exact; the
/// camber term is the patch moving sideways when the wheel tilts. Source: the paper's non-holonomic
/// rolling constraint, discretized with the midpoint axle.
class RollingSlip final : public IntervalConstraint {
 public:
  RollingSlip(const MachineModel& machine, const NlpLayout& layout, double dt_s);
  [[nodiscard]] std::string_view name() const override { return "side_slip_m_s"; }
  [[nodiscard]] int num_rows() const override { return kNumWheels; }
  [[nodiscard]] BlockPattern pattern() const override { return pattern_; }
  void bounds(Eigen::Ref<Eigen::VectorXd> lower, Eigen::Ref<Eigen::VectorXd> upper) const override;
  void evaluate(const NodeKinematics& from, const NodeKinematics& to,
                Eigen::Ref<Eigen::VectorXd> value, Eigen::Ref<Eigen::MatrixXd> jacobian_from,
                Eigen::Ref<Eigen::MatrixXd> jacobian_to) const override;

 private:
  BlockPattern pattern_;
  std::array<double, kNumWheels> radius_m_;
  double dt_s_;
};

}  // namespace wex
