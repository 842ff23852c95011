#include "tools/check/checked_ground.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tools/check/support_hull.hpp"

namespace wex::check {
namespace {

constexpr double kRadiusM = 0.6, kHalfWidthM = 0.2, kDegree = 0.017453292519943295;

CheckedGround make_ground(const std::function<double(double, double)>& height) {
  Grid grid;
  grid.size_x = 101;
  grid.size_y = 81;
  grid.cell_m = 0.1;
  grid.origin_m = {-5.0, -4.0};
  for (int j = 0; j < grid.size_y; ++j) {
    for (int i = 0; i < grid.size_x; ++i) {
      grid.values.push_back(
          static_cast<float>(height(grid.origin_m.x() + 0.1 * i, grid.origin_m.y() + 0.1 * j)));
    }
  }
  return CheckedGround(std::move(grid));
}

TyreOnGround upright(const CheckedGround& ground, double x, double y, double z) {
  return ground.tyre({x, y, z}, Eigen::Vector3d::UnitY(), kRadiusM, kHalfWidthM);
}

TEST(CheckedGround, HeightsAreBilinearAndUnknownBeyondTheMap) {
  const CheckedGround ground = make_ground([](double x, double y) { return x + x * y; });
  EXPECT_NEAR(ground.height_m(0.73, 1.25), 0.73 + 0.73 * 1.25, 1e-5);
  EXPECT_NEAR(ground.height_m(5.0, 4.0), 25.0, 1e-5);  // the last sample is on the map
  EXPECT_TRUE(std::isnan(ground.height_m(5.001, 0.0)));
  EXPECT_TRUE(std::isnan(ground.height_m(0.0, -4.001)));
}

TEST(CheckedGround, ATyreOnLevelGroundTouchesBelowItsMiddle) {
  const CheckedGround ground = make_ground([](double, double) { return 0.25; });
  const TyreOnGround tyre = upright(ground, 0.33, 0.47, 0.25 + kRadiusM + 0.07);
  ASSERT_TRUE(tyre.known);
  EXPECT_NEAR(tyre.gap_m, 0.07, 1e-6);
  EXPECT_NEAR(tyre.p_world_patch.x(), 0.33, 1e-6);
  EXPECT_NEAR(tyre.p_world_patch.y(), 0.47, 1e-6);
}

TEST(CheckedGround, ATyreThatRollsUphillTouchesAheadOfItsCentre) {
  const double slope = 20.0 * kDegree;
  const CheckedGround ground = make_ground([&](double x, double) { return std::tan(slope) * x; });
  // A disc that rolls up an incline rests r / cos above it.
  const TyreOnGround tyre = upright(ground, 0.0, 0.0, kRadiusM / std::cos(slope));
  EXPECT_NEAR(tyre.gap_m, 0.0, 1e-3);
  EXPECT_NEAR(tyre.p_world_patch.x(), kRadiusM * std::sin(slope), 0.02);
}

TEST(CheckedGround, ATyreOnASideSlopeStandsOnItsEdge) {
  const double slope = 15.0 * kDegree;
  const CheckedGround ground = make_ground([&](double, double y) { return std::tan(slope) * y; });
  const TyreOnGround tyre = upright(ground, 0.0, 0.0, kRadiusM + kHalfWidthM * std::tan(slope));
  EXPECT_NEAR(tyre.gap_m, 0.0, 1e-3);
  EXPECT_GT(tyre.p_world_patch.y(), 0.5 * kHalfWidthM);
  // With its axle along the slope it lies flat on the ground.
  const Eigen::Vector3d axle(0.0, std::cos(slope), std::sin(slope));
  const TyreOnGround leaning =
      ground.tyre({0.0, 0.0, kRadiusM / std::cos(slope)}, axle, kRadiusM, kHalfWidthM);
  EXPECT_NEAR(leaning.gap_m, 0.0, 1e-3);
}

TEST(CheckedGround, ASingleHighSampleUnderTheTreadIsSeen) {
  const CheckedGround ground = make_ground(
      [](double x, double y) { return std::hypot(x - 0.2, y - 0.1) < 0.01 ? 0.3 : 0.0; });
  const double above_m = std::sqrt(kRadiusM * kRadiusM - 0.2 * 0.2);
  EXPECT_NEAR(upright(ground, 0.0, 0.0, 0.3 + above_m).gap_m, 0.0, 1e-6);
  EXPECT_NEAR(upright(ground, 0.0, -0.25, kRadiusM).gap_m, 0.0, 1e-6);  // beside the tyre
}

TEST(CheckedGround, ATyreOverAnUnknownSampleIsUnknown) {
  const CheckedGround ground = make_ground(
      [](double x, double y) { return std::hypot(x - 0.2, y - 0.1) < 0.01 ? std::nan("") : 0.0; });
  EXPECT_FALSE(upright(ground, 0.0, 0.0, kRadiusM).known);
  EXPECT_TRUE(upright(ground, 2.0, 0.0, kRadiusM).known);
}

TEST(CheckedGround, SlopesAndDistancesAreThoseOfAPlaneWithASteepPart) {
  CheckedGround ground = make_ground([](double x, double) {
    return x < 1.0 ? std::tan(10.0 * kDegree) * x
                   : std::tan(10.0 * kDegree) + std::tan(33.0 * kDegree) * (x - 1.0);
  });
  const auto kind = CheckedGround::Foot::kTyre;
  EXPECT_NEAR(ground.slope_rad(-2.0, 0.0, kind), 10.0 * kDegree, 1e-3);
  EXPECT_NEAR(ground.slope_rad(2.5, 0.0, kind), 33.0 * kDegree, 1e-3);
  EXPECT_NEAR(ground.untraversable_distance_m(-2.0, 0.0, kind, 30.0 * kDegree, 0.3), 0.3, 1e-12);
  EXPECT_LT(ground.untraversable_distance_m(1.0, 0.0, kind, 30.0 * kDegree, 0.3), 0.3);
  EXPECT_EQ(ground.untraversable_distance_m(2.0, 0.0, kind, 30.0 * kDegree, 0.3), 0.0);
}

TEST(CheckedGround, TheRimOfAPitIsLevelAndItsFootIsOutOfATyresReach) {
  CheckedGround ground = make_ground([](double x, double) { return x < 0.05 ? 0.0 : -2.0; });
  const auto kind = CheckedGround::Foot::kTyre;
  EXPECT_LT(ground.slope_rad(-0.2, 0.0, kind), 15.0 * kDegree);
  EXPECT_TRUE(std::isnan(ground.slope_rad(0.4, 0.0, kind)));
  EXPECT_NEAR(ground.slope_rad(1.0, 0.0, kind), 0.0, 1e-6);
}

TEST(CheckedGround, NoSampleWithinIsHigherThanTheMaximum) {
  const CheckedGround ground =
      make_ground([](double x, double y) { return std::sin(3.0 * x) + std::cos(2.0 * y); });
  for (double x = -4.0; x <= 4.0; x += 0.37) {
    double highest = -1e9;
    for (double dx = -0.5; dx <= 0.5; dx += 0.1) {
      for (double dy = -0.5; dy <= 0.5; dy += 0.1) {
        if (std::hypot(dx, dy) <= 0.5) highest = std::max(highest, ground.height_m(x + dx, dy));
      }
    }
    EXPECT_GE(ground.max_height_m(x, 0.0, 0.5), highest);
  }
}

TEST(SupportHull, MarginIsTheDistanceToTheBorderWithItsSign) {
  // A square of side 4 and a point inside it that is no corner of the hull.
  const std::vector<Eigen::Vector2d> square{{-2, -2}, {2, 2}, {2, -2}, {-2, 2}, {0.5, 0.1}};
  EXPECT_NEAR(hull_margin_m({0.0, 0.0}, square), 2.0, 1e-12);
  EXPECT_NEAR(hull_margin_m({1.5, 0.0}, square), 0.5, 1e-12);
  EXPECT_NEAR(hull_margin_m({3.0, 0.0}, square), -1.0, 1e-12);
  EXPECT_NEAR(hull_margin_m({5.0, 6.0}, square), -5.0, 1e-12);  // from the corner
}

TEST(SupportHull, PointsWithoutAnInsideGiveNoMargin) {
  EXPECT_NEAR(hull_margin_m({0.0, 1.0}, {{-1, 0}, {1, 0}}), -1.0, 1e-12);
  EXPECT_NEAR(hull_margin_m({0.0, 0.0}, {{-1, 0}, {1, 0}, {3, 0}}), 0.0, 1e-12);
  EXPECT_NEAR(hull_margin_m({3.0, 4.0}, {{0, 0}}), -5.0, 1e-12);
}

}  // namespace
}  // namespace wex::check
