#pragma once

#include <array>

#include "models/terrain/terrain_map.hpp"
#include "mpc/nlp/constraint.hpp"

namespace wex {

/// Every wheel rests on the ground, off by the estimated bias:
///   p_z - z_rest(p_x, p_y, axle) - bias = 0   [m], one row per wheel,
/// with z_rest of models/terrain/wheel_rest.hpp: the disc touches where it touches.
/// Source: the paper's height constraint p_z = h(p_x, p_y), which has the touching point straight
/// below the centre.
class WheelHeight final : public NodeConstraint {
 public:
  WheelHeight(const TerrainMap& terrain, const MachineModel& machine, const NlpLayout& layout,
              const std::array<double, kNumWheels>& height_bias_m = {});
  [[nodiscard]] std::string_view name() const override { return "wheel_height_m"; }
  [[nodiscard]] int num_rows() const override { return kNumWheels; }
  [[nodiscard]] BlockPattern pattern() const override { return pattern_; }
  void bounds(Eigen::Ref<Eigen::VectorXd> lower, Eigen::Ref<Eigen::VectorXd> upper) const override;
  void evaluate(const NodeKinematics& node, Eigen::Ref<Eigen::VectorXd> value,
                Eigen::Ref<Eigen::MatrixXd> jacobian) const override;

 private:
  const TerrainMap* terrain_;
  BlockPattern pattern_;
  std::array<double, kNumWheels> radius_m_, half_width_m_, height_bias_m_;
};

}  // namespace wex
