#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "models/terrain/terrain_map.hpp"

namespace wex {

/// Middle of where a resting tyre disc touches the ground: its lowest point against the ground's
/// normal, and towards its lower edge where the ground is tilted along the axle. World frame [m].
/// Stability is judged by these points: on a slope they lie up to 0.3 m beside the wheel's centre.
[[nodiscard]] Eigen::Vector3d tyre_patch(const TerrainMap& terrain,
                                         const Eigen::Vector3d& p_world_wheel,
                                         const Eigen::Vector3d& axle_world, double radius_m,
                                         double half_width_m) noexcept;

/// How far a tyre's tread is above the ground at its lowest, negative: in it [m]. That of a wheel
/// put to rest as a disc, which on rough ground is an approximation, may be kTreadErrorM off.
///   height_at(x, y)  of the ground as the map draws it
///   num_angles  across the tread, over `half_angle_rad` to both sides of its lowest point
template <typename HeightAt>
[[nodiscard]] double tread_clearance_m(const HeightAt& height_at,
                                       const Eigen::Vector3d& p_world_wheel,
                                       const Eigen::Vector3d& axle_world, double radius_m,
                                       double half_width_m, int num_angles = 15,
                                       double half_angle_rad = 1.0) noexcept {
  constexpr int kWidths = 3;
  const Eigen::Vector3d down =
      (axle_world.z() * axle_world - Eigen::Vector3d::UnitZ()).normalized();
  const Eigen::Vector3d forward = down.cross(axle_world);
  double least_m = 1e9;
  for (int i = 0; i < num_angles; ++i) {
    const double angle = half_angle_rad * (2.0 * i / (num_angles - 1) - 1.0);
    const Eigen::Vector3d middle =
        p_world_wheel + radius_m * (std::cos(angle) * down + std::sin(angle) * forward);
    for (int j = 0; j < kWidths; ++j) {
      const Eigen::Vector3d p =
          middle + half_width_m * (2.0 * j / (kWidths - 1) - 1.0) * axle_world;
      least_m = std::min(least_m, p.z() - height_at(p.x(), p.y()));
    }
  }
  return least_m;
}
inline constexpr double kTreadErrorM = 0.017;

/// Horizontal distance from its foothold beyond which a wheel swings: nearer it lifts off or lands.
inline constexpr double kFootholdM = 0.28;

}  // namespace wex
