#include "mpc/nlp/trajectory_problem.hpp"

#include <algorithm>
#include <limits>

namespace wex {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kMaxBlockRows = 32;

using RowValues = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxBlockRows, 1>;
using BlockJacobian =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxBlockRows, kMaxNodeVariables>;

double violation(double value, double lower, double upper) {
  return std::max({0.0, lower - value, value - upper});
}

}  // namespace

TrajectoryProblem::TrajectoryProblem(TrajectorySetup setup)
    : setup_(std::move(setup)),
      tracking_(expand(setup_.tracking, *setup_.machine, setup_.layout), setup_.dt_s,
                setup_.tracking_tail_s),
      motion_(expand(setup_.rates, *setup_.machine, setup_.layout),
              expand(setup_.accelerations, *setup_.machine, setup_.layout), setup_.dt_s,
              setup_.end_at_rest),
      evaluator_(*setup_.machine, setup_.layout) {
  const int num_nodes = setup_.layout.num_nodes;
  WEX_EXPECTS(num_nodes >= 1 && setup_.dt_s > 0.0);
  WEX_EXPECTS(static_cast<int>(setup_.reference.size()) == num_nodes + 1);
  WEX_EXPECTS(setup_.q_held.size() == setup_.reference.size());
  WEX_EXPECTS(setup_.before_first.size() == setup_.layout.node_size());
  num_variables_ = setup_.layout.num_node_variables();
  for (const auto& [constraint, softness] : setup_.node_constraints) {
    const BlockPattern pattern = constraint->pattern();
    for (int k = 1; k <= num_nodes; ++k) {
      const bool soft = softness.weight > 0.0 && k <= softness.last_soft_node;
      const int num_slacks = !soft ? 0 : softness.one_sided ? 1 : constraint->num_rows();
      node_blocks_.push_back({constraint.get(), pattern, k, num_rows_, soft ? num_variables_ : -1,
                              softness.one_sided});
      for (int s = 0; s < num_slacks; ++s) slacks_.emplace_back(num_variables_++, softness.weight);
      num_rows_ += constraint->num_rows();
    }
  }
  for (const auto& constraint : setup_.interval_constraints) {
    for (int k = 0; k < num_nodes; ++k) {
      interval_blocks_.push_back({constraint.get(), constraint->pattern(), k, num_rows_});
      num_rows_ += constraint->num_rows();
    }
  }
  build_bounds();
  build_jacobian_structure();
  build_hessian();
  nodes_ = setup_.reference;
  kinematics_.resize(nodes_.size());
  evaluator_.evaluate(nodes_[0], setup_.q_held[0], kinematics_[0]);
}

void TrajectoryProblem::build_bounds() {
  const NlpLayout& layout = setup_.layout;
  lower_ = Eigen::VectorXd::Constant(num_variables_, -kInfinity);
  upper_ = Eigen::VectorXd::Constant(num_variables_, kInfinity);
  for (int k = 1; k <= layout.num_nodes; ++k) {
    const int offset = layout.node_offset(k);
    for (const int tilt : {kBasePitch, kBaseRoll}) {
      lower_[offset + tilt] = -setup_.max_tilt_rad;
      upper_[offset + tilt] = setup_.max_tilt_rad;
    }
    for (int i = kNumBaseCoordinates; i < layout.node_size(); ++i) {
      const Joint& joint = setup_.machine->joints[layout.coordinates[i] - kNumBaseCoordinates];
      lower_[offset + i] = joint.lower + setup_.joint_margin_rad;
      upper_[offset + i] = joint.upper - setup_.joint_margin_rad;
    }
  }
  if (setup_.fix_goal) {
    const int offset = layout.node_offset(layout.num_nodes);
    for (const int goal : {kBaseX, kBaseY, kBaseYaw}) {
      lower_[offset + goal] = upper_[offset + goal] = setup_.reference.back()[goal];
    }
  }
  row_lower_.resize(num_rows_);
  row_upper_.resize(num_rows_);
  for (const NodeBlock& block : node_blocks_) {
    const int n = block.constraint->num_rows();
    block.constraint->bounds(row_lower_.segment(block.row, n), row_upper_.segment(block.row, n));
    if (block.slack >= 0 && block.one_sided) lower_[block.slack] = 0.0;
  }
  for (const IntervalBlock& block : interval_blocks_) {
    const int n = block.constraint->num_rows();
    block.constraint->bounds(row_lower_.segment(block.row, n), row_upper_.segment(block.row, n));
  }
}

void TrajectoryProblem::build_jacobian_structure() {
  const auto add_block = [&](const BlockPattern& pattern, int row, int node) {
    if (node == 0) return;
    for (int r = 0; r < pattern.rows(); ++r) {
      for (int c = 0; c < pattern.cols(); ++c) {
        if (!pattern(r, c)) continue;
        jacobian_rows_.push_back(row + r);
        jacobian_columns_.push_back(setup_.layout.node_offset(node) + c);
      }
    }
  };
  for (const NodeBlock& block : node_blocks_) {
    add_block(block.pattern, block.row, block.node);
    if (block.slack < 0) continue;
    for (int r = 0; r < block.constraint->num_rows(); ++r) {
      jacobian_rows_.push_back(block.row + r);
      jacobian_columns_.push_back(block.slack + (block.one_sided ? 0 : r));
    }
  }
  for (const IntervalBlock& block : interval_blocks_) {
    add_block(block.pattern, block.row, block.from);
    add_block(block.pattern, block.row, block.from + 1);
  }
}

void TrajectoryProblem::build_hessian() {
  const NlpLayout& layout = setup_.layout;
  const auto add = [&](int row, int column, double value) {
    hessian_rows_.push_back(row);
    hessian_columns_.push_back(column);
    hessian_values_.push_back(value);
  };
  for (int k = 1; k <= layout.num_nodes; ++k) {
    for (int i = 0; i < layout.node_size(); ++i) {
      for (int lag = 0; lag <= std::min(2, layout.num_nodes - k); ++lag) {
        const double tracking = lag == 0 ? tracking_.hessian(i, k == layout.num_nodes) : 0.0;
        add(layout.node_offset(k + lag) + i, layout.node_offset(k) + i,
            tracking + motion_.hessian(i, k, lag, layout.num_nodes));
      }
    }
  }
  for (const auto& [variable, weight] : slacks_) add(variable, variable, weight);
}

void TrajectoryProblem::update(const Eigen::VectorXd& z) {
  if (evaluated_at_.size() == z.size() && evaluated_at_ == z) return;
  evaluated_at_ = z;
  const NlpLayout& layout = setup_.layout;
  for (int k = 1; k <= layout.num_nodes; ++k) {
    nodes_[k] = z.segment(layout.node_offset(k), layout.node_size());
    evaluator_.evaluate(nodes_[k], setup_.q_held[k], kinematics_[k]);
  }
}

double TrajectoryProblem::cost(const Eigen::VectorXd& z) {
  update(z);
  double sum = tracking_.value(nodes_, setup_.reference) +
               motion_.value(nodes_, setup_.before_first, setup_.reference);
  for (const auto& [variable, weight] : slacks_) sum += 0.5 * weight * z[variable] * z[variable];
  return sum;
}

void TrajectoryProblem::gradient(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> gradient) {
  update(z);
  gradient.setZero();
  tracking_.add_gradient(nodes_, setup_.reference, gradient);
  motion_.add_gradient(nodes_, setup_.before_first, setup_.reference, gradient);
  for (const auto& [variable, weight] : slacks_) gradient[variable] = weight * z[variable];
}

void TrajectoryProblem::rows(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> values) {
  update(z);
  BlockJacobian from, to;
  for (const NodeBlock& block : node_blocks_) {
    const int n = block.constraint->num_rows();
    from.resize(n, setup_.layout.node_size());
    block.constraint->evaluate(kinematics_[block.node], values.segment(block.row, n), from);
    if (block.slack < 0) continue;
    for (int r = 0; r < n; ++r) {
      values[block.row + r] += z[block.slack + (block.one_sided ? 0 : r)];
    }
  }
  for (const IntervalBlock& block : interval_blocks_) {
    const int n = block.constraint->num_rows();
    from.resize(n, setup_.layout.node_size());
    to.resize(n, setup_.layout.node_size());
    block.constraint->evaluate(kinematics_[block.from], kinematics_[block.from + 1],
                               values.segment(block.row, n), from, to);
  }
}

void TrajectoryProblem::jacobian(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> values) {
  update(z);
  Eigen::Index next = 0;
  const auto add_block = [&](const BlockPattern& pattern, const BlockJacobian& block, int node) {
    if (node == 0) return;
    for (int r = 0; r < pattern.rows(); ++r) {
      for (int c = 0; c < pattern.cols(); ++c) {
        if (pattern(r, c)) values[next++] = block(r, c);
      }
    }
  };
  BlockJacobian from, to;
  RowValues ignored;
  for (const NodeBlock& block : node_blocks_) {
    const int n = block.constraint->num_rows();
    from.resize(n, setup_.layout.node_size());
    ignored.resize(n);
    block.constraint->evaluate(kinematics_[block.node], ignored, from);
    add_block(block.pattern, from, block.node);
    if (block.slack < 0) continue;
    for (int r = 0; r < n; ++r) values[next++] = 1.0;
  }
  for (const IntervalBlock& block : interval_blocks_) {
    const int n = block.constraint->num_rows();
    from.resize(n, setup_.layout.node_size());
    to.resize(n, setup_.layout.node_size());
    ignored.resize(n);
    block.constraint->evaluate(kinematics_[block.from], kinematics_[block.from + 1], ignored, from,
                               to);
    add_block(block.pattern, from, block.from);
    add_block(block.pattern, to, block.from + 1);
  }
}

Eigen::VectorXd TrajectoryProblem::pack(const std::vector<NodeVector>& nodes) const {
  WEX_EXPECTS(static_cast<int>(nodes.size()) == setup_.layout.num_nodes + 1);
  Eigen::VectorXd z = Eigen::VectorXd::Zero(num_variables_);
  for (int k = 1; k <= setup_.layout.num_nodes; ++k) {
    z.segment(setup_.layout.node_offset(k), setup_.layout.node_size()) = nodes[k];
  }
  return z;
}

std::vector<NodeVector> TrajectoryProblem::unpack(const Eigen::VectorXd& z) const {
  std::vector<NodeVector> nodes{setup_.reference[0]};
  for (int k = 1; k <= setup_.layout.num_nodes; ++k) {
    nodes.emplace_back(z.segment(setup_.layout.node_offset(k), setup_.layout.node_size()));
  }
  return nodes;
}

std::map<std::string, double> TrajectoryProblem::worst_violation(
    const std::vector<NodeVector>& nodes, int first_node) {
  const Eigen::VectorXd z = pack(nodes);
  Eigen::VectorXd values(num_rows_);
  rows(z, values);
  std::map<std::string, double> worst;
  const auto record = [&](std::string_view name, int row, int num_rows) {
    double& entry = worst[std::string(name)];
    for (int r = row; r < row + num_rows; ++r) {
      entry = std::max(entry, violation(values[r], row_lower_[r], row_upper_[r]));
    }
  };
  for (const NodeBlock& block : node_blocks_) {
    if (block.node < first_node) continue;
    record(block.constraint->name(), block.row, block.constraint->num_rows());
  }
  for (const IntervalBlock& block : interval_blocks_) {
    if (block.from + 1 < first_node) continue;
    record(block.constraint->name(), block.row, block.constraint->num_rows());
  }
  double& bounds = worst["variable_bounds"];
  for (int i = (first_node - 1) * setup_.layout.node_size(); i < setup_.layout.num_node_variables();
       ++i) {
    bounds = std::max(bounds, violation(z[i], lower_[i], upper_[i]));
  }
  return worst;
}

}  // namespace wex
