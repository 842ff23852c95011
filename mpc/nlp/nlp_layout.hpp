#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/excavator/machine_model.hpp"

namespace wex {

/// Upper bound of optimized coordinates per node, so that node-sized matrices live on the stack.
inline constexpr int kMaxNodeVariables = 32;

using NodeVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxNodeVariables, 1>;
using NodeJacobian3 = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, kMaxNodeVariables>;

/// Where everything stands in the decision vector; written once, here.
/// A node's variables are the optimized part of q: base, then HAA, HFE, STEER of each leg. The
/// other coordinates (arm, claws) follow the reference; wheel spin follows from travel afterwards.
/// Node 0 is data, not a variable: variables are nodes 1..num_nodes, then the slacks.
struct NlpLayout {
  std::vector<int> coordinates;    ///< node variable -> coordinate of q
  std::vector<int> node_variable;  ///< coordinate of q -> node variable, -1 if not optimized
  int num_nodes = 0;               ///< nodes that are variables

  [[nodiscard]] int node_size() const { return static_cast<int>(coordinates.size()); }
  /// First variable of node k in 1..num_nodes.
  [[nodiscard]] int node_offset(int k) const { return (k - 1) * node_size(); }
  [[nodiscard]] int num_node_variables() const { return num_nodes * node_size(); }
  /// Optimized part of a full q, and back into it.
  [[nodiscard]] NodeVector gather(const Eigen::VectorXd& q) const;
  void scatter(const Eigen::Ref<const NodeVector>& x, Eigen::VectorXd& q) const;
  /// Node variables of one leg's joints (HAA, HFE, STEER that exist).
  [[nodiscard]] std::vector<int> leg_variables(const WheeledLeg& leg) const;
};

/// Layout for driving: base and the legs' joints.
[[nodiscard]] NlpLayout make_driving_layout(const MachineModel& machine, int num_nodes);

}  // namespace wex
