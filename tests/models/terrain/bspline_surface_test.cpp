#include "models/terrain/internal/bspline_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/models/terrain/terrain_fixtures.hpp"

namespace wex::terrain_internal {
namespace {

Grid random_grid(int size_x, int size_y, double cell_m) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-1.0, 1.0);
  Grid grid = make_grid(size_x, size_y, cell_m, [&](double, double) { return noise(random); });
  grid.origin_m << -0.7, 2.3;
  return grid;
}

Eigen::Vector2d position(const Grid& grid, double i, double j) {
  return grid.origin_m + grid.cell_m * Eigen::Vector2d(i, j);
}

TEST(BsplineSurface, PassesThroughEverySample) {
  const Grid grid = random_grid(17, 12, 0.1);
  const BsplineSurface surface(grid);
  for (int j = 0; j < grid.size_y; ++j) {
    for (int i = 0; i < grid.size_x; ++i) {
      EXPECT_NEAR(surface.sample(position(grid, i, j)).value, grid.at(i, j), 1e-9);
    }
  }
}

TEST(BsplineSurface, ReproducesPlanesUpToTheEdge) {
  const Grid grid = make_grid(9, 7, 0.5, [](double x, double y) { return 1.0 + 0.25 * x - y; });
  const BsplineSurface surface(grid);
  for (double x = 0.0; x <= 4.0; x += 0.13) {
    for (double y = 0.0; y <= 3.0; y += 0.11) {
      const SurfaceSample sample = surface.sample({x, y});
      EXPECT_NEAR(sample.value, 1.0 + 0.25 * x - y, 1e-6);
      EXPECT_NEAR((sample.gradient - Eigen::Vector2d(0.25, -1.0)).norm(), 0.0, 1e-6);
      EXPECT_NEAR(sample.hessian.norm(), 0.0, 1e-5);
    }
  }
}

TEST(BsplineSurface, HasTheDerivativesOfFiniteDifferences) {
  const Grid grid = random_grid(20, 15, 0.1);
  const BsplineSurface surface(grid);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> in_x(0.01, 18.99);
  std::uniform_real_distribution<double> in_y(0.01, 13.99);
  constexpr double kStep_m = 1e-5;
  for (int trial = 0; trial < 500; ++trial) {
    const Eigen::Vector2d p = position(grid, in_x(random), in_y(random));
    const SurfaceSample sample = surface.sample(p);
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector2d step = kStep_m * Eigen::Vector2d::Unit(axis);
      const SurfaceSample ahead = surface.sample(p + step);
      const SurfaceSample behind = surface.sample(p - step);
      // Gradients are of order 10, Hessians of order 1000 1/m here.
      EXPECT_NEAR(sample.gradient[axis], (ahead.value - behind.value) / (2.0 * kStep_m), 1e-3);
      EXPECT_NEAR(
          (sample.hessian.col(axis) - (ahead.gradient - behind.gradient) / (2.0 * kStep_m)).norm(),
          0.0, 1.0);
    }
  }
}

TEST(BsplineSurface, HasNoJumpInItsSecondDerivativesBetweenCells) {
  const Grid grid = random_grid(12, 12, 0.1);
  const BsplineSurface surface(grid);
  constexpr double kHair = 1e-9;  // cells
  for (int i = 1; i < 11; ++i) {
    const SurfaceSample left = surface.sample(position(grid, i - kHair, 4.3));
    const SurfaceSample right = surface.sample(position(grid, i + kHair, 4.3));
    EXPECT_NEAR((left.gradient - right.gradient).norm(), 0.0, 1e-5);
    EXPECT_NEAR((left.hessian - right.hessian).norm(), 0.0, 1e-3);
  }
}

TEST(BsplineSurface, IsClampedBeyondItsEdge) {
  const Grid grid = random_grid(8, 8, 0.1);
  const BsplineSurface surface(grid);
  const SurfaceSample beyond = surface.sample(position(grid, 12.0, 3.4));
  const SurfaceSample edge = surface.sample(position(grid, 7.0, 3.4));
  EXPECT_NEAR(beyond.value, edge.value, 1e-12);
  EXPECT_EQ(beyond.gradient.x(), 0.0);
  EXPECT_NEAR(beyond.gradient.y(), edge.gradient.y(), 1e-9);
  EXPECT_TRUE(surface.sample(position(grid, -1e12, 1e12)).hessian.allFinite());
}

TEST(BsplineSurface, AnswersNanWithNan) {
  const BsplineSurface surface(random_grid(8, 8, 0.1));
  EXPECT_TRUE(std::isnan(surface.sample({std::nan(""), 0.0}).value));
}

}  // namespace
}  // namespace wex::terrain_internal
