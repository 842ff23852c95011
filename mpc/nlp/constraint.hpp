#pragma once

#include <Eigen/Core>
#include <string_view>

#include "mpc/nlp/node_kinematics.hpp"

namespace wex {

/// rows x node variables; true where the Jacobian may be nonzero.
using BlockPattern = Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic>;

/// Rows lower <= value <= upper that couple two neighbouring nodes (an IntervalConstraint) or
/// belong to one (a NodeConstraint). Immutable and safe to share; evaluation does not allocate.
class NodeConstraint {
 public:
  virtual ~NodeConstraint() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  [[nodiscard]] virtual int num_rows() const = 0;
  [[nodiscard]] virtual BlockPattern pattern() const = 0;
  virtual void bounds(Eigen::Ref<Eigen::VectorXd> lower,
                      Eigen::Ref<Eigen::VectorXd> upper) const = 0;
  /// value: num_rows; jacobian: num_rows x node variables, all entries written.
  virtual void evaluate(const NodeKinematics& node, Eigen::Ref<Eigen::VectorXd> value,
                        Eigen::Ref<Eigen::MatrixXd> jacobian) const = 0;
};

class IntervalConstraint {
 public:
  virtual ~IntervalConstraint() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  [[nodiscard]] virtual int num_rows() const = 0;
  [[nodiscard]] virtual BlockPattern pattern() const = 0;  ///< the same for both nodes
  virtual void bounds(Eigen::Ref<Eigen::VectorXd> lower,
                      Eigen::Ref<Eigen::VectorXd> upper) const = 0;
  virtual void evaluate(const NodeKinematics& from, const NodeKinematics& to,
                        Eigen::Ref<Eigen::VectorXd> value,
                        Eigen::Ref<Eigen::MatrixXd> jacobian_from,
                        Eigen::Ref<Eigen::MatrixXd> jacobian_to) const = 0;
};

/// Pattern of one row per wheel that depends on the base and that wheel's leg.
[[nodiscard]] inline BlockPattern wheel_rows_pattern(const MachineModel& machine,
                                                     const NlpLayout& layout) {
  BlockPattern pattern = BlockPattern::Constant(kNumWheels, layout.node_size(), false);
  pattern.leftCols<kNumBaseCoordinates>().setConstant(true);
  for (int w = 0; w < kNumWheels; ++w) {
    for (const int variable : layout.leg_variables(machine.legs[w])) pattern(w, variable) = true;
  }
  return pattern;
}

}  // namespace wex
