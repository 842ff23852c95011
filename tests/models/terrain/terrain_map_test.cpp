#include "models/terrain/terrain_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "models/terrain/internal/bspline_surface.hpp"
#include "tests/models/terrain/terrain_fixtures.hpp"

namespace wex {
namespace {

TerrainMap built(const Grid& grid) {
  auto map = TerrainMap::build(grid);
  EXPECT_TRUE(map.has_value()) << map.error().message;
  return *map;
}

Grid flat(int size) {
  return make_grid(size, size, 0.1, [](double, double) { return 0.0; });
}

TEST(TerrainMap, KnowsHeightSlopeAndNormalOfAPlane) {
  const TerrainMap map =
      built(make_grid(60, 50, 0.1, [](double x, double y) { return 2.0 + 0.3 * x + 0.1 * y; }));
  const Eigen::Vector2d p(2.34, 2.71);
  const double height_m = 2.0 + 0.3 * p.x() + 0.1 * p.y();
  const Eigen::Vector3d normal = Eigen::Vector3d(-0.3, -0.1, 1.0).normalized();
  EXPECT_NEAR(map.height_m(p), height_m, 1e-6);
  EXPECT_NEAR(map.filtered_height_m(p), height_m, 1e-5);
  EXPECT_NEAR((map.normal(p) - normal).norm(), 0.0, 1e-5);
  EXPECT_NEAR((map.filtered_normal(p) - normal).norm(), 0.0, 1e-5);
  EXPECT_NEAR(map.slope().at(23, 27), std::atan(std::hypot(0.3, 0.1)), 1e-5);
  EXPECT_TRUE(map.traversable_at(p));
}

TEST(TerrainMap, JudgesSlopesAgainstThirtyDegrees) {
  for (const double slope_deg : {-31.0, -29.0, 0.0, 29.0, 31.0}) {
    const double gradient = std::tan(slope_deg * M_PI / 180.0);
    const TerrainMap map =
        built(make_grid(60, 60, 0.1, [&](double x, double) { return gradient * x; }));
    EXPECT_EQ(map.traversable_at({3.0, 3.0}), std::abs(slope_deg) < 30.0) << slope_deg;
  }
}

TEST(TerrainMap, RefusesTheFootOfARiserWithinTheTyresRadiusButNotTheLevelRimAbove) {
  // 0.5 m up at x = 4.
  const TerrainMap map =
      built(make_grid(80, 80, 0.1, [](double x, double) { return x >= 3.95 ? 0.5 : 0.0; }));
  EXPECT_TRUE(map.traversable_at({3.4, 4.0}));
  EXPECT_FALSE(map.traversable_at({3.5, 4.0}));  // the tyre touches the riser before the floor
  EXPECT_FALSE(map.traversable_at({3.9, 4.0}));
  EXPECT_TRUE(map.traversable_at({4.0, 4.0}));  // the rim: a tyre there stands on level ground
  EXPECT_TRUE(map.traversable_at({4.3, 4.0}));
  // The border runs where the ground falls away.
  EXPECT_NEAR(map.signed_distance_m({4.2, 4.0}), 0.25, 1e-6);
}

TEST(TerrainMap, TakesALowStepForTraversable) {
  const TerrainMap map =
      built(make_grid(80, 80, 0.1, [](double x, double) { return x >= 3.95 ? 0.08 : 0.0; }));
  for (double x = 1.0; x < 7.0; x += 0.1) EXPECT_TRUE(map.traversable_at({x, 4.0})) << x;
}

TEST(TerrainMap, EndsAtBothRimsOfAGap) {
  const TerrainMap map = built(
      make_grid(120, 60, 0.1, [](double x, double) { return x > 4.95 && x < 7.05 ? -2.0 : 0.0; }));
  EXPECT_TRUE(map.traversable_at({4.9, 3.0}));
  EXPECT_FALSE(map.traversable_at({5.0, 3.0}));
  EXPECT_FALSE(map.traversable_at({5.3, 3.0}));
  EXPECT_FALSE(map.traversable_at({6.7, 3.0}));
  EXPECT_FALSE(map.traversable_at({7.0, 3.0}));
  EXPECT_TRUE(map.traversable_at({7.1, 3.0}));
}

TEST(TerrainMap, RefusesTheFloorOfAPitThatNoTyreReaches) {
  // 0.9 m wide: level in the middle, but a tyre of 1.2 m diameter hangs on the rims.
  const TerrainMap map = built(
      make_grid(80, 80, 0.1, [](double x, double) { return x > 3.55 && x < 4.45 ? -0.6 : 0.0; }));
  EXPECT_LT(map.slope().at(40, 40), 0.01);
  EXPECT_FALSE(map.traversable_at({4.0, 4.0}));
  EXPECT_LT(map.signed_distance_m({4.0, 4.0}), 0.0);
}

TEST(TerrainMap, TakesUnknownGroundAndItsSurroundingsAsUntraversable) {
  Grid grid = flat(80);
  grid.at(40, 40) = kUnknown;
  const TerrainMap map = built(grid);
  EXPECT_FALSE(map.traversable_at({4.0, 4.0}));
  EXPECT_FALSE(map.traversable_at({4.5, 4.0}));  // the tyre would stand on the unknown
  EXPECT_TRUE(map.traversable_at({4.8, 4.0}));
  // The nearest free cell is 6 cells along and one across.
  EXPECT_NEAR(map.signed_distance_m({4.0, 4.0}), -0.1 * (std::sqrt(37.0) - 0.5), 1e-6);
}

TEST(TerrainMap, MeasuresTheSignedDistanceToUntraversableGround) {
  const TerrainMap map = built(flat(80));
  // The tyre must stay on the map, so the traversable part ends 0.6 m inside its border.
  EXPECT_NEAR(map.signed_distance_m({4.0, 4.0}), 3.35, 1e-5);
  EXPECT_NEAR(map.signed_distance_m({1.0, 4.0}), 0.45, 1e-5);
  EXPECT_NEAR(map.signed_distance_m({0.0, 4.0}), -0.55, 1e-5);
  EXPECT_NEAR(map.signed_distance_surface({1.0, 4.0}).value, 0.45, 1e-5);
  EXPECT_NEAR(map.signed_distance_surface({1.5, 4.0}).gradient.x(), 1.0, 1e-4);
}

TEST(TerrainMap, AnswersNanWhereANeededCellIsUnknownOrOffTheMap) {
  Grid grid = flat(20);
  grid.at(10, 10) = kUnknown;
  const TerrainMap map = built(grid);
  EXPECT_TRUE(std::isnan(map.height_m({1.0, 1.0})));
  EXPECT_TRUE(std::isnan(map.height_m({1.05, 1.0})));
  EXPECT_TRUE(std::isnan(map.dilated_height_m({1.05, 1.05})));
  EXPECT_TRUE(std::isnan(map.filtered_height_m({0.95, 0.95})));
  EXPECT_FALSE(map.known({0.95, 0.95}));
  // On a sample beside it only that sample is needed.
  EXPECT_EQ(map.height_m({1.1, 1.0}), 0.0);
  EXPECT_TRUE(map.known({1.1, 1.0}));
  EXPECT_EQ(map.normal({1.0, 1.0}), Eigen::Vector3d::UnitZ());

  EXPECT_TRUE(map.contains({1.9, 1.9}));
  EXPECT_FALSE(map.contains({1.91, 1.0}));
  EXPECT_TRUE(std::isnan(map.height_m({-0.01, 1.0})));
  EXPECT_TRUE(std::isnan(map.signed_distance_m({1.0, 2.0})));
  EXPECT_TRUE(std::isnan(map.height_m({std::nan(""), 1.0})));
  EXPECT_FALSE(map.traversable_at({-5.0, 1.0}));
  EXPECT_FALSE(map.known({1.0, std::nan("")}));
}

TEST(TerrainMap, InterpolatesBilinearly) {
  Grid grid = flat(8);
  grid.at(3, 3) = 1.0F;
  const TerrainMap map = built(grid);
  EXPECT_NEAR(map.height_m({0.325, 0.35}), 0.75 * 0.5, 1e-6);
}

TEST(TerrainMap, FillsUnknownCellsOfTheSplinesSoThatTheyAreFinite) {
  Grid grid = make_grid(40, 40, 0.1, [](double, double) { return 7.0; });
  for (int j = 10; j < 30; ++j) {
    for (int i = 5; i < 20; ++i) grid.at(i, j) = kUnknown;
  }
  const TerrainMap map = built(grid);
  for (double x = -1.0; x < 5.0; x += 0.17) {
    for (double y = -1.0; y < 5.0; y += 0.19) {
      EXPECT_NEAR(map.dilated_surface({x, y}).value, 7.0, 1e-5);
      EXPECT_TRUE(std::isfinite(map.signed_distance_surface({x, y}).value));
    }
  }
}

/// How far the spline is off level ground between two places along x.
double worst_beside(const TerrainMap& map, double ground_m, double from_x_m, double to_x_m) {
  double worst_m = 0.0;
  for (double x = from_x_m; x < to_x_m; x += 0.02) {
    worst_m = std::max(worst_m, std::abs(map.dilated_surface({x, 3.03}).value - ground_m));
  }
  return worst_m;
}

TEST(TerrainMap, ItsSplineIsFlatBesideTheRimOfAPit) {
  for (const double depth_m : {0.5, 1.0, 2.0, 4.0}) {
    // Traversable up to x = 4.9, and again from 7.1.
    const TerrainMap map = built(make_grid(
        120, 60, 0.1, [&](double x, double) { return x > 4.95 && x < 7.05 ? -depth_m : 0.0; }));
    EXPECT_LT(worst_beside(map, 0.0, 3.5, 4.86), 0.01) << depth_m;
    EXPECT_LT(worst_beside(map, 0.0, 7.14, 8.5), 0.01) << depth_m;
    EXPECT_LT(std::abs(map.dilated_surface({4.85, 3.0}).gradient.x()), 0.1) << depth_m;
  }
}

TEST(TerrainMap, ItsSplineIsFlatOnTopOfABlockAndAtItsFoot) {
  for (const double height_m : {0.5, 1.0, 2.0}) {
    // The tyre touches the riser from 0.6 m before it.
    const TerrainMap map =
        built(make_grid(120, 60, 0.1, [&](double x, double) { return x > 5.95 ? height_m : 0.0; }));
    EXPECT_TRUE(map.traversable_at({6.0, 3.0}));
    EXPECT_LT(worst_beside(map, height_m, 6.04, 8.0), 0.01) << height_m;
    double foot_m = 3.0;  // 0.15 m before ground no tyre may stand on
    while (map.signed_distance_m({foot_m + 0.01, 3.0}) >= 0.15) foot_m += 0.01;
    EXPECT_NEAR(foot_m, 5.25, 0.06);
    EXPECT_LT(worst_beside(map, 0.0, 3.0, foot_m), 0.01) << height_m;
  }
}

TEST(TerrainMap, ASplineThroughACliffWouldSwingBesideIt) {
  const TerrainMap map =
      built(make_grid(120, 60, 0.1, [](double x, double) { return x > 5.95 ? 2.0 : 0.0; }));
  const terrain_internal::BsplineSurface plain(map.dilated_height());
  double worst_m = 0.0;
  for (double x = 4.0; x < 5.2; x += 0.02) {
    worst_m = std::max(worst_m, std::abs(plain.sample({x, 3.03}).value));
  }
  EXPECT_GT(worst_m, 0.02);
  EXPECT_LT(worst_beside(map, 0.0, 4.0, 5.2), 0.005);
}

TEST(TerrainMap, ItsSplineKeepsClimbingOnSlopesAndFollowsBumps) {
  const auto hills = [](double x, double y) { return 0.3 * x + 0.4 * std::sin(0.8 * x + 0.5 * y); };
  const TerrainMap map = built(make_grid(120, 60, 0.1, hills));
  const terrain_internal::BsplineSurface plain(map.dilated_height());
  for (double x = 0.65; x < 11.0; x += 0.13) {
    for (double y = 0.65; y < 5.0; y += 0.17) {
      EXPECT_EQ(map.dilated_surface({x, y}).value, plain.sample({x, y}).value) << x << " " << y;
    }
  }
}

TEST(TerrainMap, ItsSplineFollowsASlopeThatIsTooSteepToStandOn) {
  // 35 degrees from x = 4 to 6, without a jump: nothing is carried on over it.
  const auto bank = [](double x, double) { return 0.7 * std::clamp(x - 4.0, 0.0, 2.0); };
  const TerrainMap map = built(make_grid(120, 60, 0.1, bank));
  EXPECT_FALSE(map.traversable_at({5.0, 3.0}));
  const terrain_internal::BsplineSurface plain(map.dilated_height());
  for (double x = 1.0; x < 11.0; x += 0.07) {
    EXPECT_EQ(map.dilated_surface({x, 3.0}).value, plain.sample({x, 3.0}).value) << x;
  }
}

TEST(TerrainMap, FindsTheNearestTraversableCell) {
  const TerrainMap map = built(flat(80));
  EXPECT_NEAR((map.nearest_traversable({4.0, 4.0}) - Eigen::Vector2d(4.0, 4.0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((map.nearest_traversable({0.2, 4.0}) - Eigen::Vector2d(0.6, 4.0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((map.nearest_traversable({-9.0, 4.0}) - Eigen::Vector2d(0.6, 4.0)).norm(), 0.0, 1e-9);
  const TerrainMap steep = built(make_grid(30, 30, 0.1, [](double x, double) { return 2.0 * x; }));
  EXPECT_TRUE(steep.nearest_traversable({1.0, 1.0}).hasNaN());
  EXPECT_TRUE(map.nearest_traversable({std::nan(""), 1.0}).hasNaN());
}

TEST(TerrainMap, KeepsItsPlaceInTheMapFrame) {
  Grid grid = flat(20);
  grid.origin_m << -0.95, -0.95;
  const Eigen::Vector2d map_origin_m(429588.0, 5150629.0);
  const auto map = TerrainMap::build(grid, {}, map_origin_m);
  ASSERT_TRUE(map.has_value());
  EXPECT_EQ(map->map_origin_m(), map_origin_m);
  EXPECT_EQ(map->min_corner_m(), grid.origin_m);
  EXPECT_NEAR((map->max_corner_m() - Eigen::Vector2d(0.95, 0.95)).norm(), 0.0, 1e-12);
}

TEST(TerrainMap, RefusesGridsItCannotUse) {
  const auto message_of = [](const Grid& grid) {
    const auto map = TerrainMap::build(grid);
    EXPECT_FALSE(map.has_value());
    EXPECT_EQ(map.error().code, ErrorCode::kBadInput);
    return map.error().message;
  };
  EXPECT_NE(message_of(flat(3)).find("at least 4 x 4"), std::string::npos);
  Grid grid = flat(8);
  for (const double cell_m : {0.0, -0.1, std::nan(""), HUGE_VAL}) {
    grid.cell_m = cell_m;
    EXPECT_NE(message_of(grid).find("cell size"), std::string::npos) << cell_m;
  }
  grid = make_grid(8, 8, 0.1, [](double, double) { return static_cast<double>(kUnknown); });
  EXPECT_NE(message_of(grid).find("no known cell"), std::string::npos);
  grid = flat(8);
  grid.at(2, 2) = HUGE_VALF;
  EXPECT_NE(message_of(grid).find("infinite"), std::string::npos);
}

}  // namespace
}  // namespace wex
