#include "models/terrain/wheel_rest.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

namespace wex {
namespace {

constexpr double kRadius_m = 0.6, kHalfWidth_m = 0.2;

TerrainMap ground(double slope_along_y, double wave_m) {
  Grid grid;
  grid.size_x = grid.size_y = 120;
  grid.origin_m = {-6.0, -6.0};
  grid.values.resize(120 * 120);
  for (int j = 0; j < 120; ++j) {
    for (int i = 0; i < 120; ++i) {
      const double x = -6.0 + 0.1 * i, y = -6.0 + 0.1 * j;
      grid.at(i, j) = static_cast<float>(slope_along_y * y + wave_m * std::sin(0.8 * x + 0.5 * y));
    }
  }
  return TerrainMap::build(std::move(grid)).value();
}

Eigen::Vector3d level_axle(double yaw_rad) { return {-std::sin(yaw_rad), std::cos(yaw_rad), 0.0}; }

TEST(WheelRest, StandsOneRadiusAboveLevelGround) {
  const WheelRest rest =
      wheel_rest(ground(0.0, 0.0), {0.3, 0.2}, level_axle(0.4), kRadius_m, kHalfWidth_m);
  EXPECT_NEAR(rest.height_m, kRadius_m, 1e-6);
}

TEST(WheelRest, StandsOnTheEdgeOfTheDiscOnASideSlope) {
  // Upright disc on ground that falls away along its axle: the upper rim edge carries.
  for (const double angle_rad : {0.1, 0.2, 0.3}) {
    const double slope = std::tan(angle_rad);
    const Eigen::Vector2d p(0.0, 0.5);
    const WheelRest rest =
        wheel_rest(ground(slope, 0.0), p, level_axle(0.0), kRadius_m, kHalfWidth_m);
    const double expected_m = slope * p.y() + kRadius_m + kHalfWidth_m * slope;
    EXPECT_NEAR(rest.height_m, expected_m, 4e-3) << "slope " << angle_rad;  // dilation's grid error
  }
}

TEST(WheelRest, IsTheBallWhereTheDiscStandsSquareOnTheSlope) {
  const double angle_rad = 0.25;
  const Eigen::Vector3d axle(0.0, std::cos(angle_rad), std::sin(angle_rad));
  const WheelRest rest =
      wheel_rest(ground(std::tan(angle_rad), 0.0), {0.0, 0.0}, axle, kRadius_m, kHalfWidth_m);
  EXPECT_NEAR(rest.height_m, kRadius_m / std::cos(angle_rad), 4e-3);
}

TEST(WheelRest, HasExactDerivatives) {
  const TerrainMap terrain = ground(0.1, 0.2);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-3.0, 3.0), tilt(-0.2, 0.2);
  constexpr double kStep = 1e-6, kTolerance = 1e-5;
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Vector2d p(place(random), place(random));
    const Eigen::Vector3d axle =
        (level_axle(place(random)) + tilt(random) * Eigen::Vector3d::UnitZ()).normalized();
    const auto height = [&](const Eigen::Vector2d& at, const Eigen::Vector3d& a) {
      return wheel_rest(terrain, at, a, kRadius_m, kHalfWidth_m).height_m;
    };
    const WheelRest rest = wheel_rest(terrain, p, axle, kRadius_m, kHalfWidth_m);
    for (int i = 0; i < 2; ++i) {
      const Eigen::Vector2d d = kStep * Eigen::Vector2d::Unit(i);
      EXPECT_NEAR(rest.by_xy[i], (height(p + d, axle) - height(p - d, axle)) / (2.0 * kStep),
                  kTolerance);
    }
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(i);
      EXPECT_NEAR(rest.by_axle[i], (height(p, axle + d) - height(p, axle - d)) / (2.0 * kStep),
                  kTolerance);
    }
  }
}

}  // namespace
}  // namespace wex
