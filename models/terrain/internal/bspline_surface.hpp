#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/terrain/terrain_map.hpp"

namespace wex::terrain_internal {

/// C2 bicubic B-spline through the samples of a grid, natural at the edges (second derivative zero
/// across them, so that planes are reproduced exactly up to the edge).
class BsplineSurface {
 public:
  BsplineSurface() = default;
  /// Solves for the coefficients.
  ///   samples  every value finite (contract), at least 2 x 2
  explicit BsplineSurface(const Grid& samples);

  /// Value, gradient and Hessian. Beyond the edge the point is clamped to it, and the derivatives
  /// are those of the clamped surface (zero across the edge). NaN in, NaN out. No allocation.
  [[nodiscard]] SurfaceSample sample(const Eigen::Vector2d& p_world_xy) const noexcept;

 private:
  int size_x_ = 0, size_y_ = 0;
  double cell_m_ = 1.0;
  Eigen::Vector2d origin_m_ = Eigen::Vector2d::Zero();
  std::vector<double> coefficients_;  ///< (size_x + 2) x (size_y + 2), row-major, one ring added
};

}  // namespace wex::terrain_internal
