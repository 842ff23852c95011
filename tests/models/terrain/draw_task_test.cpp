#include "models/terrain/draw_task.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/models/terrain/terrain_fixtures.hpp"

namespace wex {
namespace {

TerrainMap half_wall() {
  const auto map = TerrainMap::build(
      make_grid(400, 300, 0.1, [](double x, double) { return x > 20.0 ? 3.0 * (x - 20.0) : 0.0; }));
  return *map;
}

TEST(DrawTask, DrawsPosesWithClearanceAndDistance) {
  const TerrainMap map = half_wall();
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const auto task = draw_task(map, seed);
    ASSERT_TRUE(task.has_value()) << seed;
    for (const Pose2& pose : {task->start, task->goal}) {
      EXPECT_GE(map.signed_distance_m({pose.x_m, pose.y_m}), 3.5);
      EXPECT_LE(std::abs(pose.yaw_rad), M_PI);
    }
    EXPECT_GE(std::hypot(task->goal.x_m - task->start.x_m, task->goal.y_m - task->start.y_m), 10.0);
  }
}

TEST(DrawTask, DrawsTheSameForTheSameSeedAndAnotherForAnother) {
  const TerrainMap map = half_wall();
  EXPECT_EQ(*draw_task(map, 4), *draw_task(map, 4));
  EXPECT_NE(*draw_task(map, 4), *draw_task(map, 5));
}

TEST(DrawTask, RefusesAMapWithoutRoom) {
  const auto map = TerrainMap::build(make_grid(60, 60, 0.1, [](double, double) { return 0.0; }));
  const auto task = draw_task(*map, 1);
  ASSERT_FALSE(task.has_value());
  EXPECT_NE(task.error().message.find("no room"), std::string::npos);
}

}  // namespace
}  // namespace wex
