#include "mpc/nlp/whole_body_trajectory.hpp"

#include <Eigen/Geometry>

namespace wex {

std::vector<WholeBodyNode> whole_body_nodes(const TrajectorySetup& setup,
                                            const std::vector<NodeVector>& nodes,
                                            double first_time_s) {
  const MachineModel& machine = *setup.machine;
  std::vector<WholeBodyNode> result;
  KinematicTree::Workspace workspace = machine.tree.make_workspace();
  std::array<Eigen::Vector3d, kNumWheels> p_previous, axle_previous;
  std::array<Eigen::Matrix3d, kNumWheels> R_previous;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    WholeBodyNode node;
    node.t_s = first_time_s + static_cast<double>(k) * setup.dt_s;
    node.q = setup.q_held[k];
    setup.layout.scatter(nodes[k], node.q);
    machine.tree.update(node.q, workspace);
    for (int w = 0; w < kNumWheels; ++w) {
      const WheeledLeg& leg = machine.legs[w];
      const Eigen::Vector3d p =
          machine.tree.position(workspace, leg.carrier_body, leg.p_carrier_wheel);
      const Eigen::Vector3d axle =
          machine.tree.direction(workspace, leg.carrier_body, leg.axle_carrier);
      const Eigen::Matrix3d R = workspace.T_world_body[leg.carrier_body].linear();
      if (k > 0) {
        const Eigen::Vector3d mean_axle = (axle_previous[w] + axle).normalized();
        const Eigen::Vector3d step = p - p_previous[w];
        const Eigen::Vector3d rolled = step - step.dot(mean_axle) * mean_axle;
        const Eigen::Vector3d forward = mean_axle.cross(Eigen::Vector3d::UnitZ());
        const double travel = rolled.dot(forward) < 0.0 ? -rolled.norm() : rolled.norm();
        const Eigen::AngleAxisd carrier_turn(R * R_previous[w].transpose());
        const double carrier_angle = carrier_turn.angle() * carrier_turn.axis().dot(mean_axle);
        node.q[leg.wheel] =
            result.back().q[leg.wheel] + leg.wheel_sign * (travel / leg.radius_m - carrier_angle);
      }
      p_previous[w] = p;
      axle_previous[w] = axle;
      R_previous[w] = R;
    }
    result.push_back(std::move(node));
  }
  return result;
}

}  // namespace wex
