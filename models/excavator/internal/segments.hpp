#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace wex {

/// The nearest points a + s (b-a) and c + t (d-c) of two segments, s and t in [0, 1]; segments may
/// be points. At parallel segments one of the nearest pairs.
struct NearestOnSegments {
  double s = 0.0, t = 0.0;
  Eigen::Vector3d between;  ///< from the second's point to the first's
};

[[nodiscard]] inline NearestOnSegments nearest_on_segments(const Eigen::Vector3d& a,
                                                           const Eigen::Vector3d& b,
                                                           const Eigen::Vector3d& c,
                                                           const Eigen::Vector3d& d) noexcept {
  constexpr double kPoint_m2 = 1e-18;  ///< squared length of what counts as a point
  constexpr double kParallel = 1e-12;  ///< squared sine between axes
  const Eigen::Vector3d u = b - a, v = d - c, r = a - c;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v);
  const double ur = u.dot(r), vr = v.dot(r);
  double s = 0.0, t = 0.0;
  if (uu <= kPoint_m2) {
    if (vv > kPoint_m2) t = std::clamp(vr / vv, 0.0, 1.0);
  } else if (vv <= kPoint_m2) {
    s = std::clamp(-ur / uu, 0.0, 1.0);
  } else {
    const double sine = uu * vv - uv * uv;
    if (sine > kParallel * uu * vv) s = std::clamp((uv * vr - ur * vv) / sine, 0.0, 1.0);
    t = (uv * s + vr) / vv;
    if (t < 0.0 || t > 1.0) {
      t = std::clamp(t, 0.0, 1.0);
      s = std::clamp((uv * t - ur) / uu, 0.0, 1.0);
    }
  }
  return {s, t, r + s * u - t * v};
}

}  // namespace wex
