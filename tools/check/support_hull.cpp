#include "tools/check/support_hull.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "models/types/result.hpp"

namespace wex::check {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double distance_to_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                           const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double length2 = along.squaredNorm();
  const double share = length2 > 0.0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (a + share * along - p).norm();
}

}  // namespace

double hull_margin_m(const Eigen::Vector2d& p, const std::vector<Eigen::Vector2d>& points) {
  WEX_EXPECTS(!points.empty());
  // Of a handful of points every line between two that has all others on its left is an edge.
  double outside_m = std::numeric_limits<double>::infinity();
  double inside_m = std::numeric_limits<double>::infinity();
  bool has_inside = false, is_inside = true;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < points.size(); ++j) {
      if (i == j && points.size() > 1) continue;
      outside_m = std::min(outside_m, distance_to_segment(p, points[i], points[j]));
      const Eigen::Vector2d edge = points[j] - points[i];
      const double length = edge.norm();
      if (length < 1e-9) continue;
      bool all_left = true, any_left = false;
      for (const Eigen::Vector2d& other : points) {
        const double left_m = cross(edge, other - points[i]) / length;
        all_left = all_left && left_m > -1e-9;
        any_left = any_left || left_m > 1e-6;
      }
      if (!all_left || !any_left) continue;
      has_inside = true;
      const double left_m = cross(edge, p - points[i]) / length;
      inside_m = std::min(inside_m, left_m);
      is_inside = is_inside && left_m >= 0.0;
    }
  }
  if (has_inside && is_inside) return inside_m;
  return -outside_m;
}

}  // namespace wex::check
