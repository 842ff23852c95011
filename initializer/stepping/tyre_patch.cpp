#include "initializer/stepping/tyre_patch.hpp"

#include <cmath>

namespace wex {
namespace {

// The patch is what is pressed in by this much; on ground tilted along the axle that is a part of
// the tyre's width.
double shift_along_axle_m(double tilt, double half_width_m) {
  constexpr double kPressedM = 0.02;
  const double whole_width = kPressedM / (2.0 * half_width_m);
  return tilt < whole_width ? half_width_m / 3.0 * tilt / whole_width
                            : half_width_m - kPressedM / (3.0 * tilt);
}

}  // namespace

Eigen::Vector3d tyre_patch(const TerrainMap& terrain, const Eigen::Vector3d& p_world_wheel,
                           const Eigen::Vector3d& axle_world, double radius_m,
                           double half_width_m) noexcept {
  const Eigen::Vector2d slope = terrain.dilated_surface(p_world_wheel.head<2>()).gradient;
  const Eigen::Vector3d normal = Eigen::Vector3d(-slope.x(), -slope.y(), 1.0).normalized();
  const double along_axle = axle_world.dot(normal);
  const Eigen::Vector3d up_in_disc = (normal - along_axle * axle_world).normalized();
  const double shift_m = shift_along_axle_m(std::abs(along_axle), half_width_m);
  return p_world_wheel - radius_m * up_in_disc - std::copysign(shift_m, along_axle) * axle_world;
}

}  // namespace wex
