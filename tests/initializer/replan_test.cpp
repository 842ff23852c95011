#include "initializer/replan/replan.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>

#include "initializer/replan/ground_recheck.hpp"
#include "initializer/replan/plan_splice.hpp"
#include "initializer/verify_plan.hpp"
#include "test_worlds.hpp"

namespace wex {
namespace {

constexpr double kLengthM = 34.0, kWidthM = 20.0;
const Task kTask{{-12.0, 0.0, 0.0}, {12.0, 0.0, 0.0}};

PlanSettings quick_settings() {
  PlanSettings settings;
  settings.iterations = 40;
  return settings;
}

bool inside(const GroundRect& rect, double x, double y) {
  return x >= rect.min_m.x() && x <= rect.max_m.x() && y >= rect.min_m.y() && y <= rect.max_m.y();
}

HeightFunction with_block(const HeightFunction& ground, const GroundRect& rect, double height_m) {
  return [=](double x, double y) {
    return ground(x, y) + (inside(rect, x + 1e-9, y + 1e-9) ? height_m : 0.0);
  };
}

HeightFunction flat() {
  return [](double, double) { return 0.0; };
}

HeightFunction gap(double width_m) {
  return [=](double x, double) { return std::abs(x) < 0.5 * width_m ? -2.0 : 0.0; };
}

GroundRect square(double x, double y, double size_m) {
  return {{x - 0.5 * size_m, y - 0.5 * size_m}, {x + 0.5 * size_m, y + 0.5 * size_m}};
}

PlanMemory remembered(const TerrainMap& terrain) {
  auto memory = plan_and_remember(terrain, test_machine(), kTask, quick_settings());
  if (!memory) throw std::runtime_error(memory.error().message);
  return *std::move(memory);
}

/// Planned once, looked at by many tests.
const PlanMemory& over_flat() {
  static const PlanMemory memory = remembered(make_map(kLengthM, kWidthM, flat()));
  return memory;
}

const PlanMemory& over_gap() {
  static const PlanMemory memory = remembered(make_map(kLengthM, kWidthM, gap(1.2)));
  return memory;
}

std::string violation(const TerrainMap& terrain, const Plan& plan) {
  return verify_plan(terrain, test_machine(), plan, quick_settings()).violation;
}

std::size_t num_lifts(const Plan& plan) {
  std::size_t lifts = 0;
  for (std::size_t i = 1; i < plan.nodes.size(); ++i) {
    for (std::size_t k = 0; k < kNumWheels; ++k) {
      lifts += plan.nodes[i - 1].contacts[k] && !plan.nodes[i].contacts[k];
    }
  }
  return lifts;
}

// A tyre of radius r feels a bump of height h from sqrt(r^2 - (r - h)^2) away: one of 0.1 m from
// 0.33 m, one of 0.02 m from 0.15 m. Rectangles end half a cell before the distances meant.
TEST(GroundChange, AChangedCellIsFoundWhereItIsAndNotElsewhere) {
  const TerrainMap before = make_map(20.0, 20.0, flat());
  const auto change_by = [&](double height_m) {
    const TerrainMap after =
        make_map(20.0, 20.0, with_block(flat(), square(3.0, -2.0, 0.15), height_m));
    return GroundChange::between(before, after, std::nullopt);
  };
  const auto high = change_by(0.1), low = change_by(0.02);
  for (const auto* change : {&high, &low}) {
    ASSERT_TRUE(*change);
    EXPECT_FALSE((*change)->none());
    EXPECT_TRUE((*change)->meets(square(3.0, -2.0, 0.1)));
    EXPECT_TRUE((*change)->meets(square(3.15, -2.0, 0.1)));
    EXPECT_FALSE((*change)->meets(square(4.2, -2.0, 0.1)));
    EXPECT_FALSE((*change)->meets(square(3.0, -3.2, 0.1)));
    EXPECT_FALSE((*change)->meets(square(-8.0, 8.0, 2.0)));
    EXPECT_TRUE((*change)->meets(square(0.0, 0.0, 40.0))) << "rectangles may reach off the map";
  }
  EXPECT_TRUE((*high).meets(square(3.4, -2.0, 0.1)));
  EXPECT_FALSE((*low).meets(square(3.4, -2.0, 0.1)));
}

TEST(GroundChange, EqualMapsWithUnknownGroundDoNotDiffer) {
  const auto unknown_corner = [](double x, double y) {
    return x > 6.0 && y > 6.0 ? std::numeric_limits<double>::quiet_NaN() : bumps(x, y);
  };
  const TerrainMap map = make_map(20.0, 20.0, unknown_corner);
  const auto none = GroundChange::between(map, make_map(20.0, 20.0, unknown_corner), std::nullopt);
  ASSERT_TRUE(none);
  EXPECT_TRUE(none->none());
  const auto known = GroundChange::between(map, make_map(20.0, 20.0, bumps), std::nullopt);
  ASSERT_TRUE(known);
  EXPECT_TRUE(known->meets(square(8.0, 8.0, 0.2)));
}

TEST(GroundChange, MapsOfOtherGridsAreRefused) {
  const auto change = GroundChange::between(make_map(20.0, 20.0, flat()),
                                            make_map(21.0, 20.0, flat()), std::nullopt);
  ASSERT_FALSE(change);
  EXPECT_EQ(change.error().code, ErrorCode::kBadInput);
}

TEST(PlanSplice, PartsOfAPathAddUpAndMeet) {
  const DrivePath path{{{0.0, 0.0, 0.0}, 0.0, 3.0},
                       {{3.0, 0.0, 0.0}, 0.2, 2.0},
                       {pose_along({{3.0, 0.0, 0.0}, 0.2, 2.0}, 2.0), 0.0, -4.0}};
  DrivePath joined = part_of(path, 0.0, 4.2);
  EXPECT_NEAR(path_length_m(joined), 4.2, 1e-9);
  const DrivePath rest = part_of(path, 4.2, 100.0);
  EXPECT_NEAR(path_length_m(rest), 4.8, 1e-9);
  const Pose2 end = pose_along(joined.back(), joined.back().length_m);
  EXPECT_NEAR(end.x_m, rest.front().start.x_m, 1e-12);
  EXPECT_NEAR(end.y_m, rest.front().start.y_m, 1e-12);
  EXPECT_LT(rest.back().length_m, 0.0);
  EXPECT_TRUE(part_of(path, 2.0, 2.0).empty());
}

TEST(PlanSplice, NodesAreFoundAgainOnTheirPathThroughArcsAndCusps) {
  const DrivePath path{{{0.0, 0.0, 0.3}, 0.2, 4.0},
                       {pose_along({{0.0, 0.0, 0.3}, 0.2, 4.0}, 4.0), -0.2, -3.0}};
  std::vector<WholeBodyNode> nodes;
  std::vector<double> expected;
  for (const Station& station : path_stations(path, 0.2)) {
    WholeBodyNode node;
    node.q = Eigen::VectorXd::Zero(kNumBaseCoordinates);
    node.q[kBaseX] = station.pose.x_m;
    node.q[kBaseY] = station.pose.y_m;
    nodes.push_back(node);
    expected.push_back(station.s_m);
  }
  const std::vector<double> found = distances_along(path, nodes);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-6) << i;
}

TEST(Replan, AChangeBesideTheWayLeavesThePlanAsItIs) {
  const PlanMemory& before = over_flat();
  const TerrainMap after =
      make_map(kLengthM, kWidthM, with_block(flat(), square(0.0, 7.0, 3.0), 0.3));
  const auto replanned = replan(before, after, test_machine(), quick_settings());
  ASSERT_TRUE(replanned);
  EXPECT_EQ(replanned->outcome, ReplanOutcome::kUntouched);
  ASSERT_EQ(replanned->memory.plan.nodes.size(), before.plan.nodes.size());
  EXPECT_EQ(replanned->memory.plan.nodes.back().q, before.plan.nodes.back().q);
  EXPECT_EQ(violation(after, replanned->memory.plan), "");
}

TEST(Replan, GroundLoweredBetweenTheTracksIsCheckedAgainAndHolds) {
  const TerrainMap after =
      make_map(kLengthM, kWidthM, with_block(flat(), square(0.0, 0.0, 0.4), -0.1));
  const auto replanned = replan(over_flat(), after, test_machine(), quick_settings());
  ASSERT_TRUE(replanned);
  EXPECT_EQ(replanned->outcome, ReplanOutcome::kStillGood);
  EXPECT_GT(replanned->num_touched, 0U);
  EXPECT_LT(replanned->num_touched, over_flat().plan.nodes.size());
  EXPECT_EQ(violation(after, replanned->memory.plan), "");
}

TEST(Replan, ABlockUnderTheChassisIsNoticedThoughNoWheelMeetsIt) {
  const TerrainMap after =
      make_map(kLengthM, kWidthM, with_block(flat(), square(0.0, 0.0, 0.4), 0.8));
  const auto replanned = replan(over_flat(), after, test_machine(), quick_settings());
  ASSERT_TRUE(replanned);
  EXPECT_GE(replanned->outcome, ReplanOutcome::kNewStretch);
  EXPECT_NE(violation(after, over_flat().plan), "");
  EXPECT_EQ(violation(after, replanned->memory.plan), "");
}

TEST(Replan, ABlockOnTheWayChangesOnlyTheStretchAroundIt) {
  const PlanMemory& before = over_flat();
  const GroundRect rect = square(0.0, 0.0, 3.16);
  const TerrainMap after = make_map(kLengthM, kWidthM, with_block(flat(), rect, 0.3));
  ASSERT_NE(violation(after, before.plan), "");
  const auto replanned = replan(before, after, test_machine(), quick_settings(), rect);
  ASSERT_TRUE(replanned) << replanned.error().message;
  const Plan& plan = replanned->memory.plan;
  EXPECT_EQ(replanned->outcome, ReplanOutcome::kNewStretch);
  EXPECT_EQ(violation(after, plan), "");
  EXPECT_GT(replanned->num_unsound, 0U);
  EXPECT_LT(replanned->num_replaced, before.plan.nodes.size());
  // Far from the block nothing is different but the time.
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(plan.nodes[i].q, before.plan.nodes[i].q) << i;
  EXPECT_EQ(plan.nodes.back().q.head<3>(), before.plan.nodes.back().q.head<3>());
  EXPECT_GT(plan.cost, before.plan.cost);
  EXPECT_NEAR(plan.path_length_m, path_length_m(replanned->memory.paths.back()), 1e-9);
}

TEST(Replan, TheRectangleNeedNotBeGiven) {
  const GroundRect rect = square(0.0, 0.0, 3.16);
  const TerrainMap after = make_map(kLengthM, kWidthM, with_block(flat(), rect, 0.3));
  const auto given = replan(over_flat(), after, test_machine(), quick_settings(), rect);
  const auto found = replan(over_flat(), after, test_machine(), quick_settings());
  ASSERT_TRUE(given && found);
  EXPECT_EQ(given->num_touched, found->num_touched);
  ASSERT_EQ(given->memory.plan.nodes.size(), found->memory.plan.nodes.size());
  for (std::size_t i = 0; i < given->memory.plan.nodes.size(); ++i) {
    ASSERT_EQ(given->memory.plan.nodes[i].q, found->memory.plan.nodes[i].q) << i;
  }
}

TEST(Replan, WhatWasReplannedCanBeReplannedAgainBackAndForth) {
  const GroundRect rect = square(0.0, 0.0, 3.16);
  const TerrainMap blocked = make_map(kLengthM, kWidthM, with_block(flat(), rect, 0.3));
  const auto first = replan(over_flat(), blocked, test_machine(), quick_settings());
  ASSERT_TRUE(first);
  const TerrainMap free = make_map(kLengthM, kWidthM, flat());
  const auto second = replan(first->memory, free, test_machine(), quick_settings());
  ASSERT_TRUE(second);
  EXPECT_EQ(violation(free, second->memory.plan), "");
}

TEST(Replan, ALandingPlaceThatIsRaisedIsSteppedOntoAnew) {
  const PlanMemory& before = over_gap();
  ASSERT_GE(num_lifts(before.plan), 4U);
  const TerrainMap after =
      make_map(kLengthM, kWidthM, with_block(gap(1.2), square(2.2, 0.0, 3.16), 0.2));
  ASSERT_NE(violation(after, before.plan), "");
  const auto replanned = replan(before, after, test_machine(), quick_settings());
  ASSERT_TRUE(replanned) << replanned.error().message;
  EXPECT_EQ(violation(after, replanned->memory.plan), "");
  EXPECT_GE(num_lifts(replanned->memory.plan), 4U);
}

TEST(Replan, TheFloorOfAGapThatNothingReachesMayChange) {
  const TerrainMap after =
      make_map(kLengthM, kWidthM, with_block(gap(1.2), square(0.0, 0.0, 0.5), 0.4));
  const auto replanned = replan(over_gap(), after, test_machine(), quick_settings());
  ASSERT_TRUE(replanned) << replanned.error().message;
  EXPECT_EQ(replanned->outcome, ReplanOutcome::kStillGood);
  EXPECT_EQ(violation(after, replanned->memory.plan), "");
}

TEST(Replan, AGoalThatCannotBeStoodOnIsSaidToBe) {
  const TerrainMap after =
      make_map(kLengthM, kWidthM, with_block(flat(), square(12.0 + 2.4, 1.2, 1.0), 2.0));
  const auto replanned = replan(over_flat(), after, test_machine(), quick_settings());
  ASSERT_FALSE(replanned);
  EXPECT_EQ(replanned.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(replanned.error().message, testing::HasSubstr("the goal"));
}

TEST(Replan, AMapOfAnotherSizeIsRefused) {
  const auto replanned = replan(over_flat(), make_map(30.0, 20.0, flat()), test_machine());
  ASSERT_FALSE(replanned);
  EXPECT_EQ(replanned.error().code, ErrorCode::kBadInput);
}

TEST(Replan, NodesThatAreNotTouchedAreAsSoundAsBefore) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> x(-10.0, 10.0), y(-4.0, 4.0), height(-0.5, 0.5);
  std::size_t num_unsound = 0;
  std::vector<std::size_t> all(over_gap().plan.nodes.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  for (int k = 0; k < 8; ++k) {
    const GroundRect rect = square(x(random), y(random), 1.5);
    const TerrainMap after =
        make_map(kLengthM, kWidthM, with_block(gap(1.2), rect, height(random)));
    const auto change = GroundChange::between(over_gap().terrain, after, std::nullopt);
    ASSERT_TRUE(change);
    const auto touched = touched_nodes(over_gap().reach, *change);
    const auto unsound = unsound_on_changed_ground(
        {over_gap().plan, test_machine(), *over_gap().shape, over_gap().terrain, after}, all, {});
    const auto unsound_of_parts =
        unsound_on_changed_ground({over_gap().plan, test_machine(), *over_gap().shape,
                                   over_gap().terrain, after, &over_gap().reach, &*change},
                                  all, {});
    EXPECT_EQ(unsound_of_parts, unsound);
    num_unsound += unsound.size();
    EXPECT_THAT(touched, testing::IsSupersetOf(unsound));
  }
  EXPECT_GT(num_unsound, 0U) << "nothing was tested";
}

}  // namespace
}  // namespace wex
