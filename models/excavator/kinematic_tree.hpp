#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "models/types/pose.hpp"

namespace wex {

/// Exact chain kinematics of a floating-base tree of one-axis joints, in generalized coordinates
/// q = [x, y, z, yaw, pitch, roll, actuated joints]. The base is a chain of six such joints, so
/// every formula below is the geometric Jacobian of a serial chain and its derivative:
///   dp/dq_i = a_i x (p - o_i)  (revolute),  a_i  (prismatic),
///   d2p/dq_i dq_j = a_i x dp/dq_j  for i at or above j  (zero for a prismatic i).
/// A mimic joint has coordinate and multiplier of the joint it follows; a fixed (locked passive)
/// joint has coordinate -1. Immutable after building; all queries are const, noexcept,
/// allocation-free, and safe to call concurrently with one Workspace per thread.
class KinematicTree {
 public:
  struct Body {
    std::string name;
    std::string joint_name;  ///< of the joint that carries the body, empty for the base
    int parent = -1;         ///< body index, -1 for the base
    Eigen::Isometry3d T_parent_joint = Eigen::Isometry3d::Identity();
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< in the joint frame
    bool prismatic = false;
    int coordinate = -1;  ///< index into q, -1 if locked
    double multiplier = 1.0;
    double offset = 0.0;  ///< joint value = offset + multiplier * q[coordinate]
    double mass_kg = 0.0;
    Eigen::Vector3d p_body_com = Eigen::Vector3d::Zero();
    Eigen::Matrix3d inertia_kg_m2 = Eigen::Matrix3d::Zero();  ///< about the CoM, body axes
  };

  /// Joint poses of one configuration. Sized by make_workspace, then reused without allocation.
  struct Workspace {
    std::vector<Eigen::Isometry3d> T_world_body;
    std::vector<Eigen::Vector3d> axis_world, p_world_joint;
    std::vector<double> subtree_mass_kg;
    std::vector<Eigen::Vector3d> subtree_mass_times_com;  ///< kg m
    std::array<Eigen::Vector3d, kNumBaseCoordinates> base_axis_world;
    Eigen::Vector3d p_world_base;
  };

  KinematicTree() = default;
  /// bodies[0] is the base (parent -1, its joint fields unused); parents precede children
  /// (contract).
  KinematicTree(std::vector<Body> bodies, int num_coordinates);

  [[nodiscard]] const std::vector<Body>& bodies() const noexcept { return bodies_; }
  /// Whether `body` is carried by `ancestor`; not true of a body and itself.
  [[nodiscard]] bool descends_from(int body, int ancestor) const noexcept {
    do {
      body = bodies_[static_cast<std::size_t>(body)].parent;
    } while (body >= 0 && body != ancestor);
    return body == ancestor;
  }
  [[nodiscard]] int num_coordinates() const noexcept { return num_coordinates_; }
  [[nodiscard]] double total_mass_kg() const noexcept { return total_mass_kg_; }
  [[nodiscard]] int body_index(const std::string& name) const;  ///< -1 if there is none
  [[nodiscard]] Workspace make_workspace() const;

  /// Forward pass; q has num_coordinates entries.
  void update(const Eigen::Ref<const Eigen::VectorXd>& q, Workspace& w) const noexcept;

  /// World position of a point fixed in a body, and d/dq of it (3 x num_coordinates, overwritten).
  [[nodiscard]] Eigen::Vector3d position(const Workspace& w, int body,
                                         const Eigen::Vector3d& p_body) const noexcept;
  void position_jacobian(const Workspace& w, int body, const Eigen::Vector3d& p_body,
                         Eigen::Ref<Eigen::Matrix3Xd> jacobian) const noexcept;
  /// Second derivatives contracted with weights: H_ij = weights . d2p/dq_i dq_j (n x n,
  /// overwritten).
  void position_hessian(const Workspace& w, int body, const Eigen::Vector3d& p_body,
                        const Eigen::Vector3d& weights,
                        Eigen::Ref<Eigen::MatrixXd> hessian) const noexcept;

  /// World direction of a vector fixed in a body, its Jacobian and contracted second derivatives.
  [[nodiscard]] Eigen::Vector3d direction(const Workspace& w, int body,
                                          const Eigen::Vector3d& d_body) const noexcept;
  void direction_jacobian(const Workspace& w, int body, const Eigen::Vector3d& d_body,
                          Eigen::Ref<Eigen::Matrix3Xd> jacobian) const noexcept;
  void direction_hessian(const Workspace& w, int body, const Eigen::Vector3d& d_body,
                         const Eigen::Vector3d& weights,
                         Eigen::Ref<Eigen::MatrixXd> hessian) const noexcept;

  /// Centre of mass of the whole machine in the world frame, and its derivatives.
  [[nodiscard]] Eigen::Vector3d com(const Workspace& w) const noexcept;
  void com_jacobian(const Workspace& w, Eigen::Ref<Eigen::Matrix3Xd> jacobian) const noexcept;
  void com_hessian(const Workspace& w, const Eigen::Vector3d& weights,
                   Eigen::Ref<Eigen::MatrixXd> hessian) const noexcept;

 private:
  // Columns of the CoM Jacobian, one per chain joint (before mimic multipliers).
  Eigen::Vector3d base_com_column(const Workspace& w, int coordinate) const noexcept;
  Eigen::Vector3d joint_com_column(const Workspace& w, int body) const noexcept;
  // Each adds weights . (a_i x column_j) for the pairs of chain joints it is named after.
  template <typename BaseColumn>
  void add_base_hessian(const Workspace& w, const Eigen::Vector3d& weights,
                        const BaseColumn& base_column,
                        Eigen::Ref<Eigen::MatrixXd> hessian) const noexcept;
  void add_joint_hessian(const Workspace& w, const std::vector<int>& chain,
                         std::size_t position_in_chain, const Eigen::Vector3d& weights,
                         const Eigen::Vector3d& column,
                         Eigen::Ref<Eigen::MatrixXd> hessian) const noexcept;
  template <typename BaseColumn, typename JointColumn>
  void add_chain_hessian(const Workspace& w, const std::vector<int>& chain,
                         const Eigen::Vector3d& weights, const BaseColumn& base_column,
                         const JointColumn& joint_column,
                         Eigen::Ref<Eigen::MatrixXd> hessian) const noexcept;

  std::vector<Body> bodies_;
  std::vector<std::vector<int>> moving_ancestors_;  ///< per body, root first, itself included
  std::vector<double> subtree_mass_kg_;
  int num_coordinates_ = 0;
  double total_mass_kg_ = 0.0;
};

}  // namespace wex
