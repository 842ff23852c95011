#include "tools/wex/trajectory_execution.hpp"

#include <algorithm>

namespace wex::app {
namespace {

/// Segment [k, k+1] that holds t_s; nullopt outside the trajectory.
std::optional<std::size_t> segment(const std::vector<WholeBodyNode>& nodes, double t_s) {
  if (nodes.size() < 2 || t_s < nodes.front().t_s || t_s >= nodes.back().t_s) return std::nullopt;
  const auto after =
      std::upper_bound(nodes.begin(), nodes.end(), t_s,
                       [](double t, const WholeBodyNode& node) { return t < node.t_s; });
  return static_cast<std::size_t>(after - nodes.begin()) - 1;
}

double rate_at(const std::vector<WholeBodyNode>& nodes, int coordinate, double t_s) {
  const auto k = segment(nodes, t_s);
  if (!k) return 0.0;
  const WholeBodyNode& a = nodes[*k];
  const WholeBodyNode& b = nodes[*k + 1];
  return (b.q[coordinate] - a.q[coordinate]) / (b.t_s - a.t_s);
}

bool rate_only(const MachineModel& machine, int joint) {
  if (machine.joints[joint].role == JointRole::kWheel) return true;
  return machine.arm && machine.arm->coordinates.front() == kNumBaseCoordinates + joint;
}

}  // namespace

Eigen::VectorXd coordinates(const MachineModel& machine, const MachineState& state) {
  WEX_EXPECTS(state.num_joints == machine.num_joints());
  Eigen::VectorXd q(machine.num_coordinates());
  q.head<kNumBaseCoordinates>() = state.base;
  q.tail(state.num_joints) =
      Eigen::Map<const Eigen::VectorXd>(state.position.data(), state.num_joints);
  return q;
}

Eigen::VectorXd rates(const std::vector<WholeBodyNode>& nodes, double t_s) {
  WEX_EXPECTS(!nodes.empty());
  const auto k = segment(nodes, t_s);
  if (!k) return Eigen::VectorXd::Zero(nodes.front().q.size());
  return (nodes[*k + 1].q - nodes[*k].q) / (nodes[*k + 1].t_s - nodes[*k].t_s);
}

JointCommand command_at(const MachineModel& machine, const std::vector<WholeBodyNode>& nodes,
                        double t_s, double valid_for_s) {
  WEX_EXPECTS(!nodes.empty());
  WEX_EXPECTS(machine.num_joints() <= kMaxJoints);
  JointCommand command;
  command.num_joints = machine.num_joints();
  command.valid_until_s = t_s + valid_for_s;
  const WholeBodyNode now = sample(nodes, t_s);
  for (int j = 0; j < machine.num_joints(); ++j) {
    const Joint& joint = machine.joints[j];
    const int coordinate = kNumBaseCoordinates + j;
    command.rate[j] = rate_at(nodes, coordinate, t_s + joint.dead_time_s + joint.lag_s);
    if (!rate_only(machine, j)) {
      command.position_target[j] = now.q[coordinate];
      command.has_position_target[j] = true;
    }
  }
  return command;
}

Eigen::VectorXd predict(const Eigen::VectorXd& q_measured, const std::vector<WholeBodyNode>& nodes,
                        double t_s, double delay_s) {
  if (nodes.empty()) return q_measured;
  const Eigen::VectorXd q_now = sample(nodes, t_s).q;
  Eigen::VectorXd increment = sample(nodes, t_s + delay_s).q - q_now;
  const Eigen::Rotation2Dd turn(wrap_angle(q_measured[kBaseYaw] - q_now[kBaseYaw]));
  const Eigen::Vector2d planar = turn * Eigen::Vector2d(increment.head<2>());
  increment.head<2>() = planar;
  return q_measured + increment;
}

}  // namespace wex::app
