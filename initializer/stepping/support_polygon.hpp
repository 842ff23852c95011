#pragma once

#include <Eigen/Core>
#include <span>

namespace wex {

/// Signed distance of a point to the nearest edge of the convex hull of at most kNumLimbs points,
/// positive inside [m]; minus infinity for fewer than three. No allocation.
[[nodiscard]] double hull_margin_m(const Eigen::Vector2d& p,
                                   std::span<const Eigen::Vector2d> contacts) noexcept;

}  // namespace wex
