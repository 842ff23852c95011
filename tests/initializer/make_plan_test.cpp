#include "initializer/make_plan.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <numbers>

#include "initializer/drive_path.hpp"
#include "initializer/internal/se2_search.hpp"
#include "models/terrain/wheel_rest.hpp"
#include "tests/initializer/test_worlds.hpp"

namespace wex {
namespace {

using testing::HasSubstr;

const Task kAlongX{{-7.5, 0.3, 0.1}, {7.5, -0.4, -0.1}};

// Untraversable blocks with an opening off the straight way: the direct path does not fit.
TerrainMap map_with_detour() {
  return make_map(40.0, 30.0, [](double x, double y) {
    return std::abs(x) < 1.0 && (y < 3.0 || y > 10.0) ? 2.0 : 0.0;
  });
}

PlanSettings with_iterations(int iterations, std::uint64_t seed = 1) {
  PlanSettings settings;
  settings.iterations = iterations;
  settings.seed = seed;
  return settings;
}

// The demands of the plan, looked at through the machine's own kinematics.
void expect_standing_at_every_node(const TerrainMap& map, const Plan& plan) {
  const MachineModel& machine = test_machine();
  KinematicTree::Workspace w = machine.tree.make_workspace();
  for (std::size_t n = 0; n < plan.nodes.size(); ++n) {
    SCOPED_TRACE("node " + std::to_string(n));
    machine.tree.update(plan.nodes[n].q, w);
    std::array<Eigen::Vector2d, kNumWheels> p;
    for (std::size_t i = 0; i < kNumWheels; ++i) {
      const WheeledLeg& leg = machine.legs[i];
      const Eigen::Vector3d centre =
          machine.tree.position(w, leg.carrier_body, leg.p_carrier_wheel);
      p[i] = centre.head<2>();
      const Eigen::Vector3d axle = machine.tree.direction(w, leg.carrier_body, leg.axle_carrier);
      EXPECT_NEAR(centre.z(), wheel_rest(map, p[i], axle, leg.radius_m, leg.half_width_m).height_m,
                  1e-3);
      EXPECT_TRUE(map.traversable_at(p[i]));
      EXPECT_GE(map.signed_distance_m(p[i]), 0.15);
    }
    const Eigen::Vector2d com = machine.tree.com(w).head<2>();
    for (const auto& [a, b] : {std::pair{0, 2}, {2, 3}, {3, 1}, {1, 0}}) {  // anticlockwise
      const Eigen::Vector2d edge = (p[b] - p[a]).normalized();
      EXPECT_GE(edge.dot(Eigen::Vector2d(com.y() - p[a].y(), p[a].x() - com.x())), 0.30);
    }
    EXPECT_LE(std::abs(plan.nodes[n].q[kBaseRoll]), 0.3491);
    EXPECT_LE(std::abs(plan.nodes[n].q[kBasePitch]), 0.3491);
  }
}

// Finite differences of the timed nodes.
void expect_rates_within_limits(const Plan& plan) {
  const MachineModel& machine = test_machine();
  EXPECT_EQ(plan.nodes.front().t_s, 0.0);
  double last_speed = 0.0, last_middle_s = 0.0;
  for (std::size_t n = 1; n < plan.nodes.size(); ++n) {
    SCOPED_TRACE("node " + std::to_string(n));
    const WholeBodyNode &a = plan.nodes[n - 1], &b = plan.nodes[n];
    const double dt_s = b.t_s - a.t_s;
    ASSERT_GT(dt_s, 0.0);
    const Eigen::VectorXd step = b.q - a.q;
    EXPECT_LE(step.head<2>().norm(), 0.2 + 1e-9);
    EXPECT_LT(std::abs(step[kBaseYaw]), 0.06) << "yaw must be continuous";
    for (int j = 0; j < machine.num_joints(); ++j) {
      const Joint& joint = machine.joints[static_cast<std::size_t>(j)];
      EXPECT_LE(std::abs(step[kNumBaseCoordinates + j]) / dt_s, 0.8 * joint.max_rate * (1 + 1e-9))
          << joint.name;
    }
    const double yaw = 0.5 * (a.q[kBaseYaw] + b.q[kBaseYaw]);
    const double speed = (std::cos(yaw) * step[kBaseX] + std::sin(yaw) * step[kBaseY]) / dt_s;
    EXPECT_LE(std::abs(speed), 0.6 + 1e-9);
    const double middle_s = 0.5 * (a.t_s + b.t_s);
    // From rest at t = 0, then from the middle of one step to that of the next.
    EXPECT_LE(std::abs(speed - last_speed) / (middle_s - last_middle_s), 0.3 + 1e-3);
    last_speed = speed;
    last_middle_s = middle_s;
  }
  EXPECT_LE(std::abs(last_speed) / (plan.nodes.back().t_s - last_middle_s), 0.3 + 1e-3);
}

TEST(MakePlan, OnFlatGroundThePlanIsAsShortAsAReedsSheppCurve) {
  const TerrainMap map = flat_map();
  for (const Task& task : {kAlongX, Task{{0.0, 0.0, 0.0}, {0.0, 0.0, 2.0}},
                           Task{{-5.0, -5.0, 3.0}, {4.0, 3.0, -3.0}}}) {
    const auto plan = make_plan(map, test_machine(), task, with_iterations(100));
    ASSERT_TRUE(plan) << plan.error().message;
    const double shortest_m =
        path_length_m(reeds_shepp_path(task.start, task.goal, test_machine().min_turning_radius_m));
    EXPECT_LE(plan->path_length_m, 1.02 * shortest_m);
    expect_standing_at_every_node(map, *plan);
    expect_rates_within_limits(*plan);
  }
}

TEST(MakePlan, EndsAtTheGoalStartsAsStandingAndStaysOnTheGroundOverBumps) {
  const TerrainMap map = make_map(40.0, 30.0, [](double x, double y) { return 0.5 * bumps(x, y); });
  const auto plan = make_plan(map, test_machine(), kAlongX);
  ASSERT_TRUE(plan) << plan.error().message;
  expect_standing_at_every_node(map, *plan);
  expect_rates_within_limits(*plan);
  const auto standing = standing_posture(map, test_machine(), kAlongX.start);
  ASSERT_TRUE(standing) << standing.error().message;
  EXPECT_LT((plan->nodes.front().q - *standing).norm(), 1e-4);
  const Eigen::VectorXd& end = plan->nodes.back().q;
  EXPECT_NEAR(end[kBaseX], kAlongX.goal.x_m, 1e-6);
  EXPECT_NEAR(end[kBaseY], kAlongX.goal.y_m, 1e-6);
  EXPECT_NEAR(wrap_angle(end[kBaseYaw] - kAlongX.goal.yaw_rad), 0.0, 1e-6);
  EXPECT_EQ(plan->task, kAlongX);
  EXPECT_GE(plan->min_stability_margin_m, 0.30);
}

TEST(MakePlan, WheelsTurnByTheWayTheyRoll) {
  const Task straight{{-5.0, 0.0, 0.0}, {5.0, 0.0, 0.0}};
  const auto plan = make_plan(flat_map(), test_machine(), straight);
  ASSERT_TRUE(plan) << plan.error().message;
  for (const WheeledLeg& leg : test_machine().legs) {
    const double turned = plan->nodes.back().q[leg.wheel] - plan->nodes.front().q[leg.wheel];
    EXPECT_NEAR(leg.wheel_sign * turned * leg.radius_m, 10.0, 1e-3);
  }
}

TEST(MakePlan, FindsTheWayThroughAnOpeningAwayFromTheStraightLine) {
  const TerrainMap map = map_with_detour();
  const auto plan = make_plan(map, test_machine(), kAlongX, with_iterations(400));
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_GT(plan->iterations, 0);
  EXPECT_GT(plan->path_length_m, 16.0);
  EXPECT_LT(plan->path_length_m, 30.0);
  expect_standing_at_every_node(map, *plan);
  expect_rates_within_limits(*plan);
}

TEST(MakePlan, WithIterationsTheSameSeedGivesTheSamePlanBitForBit) {
  const TerrainMap map = map_with_detour();
  const auto first = make_plan(map, test_machine(), kAlongX, with_iterations(300, 4));
  const auto other = make_plan(map, test_machine(), kAlongX, with_iterations(300, 5));
  const auto again = make_plan(map, test_machine(), kAlongX, with_iterations(300, 4));
  ASSERT_TRUE(first && other && again);
  ASSERT_EQ(first->nodes.size(), again->nodes.size());
  for (std::size_t i = 0; i < first->nodes.size(); ++i) {
    EXPECT_EQ(first->nodes[i].t_s, again->nodes[i].t_s);
    EXPECT_EQ(first->nodes[i].q, again->nodes[i].q);
  }
  EXPECT_EQ(first->iterations, again->iterations);
  EXPECT_NE(first->cost, other->cost) << "the seed made no difference";
}

TEST(MakePlan, WithoutSteppingAGapOverTheWholeWidthIsNoPlanAndSaysWhatBlockedIt) {
  const TerrainMap map =
      make_map(40.0, 30.0, [](double x, double) { return std::abs(x) < 1.0 ? -2.0 : 0.0; });
  PlanSettings settings = with_iterations(200);
  settings.mode = PlanMode::kDriveOnly;
  const auto plan = make_plan(map, test_machine(), kAlongX, settings);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, ErrorCode::kNoPlan);
  EXPECT_THAT(plan.error().message, HasSubstr("200 iterations"));
  EXPECT_THAT(plan.error().message, HasSubstr("untraversable ground"));
}

TEST(MakePlan, TellsTheObserverAboutTheFirstPath) {
  std::vector<PlanProgress> seen;
  const auto plan = make_plan(flat_map(), test_machine(), kAlongX, {},
                              [&](const PlanProgress& progress) { seen.push_back(progress); });
  ASSERT_TRUE(plan);
  ASSERT_FALSE(seen.empty());
  ASSERT_TRUE(seen.back().best_cost);
  EXPECT_DOUBLE_EQ(*seen.back().best_cost, plan->cost);
}

struct BadEnd {
  const char* name;
  Pose2 pose;
  const char* expected;
};

class MakePlanBadEnds : public testing::TestWithParam<BadEnd> {};

TEST_P(MakePlanBadEnds, AreNamedWithTheReason) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  // Unknown ground in the south west, a pit in the north west, a 25 degree slope in the north east.
  const TerrainMap map = make_map(
      60.0, 60.0,
      [nan](double x, double y) {
        if (x < -10.0 && y < -10.0) return nan;
        if (std::hypot(x + 15.0, y - 15.0) < 1.0) return -2.0;
        return y > 5.0 && x > 5.0 ? 0.466 * std::min(x - 5.0, y - 5.0) : 0.0;
      },
      Eigen::Vector2d::Zero(), Eigen::Vector2d(1000.0, 2000.0));
  const Pose2 good{0.0, 0.0, 0.0};
  const auto from = make_plan(map, test_machine(), {GetParam().pose, good});
  const auto to = make_plan(map, test_machine(), {good, GetParam().pose});
  for (const auto& [plan, which] : {std::pair{&from, "the start"}, {&to, "the goal"}}) {
    ASSERT_FALSE(*plan);
    EXPECT_EQ(plan->error().code, ErrorCode::kBadInput);
    EXPECT_THAT(plan->error().message, HasSubstr(which));
    EXPECT_THAT(plan->error().message, HasSubstr(GetParam().expected));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Reasons, MakePlanBadEnds,
    testing::Values(
        BadEnd{"OffTheMap", {31.0, 0.0, 0.0}, "off the map"},
        BadEnd{"OnUnknownGround", {-20.0, -20.0, 0.0}, "unknown ground"},
        BadEnd{"InAPit", {-15.0 - 2.5, 15.0 - 1.5, 0.0}, "untraversable spot"},
        BadEnd{"OnASteepSlope", {15.0, 25.0, 0.0}, "too much tilt"},
        BadEnd{"NotANumber", {0.0, std::numeric_limits<double>::quiet_NaN(), 0.0}, "finite"},
        BadEnd{"InfiniteYaw", {0.0, 0.0, std::numeric_limits<double>::infinity()}, "finite"}),
    [](const auto& info) { return info.param.name; });

TEST(MakePlan, AnUnstablePoseIsRefused) {
  PlanSettings settings;
  settings.min_stability_margin_m = 3.0;  // more than half the machine's width
  const auto plan = make_plan(flat_map(), test_machine(), kAlongX, settings);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(plan.error().message, HasSubstr("stability"));
}

TEST(MakePlan, PositionsInMessagesAreInTheFrameOfTheMapFile) {
  const TerrainMap map = make_map(
      40.0, 30.0, [](double, double) { return 0.0; }, Eigen::Vector2d::Zero(),
      Eigen::Vector2d(1000.0, 2000.0));
  const auto plan = make_plan(map, test_machine(), {{25.0, 3.0, 0.0}, {0.0, 0.0, 0.0}});
  ASSERT_FALSE(plan);
  EXPECT_THAT(plan.error().message, HasSubstr("1025.00"));
  EXPECT_THAT(plan.error().message, HasSubstr("2003.00"));
}

TEST(MakePlan, UnusableSettingsAreNamed) {
  PlanSettings spacing, iterations, margin;
  spacing.subnode_spacing_m = 0.0;
  iterations.iterations = -1;
  margin.min_stability_margin_m = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [settings, name] : {std::pair{spacing, "subnode_spacing_m"},
                                       {iterations, "iterations"},
                                       {margin, "min_stability_margin_m"}}) {
    const auto plan = make_plan(flat_map(), test_machine(), kAlongX, settings);
    ASSERT_FALSE(plan);
    EXPECT_EQ(plan.error().code, ErrorCode::kBadInput);
    EXPECT_THAT(plan.error().message, HasSubstr(name));
  }
}

}  // namespace
}  // namespace wex
