#pragma once

#include "initializer/paper/paper_check.hpp"
#include "tests/initializer/test_worlds.hpp"

namespace wex {

/// Smaller than usual, so that tests need not wait for them.
inline const Roadmaps& test_roadmaps() {
  static const Roadmaps roadmaps = [] {
    RoadmapSettings settings;
    settings.arm_vertices = 1200;
    return build_roadmaps(test_machine(), CollisionModel::build(test_machine()), settings);
  }();
  return roadmaps;
}

inline PaperCheck paper_check(const TerrainMap& terrain, const PlanSettings& settings = {},
                              const Roadmaps& roadmaps = test_roadmaps()) {
  auto check = PaperCheck::build(terrain, test_machine(), roadmaps, settings);
  if (!check) throw std::runtime_error(check.error().message);
  return *std::move(check);
}

/// Level base at its default height above ground at zero.
inline BaseCoordinates level_base(const Pose2& pose) {
  BaseCoordinates base;
  base << pose.x_m, pose.y_m, test_machine().default_base_height_m, pose.yaw_rad, 0.0, 0.0;
  return base;
}

/// Where a wheel of the default posture is, level at the origin.
inline Eigen::Vector2d default_wheel(Limb limb) {
  const MachineModel& machine = test_machine();
  Eigen::VectorXd q = Eigen::VectorXd::Zero(machine.num_coordinates());
  q.tail(machine.num_joints()) = machine.default_posture();
  KinematicTree::Workspace w = machine.tree.make_workspace();
  machine.tree.update(q, w);
  const WheeledLeg& leg = machine.legs[static_cast<std::size_t>(limb)];
  return machine.tree.position(w, leg.carrier_body, leg.p_carrier_wheel).head<2>();
}

}  // namespace wex
