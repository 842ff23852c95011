#include "models/excavator/kinematic_tree.hpp"

#include <exception>
#include <utility>

#include "models/types/result.hpp"

namespace wex {
namespace {

constexpr int kFirstBaseRotation = kBaseYaw;

// A broken size contract in a noexcept query ends the process.
void require(bool contract) noexcept {
  if (!contract) std::terminate();
}

Eigen::Matrix3d joint_rotation(const Eigen::Vector3d& axis, double angle_rad) {
  return Eigen::AngleAxisd(angle_rad, axis).toRotationMatrix();
}

}  // namespace

KinematicTree::KinematicTree(std::vector<Body> bodies, int num_coordinates)
    : bodies_(std::move(bodies)), num_coordinates_(num_coordinates) {
  WEX_EXPECTS(!bodies_.empty() && bodies_.front().parent == -1);
  WEX_EXPECTS(num_coordinates_ >= kNumBaseCoordinates);
  const int n = static_cast<int>(bodies_.size());
  moving_ancestors_.resize(n);
  subtree_mass_kg_.resize(n);
  for (int b = 0; b < n; ++b) {
    Body& body = bodies_[b];
    WEX_EXPECTS(b == 0 || (body.parent >= 0 && body.parent < b));
    WEX_EXPECTS(body.coordinate < num_coordinates_);
    subtree_mass_kg_[b] = body.mass_kg;
    total_mass_kg_ += body.mass_kg;
    if (b == 0) continue;
    body.axis.normalize();
    moving_ancestors_[b] = moving_ancestors_[body.parent];
    if (body.coordinate >= 0) {
      WEX_EXPECTS(body.coordinate >= kNumBaseCoordinates);
      moving_ancestors_[b].push_back(b);
    }
  }
  for (int b = n - 1; b > 0; --b) subtree_mass_kg_[bodies_[b].parent] += subtree_mass_kg_[b];
}

int KinematicTree::body_index(const std::string& name) const {
  for (int b = 0; b < static_cast<int>(bodies_.size()); ++b) {
    if (bodies_[b].name == name) return b;
  }
  return -1;
}

KinematicTree::Workspace KinematicTree::make_workspace() const {
  const std::size_t n = bodies_.size();
  Workspace w;
  w.T_world_body.assign(n, Eigen::Isometry3d::Identity());
  w.axis_world.assign(n, Eigen::Vector3d::Zero());
  w.p_world_joint.assign(n, Eigen::Vector3d::Zero());
  w.subtree_mass_kg = subtree_mass_kg_;
  w.subtree_mass_times_com.assign(n, Eigen::Vector3d::Zero());
  w.base_axis_world.fill(Eigen::Vector3d::Zero());
  w.p_world_base.setZero();
  return w;
}

void KinematicTree::update(const Eigen::Ref<const Eigen::VectorXd>& q,
                           Workspace& w) const noexcept {
  require(q.size() == num_coordinates_ && w.T_world_body.size() == bodies_.size());
  const BaseCoordinates base = q.head<kNumBaseCoordinates>();
  w.T_world_body[0] = T_world_base_from(base);
  w.p_world_base = base.head<3>();
  const double cos_yaw = std::cos(base[kBaseYaw]), sin_yaw = std::sin(base[kBaseYaw]);
  for (int i = kBaseX; i <= kBaseZ; ++i) w.base_axis_world[i] = Eigen::Vector3d::Unit(i);
  w.base_axis_world[kBaseYaw] = Eigen::Vector3d::UnitZ();
  w.base_axis_world[kBasePitch] = Eigen::Vector3d(-sin_yaw, cos_yaw, 0.0);
  w.base_axis_world[kBaseRoll] = w.T_world_body[0].linear().col(0);
  w.p_world_joint[0] = w.p_world_base;

  const int n = static_cast<int>(bodies_.size());
  for (int b = 1; b < n; ++b) {
    const Body& body = bodies_[b];
    const Eigen::Isometry3d& T_world_parent = w.T_world_body[body.parent];
    Eigen::Matrix3d R_world_joint = T_world_parent.linear() * body.T_parent_joint.linear();
    const Eigen::Vector3d p_world_joint =
        T_world_parent.linear() * body.T_parent_joint.translation() + T_world_parent.translation();
    const double value =
        body.offset + (body.coordinate >= 0 ? body.multiplier * q[body.coordinate] : 0.0);
    w.axis_world[b] = R_world_joint * body.axis;
    w.p_world_joint[b] = p_world_joint;
    if (body.prismatic) {
      w.T_world_body[b].linear() = R_world_joint;
      w.T_world_body[b].translation() = p_world_joint + value * w.axis_world[b];
    } else {
      if (value != 0.0) R_world_joint *= joint_rotation(body.axis, value);
      w.T_world_body[b].linear() = R_world_joint;
      w.T_world_body[b].translation() = p_world_joint;
    }
  }

  for (int b = 0; b < n; ++b) {
    const Eigen::Isometry3d& T = w.T_world_body[b];
    w.subtree_mass_times_com[b] =
        bodies_[b].mass_kg * (T.linear() * bodies_[b].p_body_com + T.translation());
  }
  for (int b = n - 1; b > 0; --b) {
    w.subtree_mass_times_com[bodies_[b].parent] += w.subtree_mass_times_com[b];
  }
}

Eigen::Vector3d KinematicTree::position(const Workspace& w, int body,
                                        const Eigen::Vector3d& p_body) const noexcept {
  return w.T_world_body[body].linear() * p_body + w.T_world_body[body].translation();
}

void KinematicTree::position_jacobian(const Workspace& w, int body, const Eigen::Vector3d& p_body,
                                      Eigen::Ref<Eigen::Matrix3Xd> jacobian) const noexcept {
  require(jacobian.cols() == num_coordinates_);
  const Eigen::Vector3d p = position(w, body, p_body);
  jacobian.setZero();
  jacobian.leftCols<3>().setIdentity();
  for (int i = kFirstBaseRotation; i < kNumBaseCoordinates; ++i) {
    jacobian.col(i) = w.base_axis_world[i].cross(p - w.p_world_base);
  }
  for (const int b : moving_ancestors_[body]) {
    const Body& joint = bodies_[b];
    if (joint.prismatic) {
      jacobian.col(joint.coordinate) += joint.multiplier * w.axis_world[b];
    } else {
      jacobian.col(joint.coordinate) +=
          joint.multiplier * w.axis_world[b].cross(p - w.p_world_joint[b]);
    }
  }
}

void KinematicTree::position_hessian(const Workspace& w, int body, const Eigen::Vector3d& p_body,
                                     const Eigen::Vector3d& weights,
                                     Eigen::Ref<Eigen::MatrixXd> hessian) const noexcept {
  require(hessian.rows() == num_coordinates_ && hessian.cols() == num_coordinates_);
  const Eigen::Vector3d p = position(w, body, p_body);
  hessian.setZero();
  add_chain_hessian(
      w, moving_ancestors_[body], weights,
      [&](int i) -> Eigen::Vector3d { return w.base_axis_world[i].cross(p - w.p_world_base); },
      [&](int b) -> Eigen::Vector3d {
        return bodies_[b].prismatic ? w.axis_world[b]
                                    : w.axis_world[b].cross(p - w.p_world_joint[b]);
      },
      hessian);
}

Eigen::Vector3d KinematicTree::direction(const Workspace& w, int body,
                                         const Eigen::Vector3d& d_body) const noexcept {
  return w.T_world_body[body].linear() * d_body;
}

void KinematicTree::direction_jacobian(const Workspace& w, int body, const Eigen::Vector3d& d_body,
                                       Eigen::Ref<Eigen::Matrix3Xd> jacobian) const noexcept {
  require(jacobian.cols() == num_coordinates_);
  const Eigen::Vector3d d = direction(w, body, d_body);
  jacobian.setZero();
  for (int i = kFirstBaseRotation; i < kNumBaseCoordinates; ++i) {
    jacobian.col(i) = w.base_axis_world[i].cross(d);
  }
  for (const int b : moving_ancestors_[body]) {
    const Body& joint = bodies_[b];
    if (joint.prismatic) continue;
    jacobian.col(joint.coordinate) += joint.multiplier * w.axis_world[b].cross(d);
  }
}

void KinematicTree::direction_hessian(const Workspace& w, int body, const Eigen::Vector3d& d_body,
                                      const Eigen::Vector3d& weights,
                                      Eigen::Ref<Eigen::MatrixXd> hessian) const noexcept {
  require(hessian.rows() == num_coordinates_ && hessian.cols() == num_coordinates_);
  const Eigen::Vector3d d = direction(w, body, d_body);
  hessian.setZero();
  add_chain_hessian(
      w, moving_ancestors_[body], weights,
      [&](int i) -> Eigen::Vector3d { return w.base_axis_world[i].cross(d); },
      [&](int b) -> Eigen::Vector3d {
        if (bodies_[b].prismatic) return Eigen::Vector3d::Zero();
        return w.axis_world[b].cross(d);
      },
      hessian);
}

Eigen::Vector3d KinematicTree::com(const Workspace& w) const noexcept {
  return w.subtree_mass_times_com[0] / total_mass_kg_;
}

Eigen::Vector3d KinematicTree::base_com_column(const Workspace& w, int coordinate) const noexcept {
  return w.base_axis_world[coordinate].cross(com(w) - w.p_world_base);
}

Eigen::Vector3d KinematicTree::joint_com_column(const Workspace& w, int body) const noexcept {
  const double subtree_mass = subtree_mass_kg_[body];
  if (bodies_[body].prismatic) return (subtree_mass / total_mass_kg_) * w.axis_world[body];
  const Eigen::Vector3d lever =
      (w.subtree_mass_times_com[body] - subtree_mass * w.p_world_joint[body]) / total_mass_kg_;
  return w.axis_world[body].cross(lever);
}

void KinematicTree::com_jacobian(const Workspace& w,
                                 Eigen::Ref<Eigen::Matrix3Xd> jacobian) const noexcept {
  require(jacobian.cols() == num_coordinates_);
  jacobian.setZero();
  jacobian.leftCols<3>().setIdentity();
  for (int i = kFirstBaseRotation; i < kNumBaseCoordinates; ++i) {
    jacobian.col(i) = base_com_column(w, i);
  }
  for (int b = 1; b < static_cast<int>(bodies_.size()); ++b) {
    if (bodies_[b].coordinate < 0) continue;
    jacobian.col(bodies_[b].coordinate) += bodies_[b].multiplier * joint_com_column(w, b);
  }
}

void KinematicTree::com_hessian(const Workspace& w, const Eigen::Vector3d& weights,
                                Eigen::Ref<Eigen::MatrixXd> hessian) const noexcept {
  require(hessian.rows() == num_coordinates_ && hessian.cols() == num_coordinates_);
  hessian.setZero();
  const auto base_column = [&](int i) { return base_com_column(w, i); };
  add_base_hessian(w, weights, base_column, hessian);
  // A joint moves only its subtree, so pairs exist along each chain; every joint closes its own.
  for (int b = 1; b < static_cast<int>(bodies_.size()); ++b) {
    if (bodies_[b].coordinate < 0) continue;
    add_joint_hessian(w, moving_ancestors_[b], moving_ancestors_[b].size() - 1, weights,
                      joint_com_column(w, b), hessian);
  }
}

template <typename BaseColumn>
void KinematicTree::add_base_hessian(const Workspace& w, const Eigen::Vector3d& weights,
                                     const BaseColumn& base_column,
                                     Eigen::Ref<Eigen::MatrixXd> hessian) const noexcept {
  for (int j = kFirstBaseRotation; j < kNumBaseCoordinates; ++j) {
    const Eigen::Vector3d column = base_column(j);
    for (int i = kFirstBaseRotation; i <= j; ++i) {
      const double value = weights.cross(w.base_axis_world[i]).dot(column);
      hessian(i, j) += value;
      if (i != j) hessian(j, i) += value;
    }
  }
}

void KinematicTree::add_joint_hessian(const Workspace& w, const std::vector<int>& chain,
                                      std::size_t position_in_chain, const Eigen::Vector3d& weights,
                                      const Eigen::Vector3d& column,
                                      Eigen::Ref<Eigen::MatrixXd> hessian) const noexcept {
  const Body& lower = bodies_[chain[position_in_chain]];
  const Eigen::Vector3d scaled_column = lower.multiplier * column;
  // weights . (a_i x c_j) = a_i . (c_j x weights)
  const Eigen::Vector3d torque = scaled_column.cross(weights);
  for (int i = kFirstBaseRotation; i < kNumBaseCoordinates; ++i) {
    const double value = w.base_axis_world[i].dot(torque);
    hessian(i, lower.coordinate) += value;
    hessian(lower.coordinate, i) += value;
  }
  for (std::size_t k = 0; k <= position_in_chain; ++k) {
    const Body& upper = bodies_[chain[k]];
    if (upper.prismatic) continue;
    const double value = upper.multiplier * w.axis_world[chain[k]].dot(torque);
    hessian(upper.coordinate, lower.coordinate) += value;
    // Two joints of one coordinate (mimic) meet on the diagonal and count there in both orders.
    if (k != position_in_chain) hessian(lower.coordinate, upper.coordinate) += value;
  }
}

template <typename BaseColumn, typename JointColumn>
void KinematicTree::add_chain_hessian(const Workspace& w, const std::vector<int>& chain,
                                      const Eigen::Vector3d& weights, const BaseColumn& base_column,
                                      const JointColumn& joint_column,
                                      Eigen::Ref<Eigen::MatrixXd> hessian) const noexcept {
  add_base_hessian(w, weights, base_column, hessian);
  for (std::size_t k = 0; k < chain.size(); ++k) {
    add_joint_hessian(w, chain, k, weights, joint_column(chain[k]), hessian);
  }
}

}  // namespace wex
