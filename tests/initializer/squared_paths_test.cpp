#include "initializer/internal/squared_paths.hpp"

#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "test_worlds.hpp"

namespace wex {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// A machine of four points: no wheel 0.15 m from good ground must carry, an axle at most is
/// lifted.
PoseFootholds four_points(const TerrainMap& map) {
  return [&map](const Pose2& pose, double) {
    const double c = std::cos(pose.yaw_rad), s = std::sin(pose.yaw_rad);
    std::array<bool, 2> axle_stands{};
    for (const int axle : {0, 1}) {
      const double x = axle == 0 ? 2.4 : -2.3;
      bool stands = true;
      for (const double y : {-1.25, 1.25}) {
        const Eigen::Vector2d p(pose.x_m + c * x - s * y, pose.y_m + s * x + c * y);
        const double distance_m = map.signed_distance_m(p);
        if (std::isnan(distance_m)) return Footholds::kNone;
        stands = stands && distance_m >= 0.15;
      }
      axle_stands[static_cast<std::size_t>(axle)] = stands;
    }
    if (axle_stands[0] && axle_stands[1]) return Footholds::kAllWheels;
    return axle_stands[0] || axle_stands[1] ? Footholds::kSomeWheels : Footholds::kNone;
  };
}

SearchSettings settings_for(const TerrainMap& map) {
  SearchSettings settings;
  settings.x_min_m = map.min_corner_m().x();
  settings.x_max_m = map.max_corner_m().x();
  settings.y_min_m = map.min_corner_m().y();
  settings.y_max_m = map.max_corner_m().y();
  return settings;
}

std::vector<DrivePath> paths_on(const TerrainMap& map, const Pose2& start, const Pose2& goal,
                                std::size_t max_paths = 6) {
  return squared_paths(map, start, goal, settings_for(map), four_points(map), max_paths);
}

/// A ditch whose sides no wheel may stand on, the edge of its level banks at +-half_width.
double ditch(double across_m, double half_width_m) {
  return std::min(0.0, 3.0 * (std::abs(across_m) - half_width_m));
}

/// A ditch 2 m wide through the map's middle, met squarely at a heading of `skew_rad`.
TerrainMap gap_at(double skew_rad) {
  const double c = std::cos(skew_rad), s = std::sin(skew_rad);
  return make_map(36.0, 24.0, [=](double x, double y) { return ditch(c * x + s * y, 1.0); });
}

/// Ends meet ends, the first at the start, the last at the goal.
void expect_joined(const DrivePath& path, const Pose2& start, const Pose2& goal) {
  ASSERT_FALSE(path.empty());
  const auto expect_same = [](const Pose2& a, const Pose2& b) {
    EXPECT_NEAR(a.x_m, b.x_m, 1e-6);
    EXPECT_NEAR(a.y_m, b.y_m, 1e-6);
    EXPECT_NEAR(wrap_angle(a.yaw_rad - b.yaw_rad), 0.0, 1e-6);
  };
  expect_same(path.front().start, start);
  for (std::size_t i = 1; i < path.size(); ++i) {
    expect_same(pose_along(path[i - 1], path[i - 1].length_m), path[i].start);
  }
  expect_same(pose_along(path.back(), path.back().length_m), goal);
}

/// Every pose has footholds; where wheels are lifted the path is straight and heads like `yaw_rad`.
void expect_square(const TerrainMap& map, const DrivePath& path, double yaw_rad) {
  const PoseFootholds footholds = four_points(map);
  int lifted = 0;
  for (const PathSegment& segment : path) {
    const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(segment.length_m) / 0.1)));
    for (int k = 0; k <= steps; ++k) {
      const Pose2 pose = pose_along(segment, segment.length_m * k / steps);
      const Footholds feet = footholds(pose, segment.curvature_1_m);
      EXPECT_NE(feet, Footholds::kNone) << pose.x_m << " " << pose.y_m;
      if (feet != Footholds::kSomeWheels) continue;
      ++lifted;
      EXPECT_EQ(segment.curvature_1_m, 0.0);
      EXPECT_LT(std::abs(wrap_angle(pose.yaw_rad - yaw_rad)), 2.0 * kDegree);
    }
  }
  EXPECT_GT(lifted, 0) << "it does not cross";
}

TEST(SquaredPaths, CrossAGapAtTenDegreesWithinTwoDegreesOfSquare) {
  for (const double skew : {10.0 * kDegree, -10.0 * kDegree}) {
    SCOPED_TRACE(skew);
    const TerrainMap map = gap_at(skew);
    const Pose2 start{-9.0, 0.5, 0.05}, goal{9.0, -0.5, -0.05};
    const auto paths = paths_on(map, start, goal);
    ASSERT_FALSE(paths.empty());
    for (const DrivePath& path : paths) {
      expect_joined(path, start, goal);
      expect_square(map, path, skew);
    }
  }
}

TEST(SquaredPaths, TurnOutOfAStartAndIntoAGoalAlongTheEdge) {
  const TerrainMap map = gap_at(0.0);
  for (const double yaw : {90.0 * kDegree, -90.0 * kDegree}) {
    SCOPED_TRACE(yaw);
    const Pose2 start{-7.5, 1.0, yaw}, goal{7.5, -1.0, yaw};
    const auto paths = paths_on(map, start, goal);
    ASSERT_FALSE(paths.empty());
    expect_joined(paths.front(), start, goal);
    expect_square(map, paths.front(), 0.0);
  }
}

TEST(SquaredPaths, CheapestFirstAndNoMoreThanAskedFor) {
  const TerrainMap map = gap_at(5.0 * kDegree);
  const Pose2 start{-9.0, 2.0, 0.3}, goal{9.0, -1.0, -0.2};
  const auto all = paths_on(map, start, goal, 20), some = paths_on(map, start, goal, 2);
  ASSERT_GT(all.size(), 2U);
  for (std::size_t i = 1; i < all.size(); ++i) {
    EXPECT_LE(path_cost_m(all[i - 1], {}), path_cost_m(all[i], {}));
  }
  ASSERT_EQ(some.size(), 2U);
  EXPECT_EQ(path_cost_m(some.front(), {}), path_cost_m(all.front(), {}));
}

TEST(SquaredPaths, NoneWithoutAnEdge) {
  const TerrainMap map = flat_map();
  EXPECT_TRUE(paths_on(map, {-7.5, 0.0, 0.0}, {7.5, 0.0, 0.0}).empty());
}

TEST(SquaredPaths, NoneFromAPlaceToItself) {
  const TerrainMap map = gap_at(0.0);
  EXPECT_TRUE(paths_on(map, {-7.5, 0.0, 0.0}, {-7.5, 0.0, 0.0}).empty());
}

TEST(SquaredPaths, NoneOverWhatIsWiderThanTheWheelbase) {
  const TerrainMap map = make_map(36.0, 24.0, [](double x, double) { return ditch(x, 3.0); });
  EXPECT_TRUE(paths_on(map, {-9.0, 0.0, 0.0}, {9.0, 0.0, 0.0}).empty());
}

TEST(SquaredPaths, MirroredTerrainGivesMirroredPaths) {
  const TerrainMap left = gap_at(8.0 * kDegree), right = gap_at(-8.0 * kDegree);
  const auto a = paths_on(left, {-9.0, 1.0, 0.4}, {9.0, 0.5, -0.1});
  const auto b = paths_on(right, {-9.0, -1.0, -0.4}, {9.0, -0.5, 0.1});
  ASSERT_FALSE(a.empty());
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(path_cost_m(a[i], {}), path_cost_m(b[i], {}), 0.02);
  }
}

}  // namespace
}  // namespace wex
