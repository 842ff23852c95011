#include "mpc/nlp/wheel_traversability.hpp"

#include <limits>

namespace wex {

WheelTraversability::WheelTraversability(const TerrainMap& terrain, const MachineModel& machine,
                                         const NlpLayout& layout, double min_signed_distance_m)
    : terrain_(&terrain),
      pattern_(wheel_rows_pattern(machine, layout)),
      min_signed_distance_m_(min_signed_distance_m) {}

void WheelTraversability::bounds(Eigen::Ref<Eigen::VectorXd> lower,
                                 Eigen::Ref<Eigen::VectorXd> upper) const {
  lower.setConstant(min_signed_distance_m_);
  upper.setConstant(std::numeric_limits<double>::infinity());
}

void WheelTraversability::evaluate(const NodeKinematics& node, Eigen::Ref<Eigen::VectorXd> value,
                                   Eigen::Ref<Eigen::MatrixXd> jacobian) const {
  for (int w = 0; w < kNumWheels; ++w) {
    const SurfaceSample distance =
        terrain_->signed_distance_surface(node.p_world_wheel[w].head<2>());
    value[w] = distance.value;
    jacobian.row(w) = distance.gradient.transpose() * node.J_wheel[w].topRows<2>();
  }
}

}  // namespace wex
