#include "initializer/stepping/support_polygon.hpp"

#include <algorithm>
#include <limits>

namespace wex {

double hull_margin_m(const Eigen::Vector2d& p, std::span<const Eigen::Vector2d> contacts) noexcept {
  constexpr double kOnLine = 1e-9;
  const auto cross = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() * b.y() - a.y() * b.x();
  };
  // An edge of the hull has every contact on its left.
  double margin_m = std::numeric_limits<double>::infinity();
  bool any = false;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    for (std::size_t j = 0; j < contacts.size(); ++j) {
      const Eigen::Vector2d edge = contacts[j] - contacts[i];
      const double length = edge.norm();
      if (i == j || length < kOnLine) continue;
      const bool outer =
          std::all_of(contacts.begin(), contacts.end(), [&](const Eigen::Vector2d& c) {
            return cross(edge, c - contacts[i]) >= -kOnLine * length;
          });
      if (!outer) continue;
      any = true;
      margin_m = std::min(margin_m, cross(edge, p - contacts[i]) / length);
    }
  }
  return any && contacts.size() >= 3 ? margin_m : -std::numeric_limits<double>::infinity();
}

}  // namespace wex
