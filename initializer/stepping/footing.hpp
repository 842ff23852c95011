#pragma once

#include <Eigen/Geometry>
#include <array>
#include <span>

#include "initializer/stepping/support_polygon.hpp"
#include "initializer/stepping/wheel_placer.hpp"

namespace wex {

/// A base that stands on contacts, everything but cabin and arm decided.
struct Footing {
  BaseCoordinates base;
  Eigen::Isometry3d T_world_base;
  std::array<Eigen::Vector2d, kNumLimbs> contacts;  ///< world [m]
  std::size_t num_contacts = 0;
  Eigen::Vector3d moment_base;  ///< of all but cabin and arm [kg m]
  double mass_kg = 0.0;         ///< of the whole machine

  /// Static stability with cabin and arm of this moment.
  [[nodiscard]] double margin_m(const Eigen::Vector3d& arm_moment_base) const noexcept {
    const Eigen::Vector3d com = T_world_base * ((moment_base + arm_moment_base) / mass_kg);
    return hull_margin_m(com.head<2>(), std::span(contacts.data(), num_contacts));
  }
};

/// Footing on the wheels that are not lifted, and on the bucket if given.
[[nodiscard]] inline Footing footing_on(const BaseCoordinates& base,
                                        const WheelPlacement& placement, std::uint8_t lifted,
                                        const Eigen::Vector3d* p_world_bucket, double mass_kg) {
  Footing footing;
  footing.base = base;
  footing.T_world_base = T_world_base_from(base);
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    if ((lifted >> i & 1) != 0) continue;
    footing.contacts[footing.num_contacts++] = placement.p_world_patch[i].head<2>();
  }
  if (p_world_bucket != nullptr) {
    footing.contacts[footing.num_contacts++] = p_world_bucket->head<2>();
  }
  footing.moment_base = placement.moment_base;
  footing.mass_kg = mass_kg;
  return footing;
}

}  // namespace wex
