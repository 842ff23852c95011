// The default mode as a whole: plans that step, why there is none, what its mechanisms are worth.
#include <gmock/gmock.h>

#include "initializer/make_plan.hpp"
#include "initializer/verify_plan.hpp"
#include "test_worlds.hpp"

namespace wex {
namespace {

using testing::HasSubstr;

const Task kAcross{{-7.5, 0.3, 0.05}, {7.5, -0.4, -0.1}};

TerrainMap gap_map(double width_m) {
  return make_map(30.0, 16.0,
                  [=](double x, double) { return std::abs(x) < 0.5 * width_m ? -2.0 : 0.0; });
}
TerrainMap step_map(double height_m) {
  return make_map(30.0, 16.0, [=](double x, double) { return x > 0.0 ? height_m : 0.0; });
}

PlanSettings with_iterations(int iterations, std::uint64_t seed = 1) {
  PlanSettings settings;
  settings.iterations = iterations;
  settings.seed = seed;
  return settings;
}

int wheel_lifts(const Plan& plan) {
  int lifts = 0;
  for (std::size_t n = 1; n < plan.nodes.size(); ++n) {
    for (std::size_t i = 0; i < kNumWheels; ++i) {
      lifts += plan.nodes[n - 1].contacts[i] && !plan.nodes[n].contacts[i] ? 1 : 0;
    }
  }
  return lifts;
}

/// A plan is sound by its own statement, and by a look through the whole kinematics.
void expect_verified(const TerrainMap& map, const Plan& plan, const PlanSettings& settings = {}) {
  const PlanVerdict verdict = verify_plan(map, test_machine(), plan, settings);
  EXPECT_TRUE(verdict.ok) << verdict.violation;
  EXPECT_GE(verdict.min_stability_margin_m, settings.min_stability_margin_m - 1e-6);
  EXPECT_DOUBLE_EQ(verdict.min_stability_margin_m, plan.min_stability_margin_m);
}

TEST(PlanSearch, CrossesAGapWithTwoPairLifts) {
  const TerrainMap map = gap_map(2.0);
  const auto plan = make_plan(map, test_machine(), kAcross, with_iterations(60));
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_EQ(wheel_lifts(*plan), 4);
  expect_verified(map, *plan);
  EXPECT_LE(plan->first_solution_time_s, plan->total_time_s);
}

TEST(PlanSearch, ClimbsAndDescendsAStep) {
  const TerrainMap map = step_map(1.0);
  const Task down{{7.5, -0.4, 3.1}, {-7.5, 0.3, 3.0}};
  for (const Task& task : {kAcross, down}) {
    const auto plan = make_plan(map, test_machine(), task, with_iterations(60));
    ASSERT_TRUE(plan) << plan.error().message;
    EXPECT_GE(wheel_lifts(*plan), 4);
    expect_verified(map, *plan);
  }
}

TEST(PlanSearch, DoesNotLiftAWheelOnFlatGround) {
  const TerrainMap map = flat_map();
  const auto plan = make_plan(map, test_machine(), kAcross, with_iterations(60));
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_EQ(wheel_lifts(*plan), 0);
}

TEST(PlanSearch, WithIterationsTheSameSeedGivesTheSameSteppingPlanBitForBit) {
  const TerrainMap map = gap_map(1.5);
  const Task hard{{-7.5, 2.0, 1.3}, {7.5, -2.0, -1.2}};
  const auto first = make_plan(map, test_machine(), hard, with_iterations(40, 3));
  const auto again = make_plan(map, test_machine(), hard, with_iterations(40, 3));
  ASSERT_TRUE(first) << first.error().message;
  ASSERT_TRUE(again);
  EXPECT_GT(wheel_lifts(*first), 0);
  ASSERT_EQ(first->nodes.size(), again->nodes.size());
  for (std::size_t i = 0; i < first->nodes.size(); ++i) {
    EXPECT_EQ(first->nodes[i].t_s, again->nodes[i].t_s);
    EXPECT_EQ(first->nodes[i].q, again->nodes[i].q);
    EXPECT_EQ(first->nodes[i].contacts, again->nodes[i].contacts);
  }
  EXPECT_EQ(first->cost, again->cost);
  EXPECT_EQ(first->iterations, again->iterations);
}

TEST(PlanSearch, EveryAblationStillGivesAnHonestAnswer) {
  const TerrainMap map = gap_map(2.0);
  for (bool PlanAblation::* mechanism : {&PlanAblation::certificate_first, &PlanAblation::alignment,
                                         &PlanAblation::blocking, &PlanAblation::certified_tree}) {
    PlanSettings settings = with_iterations(200);
    settings.ablation.*mechanism = false;
    const auto plan = make_plan(map, test_machine(), kAcross, settings);
    if (plan) {
      expect_verified(map, *plan, settings);
    } else {
      EXPECT_EQ(plan.error().code, ErrorCode::kNoPlan);
      EXPECT_THAT(plan.error().message, HasSubstr("poses tried were rejected"));
    }
  }
}

TEST(PlanSearch, AGapWiderThanTheWheelbaseIsNoPlanAndSaysWhereItEnds) {
  const TerrainMap map = gap_map(5.4);
  const auto plan = make_plan(map, test_machine(), kAcross, with_iterations(100));
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, ErrorCode::kNoPlan);
  EXPECT_THAT(plan.error().message, HasSubstr("100 iterations"));
  EXPECT_THAT(plan.error().message, HasSubstr("poses tried were rejected"));
  EXPECT_THAT(plan.error().message, HasSubstr("could not be followed"));
}

TEST(PlanSearch, AMachineWithoutAnArmOnlyDrives) {
  MachineModel machine = test_machine();
  machine.arm.reset();
  const auto flat = make_plan(flat_map(), machine, kAcross, with_iterations(20));
  EXPECT_TRUE(flat) << flat.error().message;
  const auto over_a_gap = make_plan(gap_map(2.0), machine, kAcross, with_iterations(60));
  ASSERT_FALSE(over_a_gap);
  EXPECT_EQ(over_a_gap.error().code, ErrorCode::kNoPlan);
}

TEST(PlanSearch, APenaltyOnSteppingPrefersTheWayAround) {
  // A gap that ends 8 m beside the straight way.
  const TerrainMap map = make_map(
      36.0, 30.0, [](double x, double y) { return std::abs(x) < 0.6 && y < 0.0 ? -2.0 : 0.0; });
  const Task task{{-8.0, -8.0, 0.0}, {8.0, -8.0, 0.0}};
  const auto lifts = [&](double penalty) {
    PlanSettings settings = with_iterations(60);
    settings.stepping_penalty = penalty;
    const auto plan = make_plan(map, test_machine(), task, settings);
    EXPECT_TRUE(plan) << plan.error().message;
    if (!plan) return -1;
    expect_verified(map, *plan, settings);
    return wheel_lifts(*plan);
  };
  EXPECT_EQ(lifts(0.0), 4);
  EXPECT_EQ(lifts(10.0), 0);
}

TEST(PlanSearch, AGoalSurroundedByUnknownGroundIsNoPlanAndSaysWhy) {
  const double nan = std::nan("");
  const TerrainMap map = make_map(30.0, 16.0, [nan](double x, double y) {
    const double r = std::hypot(x - 7.5, y + 0.4);
    return r > 3.8 && r < 5.0 ? nan : 0.0;
  });
  const auto plan = make_plan(map, test_machine(), kAcross, with_iterations(60));
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, ErrorCode::kNoPlan) << "the goal itself is good ground";
  EXPECT_THAT(plan.error().message, HasSubstr("unknown ground"));
}

}  // namespace
}  // namespace wex
