#include "initializer/pose_check.hpp"

#include <gmock/gmock.h>

#include <numbers>
#include <random>

#include "tests/initializer/test_worlds.hpp"

namespace wex {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

PoseCheck make_check(const TerrainMap& map, const PlanSettings& settings = {}) {
  auto check = PoseCheck::build(map, test_machine(), settings);
  if (!check) throw std::runtime_error(check.error().message);
  return *std::move(check);
}

StandingPose stand(const TerrainMap& map, const Pose2& pose, const PlanSettings& settings = {}) {
  return make_check(map, settings).stand(pose, PoseCheck::Steering{});
}

std::vector<Pose2> random_poses(int count, double half_x_m, double half_y_m) {
  std::mt19937 generator(11);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Pose2> poses;
  for (int i = 0; i < count; ++i) {
    poses.push_back({half_x_m * unit(generator), half_y_m * unit(generator),
                     std::numbers::pi * unit(generator)});
  }
  return poses;
}

TEST(PoseCheck, OnFlatGroundTheBaseIsLevelAtItsDefaultHeight) {
  const StandingPose pose = stand(flat_map(), {1.0, 2.0, 0.7});
  ASSERT_TRUE(pose.ok()) << describe(pose, Eigen::Vector2d::Zero());
  EXPECT_NEAR(pose.base[kBaseZ], test_machine().default_base_height_m, 1e-6);
  EXPECT_NEAR(pose.base[kBaseRoll], 0.0, 1e-9);
  EXPECT_NEAR(pose.base[kBasePitch], 0.0, 1e-9);
  // Closed forms of the wheel's height over hip flexion from the joint table, tyre at static sag.
  const double front_sag_m = test_machine().legs[0].static_sag_m;
  const double hind_sag_m = test_machine().legs[2].static_sag_m;
  const double front = pose.hfe_rad[0], hind = pose.hfe_rad[2];
  EXPECT_NEAR(0.1335 - 0.0925 + 1.2 * std::sin(front) + front_sag_m, 0.6 - 0.95, 1e-3);
  EXPECT_NEAR(0.06 + 1.68 * std::sin(hind) + (0.1055 + hind_sag_m) * std::cos(hind), 0.6 - 0.95,
              3e-3);
}

// Ground rising to the north by 10 degrees.
TEST(PoseCheck, OnASlopeTheBaseFollowsTheGroundInRollOrPitch) {
  const double slope = std::tan(10.0 * kDegree);
  const TerrainMap map = make_map(40.0, 30.0, [&](double, double y) { return slope * y; });
  const StandingPose across = stand(map, {0.0, 1.0, 0.0});
  ASSERT_TRUE(across.ok());
  EXPECT_NEAR(across.base[kBaseRoll], 10.0 * kDegree, 1e-4);  // left side up
  EXPECT_NEAR(across.base[kBasePitch], 0.0, 1e-4);
  EXPECT_NEAR(across.base[kBaseZ], slope + test_machine().default_base_height_m, 1e-3);
  const StandingPose uphill = stand(map, {0.0, 1.0, 0.5 * std::numbers::pi});
  ASSERT_TRUE(uphill.ok());
  EXPECT_NEAR(uphill.base[kBaseRoll], 0.0, 1e-4);
  EXPECT_NEAR(uphill.base[kBasePitch], -10.0 * kDegree, 1e-4);  // nose up
}

TEST(PoseCheck, MoreTiltThanAllowedIsRefusedAsTilt) {
  const double slope = std::tan(25.0 * kDegree);
  const TerrainMap map = make_map(40.0, 30.0, [&](double x, double) { return slope * x; });
  EXPECT_EQ(stand(map, {0.0, 0.0, 0.0}).rejection, Rejection::kTilt);
}

TEST(PoseCheck, NamesTheWheelThatStandsOverAPit) {
  // A pit under the left front wheel only.
  const TerrainMap map = make_map(40.0, 30.0, [](double x, double y) {
    return std::hypot(x - 2.5, y - 1.5) < 1.0 ? -2.0 : 0.0;
  });
  const StandingPose pose = stand(map, {0.0, 0.0, 0.0});
  ASSERT_FALSE(pose.ok());
  EXPECT_EQ(pose.wheel, 0);
  EXPECT_THAT(describe(pose, Eigen::Vector2d(100.0, 0.0)), testing::HasSubstr("wheel LF"));
  EXPECT_THAT(describe(pose, Eigen::Vector2d(100.0, 0.0)), testing::HasSubstr("(102."));
}

TEST(PoseCheck, AWheelOffTheMapIsARejection) {
  const StandingPose pose = stand(flat_map(40.0, 30.0), {19.0, 0.0, 0.0});
  EXPECT_FALSE(pose.ok());
}

TEST(PoseCheck, ABoulderUnderTheChassisIsTooLittleClearanceOrLiftsTheChassis) {
  const auto with_boulder = [](double height_m) {
    return make_map(40.0, 30.0,
                    [=](double x, double y) { return std::max(0.0, height_m - std::hypot(x, y)); });
  };
  const StandingPose low = stand(with_boulder(0.7), {0.0, 0.0, 0.0});
  ASSERT_TRUE(low.ok()) << describe(low, Eigen::Vector2d::Zero());
  EXPECT_GE(low.base[kBaseZ] - test_machine().belly_below_base_m - 0.7, 0.05);
  EXPECT_EQ(stand(with_boulder(1.5), {0.0, 0.0, 0.0}).rejection, Rejection::kBelly);
}

TEST(PoseCheck, RaisingADemandNeverMakesAnInfeasiblePoseFeasible) {
  const TerrainMap map = make_map(40.0, 30.0, bumps);
  const PoseCheck lenient = make_check(map);
  PlanSettings margin, distance, clearance, tilt;
  margin.min_stability_margin_m = 1.1;
  distance.min_signed_distance_m = 0.6;
  clearance.belly_clearance_m = 0.35;
  tilt.max_tilt_rad = 8.0 * kDegree;
  for (const PlanSettings& settings : {margin, distance, clearance, tilt}) {
    const PoseCheck strict = make_check(map, settings);
    int lenient_ok = 0, strict_ok = 0;
    for (const Pose2& pose : random_poses(1500, 17.0, 12.0)) {
      const bool ok = lenient.stand(pose, PoseCheck::Steering{}).ok();
      const bool still_ok = strict.stand(pose, PoseCheck::Steering{}).ok();
      lenient_ok += ok;
      strict_ok += still_ok;
      EXPECT_LE(still_ok, ok);
    }
    EXPECT_LT(strict_ok, lenient_ok) << "the demand made no difference: nothing was tested";
    EXPECT_GT(strict_ok, 0);
  }
}

TEST(PoseCheck, ShiftingMapAndPoseTogetherChangesNothing) {
  const Eigen::Vector2d shift(131.7, -42.3);
  const TerrainMap map = make_map(40.0, 30.0, bumps);
  const TerrainMap shifted = make_map(40.0, 30.0, bumps, shift);
  const PoseCheck check = make_check(map), check_shifted = make_check(shifted);
  int num_ok = 0;
  for (const Pose2& pose : random_poses(1000, 18.0, 13.0)) {
    const StandingPose here = check.stand(pose, PoseCheck::Steering{});
    const StandingPose there = check_shifted.stand(
        {pose.x_m + shift.x(), pose.y_m + shift.y(), pose.yaw_rad}, PoseCheck::Steering{});
    EXPECT_EQ(here.rejection, there.rejection);
    EXPECT_NEAR(here.base[kBaseZ], there.base[kBaseZ], 1e-4);
    EXPECT_NEAR(here.stability_margin_m, there.stability_margin_m, 1e-4);
    num_ok += here.ok();
  }
  EXPECT_GT(num_ok, 100);
  EXPECT_LT(num_ok, 990);
}

// The arm is not in the middle of the machine, so only stability may tell left from right.
TEST(PoseCheck, MirroredGroundGivesMirroredFeasibility) {
  const TerrainMap map = make_map(40.0, 30.0, bumps);
  const TerrainMap mirrored = make_map(40.0, 30.0, [](double x, double y) { return bumps(x, -y); });
  PlanSettings settings;
  settings.min_stability_margin_m = 0.0;
  const PoseCheck check = make_check(map, settings);
  const PoseCheck check_mirrored = make_check(mirrored, settings);
  int num_ok = 0;
  for (const Pose2& pose : random_poses(1000, 18.0, 13.0)) {
    // Of two nearest traversable cells at the same distance only one is a candidate.
    if (!map.traversable_at({pose.x_m, pose.y_m})) continue;
    const StandingPose left = check.stand(pose, PoseCheck::Steering{});
    const StandingPose right =
        check_mirrored.stand({pose.x_m, -pose.y_m, -pose.yaw_rad}, PoseCheck::Steering{});
    EXPECT_EQ(left.ok(), right.ok())
        << describe(left, {0.0, 0.0}) << " / " << describe(right, {0.0, 0.0});
    if (!left.ok() || !right.ok()) continue;
    ++num_ok;
    EXPECT_NEAR(left.base[kBaseZ], right.base[kBaseZ], 1e-3);
    EXPECT_NEAR(left.base[kBaseRoll], -right.base[kBaseRoll], 1e-3);
    EXPECT_NEAR(left.hfe_rad[0], right.hfe_rad[1], 1e-2);
    EXPECT_NEAR(left.hfe_rad[2], right.hfe_rad[3], 1e-2);
  }
  EXPECT_GT(num_ok, 100);
  EXPECT_LT(num_ok, 990);
}

TEST(PoseCheck, SupportMarginIsTheDistanceToTheNearestEdge) {
  const std::array<Eigen::Vector2d, kNumWheels> square{
      Eigen::Vector2d(2.0, 1.0), Eigen::Vector2d(2.0, -1.0), Eigen::Vector2d(-2.0, 1.0),
      Eigen::Vector2d(-2.0, -1.0)};
  EXPECT_NEAR(support_margin_m({0.0, 0.0}, square), 1.0, 1e-12);
  EXPECT_NEAR(support_margin_m({1.7, 0.0}, square), 0.3, 1e-12);
  EXPECT_NEAR(support_margin_m({0.0, -1.4}, square), -0.4, 1e-12);
}

}  // namespace
}  // namespace wex
