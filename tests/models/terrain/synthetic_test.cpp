#include "models/terrain/synthetic.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/models/terrain/terrain_fixtures.hpp"

namespace wex {
namespace {

SyntheticTerrain made(const std::string& kind, double difficulty, std::uint64_t seed) {
  auto terrain = make_synthetic_terrain(kind, difficulty, seed);
  EXPECT_TRUE(terrain.has_value());
  return std::move(*terrain);
}

TerrainMap map_of(const SyntheticTerrain& terrain) {
  return *TerrainMap::build(terrain.raster.elevation, {}, terrain.raster.map_origin_m);
}

/// Height of the cell around a point of the map frame.
float height_at(const SyntheticTerrain& terrain, double x_m, double y_m) {
  const Grid& grid = terrain.raster.elevation;
  return grid.at(static_cast<int>(x_m / grid.cell_m), static_cast<int>(y_m / grid.cell_m));
}

/// Length over which the heights along y = y_m are within 1 mm of `height_m`.
double length_at_height(const SyntheticTerrain& terrain, double y_m, double height_m) {
  const Grid& grid = terrain.raster.elevation;
  const int j = static_cast<int>(y_m / grid.cell_m);
  int count = 0;
  for (int i = 0; i < grid.size_x; ++i) {
    if (std::abs(grid.at(i, j) - height_m) < 1e-3) ++count;
  }
  return count * grid.cell_m;
}

std::pair<float, float> range_of(const SyntheticTerrain& terrain) {
  const auto& values = terrain.raster.elevation.values;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return {*low, *high};
}

TEST(SyntheticTerrain, OfEveryKindIsTheSameForTheSameSeed) {
  for (const std::string& kind : synthetic_kinds()) {
    const SyntheticTerrain first = made(kind, 0.4, 17);
    const SyntheticTerrain second = made(kind, 0.4, 17);
    EXPECT_EQ(first.raster.elevation.values, second.raster.elevation.values) << kind;
    EXPECT_EQ(first.task, second.task) << kind;
    EXPECT_NE(first.task, made(kind, 0.4, 18).task) << kind;
  }
}

TEST(SyntheticTerrain, IsTheSameOnEveryMachine) {
  // Values of the first release; a change here changes every recorded result.
  const SyntheticTerrain rough = made("rough", 0.5, 1);
  EXPECT_FLOAT_EQ(height_at(rough, 0.05, 0.05), 0.294F);
  EXPECT_FLOAT_EQ(height_at(rough, 15.05, 8.05), -0.006F);
  EXPECT_DOUBLE_EQ(rough.task.start.y_m, 7.6832626213335837);
}

TEST(SyntheticTerrain, HasTheSizesOfTheTestField) {
  for (const std::string& kind : synthetic_kinds()) {
    const SyntheticTerrain terrain = made(kind, 0.0, 3);
    const Grid& grid = terrain.raster.elevation;
    const bool is_hole = kind == "hole";
    EXPECT_EQ(grid.size_x, is_hole ? 360 : 300) << kind;
    EXPECT_EQ(grid.size_y, is_hole ? 240 : 160) << kind;
    EXPECT_EQ(grid.cell_m, 0.1);
    // The outer corner of the first cell is the map frame's zero.
    const Eigen::Vector2d corner =
        terrain.raster.map_origin_m + grid.origin_m - Eigen::Vector2d(0.05, 0.05);
    EXPECT_NEAR(corner.norm(), 0.0, 1e-9) << kind;
  }
}

TEST(SyntheticTerrain, DrawsStartAndGoalAroundTheRoute) {
  double lowest = 1e9, highest = -1e9;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const SyntheticTerrain terrain = made("flat", 0.0, seed);
    EXPECT_DOUBLE_EQ(terrain.task.start.x_m, 7.5);
    EXPECT_DOUBLE_EQ(terrain.task.goal.x_m, 22.5);
    for (const Pose2& pose : {terrain.task.start, terrain.task.goal}) {
      EXPECT_LE(std::abs(pose.y_m - 8.0), 1.0);
      EXPECT_LE(std::abs(pose.yaw_rad), 10.0 * M_PI / 180.0);
      lowest = std::min(lowest, pose.y_m);
      highest = std::max(highest, pose.y_m);
    }
  }
  EXPECT_LT(lowest, 7.05);
  EXPECT_GT(highest, 8.95);
}

TEST(SyntheticTerrain, LeavesRoomAroundStartAndGoal) {
  for (const std::string& kind : synthetic_kinds()) {
    const SyntheticTerrain terrain = made(kind, 0.0, 5);
    const Grid& grid = terrain.raster.elevation;
    const Eigen::Vector2d size = grid.cell_m * Eigen::Vector2d(grid.size_x, grid.size_y);
    for (const Pose2& pose : {terrain.task.start, terrain.task.goal}) {
      EXPECT_GE(std::min({pose.x_m, pose.y_m, size.x() - pose.x_m, size.y() - pose.y_m}), 4.5)
          << kind;
    }
  }
}

TEST(SyntheticTerrain, FlatIsFlat) {
  EXPECT_EQ(range_of(made("flat", 1.0, 2)), std::make_pair(0.0F, 0.0F));
}

TEST(SyntheticTerrain, RoughSpansItsWholeAmplitude) {
  for (const double difficulty : {0.0, 0.3, 1.0}) {
    const auto amplitude = static_cast<float>(0.25 + 1.75 * difficulty);
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const auto [low, high] = range_of(made("rough", difficulty, seed));
      EXPECT_NEAR(low, -amplitude, 6e-4);
      EXPECT_NEAR(high, amplitude, 6e-4);
    }
  }
}

TEST(SyntheticTerrain, RoughHasTheSlopesOfItsDifficulty) {
  const std::vector<std::pair<double, double>> expected_p95_deg{
      {0.0, 6.0}, {0.25, 17.0}, {0.5, 26.0}, {0.75, 34.0}, {1.0, 41.0}};
  constexpr int kSeeds = 4;
  for (const auto& [difficulty, expected_deg] : expected_p95_deg) {
    double sum_deg = 0.0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      std::vector<float> slope = map_of(made("rough", difficulty, seed)).slope().values;
      const auto p95 = slope.begin() + static_cast<std::ptrdiff_t>(slope.size() * 95 / 100);
      std::nth_element(slope.begin(), p95, slope.end());
      sum_deg += *p95 * 180.0 / M_PI;
    }
    EXPECT_NEAR(sum_deg / kSeeds, expected_deg, 0.12 * expected_deg) << difficulty;
  }
}

TEST(SyntheticTerrain, RoughOfLowDifficultyHasTraversableStartAndGoal) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const SyntheticTerrain terrain = made("rough", 0.15, seed);
    const TerrainMap map = map_of(terrain);
    for (const Pose2& pose : {terrain.task.start, terrain.task.goal}) {
      EXPECT_TRUE(map.traversable_at(Eigen::Vector2d(pose.x_m, pose.y_m) - map.map_origin_m()));
    }
  }
}

TEST(SyntheticTerrain, GapIsTwoMetresDeepOverTheFullWidth) {
  for (const auto& [difficulty, width_m] :
       std::vector<std::pair<double, double>>{{0.0, 1.0}, {0.5, 2.25}, {1.0, 3.5}}) {
    const SyntheticTerrain terrain = made("gap", difficulty, 4);
    EXPECT_EQ(range_of(terrain), std::make_pair(-2.0F, 0.0F));
    for (const double y_m : {0.05, 8.05, 15.95}) {
      // The skew of at most 5 degrees lengthens the cut by 0.4 percent.
      EXPECT_NEAR(length_at_height(terrain, y_m, -2.0), width_m, 0.11) << difficulty;
    }
  }
}

TEST(SyntheticTerrain, SkewsObstaclesBySeedAndByFiveDegreesAtMost) {
  double largest = 0.0;
  double first_middle = 0.0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const Grid grid = made("gap", 0.5, seed).raster.elevation;
    const auto first_low = [&](int j) {
      int i = 0;
      while (grid.at(i, j) > -1.0F) ++i;
      return i * grid.cell_m;
    };
    const double shift_m = first_low(0) - first_low(grid.size_y - 1);
    largest = std::max(largest, std::abs(shift_m));
    first_middle = first_low(80);
    EXPECT_NEAR(first_middle, 15.0 - 1.125, 0.15);
  }
  EXPECT_LE(largest, std::tan(5.0 * M_PI / 180.0) * 16.0 + 0.1);
  EXPECT_GE(largest, 1.0);
}

TEST(SyntheticTerrain, StepIsABlockOfEightMetres) {
  for (const auto& [difficulty, height_m] :
       std::vector<std::pair<double, double>>{{0.0, 0.5}, {0.5, 1.0}, {1.0, 1.5}}) {
    const SyntheticTerrain terrain = made("step", difficulty, 4);
    EXPECT_NEAR(length_at_height(terrain, 8.05, height_m), 8.0, 0.11);
    EXPECT_NEAR(range_of(terrain).second, height_m, 1e-6);
    EXPECT_EQ(range_of(terrain).first, 0.0F);
  }
}

TEST(SyntheticTerrain, WallIsHalfAMetreHighAndFortyCentimetresThick) {
  const SyntheticTerrain terrain = made("wall", 0.0, 4);
  EXPECT_NEAR(length_at_height(terrain, 8.05, 0.5), 0.4, 0.11);
}

TEST(SyntheticTerrain, RampRisesTwoMetresOverEight) {
  const SyntheticTerrain terrain = made("ramp", 0.0, 4);
  EXPECT_EQ(height_at(terrain, 7.5, 8.0), 0.0F);
  EXPECT_EQ(height_at(terrain, 22.5, 8.0), 2.0F);
  EXPECT_NEAR(height_at(terrain, 15.0, 8.0), 1.0F, 0.05);
  EXPECT_NEAR(map_of(terrain).slope().at(150, 80), std::atan(0.25), 1e-3);
}

TEST(SyntheticTerrain, SideSlopeRisesFifteenDegreesAcrossTheRoute) {
  const TerrainMap map = map_of(made("side_slope", 0.0, 4));
  const Eigen::Vector3d expected(0.0, -std::sin(M_PI / 12.0), std::cos(M_PI / 12.0));
  EXPECT_NEAR((map.filtered_normal({0.0, 0.0}) - expected).norm(), 0.0, 1e-4);
}

TEST(SyntheticTerrain, HoleIsCrossedByANeckOneMetreWideAndThreeLong) {
  const SyntheticTerrain terrain = made("hole", 0.0, 4);
  EXPECT_NEAR(length_at_height(terrain, 0.05, -2.0), 3.0, 0.11);
  EXPECT_NEAR(length_at_height(terrain, 12.05, -2.0), 0.0, 1e-9);
  int neck_cells = 0;
  for (double y_m = 0.05; y_m < 24.0; y_m += 0.1) {
    if (height_at(terrain, 18.05, y_m) == 0.0F) ++neck_cells;
  }
  EXPECT_NEAR(neck_cells * 0.1, 1.0, 0.11);
  EXPECT_NEAR(std::hypot(terrain.task.goal.x_m - terrain.task.start.x_m,
                         terrain.task.goal.y_m - terrain.task.start.y_m),
              28.2, 1.0);
}

TEST(SyntheticTerrain, BridgeIsOneAndAHalfMetresWideOverAPit) {
  const SyntheticTerrain terrain = made("bridge", 0.0, 4);
  EXPECT_NEAR(length_at_height(terrain, 2.05, -2.0), 2.0, 0.11);
  int bridge_cells = 0;
  for (double y_m = 0.05; y_m < 16.0; y_m += 0.1) {
    if (height_at(terrain, 15.05, y_m) == 0.0F) ++bridge_cells;
  }
  EXPECT_NEAR(bridge_cells * 0.1, 1.5, 0.11);
}

TEST(SyntheticTerrain, RefusesUnknownKindsListingTheKnown) {
  const auto terrain = make_synthetic_terrain("moon", 0.5, 1);
  ASSERT_FALSE(terrain.has_value());
  EXPECT_EQ(terrain.error().code, ErrorCode::kBadInput);
  EXPECT_NE(terrain.error().message.find("flat, rough, gap, step, hole, ramp, wall, bridge, "
                                         "side_slope"),
            std::string::npos);
}

TEST(SyntheticTerrain, RefusesDifficultiesOutsideZeroToOne) {
  for (const double difficulty : {-0.1, 1.01, std::nan(""), HUGE_VAL}) {
    const auto terrain = make_synthetic_terrain("rough", difficulty, 1);
    ASSERT_FALSE(terrain.has_value());
    EXPECT_NE(terrain.error().message.find("from 0 to 1"), std::string::npos);
  }
}

}  // namespace
}  // namespace wex
