#include "initializer/drive_path.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "initializer/internal/direct_paths.hpp"
#include "initializer/internal/se2_search.hpp"

namespace wex {
namespace {

constexpr double kRadiusM = 4.5;

void expect_near(const Pose2& a, const Pose2& b, double tolerance) {
  EXPECT_NEAR(a.x_m, b.x_m, tolerance);
  EXPECT_NEAR(a.y_m, b.y_m, tolerance);
  EXPECT_NEAR(wrap_angle(a.yaw_rad - b.yaw_rad), 0.0, tolerance);
}

TEST(DrivePath, QuarterCircleToTheLeftEndsOneRadiusAheadAndBeside) {
  const PathSegment arc{{0.0, 0.0, 0.0}, 1.0 / kRadiusM, 0.5 * std::numbers::pi * kRadiusM};
  expect_near(pose_along(arc, arc.length_m), {kRadiusM, kRadiusM, 0.5 * std::numbers::pi}, 1e-12);
}

TEST(DrivePath, DrivingBackwardsWithWheelsToTheLeftTurnsTheNoseRight) {
  const PathSegment arc{{0.0, 0.0, 0.0}, 1.0 / kRadiusM, -1.0};
  EXPECT_NEAR(pose_along(arc, arc.length_m).yaw_rad, -1.0 / kRadiusM, 1e-12);
}

TEST(DrivePath, ReedsSheppPathsEndAtTheirGoal) {
  for (const Pose2& goal : {Pose2{15.0, 1.0, 0.1}, Pose2{0.0, 3.0, 0.0}, Pose2{-4.0, 0.5, 2.5},
                            Pose2{1.0, -1.0, -3.0}, Pose2{0.0, 0.0, 1.5}}) {
    const Pose2 start{0.3, -0.2, 9.0};  // more than a whole turn: must be kept
    const DrivePath path = reeds_shepp_path(start, goal, kRadiusM);
    EXPECT_EQ(path.front().start, start);
    for (std::size_t i = 1; i < path.size(); ++i) {
      EXPECT_NEAR(pose_along(path[i - 1], path[i - 1].length_m).yaw_rad, path[i].start.yaw_rad,
                  1e-9);
    }
    expect_near(pose_along(path.back(), path.back().length_m), goal, 1e-6);
  }
}

TEST(DrivePath, DirectPathsAllReachTheGoalAndTheCheapestComesFirst) {
  const PathCostWeights weights;
  for (const Pose2& goal : {Pose2{15.0, 1.0, 0.1}, Pose2{-12.0, 3.0, 0.2}, Pose2{2.0, 6.0, 3.0}}) {
    const Pose2 start{0.3, -0.2, -7.0};
    const auto paths = direct_paths(start, goal, kRadiusM, weights);
    ASSERT_GE(paths.size(), 2U);
    ASSERT_LE(paths.size(), 3U);
    for (std::size_t k = 1; k < paths.size(); ++k) EXPECT_FALSE(same_way(paths[k - 1], paths[k]));
    int num_forward = 0, num_reverse = 0;
    for (std::size_t k = 0; k < paths.size(); ++k) {
      const DrivePath& path = paths[k];
      expect_near(path.front().start, start, 1e-6);
      EXPECT_NEAR(path.front().start.yaw_rad, start.yaw_rad, 1e-9);
      for (std::size_t i = 1; i < path.size(); ++i) {
        const Pose2 end = pose_along(path[i - 1], path[i - 1].length_m);
        expect_near(end, path[i].start, 1e-9);
        EXPECT_NEAR(end.yaw_rad, path[i].start.yaw_rad, 1e-9);
      }
      expect_near(pose_along(path.back(), path.back().length_m), goal, 1e-6);
      if (k > 0) {
        EXPECT_GE(path_cost_m(path, weights), path_cost_m(paths[k - 1], weights));
      }
      const auto all = [&](double gear) {
        return std::all_of(path.begin(), path.end(), [&](const PathSegment& segment) {
          return gear * segment.length_m >= -1e-9;
        });
      };
      num_forward += all(1.0);
      num_reverse += all(-1.0);
    }
    EXPECT_GE(num_forward, 1);
    EXPECT_GE(num_reverse, 1);
  }
}

TEST(DrivePath, StraightAheadThereIsOneDirectPathForwardsAndTheLongOneInReverse) {
  const auto paths = direct_paths({0.0, 0.0, 0.0}, {10.0, 0.0, 0.0}, kRadiusM, {});
  ASSERT_EQ(paths.size(), 2U);
  EXPECT_NEAR(path_length_m(paths.front()), 10.0, 1e-9);
  EXPECT_GT(path_length_m(paths.back()), 30.0);
}

TEST(DrivePath, TheSameWayIsToldWithoutItsEmptySegments) {
  const Pose2 start{0.0, 0.0, 0.0};
  const PathSegment ahead{start, 0.0, 3.0}, nothing{start, 0.2, 1e-9}, left{start, 0.2, 1.0};
  EXPECT_TRUE(same_way({nothing, ahead, left}, {ahead, nothing, left, nothing}));
  EXPECT_FALSE(same_way({ahead, left}, {ahead}));
  EXPECT_FALSE(same_way({ahead}, {{start, 0.0, -3.0}}));
  EXPECT_FALSE(same_way({ahead}, {{start, 0.1, 3.0}}));
  EXPECT_TRUE(same_way({}, {nothing}));
}

TEST(DrivePath, ReversingAndChangesOfDirectionCostExtra) {
  const PathCostWeights weights{.cusp_m = 1.5, .reverse_share = 0.2};
  const DrivePath path{{{0.0, 0.0, 0.0}, 0.0, 3.0}, {{3.0, 0.0, 0.0}, 0.0, -2.0}};
  EXPECT_DOUBLE_EQ(path_length_m(path), 5.0);
  EXPECT_DOUBLE_EQ(path_cost_m(path, weights), 3.0 + 1.5 + 2.0 * 1.2);
}

TEST(DrivePath, StationsAreCloseTogetherAndStopAtEndsAndCusps) {
  const DrivePath path = reeds_shepp_path({0.0, 0.0, 0.0}, {0.0, 2.0, 0.0}, kRadiusM);
  const auto stations = path_stations(path, 0.2);
  int num_stops = 0;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    num_stops += stations[i].stop;
    if (i == 0) continue;
    EXPECT_LE(stations[i].s_m - stations[i - 1].s_m, 0.2 + 1e-9);
    EXPECT_GT(stations[i].s_m, stations[i - 1].s_m);
    EXPECT_FALSE(stations[i].stop && stations[i - 1].stop) << "no room to move at station " << i;
  }
  EXPECT_NEAR(stations.back().s_m, path_length_m(path), 1e-5);
  EXPECT_GE(num_stops, 3) << "moving sideways takes at least one change of direction";
  EXPECT_TRUE(stations.front().stop && stations.back().stop);
}

TEST(DrivePath, SteeredCurvatureStartsAtZeroChangesGraduallyAndReachesTheArcs) {
  const DrivePath path{{{0.0, 0.0, 0.0}, 1.0 / kRadiusM, 5.0},
                       {{0.0, 0.0, 0.0}, -1.0 / kRadiusM, 5.0}};
  const auto stations = path_stations(path, 0.1);
  const auto curvature = steered_curvature_1_m(path, stations, 2.0);
  EXPECT_EQ(curvature.front(), 0.0);
  EXPECT_NEAR(curvature[25], 1.0 / kRadiusM, 1e-12);  // 2.5 m: the middle of the first arc
  EXPECT_NEAR(curvature[50], 0.0, 1e-12);             // where one arc meets the other
  EXPECT_NEAR(curvature[75], -1.0 / kRadiusM, 1e-12);
  for (std::size_t i = 1; i < curvature.size(); ++i) {
    EXPECT_LT(std::abs(curvature[i] - curvature[i - 1]), 0.16 / kRadiusM);
  }
}

TEST(DrivePath, MovingAverageKeepsStraightLinesAndEndValuesAndTamesSteps) {
  std::vector<double> s, line, step;
  for (int i = 0; i <= 40; ++i) {
    s.push_back(0.1 * i + (i % 3) * 0.01);
    line.push_back(2.0 - 3.0 * s.back());
    step.push_back(i < 20 ? 0.0 : 1.0);
  }
  const auto mean_line = moving_average(s, line, 1.0);
  for (std::size_t i = 0; i < s.size(); ++i) EXPECT_NEAR(mean_line[i], line[i], 1e-9);
  const auto mean_step = moving_average(s, step, 1.0);
  EXPECT_NEAR(mean_step.front(), 0.0, 1e-12);
  EXPECT_NEAR(mean_step.back(), 1.0, 1e-12);
  for (std::size_t i = 1; i < s.size(); ++i) EXPECT_LT(mean_step[i] - mean_step[i - 1], 0.15);
}

}  // namespace
}  // namespace wex
