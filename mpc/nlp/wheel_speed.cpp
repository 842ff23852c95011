#include "mpc/nlp/wheel_speed.hpp"

namespace wex {

WheelSpeed::WheelSpeed(const MachineModel& machine, const NlpLayout& layout, double dt_s,
                       double rate_fraction)
    : pattern_(wheel_rows_pattern(machine, layout)), dt_s_(dt_s) {
  for (int w = 0; w < kNumWheels; ++w) {
    const WheeledLeg& leg = machine.legs[w];
    const Joint& joint = machine.joints[leg.wheel - kNumBaseCoordinates];
    max_speed_m_s_[w] = rate_fraction * joint.max_rate * leg.radius_m;
  }
}

void WheelSpeed::bounds(Eigen::Ref<Eigen::VectorXd> lower,
                        Eigen::Ref<Eigen::VectorXd> upper) const {
  for (int w = 0; w < kNumWheels; ++w) {
    lower[w] = -max_speed_m_s_[w];
    upper[w] = max_speed_m_s_[w];
  }
}

void WheelSpeed::evaluate(const NodeKinematics& from, const NodeKinematics& to,
                          Eigen::Ref<Eigen::VectorXd> value,
                          Eigen::Ref<Eigen::MatrixXd> jacobian_from,
                          Eigen::Ref<Eigen::MatrixXd> jacobian_to) const {
  for (int w = 0; w < kNumWheels; ++w) {
    const Eigen::Vector2d axle = 0.5 * (from.axle_world[w].head<2>() + to.axle_world[w].head<2>());
    const Eigen::Vector2d forward(axle.y(), -axle.x());  // axle x up, horizontal part
    const Eigen::Vector2d travel = (to.p_world_wheel[w] - from.p_world_wheel[w]).head<2>();
    value[w] = forward.dot(travel) / dt_s_;
    const Eigen::RowVector2d by_axle(-0.5 * travel.y() / dt_s_, 0.5 * travel.x() / dt_s_);
    jacobian_from.row(w) = by_axle * from.J_axle[w].topRows<2>() -
                           forward.transpose() / dt_s_ * from.J_wheel[w].topRows<2>();
    jacobian_to.row(w) = by_axle * to.J_axle[w].topRows<2>() +
                         forward.transpose() / dt_s_ * to.J_wheel[w].topRows<2>();
  }
}

}  // namespace wex
