#include "models/types/pose.hpp"

#include <gmock/gmock.h>

#include <numbers>
#include <random>

namespace wex {
namespace {

constexpr double kTolerance = 1e-9;  // m and rad, at poses up to 100 m from the origin
constexpr double kPi = std::numbers::pi;

/// Base coordinates with yaw and roll anywhere and pitch up to 1 mrad from vertical.
BaseCoordinates random_base(std::mt19937& random) {
  std::uniform_real_distribution<double> position_m(-100.0, 100.0);
  std::uniform_real_distribution<double> turn_rad(-kPi, kPi);
  std::uniform_real_distribution<double> pitch_rad(-kPi / 2 + 1e-3, kPi / 2 - 1e-3);
  BaseCoordinates base;
  base << position_m(random), position_m(random), position_m(random), turn_rad(random),
      pitch_rad(random), turn_rad(random);
  return base;
}

TEST(BasePose, SurvivesTheRoundTripAtRandomPoses) {
  std::mt19937 random(11);
  for (int i = 0; i < 1000; ++i) {
    const BaseCoordinates base = random_base(random);
    const BaseCoordinates back = base_coordinates_from(T_world_base_from(base));
    EXPECT_LT((back - base).cwiseAbs().maxCoeff(), kTolerance) << base.transpose();
  }
}

TEST(BasePose, IsTheSameTransformWhereTheAnglesAreNotUnique) {
  std::mt19937 random(12);
  for (int i = 0; i < 1000; ++i) {
    BaseCoordinates base = random_base(random);
    base[kBaseYaw] += 2.0 * kPi * static_cast<double>(i % 7 - 3);  // unwrapped yaw
    base[kBasePitch] *= 2.0;                                       // beyond the vertical
    const Eigen::Isometry3d T_world_base = T_world_base_from(base);
    const Eigen::Isometry3d T_again = T_world_base_from(base_coordinates_from(T_world_base));
    EXPECT_TRUE(T_again.isApprox(T_world_base, kTolerance)) << base.transpose();
  }
}

TEST(BasePose, IsARotationMatrixWithoutReflection) {
  std::mt19937 random(13);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Matrix3d R = T_world_base_from(random_base(random)).linear();
    EXPECT_TRUE((R * R.transpose()).isIdentity(kTolerance));
    EXPECT_NEAR(R.determinant(), 1.0, kTolerance);
  }
}

TEST(BasePose, TurnsLeftNosesDownAndRollsRightWithPositiveAngles) {
  BaseCoordinates base = BaseCoordinates::Zero();
  base[kBaseYaw] = 0.1;
  EXPECT_GT((T_world_base_from(base) * Eigen::Vector3d::UnitX()).y(), 0.0);
  base = BaseCoordinates::Zero();
  base[kBasePitch] = 0.1;
  EXPECT_LT((T_world_base_from(base) * Eigen::Vector3d::UnitX()).z(), 0.0);
  base = BaseCoordinates::Zero();
  base[kBaseRoll] = 0.1;
  EXPECT_GT((T_world_base_from(base) * Eigen::Vector3d::UnitY()).z(), 0.0);
}

TEST(BasePose, YawActsAfterPitchAndRoll) {
  BaseCoordinates base = BaseCoordinates::Zero();
  base[kBaseYaw] = kPi / 2;
  base[kBasePitch] = kPi / 6;
  const Eigen::Vector3d x_world = T_world_base_from(base).linear() * Eigen::Vector3d::UnitX();
  EXPECT_TRUE(x_world.isApprox(Eigen::Vector3d(0.0, std::cos(kPi / 6), -0.5), kTolerance));
}

TEST(WrapAngle, GivesTheNearestEquivalentAngle) {
  EXPECT_NEAR(wrap_angle(0.3 + 4.0 * kPi), 0.3, kTolerance);
  EXPECT_NEAR(wrap_angle(-0.3 - 6.0 * kPi), -0.3, kTolerance);
  EXPECT_NEAR(wrap_angle(kPi + 0.1), -kPi + 0.1, kTolerance);
  std::mt19937 random(14);
  std::uniform_real_distribution<double> angle_rad(-50.0, 50.0);
  for (int i = 0; i < 1000; ++i) {
    const double angle = angle_rad(random);
    const double wrapped = wrap_angle(angle);
    EXPECT_LE(std::abs(wrapped), kPi);
    EXPECT_NEAR(std::sin(wrapped), std::sin(angle), kTolerance) << angle;
    EXPECT_NEAR(std::cos(wrapped), std::cos(angle), kTolerance) << angle;
  }
}

}  // namespace
}  // namespace wex
