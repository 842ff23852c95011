#include "mpc/receding_horizon/receding_horizon.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <random>

#include "mpc/refinement/refine.hpp"
#include "tests/support/driving_plan.hpp"

namespace wex {
namespace {

class RecedingHorizonTest : public ::testing::Test {
 protected:
  MachineModel machine_ = load_machine().value();
  TerrainMap terrain_ = test::rolling_ground(0.1);
  Plan plan_ = test::arc_plan(terrain_, machine_, {2.0, -1.0, 0.0}, 6.0, 0.1);
  RefinedTrajectory reference_ = refine(terrain_, machine_, plan_).value();

  HorizonInput at_rest(const Eigen::VectorXd& q) const {
    HorizonInput input;
    input.q = q;
    input.qdot = Eigen::VectorXd::Zero(q.size());
    return input;
  }
};

TEST_F(RecedingHorizonTest, FollowsTheReferenceWhenStartedOnIt) {
  RecedingHorizon horizon(terrain_, machine_, reference_);
  const HorizonResult result = horizon.solve(at_rest(reference_.nodes[0].q));
  ASSERT_TRUE(result.usable) << result.report.status;
  ASSERT_EQ(result.nodes.size(), 21u);
  EXPECT_EQ(result.nodes[0].q, reference_.nodes[0].q);
  for (const WholeBodyNode& node : result.nodes) {
    const Eigen::VectorXd expected = sample(reference_.nodes, node.t_s).q;
    EXPECT_LT((node.q.head<3>() - expected.head<3>()).norm(), 0.10) << "at " << node.t_s << " s";
  }
}

TEST_F(RecedingHorizonTest, ReachesTheGoalInClosedLoopUnderStateNoise) {
  RecedingHorizon horizon(terrain_, machine_, reference_);
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 1e-3);  // 1 mm, 1 mrad
  HorizonInput input = at_rest(reference_.nodes[0].q);
  constexpr double kPeriod_s = 0.1;
  int unusable = 0;
  while (input.t_s < reference_.nodes.back().t_s + 2.0) {
    const HorizonResult result = horizon.solve(input);
    if (!result.usable) {
      ++unusable;
      break;
    }
    const Eigen::VectorXd q = sample(result.nodes, input.t_s + kPeriod_s).q;
    input.qdot = (q - input.q) / kPeriod_s;
    input.q = q;
    for (double& value : input.q) value += noise(random);
    input.t_s += kPeriod_s;
    input.reference_time_s = input.t_s;
  }
  EXPECT_EQ(unusable, 0);
  EXPECT_NEAR(input.q[kBaseX], plan_.task.goal.x_m, 0.05);
  EXPECT_NEAR(input.q[kBaseY], plan_.task.goal.y_m, 0.05);
  EXPECT_NEAR(input.q[kBaseYaw], plan_.task.goal.yaw_rad, 0.03);
}

/// Backwards round a bend, at `speed_m_s`.
RefinedTrajectory backwards(const TerrainMap& terrain, const MachineModel& machine,
                            double speed_m_s) {
  constexpr double kPlannedSpeed_m_s = 0.5;
  Plan plan = test::arc_plan(terrain, machine, {2.0, -1.0, 0.0}, 8.0, 0.2, kPlannedSpeed_m_s);
  std::reverse(plan.nodes.begin(), plan.nodes.end());
  const double end_s = plan.nodes.front().t_s;
  for (WholeBodyNode& node : plan.nodes) node.t_s = end_s - node.t_s;
  std::swap(plan.task.start, plan.task.goal);
  RefinedTrajectory trajectory = refine(terrain, machine, plan).value();
  for (WholeBodyNode& node : trajectory.nodes) node.t_s *= kPlannedSpeed_m_s / speed_m_s;
  return trajectory;
}

// The hind legs go ahead then, and within the horizon the machine covers less than it takes for an
// error of theirs to grow: what is put off for ever must not pay.
TEST_F(RecedingHorizonTest, BringsALegBackThatGoesAheadOfASlowMachine) {
  const RefinedTrajectory reference = backwards(terrain_, machine_, 0.2);
  RecedingHorizon horizon(terrain_, machine_, reference);
  HorizonInput input = at_rest(reference.nodes[0].q);
  input.q[machine_.legs[2].haa] -= 0.03;
  constexpr double kPeriod_s = 0.2;
  double worst_rad = 0.0, last_rad = 0.0;
  while (input.t_s < reference.nodes.back().t_s) {
    const HorizonResult result = horizon.solve(input);
    ASSERT_TRUE(result.usable) << result.report.status << " at " << input.t_s << " s";
    const Eigen::VectorXd q = sample(result.nodes, input.t_s + kPeriod_s).q;
    input.qdot = (q - input.q) / kPeriod_s;
    input.q = q;
    input.t_s += kPeriod_s;
    input.reference_time_s = input.t_s;
    const Eigen::VectorXd error = q - sample(reference.nodes, input.t_s).q;
    last_rad = 0.0;
    for (const WheeledLeg& leg : machine_.legs) {
      last_rad = std::max({last_rad, std::abs(error[leg.haa]), std::abs(error[leg.hfe])});
    }
    worst_rad = std::max(worst_rad, last_rad);
  }
  EXPECT_LT(worst_rad, 0.06);
  EXPECT_LT(last_rad, 0.03);
}

TEST_F(RecedingHorizonTest, RecoversFromAWheelOffTheGround) {
  RecedingHorizon horizon(terrain_, machine_, reference_);
  Eigen::VectorXd q = reference_.nodes[0].q;
  q[kBaseZ] += 0.04;
  const HorizonResult result = horizon.solve(at_rest(q));
  ASSERT_TRUE(result.usable) << result.report.status;
  EXPECT_LT(result.report.worst_residual.at("wheel_height_m"), 0.005);
}

TEST_F(RecedingHorizonTest, TracksGroundThatIsHigherThanTheMapByTheGivenBias) {
  RecedingHorizon horizon(terrain_, machine_, reference_);
  HorizonInput input = at_rest(reference_.nodes[0].q);
  input.q[kBaseZ] += 0.05;
  input.height_bias_m.fill(0.05);
  const HorizonResult result = horizon.solve(input);
  ASSERT_TRUE(result.usable) << result.report.status;
  EXPECT_NEAR(result.nodes[4].q[kBaseZ] - sample(reference_.nodes, 1.0).q[kBaseZ], 0.05, 0.03);
}

TEST_F(RecedingHorizonTest, GivesNothingUsableForInputThatIsNotFinite) {
  RecedingHorizon horizon(terrain_, machine_, reference_);
  HorizonInput input = at_rest(reference_.nodes[0].q);
  input.q[kBaseX] = std::numeric_limits<double>::quiet_NaN();
  const HorizonResult result = horizon.solve(input);
  EXPECT_FALSE(result.usable);
  EXPECT_TRUE(result.nodes.empty());
}

TEST_F(RecedingHorizonTest, SpinsTheWheelsByTheDistanceTheyRoll) {
  RecedingHorizon horizon(terrain_, machine_, reference_);
  const HorizonResult result = horizon.solve(at_rest(reference_.nodes[0].q));
  ASSERT_TRUE(result.usable);
  const Eigen::VectorXd& first = result.nodes.front().q;
  const Eigen::VectorXd& last = result.nodes.back().q;
  const double driven_m = (last.head<2>() - first.head<2>()).norm();
  double mean_spin_rad = 0.0;
  for (const WheeledLeg& leg : machine_.legs) {
    mean_spin_rad += leg.wheel_sign * (last[leg.wheel] - first[leg.wheel]) / kNumWheels;
  }
  EXPECT_NEAR(mean_spin_rad * machine_.legs[0].radius_m, driven_m, 0.08 * driven_m);
}

}  // namespace
}  // namespace wex
