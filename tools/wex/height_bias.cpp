#include "tools/wex/height_bias.hpp"

#include <cmath>

#include "models/terrain/wheel_rest.hpp"

namespace wex::app {

HeightBias::HeightBias(const TerrainMap& terrain, const MachineModel& machine,
                       double time_constant_s)
    : terrain_(&terrain),
      machine_(&machine),
      time_constant_s_(time_constant_s),
      workspace_(machine.tree.make_workspace()) {}

void HeightBias::update(double t_s, const Eigen::VectorXd& q) {
  WEX_EXPECTS(!last_t_s_ || t_s >= *last_t_s_);
  const double gain = last_t_s_ ? 1.0 - std::exp(-(t_s - *last_t_s_) / time_constant_s_) : 1.0;
  last_t_s_ = t_s;
  machine_->tree.update(q, workspace_);
  for (int i = 0; i < kNumWheels; ++i) {
    const WheeledLeg& leg = machine_->legs[i];
    const Eigen::Vector3d p_world_centre =
        machine_->tree.position(workspace_, leg.carrier_body, leg.p_carrier_wheel);
    const Eigen::Vector3d axle_world =
        machine_->tree.direction(workspace_, leg.carrier_body, leg.axle_carrier);
    const double model_height_m =
        wheel_rest(*terrain_, p_world_centre.head<2>(), axle_world, leg.radius_m, leg.half_width_m)
            .height_m;
    bias_m_[i] += gain * (p_world_centre.z() - model_height_m - bias_m_[i]);
  }
}

}  // namespace wex::app
