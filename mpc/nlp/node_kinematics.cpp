#include "mpc/nlp/node_kinematics.hpp"

#include <cmath>

namespace wex {

NodeKinematicsEvaluator::NodeKinematicsEvaluator(const MachineModel& machine,
                                                 const NlpLayout& layout)
    : machine_(&machine),
      layout_(&layout),
      workspace_(machine.tree.make_workspace()),
      q_(machine.num_coordinates()),
      full_jacobian_(3, machine.num_coordinates()) {}

void NodeKinematicsEvaluator::gather(NodeJacobian3& out) const {
  out.resize(3, layout_->node_size());
  for (int i = 0; i < layout_->node_size(); ++i) {
    out.col(i) = full_jacobian_.col(layout_->coordinates[i]);
  }
}

void NodeKinematicsEvaluator::evaluate(const Eigen::Ref<const NodeVector>& x,
                                       const Eigen::VectorXd& q_held, NodeKinematics& out) {
  q_ = q_held;
  layout_->scatter(x, q_);
  out.x = x;
  const KinematicTree& tree = machine_->tree;
  tree.update(q_, workspace_);
  for (int w = 0; w < kNumWheels; ++w) {
    const WheeledLeg& leg = machine_->legs[w];
    out.p_world_wheel[w] = tree.position(workspace_, leg.carrier_body, leg.p_carrier_wheel);
    tree.position_jacobian(workspace_, leg.carrier_body, leg.p_carrier_wheel, full_jacobian_);
    gather(out.J_wheel[w]);
    out.axle_world[w] = tree.direction(workspace_, leg.carrier_body, leg.axle_carrier);
    tree.direction_jacobian(workspace_, leg.carrier_body, leg.axle_carrier, full_jacobian_);
    gather(out.J_axle[w]);

    // Lowest point of the disc: centre - r (z - (z.a) a) / |.|, in xy.
    const Eigen::Vector3d& a = out.axle_world[w];
    const double s2 = 1.0 - a.z() * a.z();
    const double k = leg.radius_m * a.z() / std::sqrt(s2);
    const double dk = leg.radius_m / (s2 * std::sqrt(s2));
    out.p_world_contact_xy[w] = out.p_world_wheel[w].head<2>() + k * a.head<2>();
    out.J_contact[w] = out.J_wheel[w];
    out.J_contact[w].topRows<2>() +=
        k * out.J_axle[w].topRows<2>() + dk * a.head<2>() * out.J_axle[w].row(2);
  }
  out.p_world_com = tree.com(workspace_);
  tree.com_jacobian(workspace_, full_jacobian_);
  gather(out.J_com);
}

}  // namespace wex
