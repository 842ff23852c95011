#include "models/terrain/internal/tyre_dilation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/models/terrain/terrain_fixtures.hpp"

namespace wex::terrain_internal {
namespace {

constexpr double kRadius_m = 0.6;

float dilated_by_search(const Grid& grid, int i, int j) {
  double best = -1e9;
  for (int n = 0; n < grid.size_y; ++n) {
    for (int m = 0; m < grid.size_x; ++m) {
      const double distance_m = grid.cell_m * std::hypot(m - i, n - j);
      if (distance_m > kRadius_m + 1e-9 || std::isnan(grid.at(m, n))) continue;
      const double square = kRadius_m * kRadius_m - distance_m * distance_m;
      best = std::max(best, grid.at(m, n) + std::sqrt(std::max(0.0, square)) - kRadius_m);
    }
  }
  return static_cast<float>(best);
}

TEST(TyreDilation, EqualsAnExhaustiveSearchOnNoiseWithHoles) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> noise(-1.0, 1.0);
  for (const double cell_m : {0.1, 0.07, 0.25}) {
    Grid grid = make_grid(31, 27, cell_m, [&](double, double) { return noise(random); });
    for (float& height : grid.values) {
      if (noise(random) > 0.7) height = kUnknown;
    }
    const Grid dilated = dilate_by_tyre(grid, kRadius_m);
    for (int j = 0; j < grid.size_y; ++j) {
      for (int i = 0; i < grid.size_x; ++i) {
        if (std::isnan(grid.at(i, j))) {
          EXPECT_TRUE(std::isnan(dilated.at(i, j)));
        } else {
          EXPECT_NEAR(dilated.at(i, j), dilated_by_search(grid, i, j), 1e-5);
        }
      }
    }
  }
}

TEST(TyreDilation, OfASpikeIsTheTyresOwnShape) {
  Grid grid = make_grid(21, 21, 0.1, [](double, double) { return 0.0; });
  grid.at(10, 10) = 1.0F;
  const Grid dilated = dilate_by_tyre(grid, kRadius_m);
  EXPECT_NEAR(dilated.at(10, 10), 1.0, 1e-6);
  EXPECT_NEAR(dilated.at(13, 10), 1.0 + std::sqrt(0.36 - 0.09) - 0.6, 1e-6);
  EXPECT_NEAR(dilated.at(16, 10), 0.4, 1e-3);  // the flank, at the height of the axle
  EXPECT_NEAR(dilated.at(17, 10), 0.0, 1e-6);
}

TEST(TyreDilation, OfASlopeLiesAboveItByWhatADiscTouchesAhead) {
  const double gradient = std::tan(0.35);
  const Grid grid = make_grid(41, 41, 0.05, [&](double x, double) { return gradient * x; });
  const Grid dilated = dilate_by_tyre(grid, kRadius_m);
  const double expected = kRadius_m * (std::sqrt(1.0 + gradient * gradient) - 1.0);
  // The tangent point lies between samples: short by at most cell^2 / (8 r) or so.
  EXPECT_NEAR(dilated.at(20, 20) - grid.at(20, 20), expected, 1e-3);
}

TEST(KnownWithin, IsFalseNearUnknownCellsAndNearTheEdge) {
  Grid grid = make_grid(41, 41, 0.1, [](double, double) { return 0.0; });
  grid.at(20, 20) = kUnknown;
  const auto known = known_within(grid, 0.6);
  const auto at = [&](int i, int j) { return known[static_cast<std::size_t>(j) * 41 + i] != 0; };
  EXPECT_FALSE(at(20, 20));
  EXPECT_FALSE(at(26, 20));
  EXPECT_TRUE(at(27, 20));
  EXPECT_FALSE(at(24, 24));  // 0.57 m
  EXPECT_TRUE(at(25, 24));   // 0.64 m
  EXPECT_FALSE(at(5, 20));   // the first cell beyond the map is 0.6 m away
  EXPECT_TRUE(at(6, 20));
}

}  // namespace
}  // namespace wex::terrain_internal
