#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "models/types/limbs.hpp"

namespace wex {

struct BaseFrame;

/// Convex hull of the contacts that carry, seen from above; for the margin of many centres of mass.
/// No allocation.
class StancePolygon {
 public:
  /// Wheels that are not lifted; at least three (contract: fewer give a margin of minus infinity).
  StancePolygon(const std::array<Eigen::Vector3d, kNumWheels>& p_world_patch,
                std::uint8_t lifted) noexcept;
  /// The same with the bucket.
  StancePolygon(const std::array<Eigen::Vector3d, kNumWheels>& p_world_patch, std::uint8_t lifted,
                const Eigen::Vector3d& p_world_bucket, const BaseFrame& base) noexcept;

  /// Margin as a function of a moment in the base frame: what moves is added to what is fixed.
  class InBase {
   public:
    /// Signed distance of the centre of mass to the nearest edge, positive inside [m].
    [[nodiscard]] double margin_m(const Eigen::Vector3d& moment_base) const noexcept {
      double margin_m = none_m_;
      for (int i = 0; i < count_; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const double distance_m = offset_[at] + normal_[at].dot(moment_base);
        margin_m = distance_m < margin_m ? distance_m : margin_m;
      }
      return margin_m;
    }

   private:
    friend class StancePolygon;
    int count_ = 0;
    double none_m_ = -1e9;
    std::array<Eigen::Vector3d, kNumLimbs> normal_;  // [m / (kg m)]
    std::array<double, kNumLimbs> offset_{};
  };
  ///   fixed_moment_base  of everything whose moment is not given later [kg m]
  [[nodiscard]] InBase in_base(const BaseFrame& base, const Eigen::Vector3d& fixed_moment_base,
                               double mass_kg) const noexcept;

 private:
  void add(const Eigen::Vector3d& p) noexcept {
    p_[static_cast<std::size_t>(count_++)] = p.head<2>();
  }
  void make_convex() noexcept;

  int count_ = 0;  // counter-clockwise
  std::array<Eigen::Vector2d, kNumLimbs> p_;
};

}  // namespace wex
