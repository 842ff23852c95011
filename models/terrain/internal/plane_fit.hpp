#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/terrain/terrain_map.hpp"

namespace wex::terrain_internal {

/// One least-squares plane per cell, over the known cells whose centres lie within a radius.
struct PlaneFit {
  Grid height;                            ///< the plane at the cell's centre [m]; NaN if unknown
  std::vector<Eigen::Vector2f> gradient;  ///< dz/dx, dz/dy [-]; zero where the cell is unknown

  [[nodiscard]] Eigen::Vector3d normal_at(std::size_t cell) const;  ///< unit length, z > 0
};

/// Fits every known cell. Where the known neighbours lie on one line the slope across it is taken
/// as zero, and a lone cell is level (the minimum-norm solution).
///   radius_m  at least 1.5 cells are used, so that a coarse grid still has a slope
///   method    row-wise prefix sums of the moments, one difference per row of the disc
[[nodiscard]] PlaneFit fit_planes(const Grid& elevation, double radius_m);

}  // namespace wex::terrain_internal
