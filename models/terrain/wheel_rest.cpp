#include "models/terrain/wheel_rest.hpp"

#include <cmath>

namespace wex {

WheelRest wheel_rest(const TerrainMap& terrain, const Eigen::Vector2d& p_world_xy,
                     const Eigen::Vector3d& axle_world, double radius_m,
                     double half_width_m) noexcept {
  constexpr double kRounding = 0.01;  // of |s|, so that derivatives exist at s = 0
  const SurfaceSample ground = terrain.dilated_surface(p_world_xy);
  const Eigen::Vector2d& g = ground.gradient;
  const Eigen::Vector3d up(-g.x(), -g.y(), 1.0);  // n = up / |up|, 1 / n_z = |up|
  const double length = up.norm();
  const double s = axle_world.dot(up) / length;
  const double cosine = std::sqrt(1.0 - s * s);
  const double rounded = std::sqrt(s * s + kRounding * kRounding);
  const double edge_m = radius_m * (cosine - 1.0) + half_width_m * (rounded - kRounding);
  const double edge_by_s = -radius_m * s / cosine + half_width_m * s / rounded;

  const Eigen::Vector2d length_by_xy = ground.hessian * g / length;
  const Eigen::Vector2d s_by_xy =
      -(ground.hessian * axle_world.head<2>() + s * length_by_xy) / length;
  WheelRest rest;
  rest.height_m = ground.value + radius_m + edge_m * length;
  rest.by_xy = g + edge_by_s * length * s_by_xy + edge_m * length_by_xy;
  rest.by_axle = edge_by_s * up;
  return rest;
}

}  // namespace wex
