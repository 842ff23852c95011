#include "mpc/nlp/wheel_height.hpp"

namespace wex {

WheelHeight::WheelHeight(const TerrainMap& terrain, const MachineModel& machine,
                         const NlpLayout& layout,
                         const std::array<double, kNumWheels>& height_bias_m)
    : terrain_(&terrain), pattern_(wheel_rows_pattern(machine, layout)) {
  for (int w = 0; w < kNumWheels; ++w) {
    radius_plus_bias_m_[w] = machine.legs[w].radius_m + height_bias_m[w];
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
    const SurfaceSample ground = terrain_->dilated_surface(node.p_world_wheel[w].head<2>());
    value[w] = node.p_world_wheel[w].z() - ground.value - radius_plus_bias_m_[w];
    jacobian.row(w) =
        node.J_wheel[w].row(2) - ground.gradient.transpose() * node.J_wheel[w].topRows<2>();
  }
}

}  // namespace wex
