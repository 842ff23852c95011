#include "initializer/leg_table.hpp"

#include <gmock/gmock.h>

#include <random>

#include "tests/initializer/test_worlds.hpp"

namespace wex {
namespace {

constexpr double kTableToleranceM = 2e-5;

Eigen::VectorXd transport_coordinates(const MachineModel& machine) {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(machine.num_coordinates());
  q.tail(machine.num_joints()) = machine.transport_posture();
  return q;
}

TEST(LegTable, AgreesWithTheFullKinematicsAtRandomPostures) {
  const MachineModel& machine = test_machine();
  const auto tables = build_leg_tables(machine);
  ASSERT_TRUE(tables) << tables.error().message;
  std::mt19937 generator(5);
  KinematicTree::Workspace w = machine.tree.make_workspace();
  for (int trial = 0; trial < 400; ++trial) {
    const auto i = static_cast<std::size_t>(trial % kNumWheels);
    const WheeledLeg& leg = machine.legs[i];
    const LegTable& table = (*tables)[i];
    Eigen::VectorXd q = transport_coordinates(machine);
    q[leg.hfe] = q[leg.steer] = 0.0;
    machine.tree.update(q, w);
    const Eigen::Vector3d com_zero = machine.tree.com(w);
    q[leg.hfe] = std::uniform_real_distribution<double>(table.hfe_lower_rad(),
                                                        table.hfe_upper_rad())(generator);
    q[leg.steer] = std::uniform_real_distribution<double>(table.steer_lower_rad(),
                                                          table.steer_upper_rad())(generator);
    machine.tree.update(q, w);
    const LegTable::Steer steer(q[leg.steer]);
    const Eigen::Vector3d p = machine.tree.position(w, leg.carrier_body, leg.p_carrier_wheel);
    const Eigen::Vector3d axle = machine.tree.direction(w, leg.carrier_body, leg.axle_carrier);
    EXPECT_LT((table.p_base_wheel(q[leg.hfe], steer) - p).norm(), kTableToleranceM);
    EXPECT_LT((table.axle_base(q[leg.hfe], steer) - axle).norm(), 1e-4);
    const Eigen::Vector3d moved =
        table.moment_base(q[leg.hfe], steer) / machine.tree.total_mass_kg();
    EXPECT_LT((com_zero + moved - machine.tree.com(w)).norm(), kTableToleranceM);
  }
}

TEST(LegTable, SteeringPutsEveryAxleThroughOneCentreOfRotation) {
  const auto tables = build_leg_tables(test_machine());
  ASSERT_TRUE(tables);
  for (const double radius_m : {4.5, -4.5, 12.0, -30.0}) {
    for (const LegTable& table : *tables) {
      const double hfe = table.hfe_default_rad();
      const LegTable::Steer steer(table.steering_rad(hfe, 1.0 / radius_m));
      EXPECT_GE(steer.angle_rad(), table.steer_lower_rad());
      EXPECT_LE(steer.angle_rad(), table.steer_upper_rad());
      const Eigen::Vector2d p = table.p_base_wheel(hfe, steer).head<2>();
      const Eigen::Vector2d axle = table.axle_base(hfe, steer).head<2>().normalized();
      const Eigen::Vector2d to_centre = Eigen::Vector2d(0.0, radius_m) - p;
      EXPECT_NEAR(to_centre.x() * axle.y() - to_centre.y() * axle.x(), 0.0, 1e-3)
          << "distance of the axle's line from the centre [m], radius " << radius_m;
      EXPECT_GT(to_centre.dot(axle) * radius_m, 0.0) << "the axle points away from the centre";
    }
  }
}

TEST(LegTable, WheelsStandStraightOnAStraightPath) {
  const auto tables = build_leg_tables(test_machine());
  ASSERT_TRUE(tables);
  for (const LegTable& table : *tables) EXPECT_NEAR(table.steering_rad(-0.3, 0.0), 0.0, 1e-6);
}

TEST(LegTable, ALegWithoutHipFlexionIsRefused) {
  MachineModel machine = test_machine();
  machine.legs[2].hfe = -1;
  const auto tables = build_leg_tables(machine);
  ASSERT_FALSE(tables);
  EXPECT_EQ(tables.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(tables.error().message, testing::HasSubstr("LH"));
}

}  // namespace
}  // namespace wex
