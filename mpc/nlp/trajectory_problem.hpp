#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "mpc/nlp/constraint.hpp"
#include "mpc/nlp/motion_cost.hpp"
#include "mpc/nlp/tracking_cost.hpp"

namespace wex {

/// How a node constraint may be violated, at a price: 1/2 weight * slack^2.
struct Softness {
  double weight = 0.0;     ///< 0: hard
  int last_soft_node = 0;  ///< nodes 1..this are soft, the others hard
  bool one_sided =
      false;  ///< one slack >= 0 per node, shared by the rows (inequalities from below)
};

/// Everything that defines one trajectory optimization over nodes 1..num_nodes; node 0 is data.
struct TrajectorySetup {
  const MachineModel* machine = nullptr;
  NlpLayout layout;
  double dt_s = 0.25;
  NodeVector before_first;              ///< x_-1, gives the start velocity
  std::vector<NodeVector> reference;    ///< node 0 (the start state) .. num_nodes
  std::vector<Eigen::VectorXd> q_held;  ///< full q per node for what is not optimized
  double max_tilt_rad = 0.35;
  double joint_margin_rad = 0.0;  ///< kept from each end stop
  bool fix_goal = false;          ///< x, y, yaw of the last node as in the reference
  bool end_at_rest = false;
  CoordinateWeights tracking, rates, accelerations;
  double tracking_tail_s = 0.0;  ///< the last node's deviation counts for so much longer
  std::vector<std::pair<std::shared_ptr<const NodeConstraint>, Softness>> node_constraints;
  std::vector<std::shared_ptr<const IntervalConstraint>> interval_constraints;
};

/// The sparse nonlinear program of a TrajectorySetup with exact first derivatives and the
/// Gauss-Newton Hessian (that of the quadratic cost, constant). Not thread-safe.
class TrajectoryProblem {
 public:
  explicit TrajectoryProblem(TrajectorySetup setup);

  [[nodiscard]] int num_variables() const { return num_variables_; }
  [[nodiscard]] int num_rows() const { return num_rows_; }
  [[nodiscard]] const Eigen::VectorXd& lower() const { return lower_; }
  [[nodiscard]] const Eigen::VectorXd& upper() const { return upper_; }
  [[nodiscard]] const Eigen::VectorXd& row_lower() const { return row_lower_; }
  [[nodiscard]] const Eigen::VectorXd& row_upper() const { return row_upper_; }
  [[nodiscard]] const std::vector<int>& jacobian_rows() const { return jacobian_rows_; }
  [[nodiscard]] const std::vector<int>& jacobian_columns() const { return jacobian_columns_; }
  [[nodiscard]] const std::vector<int>& hessian_rows() const { return hessian_rows_; }
  [[nodiscard]] const std::vector<int>& hessian_columns() const { return hessian_columns_; }
  [[nodiscard]] const std::vector<double>& hessian_values() const { return hessian_values_; }

  [[nodiscard]] double cost(const Eigen::VectorXd& z);
  void gradient(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> gradient);
  void rows(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> values);
  void jacobian(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> values);

  /// Decision vector for given nodes (0..num_nodes), slacks zero; and the nodes of a decision
  /// vector.
  [[nodiscard]] Eigen::VectorXd pack(const std::vector<NodeVector>& nodes) const;
  [[nodiscard]] std::vector<NodeVector> unpack(const Eigen::VectorXd& z) const;

  /// Worst violation per constraint name over nodes first..num_nodes, slacks not counted (true
  /// rows).
  [[nodiscard]] std::map<std::string, double> worst_violation(const std::vector<NodeVector>& nodes,
                                                              int first_node = 1);
  /// Kinematics of the nodes last evaluated with rows(), jacobian() or worst_violation().
  [[nodiscard]] const std::vector<NodeKinematics>& kinematics() const { return kinematics_; }
  [[nodiscard]] const TrajectorySetup& setup() const { return setup_; }

 private:
  struct NodeBlock {  // one constraint at one node
    const NodeConstraint* constraint;
    BlockPattern pattern;
    int node, row, slack;  // first slack variable, -1 if hard
    bool one_sided;
  };
  struct IntervalBlock {
    const IntervalConstraint* constraint;
    BlockPattern pattern;
    int from, row;
  };
  void build_bounds();
  void build_jacobian_structure();
  void build_hessian();
  void update(const Eigen::VectorXd& z);  // nodes and kinematics, if z is new

  TrajectorySetup setup_;
  TrackingCost tracking_;
  MotionCost motion_;
  std::vector<NodeBlock> node_blocks_;
  std::vector<IntervalBlock> interval_blocks_;
  std::vector<std::pair<int, double>> slacks_;  // variable, weight
  int num_variables_ = 0, num_rows_ = 0;
  Eigen::VectorXd lower_, upper_, row_lower_, row_upper_;
  std::vector<int> jacobian_rows_, jacobian_columns_, hessian_rows_, hessian_columns_;
  std::vector<double> hessian_values_;
  Eigen::VectorXd evaluated_at_;
  std::vector<NodeVector> nodes_;
  std::vector<NodeKinematics> kinematics_;
  NodeKinematicsEvaluator evaluator_;
};

}  // namespace wex
