#include "mpc/nlp/rolling_slip.hpp"

#include <cmath>

namespace wex {

RollingSlip::RollingSlip(const MachineModel& machine, const NlpLayout& layout, double dt_s)
    : pattern_(wheel_rows_pattern(machine, layout)), dt_s_(dt_s) {
  for (int w = 0; w < kNumWheels; ++w) radius_m_[w] = machine.legs[w].radius_m;
}

void RollingSlip::bounds(Eigen::Ref<Eigen::VectorXd> lower,
                         Eigen::Ref<Eigen::VectorXd> upper) const {
  lower.setZero();
  upper.setZero();
}

void RollingSlip::evaluate(const NodeKinematics& from, const NodeKinematics& to,
                           Eigen::Ref<Eigen::VectorXd> value,
                           Eigen::Ref<Eigen::MatrixXd> jacobian_from,
                           Eigen::Ref<Eigen::MatrixXd> jacobian_to) const {
  for (int w = 0; w < kNumWheels; ++w) {
    const Eigen::Vector3d& a0 = from.axle_world[w];
    const Eigen::Vector3d& a1 = to.axle_world[w];
    const Eigen::Vector3d axle = 0.5 * (a0 + a1);
    const Eigen::Vector3d travel = to.p_world_wheel[w] - from.p_world_wheel[w];
    const double r = radius_m_[w];
    value[w] = (axle.dot(travel) + r * (std::asin(a1.z()) - std::asin(a0.z()))) / dt_s_;
    const double camber0 = r / std::sqrt(1.0 - a0.z() * a0.z());
    const double camber1 = r / std::sqrt(1.0 - a1.z() * a1.z());
    jacobian_from.row(w) = (0.5 * travel.transpose() * from.J_axle[w] -
                            axle.transpose() * from.J_wheel[w] - camber0 * from.J_axle[w].row(2)) /
                           dt_s_;
    jacobian_to.row(w) = (0.5 * travel.transpose() * to.J_axle[w] +
                          axle.transpose() * to.J_wheel[w] + camber1 * to.J_axle[w].row(2)) /
                         dt_s_;
  }
}

}  // namespace wex
