#include <gtest/gtest.h>

#include "initializer/make_plan.hpp"
#include "models/terrain/synthetic.hpp"
#include "tests/tools/check/checked_motions.hpp"
#include "tools/check/check_command.hpp"

namespace wex::check {
namespace {

struct Ground {
  const char* kind;
  double difficulty;
};

class CheckedDrives : public testing::TestWithParam<Ground> {};

TEST_P(CheckedDrives, PlansOnFourWheelsAreAccepted) {
  const auto [kind, difficulty] = GetParam();
  for (const std::uint64_t seed : {1, 2}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const SyntheticTerrain synthetic = make_synthetic_terrain(kind, difficulty, seed).value();
    const Eigen::Vector2d origin = synthetic.raster.map_origin_m;
    const TerrainMap terrain = TerrainMap::build(synthetic.raster.elevation, {}, origin).value();
    Task task = synthetic.task;
    for (Pose2* pose : {&task.start, &task.goal}) {
      pose->x_m -= origin.x();
      pose->y_m -= origin.y();
    }
    PlanSettings settings;
    settings.mode = PlanMode::kDriveOnly;
    settings.iterations = 200;
    settings.seed = seed;
    const auto plan = make_plan(terrain, test::machine(), task, settings);
    ASSERT_TRUE(plan) << plan.error().message;
    const auto report = check_plan(test::machine(), synthetic.raster, *plan);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_TRUE(report->accepted) << check_table(*report);
  }
}

INSTANTIATE_TEST_SUITE_P(Terrains, CheckedDrives,
                         testing::Values(Ground{"flat", 0.0}, Ground{"rough", 0.0},
                                         Ground{"rough", 0.25}, Ground{"ramp", 0.0},
                                         Ground{"side_slope", 0.0}),
                         [](const auto& info) {
                           return std::string(info.param.kind) +
                                  std::to_string(static_cast<int>(100 * info.param.difficulty));
                         });

}  // namespace
}  // namespace wex::check
