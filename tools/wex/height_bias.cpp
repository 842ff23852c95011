#include "tools/wex/height_bias.hpp"

#include <cmath>

#include "models/terrain/wheel_rest.hpp"

namespace wex::app {
namespace {

/// The plane that fits four heights best, at their places.
std::array<double, kNumWheels> without_warp(std::array<double, kNumWheels> height_m,
                                            const std::array<Eigen::Vector2d, kNumWheels>& at) {
  // Heights at four points that no plane has any share of: by Cramer's rule, each point's is the
  // area that the other three span, with alternating sign.
  const auto area = [&at](int a, int b, int c) {
    const Eigen::Vector2d u = at[b] - at[a], v = at[c] - at[a];
    return u.x() * v.y() - u.y() * v.x();
  };
  const Eigen::Vector4d warp(area(1, 2, 3), -area(0, 2, 3), area(0, 1, 3), -area(0, 1, 2));
  Eigen::Map<Eigen::Vector4d> height(height_m.data());
  constexpr double kInLine_m4 = 1e-6;
  if (warp.squaredNorm() > kInLine_m4) height -= warp * (warp.dot(height) / warp.squaredNorm());
  return height_m;
}

}  // namespace

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
  std::array<Eigen::Vector2d, kNumWheels> wheel_m;
  for (int i = 0; i < kNumWheels; ++i) {
    const WheeledLeg& leg = machine_->legs[i];
    const Eigen::Vector3d p_world_centre =
        machine_->tree.position(workspace_, leg.carrier_body, leg.p_carrier_wheel);
    const Eigen::Vector3d axle_world =
        machine_->tree.direction(workspace_, leg.carrier_body, leg.axle_carrier);
    const double model_height_m =
        wheel_rest(*terrain_, p_world_centre.head<2>(), axle_world, leg.radius_m, leg.half_width_m)
            .height_m;
    low_passed_m_[i] += gain * (p_world_centre.z() - model_height_m - low_passed_m_[i]);
    wheel_m[i] = p_world_centre.head<2>();
  }
  bias_m_ = without_warp(low_passed_m_, wheel_m);
}

}  // namespace wex::app
