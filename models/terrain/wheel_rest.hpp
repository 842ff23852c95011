#pragma once

#include <Eigen/Core>

#include "models/terrain/terrain_map.hpp"

namespace wex {

/// Height of a resting wheel's centre and its exact derivatives.
struct WheelRest {
  double height_m = 0.0;                              ///< world z of the centre
  Eigen::Vector2d by_xy = Eigen::Vector2d::Zero();    ///< d height / d centre xy
  Eigen::Vector3d by_axle = Eigen::Vector3d::Zero();  ///< d height / d axle
};

/// Where the centre of a tyre disc (radius r, half-width w, unit axle a) stands when it touches the
/// ground at p_world_xy. The tyre-dilated map is the answer for a ball; on ground that is tilted
/// along the axle by s = a . n (n ground normal) a disc stands on its edge:
///   z = h_dilated + r + [ r (sqrt(1 - s^2) - 1) + w |s| ] / n_z,
/// exact on inclined planes; |s| is rounded off within 0.6 degrees. No allocation; thread-safe.
[[nodiscard]] WheelRest wheel_rest(const TerrainMap& terrain, const Eigen::Vector2d& p_world_xy,
                                   const Eigen::Vector3d& axle_world, double radius_m,
                                   double half_width_m) noexcept;

}  // namespace wex
