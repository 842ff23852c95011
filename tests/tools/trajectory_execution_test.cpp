#include "tools/wex/trajectory_execution.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace wex::app {
namespace {

class TrajectoryExecution : public ::testing::Test {
 protected:
  TrajectoryExecution() : machine_(*load_machine()) {
    // Joint j moves at (j + 1) mm or mrad per second until 2 s, then three times as fast.
    for (int k = 0; k <= 16; ++k) {
      WholeBodyNode node;
      node.t_s = 10.0 + 0.25 * k;
      node.q = Eigen::VectorXd::Zero(machine_.num_coordinates());
      const double t = 0.25 * k;
      for (int j = 0; j < machine_.num_joints(); ++j) {
        node.q[kNumBaseCoordinates + j] = rate(j) * (t <= 2.0 ? t : 2.0 + 3.0 * (t - 2.0));
      }
      node.q[kBaseX] = 0.5 * t;
      nodes_.push_back(node);
    }
  }
  static double rate(int joint) { return 1e-3 * (joint + 1); }

  MachineModel machine_;
  std::vector<WholeBodyNode> nodes_;
};

TEST_F(TrajectoryExecution, TakesEachRateAheadByTheJointsDeadTimeAndLag) {
  constexpr double kStep = 0.01;
  for (int j = 0; j < machine_.num_joints(); ++j) {
    const double ahead_s = machine_.joints[j].dead_time_s + machine_.joints[j].lag_s;
    const double change_s = 12.0 - ahead_s;  // when the faster rate must be asked for
    EXPECT_NEAR(command_at(machine_, nodes_, change_s - kStep, 0.1).rate[j], rate(j), 1e-12)
        << machine_.joints[j].name;
    EXPECT_NEAR(command_at(machine_, nodes_, change_s + kStep, 0.1).rate[j], 3.0 * rate(j), 1e-12)
        << machine_.joints[j].name;
  }
}

TEST_F(TrajectoryExecution, TargetsThePositionDueNowForAllButWheelsAndTurn) {
  const JointCommand command = command_at(machine_, nodes_, 11.0, 0.08);
  EXPECT_EQ(command.num_joints, machine_.num_joints());
  EXPECT_DOUBLE_EQ(command.valid_until_s, 11.08);
  for (int j = 0; j < machine_.num_joints(); ++j) {
    const std::string& name = machine_.joints[j].name;
    const bool rate_only = name == "TURN" || name.ends_with("_WHEEL");
    EXPECT_EQ(command.has_position_target[j], !rate_only) << name;
    EXPECT_NEAR(command.position_target[j], rate_only ? 0.0 : rate(j), 1e-12) << name;
  }
}

TEST_F(TrajectoryExecution, AsksForNoMotionBeyondTheEnd) {
  const JointCommand command = command_at(machine_, nodes_, 14.0, 0.08);
  for (int j = 0; j < machine_.num_joints(); ++j) EXPECT_EQ(command.rate[j], 0.0);
  EXPECT_EQ(rates(nodes_, 14.0).norm(), 0.0);
  EXPECT_DOUBLE_EQ(rates(nodes_, 13.9)[kBaseX], 0.5);
}

TEST_F(TrajectoryExecution, PredictsTheMeasurementPlusTheMotionUnderWay) {
  Eigen::VectorXd q = sample(nodes_, 11.0).q;
  q[kBaseY] = 3.0;
  q[kNumBaseCoordinates] += 0.1;
  const Eigen::VectorXd predicted = predict(q, nodes_, 11.0, 0.2);
  EXPECT_NEAR(predicted[kBaseX], q[kBaseX] + 0.1, 1e-12);
  EXPECT_NEAR(predicted[kBaseY], 3.0, 1e-12);
  EXPECT_NEAR(predicted[kNumBaseCoordinates], q[kNumBaseCoordinates] + 0.2 * rate(0), 1e-12);
}

TEST_F(TrajectoryExecution, TurnsThePredictedTravelIntoTheMeasuredHeading) {
  Eigen::VectorXd q = sample(nodes_, 11.0).q;
  q[kBaseYaw] = 0.5 * std::numbers::pi;
  const Eigen::VectorXd predicted = predict(q, nodes_, 11.0, 0.2);
  EXPECT_NEAR(predicted[kBaseX], q[kBaseX], 1e-12);
  EXPECT_NEAR(predicted[kBaseY], q[kBaseY] + 0.1, 1e-12);
}

TEST_F(TrajectoryExecution, PredictsTheMeasurementWithoutATrajectory) {
  const Eigen::VectorXd q = Eigen::VectorXd::LinSpaced(machine_.num_coordinates(), 0.0, 1.0);
  EXPECT_EQ(predict(q, {}, 11.0, 0.2), q);
}

}  // namespace
}  // namespace wex::app
