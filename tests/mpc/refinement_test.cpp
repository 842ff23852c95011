#include <gmock/gmock.h>

#include "mpc/refinement/refine.hpp"
#include "tests/support/driving_plan.hpp"

namespace wex {
namespace {

struct Case {
  const char* name;
  double amplitude_m, length_m, curvature_1_m;
};

class Refinement : public ::testing::TestWithParam<Case> {
 protected:
  MachineModel machine_ = load_machine().value();
};

TEST_P(Refinement, TurnsACoarsePlanIntoRollingWithoutSlip) {
  const TerrainMap terrain = test::rolling_ground(GetParam().amplitude_m);
  const Plan plan = test::arc_plan(terrain, machine_, {2.0, 0.0, 0.0}, GetParam().length_m,
                                   GetParam().curvature_1_m);
  const RefinementSettings settings;
  const Result<RefinedTrajectory> refined = refine(terrain, machine_, plan, settings);
  ASSERT_TRUE(refined.has_value()) << refined.error().message;
  EXPECT_TRUE(refined->report.feasible);
  EXPECT_LE(refined->report.worst_residual.at("wheel_height_m"), settings.height_tolerance_m);
  EXPECT_LE(refined->report.worst_residual.at("side_slip_m_s"), settings.slip_tolerance_m_s);
  EXPECT_GE(refined->min_stability_margin_m, settings.min_stability_margin_m - 1e-3);
  const Eigen::VectorXd& last = refined->nodes.back().q;
  EXPECT_NEAR(last[kBaseX], plan.task.goal.x_m, 1e-6);
  EXPECT_NEAR(last[kBaseY], plan.task.goal.y_m, 1e-6);
  EXPECT_NEAR(last[kBaseYaw], plan.task.goal.yaw_rad, 1e-6);
  EXPECT_EQ(refined->nodes.front().q, plan.nodes.front().q);
}

TEST_P(Refinement, KeepsEveryRateWithinItsLimit) {
  const TerrainMap terrain = test::rolling_ground(GetParam().amplitude_m);
  const Plan plan = test::arc_plan(terrain, machine_, {2.0, 0.0, 0.0}, GetParam().length_m,
                                   GetParam().curvature_1_m);
  const Result<RefinedTrajectory> refined = refine(terrain, machine_, plan);
  ASSERT_TRUE(refined.has_value()) << refined.error().message;
  for (std::size_t k = 1; k < refined->nodes.size(); ++k) {
    const Eigen::VectorXd rate =
        (refined->nodes[k].q - refined->nodes[k - 1].q).tail(machine_.num_joints()) / refined->dt_s;
    for (int j = 0; j < machine_.num_joints(); ++j) {
      EXPECT_LE(std::abs(rate[j]), machine_.joints[j].max_rate * 1.001)
          << machine_.joints[j].name << " at node " << k;
    }
  }
}

TEST_P(Refinement, LeavesTheTrackerRoomToEveryEndStop) {
  const TerrainMap terrain = test::rolling_ground(GetParam().amplitude_m);
  const Plan plan = test::arc_plan(terrain, machine_, {2.0, 0.0, 0.0}, GetParam().length_m,
                                   GetParam().curvature_1_m);
  const RefinementSettings settings;
  const Result<RefinedTrajectory> refined = refine(terrain, machine_, plan, settings);
  ASSERT_TRUE(refined.has_value()) << refined.error().message;
  for (std::size_t k = 1; k < refined->nodes.size(); ++k) {
    for (const WheeledLeg& leg : machine_.legs) {
      for (const int coordinate : {leg.haa, leg.hfe, leg.steer}) {
        const Joint& joint = machine_.joints[coordinate - kNumBaseCoordinates];
        const double q = refined->nodes[k].q[coordinate];
        EXPECT_GE(q - joint.lower, settings.joint_margin_rad - 1e-3)
            << joint.name << ", node " << k;
        EXPECT_GE(joint.upper - q, settings.joint_margin_rad - 1e-3)
            << joint.name << ", node " << k;
      }
    }
  }
}

TEST(RefinementErrors, RefusesAPlanThatLiftsAWheel) {
  const MachineModel machine = load_machine().value();
  const TerrainMap terrain = test::rolling_ground(0.0);
  Plan plan = test::arc_plan(terrain, machine, {2.0, 0.0, 0.0}, 2.0, 0.0);
  plan.nodes[2].contacts[0] = false;
  const Result<RefinedTrajectory> refined = refine(terrain, machine, plan);
  ASSERT_FALSE(refined.has_value());
  EXPECT_EQ(refined.error().code, ErrorCode::kRefinementFailed);
}

TEST(RefinementErrors, SaysWhichRowFailsWhenTheGroundCannotBeReached) {
  const MachineModel machine = load_machine().value();
  const TerrainMap terrain = test::rolling_ground(0.0);
  Plan plan = test::arc_plan(terrain, machine, {2.0, 0.0, 0.0}, 4.0, 0.0);
  plan.task.goal.x_m += 20.0;
  plan.nodes.back().q[kBaseX] += 20.0;  // 20 m in the last 0.4 s
  RefinementSettings settings;
  settings.max_iterations = 60;
  const Result<RefinedTrajectory> refined = refine(terrain, machine, plan, settings);
  ASSERT_FALSE(refined.has_value());
  EXPECT_EQ(refined.error().code, ErrorCode::kRefinementFailed);
  EXPECT_THAT(refined.error().message, ::testing::HasSubstr("off by"));
}

INSTANTIATE_TEST_SUITE_P(Grounds, Refinement,
                         ::testing::Values(Case{"FlatStraight", 0.0, 8.0, 0.0},
                                           Case{"FlatMinimumRadius", 0.0, 6.0, 1.0 / 4.5},
                                           Case{"RollingStraight", 0.12, 10.0, 0.0},
                                           Case{"RollingCurve", 0.12, 8.0, -0.1}),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace wex
