#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "models/terrain/draw_task.hpp"
#include "models/terrain/synthetic.hpp"
#include "tests/models/terrain/terrain_fixtures.hpp"

namespace wex {
namespace {

const std::filesystem::path kScenarios = WEX_SCENARIOS_DIR;

TEST(Scenarios, RoughDemoIsWhatTheGeneratorMakes) {
  const auto made = make_synthetic_terrain("rough", 0.15, 1);
  const auto read = read_raster(kScenarios / "rough_demo.asc");
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->elevation.values, made->raster.elevation.values);
  EXPECT_EQ(read->map_origin_m, made->raster.map_origin_m);
  EXPECT_NEAR((read->elevation.origin_m - made->raster.elevation.origin_m).norm(), 0.0, 1e-9);
  EXPECT_EQ(*read_task(kScenarios / "rough_demo.json"), made->task);
}

class EveryScenario : public testing::TestWithParam<const char*> {};

TEST_P(EveryScenario, HasATaskOnTraversableGround) {
  const std::string map_file = GetParam();
  const auto raster = read_raster(kScenarios / map_file);
  ASSERT_TRUE(raster.has_value()) << raster.error().message;
  const auto map = TerrainMap::build(raster->elevation, {}, raster->map_origin_m);
  const auto task = read_task((kScenarios / map_file).replace_extension(".json"));
  ASSERT_TRUE(map.has_value() && task.has_value());
  for (const Pose2& pose : {task->start, task->goal}) {
    const Eigen::Vector2d p_world = Eigen::Vector2d(pose.x_m, pose.y_m) - map->map_origin_m();
    EXPECT_GE(map->signed_distance_m(p_world), 3.0);
  }
}

INSTANTIATE_TEST_SUITE_P(All, EveryScenario,
                         testing::Values("rough_demo.asc", "real_minnesota.tif"));

class RealMap : public testing::Test {
 protected:
  Result<Raster> raster = read_raster(kScenarios / "real_minnesota.tif");
  Result<TerrainMap> map = TerrainMap::build(raster->elevation, {}, raster->map_origin_m);
};

TEST_F(RealMap, CoversSixtyMetresInCellsOfTenCentimetres) {
  EXPECT_EQ(raster->elevation.size_x, 600);
  EXPECT_EQ(raster->elevation.size_y, 600);
  EXPECT_NEAR(raster->elevation.cell_m, 0.1, 1e-9);
  EXPECT_EQ(raster->map_origin_m, Eigen::Vector2d(429588.0, 5150629.0));
}

TEST_F(RealMap, SlopesBetweenFiveAndTwentyDegreesAlmostEverywhere) {
  std::size_t between = 0;
  for (const float slope : map->slope().values) {
    const double slope_deg = slope * 180.0 / M_PI;
    if (slope_deg >= 5.0 && slope_deg <= 20.0) ++between;
  }
  EXPECT_GE(static_cast<double>(between), 0.9 * static_cast<double>(map->slope().values.size()));
}

TEST_F(RealMap, ComesWithTheTaskDrawnBySeedOne) {
  const auto drawn = draw_task(*map, 1);
  const auto task = read_task(kScenarios / "real_minnesota.json");
  ASSERT_TRUE(drawn.has_value() && task.has_value());
  const auto expect_same = [&](const Pose2& in_file, const Pose2& local) {
    EXPECT_NEAR(in_file.x_m, local.x_m + map->map_origin_m().x(), 1e-3);
    EXPECT_NEAR(in_file.y_m, local.y_m + map->map_origin_m().y(), 1e-3);
    EXPECT_NEAR(in_file.yaw_rad, local.yaw_rad, 1e-3);
  };
  expect_same(task->start, drawn->start);
  expect_same(task->goal, drawn->goal);
}

}  // namespace
}  // namespace wex
