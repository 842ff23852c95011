#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "initializer/paper/paper_check.hpp"
#include "initializer/stepping/arm_kinematics.hpp"
#include "tests/initializer/test_worlds.hpp"

namespace wex {

/// Built once a process.
inline const Roadmaps& test_roadmaps() {
  static const Roadmaps roadmaps =
      build_roadmaps(test_machine(), CollisionModel::build(test_machine()));
  return roadmaps;
}

/// The roadmaps with the arm in default posture alone.
inline Roadmaps only_default_arm() {
  Roadmaps maps = test_roadmaps();
  LimbRoadmap& arm = maps.limbs.back();
  arm.q.conservativeResize(Eigen::NoChange, 1);
  arm.p_base_contact.conservativeResize(Eigen::NoChange, 1);
  arm.moment_base.conservativeResize(Eigen::NoChange, 1);
  arm.edges.clear();
  arm.neighbours.clear();
  arm.joint_neighbours.clear();
  arm.first_edge.assign(2, 0);
  arm.first_joint_neighbour.assign(2, 0);
  return maps;
}

/// Vertices of the arm more, without edges: the bucket on the ground of the default stance at these
/// places of the base frame.
inline Roadmaps with_bucket_at(Roadmaps maps, const std::vector<Eigen::Vector2d>& places) {
  const auto arm = ArmKinematics::build(test_machine());
  if (!arm) throw std::runtime_error(arm.error().message);
  LimbRoadmap& map = maps.limbs.back();
  Eigen::Index i = map.num_vertices();
  const auto count = i + static_cast<Eigen::Index>(places.size());
  map.q.conservativeResize(Eigen::NoChange, count);
  map.p_base_contact.conservativeResize(Eigen::NoChange, count);
  map.moment_base.conservativeResize(Eigen::NoChange, count);
  map.first_edge.resize(static_cast<std::size_t>(count) + 1, map.first_edge.back());
  map.first_joint_neighbour.resize(static_cast<std::size_t>(count) + 1,
                                   map.first_joint_neighbour.back());
  for (const Eigen::Vector2d& place : places) {
    std::optional<ArmPosture> posture;
    for (double tele_m = 0.0; !posture && tele_m < 1.7; tele_m += 0.1) {
      posture =
          arm->reach({place.x(), place.y(), -test_machine().default_base_height_m}, tele_m, 0.35);
    }
    if (!posture) throw std::runtime_error("the bucket does not reach a place of the test");
    const ArmKinematics::Joints joints = ArmKinematics::joints_of(*posture);
    for (std::size_t k = 0; k < joints.size(); ++k) {
      map.q(static_cast<Eigen::Index>(k), i) = joints[k];
    }
    map.p_base_contact.col(i) = arm->shape(*posture).p_base_contact;
    map.moment_base.col(i) = arm->moment_base(*posture);
    ++i;
  }
  return maps;
}

/// Legs that only go up and down, hips and steering in default posture: left and right alike.
inline Roadmaps with_plain_legs(Roadmaps maps) {
  constexpr Eigen::Index kCount = 80;
  const MachineModel& machine = test_machine();
  KinematicTree::Workspace w = machine.tree.make_workspace();
  for (std::size_t leg = 0; leg < kNumWheels; ++leg) {
    LimbRoadmap& map = maps.limbs[leg];
    const int hfe = machine.legs[leg].hfe;
    const Joint& joint = machine.joints[static_cast<std::size_t>(hfe - kNumBaseCoordinates)];
    Eigen::VectorXd q = Eigen::VectorXd::Zero(machine.num_coordinates());
    q.tail(machine.num_joints()) = machine.default_posture();
    machine.tree.update(q, w);
    const double default_rad = q[hfe];
    const Eigen::Vector3d default_com = machine.tree.com(w), moment_base = map.moment_base.col(0);
    std::vector<double> hfe_rad;
    for (Eigen::Index i = 0; i < kCount; ++i) {
      hfe_rad.push_back(std::lerp(joint.lower, joint.upper, static_cast<double>(i) / (kCount - 1)));
    }
    hfe_rad.push_back(default_rad);
    std::sort(hfe_rad.begin(), hfe_rad.end(), [&](double a, double b) {
      return std::abs(a - default_rad) < std::abs(b - default_rad);
    });
    map.q = map.q.col(0).eval().replicate(1, kCount + 1);
    map.p_base_contact.resize(Eigen::NoChange, kCount + 1);
    map.moment_base.resize(Eigen::NoChange, kCount + 1);
    for (Eigen::Index i = 0; i <= kCount; ++i) {
      q[hfe] = hfe_rad[static_cast<std::size_t>(i)];
      machine.tree.update(q, w);
      for (std::size_t k = 0; k < map.coordinates.size(); ++k) {
        map.q(static_cast<Eigen::Index>(k), i) = q[map.coordinates[k]];
      }
      const WheeledLeg& wheel = machine.legs[leg];
      map.p_base_contact.col(i) =
          machine.tree.position(w, wheel.carrier_body, wheel.p_carrier_wheel);
      map.moment_base.col(i) =
          moment_base + machine.tree.total_mass_kg() * (machine.tree.com(w) - default_com);
    }
  }
  return maps;
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
