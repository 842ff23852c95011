#pragma once

#include <Eigen/Core>

#include "models/terrain/terrain_map.hpp"

namespace wex {

/// Middle of where a resting tyre disc touches the ground: its lowest point against the ground's
/// normal, and towards its lower edge where the ground is tilted along the axle. World frame [m].
/// Stability is judged by these points: on a slope they lie up to 0.3 m beside the wheel's centre.
[[nodiscard]] Eigen::Vector3d tyre_patch(const TerrainMap& terrain,
                                         const Eigen::Vector3d& p_world_wheel,
                                         const Eigen::Vector3d& axle_world, double radius_m,
                                         double half_width_m) noexcept;

}  // namespace wex
