#include "models/excavator/internal/capsule_cover.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace wex::shapes {
namespace {

/// How far the rods a box is cut into may stick out of its sides, were they to end where it ends,
/// and how far they do so that they can end inside.
constexpr double kMinProtrusion_m = 0.067, kProtrusion_m = 0.08;
constexpr int kMaxRods = 32;  ///< side by side
constexpr int kRingSides = 8;

using Capsules = std::vector<CoverCapsule>;

/// Fewest rods that fit: nu x nv of half sizes u, v.
std::array<int, 2> fewest_rods(double half_u_m, double half_v_m) {
  std::array<int, 2> best{kMaxRods, kMaxRods};
  for (int nu = 1; nu <= kMaxRods; ++nu) {
    for (int nv = 1; nv <= nu; ++nv) {
      const double u = half_u_m / nu, v = half_v_m / nv;
      const bool fits = std::hypot(u, v) - std::min(u, v) <= kMinProtrusion_m;
      if (fits && nu * nv < best[0] * best[1]) best = {nu, nv};
    }
  }
  return best;
}

/// Rods along the longest side. A rod contains its part of the box if it reaches the corners, that
/// is u, v and how far its axis ends inside.
Capsules cover_box(const Eigen::Vector3d& half_m) {
  std::array<int, 3> axes{0, 1, 2};
  std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return half_m[a] > half_m[b]; });
  const auto [nu, nv] = fewest_rods(half_m[axes[1]], half_m[axes[2]]);
  const double u = half_m[axes[1]] / nu, v = half_m[axes[2]] / nv;
  const double radius_m = std::min(u, v) + kProtrusion_m;
  const double inset_m = std::min(std::sqrt(radius_m * radius_m - u * u - v * v), half_m[axes[0]]);
  Capsules capsules;
  for (int i = 0; i < nu; ++i) {
    for (int j = 0; j < nv; ++j) {
      Eigen::Vector3d a = Eigen::Vector3d::Zero();
      a[axes[1]] = -half_m[axes[1]] + (2 * i + 1) * u;
      a[axes[2]] = -half_m[axes[2]] + (2 * j + 1) * v;
      Eigen::Vector3d b = a;
      b[axes[0]] = half_m[axes[0]] - inset_m;
      a[axes[0]] = -b[axes[0]];
      capsules.push_back({a, b, radius_m});
    }
  }
  return capsules;
}

/// Ring: at the apothem `a` a rod of radius r reaches the edges (R, +-w) with r^2 = (R-a)^2 + w^2,
/// and inwards everything beyond (2a - R) / cos(pi/n); the ball fills the rest.
Capsules cover_disc(double radius_m, double half_width_m) {
  const double a = std::max(0.5 * radius_m, radius_m - half_width_m);
  const double ring_cos = std::cos(std::numbers::pi / kRingSides);
  const double rod = std::hypot(radius_m - a, half_width_m);
  const double hole = (2.0 * a - radius_m) / ring_cos;
  const auto corner = [&](int i) -> Eigen::Vector3d {
    const double angle = 2.0 * std::numbers::pi * i / kRingSides;
    return Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0) * (a / ring_cos);
  };
  Capsules capsules;
  for (int i = 0; i < kRingSides; ++i) capsules.push_back({corner(i), corner(i + 1), rod});
  capsules.push_back(
      {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), std::hypot(hole, half_width_m)});
  return capsules;
}

/// A cylinder longer than wide: one rod.
Capsules cover_rod(double radius_m, double half_length_m) {
  const double rod_m = radius_m + kProtrusion_m;
  const double inset_m = std::min(std::sqrt(rod_m * rod_m - radius_m * radius_m), half_length_m);
  const Eigen::Vector3d end(0.0, 0.0, half_length_m - inset_m);
  return {{-end, end, rod_m}};
}

}  // namespace

std::vector<CoverCapsule> capsule_cover(const Shape& shape) {
  const double radius_m = shape.size_m[0], half_length_m = shape.size_m[1];
  Capsules capsules;
  if (shape.form == Form::kBox) {
    capsules = cover_box(shape.size_m);
  } else if (shape.form == Form::kCapsule) {
    const Eigen::Vector3d end(0.0, 0.0, half_length_m);
    capsules = {{-end, end, radius_m}};
  } else {
    capsules = half_length_m < radius_m ? cover_disc(radius_m, half_length_m)
                                        : cover_rod(radius_m, half_length_m);
  }
  for (CoverCapsule& capsule : capsules) {
    const Eigen::Vector3d a = capsule.p_link_a, b = capsule.p_link_b;
    capsule.p_link_a = shape.T_link_shape * a;
    capsule.p_link_b = shape.T_link_shape * b;
  }
  return capsules;
}

}  // namespace wex::shapes
