#include "mpc/nlp/wheel_height.hpp"

#include "models/terrain/wheel_rest.hpp"

namespace wex {

WheelHeight::WheelHeight(const TerrainMap& terrain, const MachineModel& machine,
                         const NlpLayout& layout,
                         const std::array<double, kNumWheels>& height_bias_m)
    : terrain_(&terrain),
      pattern_(wheel_rows_pattern(machine, layout)),
      height_bias_m_(height_bias_m) {
  for (int w = 0; w < kNumWheels; ++w) {
    radius_m_[w] = machine.legs[w].radius_m;
    half_width_m_[w] = machine.legs[w].half_width_m;
  }
}

void WheelHeight::bounds(Eigen::Ref<Eigen::VectorXd> lower,
                         Eigen::Ref<Eigen::VectorXd> upper) const {
  lower.setZero();
  upper.setZero();
}

void WheelHeight::evaluate(const NodeKinematics& node, Eigen::Ref<Eigen::VectorXd> value,
                           Eigen::Ref<Eigen::MatrixXd> jacobian) const {
  for (int w = 0; w < kNumWheels; ++w) {
    const Eigen::Vector3d& p = node.p_world_wheel[w];
    const WheelRest rest =
        wheel_rest(*terrain_, p.head<2>(), node.axle_world[w], radius_m_[w], half_width_m_[w]);
    value[w] = p.z() - rest.height_m - height_bias_m_[w];
    jacobian.row(w) = node.J_wheel[w].row(2) -
                      rest.by_xy.transpose() * node.J_wheel[w].topRows<2>() -
                      rest.by_axle.transpose() * node.J_axle[w];
  }
}

}  // namespace wex
