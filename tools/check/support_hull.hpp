#pragma once

#include <Eigen/Core>
#include <vector>

namespace wex::check {

/// Signed distance of a point to the border of the convex hull of others, positive inside [m].
/// Points on one line (or fewer than three) have no inside: minus the distance to them.
///   points  not empty (contract)
[[nodiscard]] double hull_margin_m(const Eigen::Vector2d& p,
                                   const std::vector<Eigen::Vector2d>& points);

}  // namespace wex::check
