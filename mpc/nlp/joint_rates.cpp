#include "mpc/nlp/joint_rates.hpp"

namespace wex {

JointRates::JointRates(const MachineModel& machine, const NlpLayout& layout, double dt_s,
                       double rate_fraction)
    : node_size_(layout.node_size()), dt_s_(dt_s) {
  for (int i = kNumBaseCoordinates; i < node_size_; ++i) {
    const Joint& joint = machine.joints[layout.coordinates[i] - kNumBaseCoordinates];
    max_rate_.push_back(rate_fraction * joint.max_rate);
  }
}

BlockPattern JointRates::pattern() const {
  BlockPattern pattern = BlockPattern::Constant(num_rows(), node_size_, false);
  for (int row = 0; row < num_rows(); ++row) pattern(row, kNumBaseCoordinates + row) = true;
  return pattern;
}

void JointRates::bounds(Eigen::Ref<Eigen::VectorXd> lower,
                        Eigen::Ref<Eigen::VectorXd> upper) const {
  for (int row = 0; row < num_rows(); ++row) {
    lower[row] = -max_rate_[row];
    upper[row] = max_rate_[row];
  }
}

void JointRates::evaluate(const NodeKinematics& from, const NodeKinematics& to,
                          Eigen::Ref<Eigen::VectorXd> value,
                          Eigen::Ref<Eigen::MatrixXd> jacobian_from,
                          Eigen::Ref<Eigen::MatrixXd> jacobian_to) const {
  jacobian_from.setZero();
  jacobian_to.setZero();
  for (int row = 0; row < num_rows(); ++row) {
    const int variable = kNumBaseCoordinates + row;
    value[row] = (to.x[variable] - from.x[variable]) / dt_s_;
    jacobian_from(row, variable) = -1.0 / dt_s_;
    jacobian_to(row, variable) = 1.0 / dt_s_;
  }
}

}  // namespace wex
