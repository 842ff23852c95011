#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace wex {

/// Planar pose in the world frame: metres, radians, yaw about world z.
struct Pose2 {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;
  bool operator==(const Pose2&) const = default;
};

/// The nearest equivalent angle in (-pi, pi].
[[nodiscard]] inline double wrap_angle(double angle_rad) {
  return std::remainder(angle_rad, 2.0 * std::numbers::pi);
}

/// Layout of the base part of generalized coordinates: x, y, z, yaw, pitch, roll (ZYX Euler
/// angles).
inline constexpr int kNumBaseCoordinates = 6;
enum BaseCoordinate { kBaseX = 0, kBaseY, kBaseZ, kBaseYaw, kBasePitch, kBaseRoll };
using BaseCoordinates = Eigen::Matrix<double, kNumBaseCoordinates, 1>;

/// R_world_base = Rz(yaw) Ry(pitch) Rx(roll).
[[nodiscard]] inline Eigen::Isometry3d T_world_base_from(const BaseCoordinates& base) {
  Eigen::Isometry3d T_world_base = Eigen::Isometry3d::Identity();
  T_world_base.linear() = (Eigen::AngleAxisd(base[kBaseYaw], Eigen::Vector3d::UnitZ()) *
                           Eigen::AngleAxisd(base[kBasePitch], Eigen::Vector3d::UnitY()) *
                           Eigen::AngleAxisd(base[kBaseRoll], Eigen::Vector3d::UnitX()))
                              .toRotationMatrix();
  T_world_base.translation() = base.head<3>();
  return T_world_base;
}

/// Inverse of T_world_base_from; pitch in (-pi/2, pi/2), yaw and roll in (-pi, pi].
[[nodiscard]] inline BaseCoordinates base_coordinates_from(const Eigen::Isometry3d& T_world_base) {
  const Eigen::Matrix3d R = T_world_base.linear();
  BaseCoordinates base;
  base << T_world_base.translation(), std::atan2(R(1, 0), R(0, 0)),
      std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0))), std::atan2(R(2, 1), R(2, 2));
  return base;
}

}  // namespace wex
