#pragma once

#include <array>

#include "mpc/nlp/nlp_layout.hpp"

namespace wex {

/// Everything the constraints need of one node, with exact Jacobians with respect to the node's
/// variables. World frame, SI units.
struct NodeKinematics {
  NodeVector x;                                           ///< the node's variables
  std::array<Eigen::Vector3d, kNumWheels> p_world_wheel;  ///< wheel centres
  std::array<NodeJacobian3, kNumWheels> J_wheel;
  std::array<Eigen::Vector3d, kNumWheels> axle_world;  ///< unit, to the machine's left
  std::array<NodeJacobian3, kNumWheels> J_axle;
  std::array<Eigen::Vector2d, kNumWheels>
      p_world_contact_xy;                           ///< touching point, disc on a level patch
  std::array<NodeJacobian3, kNumWheels> J_contact;  ///< rows 0, 1 used
  Eigen::Vector3d p_world_com;
  NodeJacobian3 J_com;
};

/// Evaluates NodeKinematics without allocation after construction. One per thread.
class NodeKinematicsEvaluator {
 public:
  NodeKinematicsEvaluator(const MachineModel& machine, const NlpLayout& layout);

  /// q_held: full q whose optimized part is overwritten by x.
  void evaluate(const Eigen::Ref<const NodeVector>& x, const Eigen::VectorXd& q_held,
                NodeKinematics& out);

 private:
  void gather(NodeJacobian3& out) const;

  const MachineModel* machine_;
  const NlpLayout* layout_;
  KinematicTree::Workspace workspace_;
  Eigen::VectorXd q_;
  Eigen::Matrix3Xd full_jacobian_;
};

}  // namespace wex
