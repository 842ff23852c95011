#pragma once

#include "models/terrain/terrain_map.hpp"
#include "mpc/nlp/constraint.hpp"

namespace wex {

/// Wheels stay inside traversable ground: sdf(wheel centre xy) >= min_signed_distance_m, a row per
/// wheel. Source: the paper's traversability constraint.
class WheelTraversability final : public NodeConstraint {
 public:
  WheelTraversability(const TerrainMap& terrain, const MachineModel& machine,
                      const NlpLayout& layout, double min_signed_distance_m);
  [[nodiscard]] std::string_view name() const override { return "signed_distance_m"; }
  [[nodiscard]] int num_rows() const override { return kNumWheels; }
  [[nodiscard]] BlockPattern pattern() const override { return pattern_; }
  void bounds(Eigen::Ref<Eigen::VectorXd> lower, Eigen::Ref<Eigen::VectorXd> upper) const override;
  void evaluate(const NodeKinematics& node, Eigen::Ref<Eigen::VectorXd> value,
                Eigen::Ref<Eigen::MatrixXd> jacobian) const override;

 private:
  const TerrainMap* terrain_;
  BlockPattern pattern_;
  double min_signed_distance_m_;
};

}  // namespace wex
