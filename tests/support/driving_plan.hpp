#pragma once

#include <cmath>

#include "models/excavator/machine_model.hpp"
#include "models/terrain/terrain_map.hpp"
#include "models/types/plan.hpp"

namespace wex::test {

/// Moves hip flexion until every wheel centre is one radius above the tyre-dilated ground.
inline void put_wheels_on_ground(const TerrainMap& terrain, const MachineModel& machine,
                                 Eigen::VectorXd& q) {
  KinematicTree::Workspace workspace = machine.tree.make_workspace();
  Eigen::Matrix3Xd jacobian(3, machine.num_coordinates());
  for (int iteration = 0; iteration < 10; ++iteration) {
    machine.tree.update(q, workspace);
    Eigen::VectorXd step = Eigen::VectorXd::Zero(q.size());
    for (const WheeledLeg& leg : machine.legs) {
      const Eigen::Vector3d p =
          machine.tree.position(workspace, leg.carrier_body, leg.p_carrier_wheel);
      machine.tree.position_jacobian(workspace, leg.carrier_body, leg.p_carrier_wheel, jacobian);
      const double gap_m = p.z() - terrain.dilated_surface(p.head<2>()).value - leg.radius_m;
      step[leg.hfe] = -gap_m / jacobian(2, leg.hfe);
    }
    q += step;
  }
}

/// A coarse driving plan along a circular arc: wheels straight and on the ground, base level above
/// the filtered ground, constant speed. A guide for the optimizers, wrong in what they must mend.
inline Plan arc_plan(const TerrainMap& terrain, const MachineModel& machine, const Pose2& start,
                     double length_m, double curvature_1_m, double speed_m_s = 0.5) {
  Plan plan;
  const int num_steps = static_cast<int>(std::ceil(length_m / 0.2));
  for (int i = 0; i <= num_steps; ++i) {
    const double s = length_m * i / num_steps;
    const double heading = start.yaw_rad + curvature_1_m * s;
    const double chord = start.yaw_rad + 0.5 * curvature_1_m * s;
    const double half_turn = 0.5 * curvature_1_m * s;
    const double reach = std::abs(half_turn) < 1e-9 ? s : s * std::sin(half_turn) / half_turn;
    WholeBodyNode node;
    node.t_s = s / speed_m_s;
    node.q = Eigen::VectorXd::Zero(machine.num_coordinates());
    node.q.tail(machine.num_joints()) = machine.transport_posture();
    node.q[kBaseX] = start.x_m + reach * std::cos(chord);
    node.q[kBaseY] = start.y_m + reach * std::sin(chord);
    node.q[kBaseYaw] = heading;
    node.q[kBaseZ] = terrain.filtered_height_m(node.q.head<2>()) + machine.default_base_height_m;
    put_wheels_on_ground(terrain, machine, node.q);
    plan.nodes.push_back(node);
  }
  const WholeBodyNode& last = plan.nodes.back();
  plan.task = {start, {last.q[kBaseX], last.q[kBaseY], last.q[kBaseYaw]}};
  return plan;
}

/// Gently rolling ground, smooth enough for finite differences.
inline TerrainMap rolling_ground(double amplitude_m, int size_x = 300, int size_y = 160) {
  Grid grid;
  grid.size_x = size_x;
  grid.size_y = size_y;
  grid.cell_m = 0.1;
  grid.origin_m = {-5.0, -8.0};
  grid.values.resize(static_cast<std::size_t>(size_x) * size_y);
  for (int j = 0; j < size_y; ++j) {
    for (int i = 0; i < size_x; ++i) {
      const double x = grid.origin_m.x() + 0.1 * i, y = grid.origin_m.y() + 0.1 * j;
      grid.at(i, j) = static_cast<float>(amplitude_m * std::sin(0.9 * x) * std::cos(0.7 * y + 0.3));
    }
  }
  return TerrainMap::build(std::move(grid)).value();
}

}  // namespace wex::test
