#include "models/terrain/internal/plane_fit.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "tests/models/terrain/terrain_fixtures.hpp"

namespace wex::terrain_internal {
namespace {

std::size_t cell_of(const Grid& grid, int i, int j) {
  return static_cast<std::size_t>(j) * grid.size_x + i;
}

/// The same fit from its definition: a dense least-squares solve per cell.
Eigen::Vector3d plane_by_definition(const Grid& grid, int i, int j, double radius_m) {
  std::vector<Eigen::Vector3d> rows;
  std::vector<double> heights;
  for (int n = 0; n < grid.size_y; ++n) {
    for (int m = 0; m < grid.size_x; ++m) {
      const double dx = (m - i) * grid.cell_m;
      const double dy = (n - j) * grid.cell_m;
      if (std::hypot(dx, dy) > radius_m + 1e-9 || std::isnan(grid.at(m, n))) continue;
      rows.emplace_back(1.0, dx, dy);
      heights.push_back(grid.at(m, n));
    }
  }
  Eigen::MatrixXd A(rows.size(), 3);
  Eigen::VectorXd b(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    A.row(static_cast<Eigen::Index>(k)) = rows[k];
    b[static_cast<Eigen::Index>(k)] = heights[k];
  }
  return A.completeOrthogonalDecomposition().solve(b);
}

TEST(PlaneFit, OfAPlaneIsThatPlaneUpToTheEdges) {
  const Grid grid =
      make_grid(40, 30, 0.1, [](double x, double y) { return 3.0 + 0.2 * x - 0.5 * y; });
  for (const double radius_m : {0.3, 2.5}) {
    const PlaneFit fit = fit_planes(grid, radius_m);
    for (std::size_t cell = 0; cell < grid.values.size(); ++cell) {
      EXPECT_NEAR(fit.height.values[cell], grid.values[cell], 1e-5);
      EXPECT_NEAR(fit.gradient[cell].x(), 0.2, 1e-5);
      EXPECT_NEAR(fit.gradient[cell].y(), -0.5, 1e-5);
    }
    const Eigen::Vector3d expected = Eigen::Vector3d(-0.2, 0.5, 1.0).normalized();
    EXPECT_NEAR((fit.normal_at(0) - expected).norm(), 0.0, 1e-5);
  }
}

/// Share of unknown cells: the sums take another way where every cell of a disc is known.
class PlaneFitOfNoise : public testing::TestWithParam<double> {};

TEST_P(PlaneFitOfNoise, AgreesWithADenseLeastSquaresSolve) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> noise(-1.0, 1.0);
  std::bernoulli_distribution unknown(GetParam());
  const Grid grid = make_grid(61, 57, 0.1, [&](double, double) {
    return unknown(random) ? static_cast<double>(kUnknown) : noise(random);
  });
  for (const double radius_m : {0.3, 0.95, 2.5}) {
    const PlaneFit fit = fit_planes(grid, radius_m);
    for (int j = 0; j < grid.size_y; j += 4) {
      for (int i = 0; i < grid.size_x; i += 3) {
        if (std::isnan(grid.at(i, j))) continue;
        const Eigen::Vector3d expected = plane_by_definition(grid, i, j, radius_m);
        EXPECT_NEAR(fit.height.at(i, j), expected[0], 1e-4) << i << ", " << j;
        EXPECT_NEAR(fit.gradient[cell_of(grid, i, j)].x(), expected[1], 1e-4) << i << ", " << j;
        EXPECT_NEAR(fit.gradient[cell_of(grid, i, j)].y(), expected[2], 1e-4) << i << ", " << j;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(FromNoHolesToMany, PlaneFitOfNoise, testing::Values(0.0, 0.003, 0.3));

TEST(PlaneFit, StaysAccurateFarFromTheOriginAndHighUp) {
  Grid grid =
      make_grid(2000, 8, 0.1, [](double x, double y) { return 2500.0 + 0.3 * x + 0.1 * y; });
  grid.origin_m << 1000.0, -5000.0;
  const PlaneFit fit = fit_planes(grid, 0.3);
  // A float near 2600 m is good to 0.12 mm, over a 0.6 m wide disc.
  EXPECT_NEAR(fit.gradient[cell_of(grid, 1990, 4)].x(), 0.3, 1e-3);
  EXPECT_NEAR(fit.gradient[cell_of(grid, 1990, 4)].y(), 0.1, 1e-3);
}

TEST(PlaneFit, LeavesUnknownCellsUnknownAndIgnoresThemElsewhere) {
  Grid grid = make_grid(9, 9, 0.1, [](double x, double) { return x; });
  grid.at(4, 4) = kUnknown;
  const PlaneFit fit = fit_planes(grid, 0.3);
  EXPECT_TRUE(std::isnan(fit.height.at(4, 4)));
  EXPECT_NEAR(fit.height.at(5, 4), 0.5, 1e-6);
  EXPECT_NEAR(fit.gradient[cell_of(grid, 5, 4)].x(), 1.0, 1e-5);
}

TEST(PlaneFit, TakesTheSlopeAcrossALineOfKnownCellsAsZero) {
  Grid grid = make_grid(9, 9, 0.1, [](double x, double y) {
    return std::abs(y - 0.4) < 0.01 ? 2.0 * x : static_cast<double>(kUnknown);
  });
  const PlaneFit fit = fit_planes(grid, 0.3);
  EXPECT_NEAR(fit.gradient[cell_of(grid, 4, 4)].x(), 2.0, 1e-4);
  EXPECT_NEAR(fit.gradient[cell_of(grid, 4, 4)].y(), 0.0, 1e-6);
}

TEST(PlaneFit, TakesALoneCellAsLevel) {
  Grid grid = make_grid(9, 9, 0.1, [](double, double) { return static_cast<double>(kUnknown); });
  grid.at(4, 4) = 1.5F;
  const PlaneFit fit = fit_planes(grid, 0.3);
  EXPECT_FLOAT_EQ(fit.height.at(4, 4), 1.5F);
  EXPECT_EQ(fit.normal_at(cell_of(grid, 4, 4)), Eigen::Vector3d::UnitZ());
}

TEST(PlaneFit, SeesSlopesOnAGridCoarserThanItsRadius) {
  const Grid grid = make_grid(6, 6, 2.0, [](double x, double) { return 0.5 * x; });
  EXPECT_NEAR(fit_planes(grid, 0.3).gradient[cell_of(grid, 2, 2)].x(), 0.5, 1e-6);
}

}  // namespace
}  // namespace wex::terrain_internal
