#include <gtest/gtest.h>

#include "initializer/make_plan.hpp"
#include "tests/tools/check/checked_motions.hpp"
#include "tools/check/check_command.hpp"

namespace wex::check {
namespace {

struct Obstacle {
  const char* name;
  double (*height_m)(double x, double y);
};

double gap(double x, double y) { return std::abs(x + 0.05 * y) < 1.0 ? -2.0 : 0.0; }
double step(double x, double) { return x > 0.0 ? 0.8 : 0.0; }
double wall(double x, double) { return std::abs(x) < 0.2 ? 0.5 : 0.0; }

class CheckedSteps : public testing::TestWithParam<Obstacle> {};

TEST_P(CheckedSteps, PlansWithLiftedWheelsAreAccepted) {
  const Raster raster = test::make_raster(GetParam().height_m);
  const TerrainMap terrain = TerrainMap::build(raster.elevation, {}, raster.map_origin_m).value();
  PlanSettings settings;
  settings.iterations = 60;
  const Task task{{-7.5, 0.5, 0.1}, {7.5, -0.5, -0.1}};
  const auto plan = make_plan(terrain, test::machine(), task, settings);
  ASSERT_TRUE(plan) << plan.error().message;
  int lifted_nodes = 0;
  for (const WholeBodyNode& node : plan->nodes) {
    lifted_nodes +=
        node.contacts[0] && node.contacts[1] && node.contacts[2] && node.contacts[3] ? 0 : 1;
  }
  EXPECT_GT(lifted_nodes, 0);
  const auto report = check_plan(test::machine(), raster, *plan);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_TRUE(report->accepted) << check_table(*report);
}

TEST_P(CheckedSteps, TheSamePlanOverGroundThatWasMovedIsNot) {
  const Raster raster = test::make_raster(GetParam().height_m);
  const TerrainMap terrain = TerrainMap::build(raster.elevation, {}, raster.map_origin_m).value();
  PlanSettings settings;
  settings.iterations = 60;
  const auto plan =
      make_plan(terrain, test::machine(), {{-7.5, 0.5, 0.1}, {7.5, -0.5, -0.1}}, settings);
  ASSERT_TRUE(plan) << plan.error().message;
  const Raster moved =
      test::make_raster([](double x, double y) { return GetParam().height_m(x - 0.6, y); });
  const auto report = check_plan(test::machine(), moved, *plan);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_FALSE(report->accepted);
  EXPECT_FALSE(report->verdict().empty());
}

INSTANTIATE_TEST_SUITE_P(Obstacles, CheckedSteps,
                         testing::Values(Obstacle{"Gap", gap}, Obstacle{"Step", step},
                                         Obstacle{"Wall", wall}),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace wex::check
