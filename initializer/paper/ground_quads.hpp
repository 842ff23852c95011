#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "models/terrain/terrain_map.hpp"

namespace wex {

/// A point in cells of a map: u along x, v along y, counted from the ring around the map.
struct CellPoint {
  float u = 0.0F, v = 0.0F;
};

/// One layer of a map for very many bilinear queries in single precision: the four samples around
/// every cell lie side by side, so that a query touches one cache line. Off the map and beside
/// unknown samples the value is NaN, with which no comparison holds. No allocation in queries.
class GroundQuads {
 public:
  explicit GroundQuads(const Grid& grid);

  [[nodiscard]] CellPoint cells(const Eigen::Vector2d& p_world_xy) const noexcept {
    return {static_cast<float>((p_world_xy.x() - x_m_) * per_m_),
            static_cast<float>((p_world_xy.y() - y_m_) * per_m_)};
  }
  [[nodiscard]] double cells_per_m() const noexcept { return per_m_; }

  [[nodiscard]] float at(float u, float v) const noexcept {
    const float cu = std::clamp(u, 0.0F, max_u_), cv = std::clamp(v, 0.0F, max_v_);
    const int i = static_cast<int>(cu), j = static_cast<int>(cv);
    const float* q = data() + 4 * (j * stride_ + i);
    const float s = cu - static_cast<float>(i), t = cv - static_cast<float>(j);
    const float low = q[0] + s * (q[1] - q[0]), high = q[2] + s * (q[3] - q[2]);
    return low + t * (high - low);
  }
  [[nodiscard]] float at(CellPoint p) const noexcept { return at(p.u, p.v); }

 private:
  struct alignas(16) Quad {
    float value[4];  // (i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)
  };
  [[nodiscard]] const float* data() const noexcept { return quads_.front().value; }

  std::vector<Quad> quads_;
  int stride_ = 0;
  float max_u_ = 0.0F, max_v_ = 0.0F;
  double x_m_ = 0.0, y_m_ = 0.0, per_m_ = 10.0;  // of the ring's first sample
};

/// A base pose in the cells of a map: what is fixed in the base goes into cells and height by nine
/// multiplications.
struct CellPose {
  CellPose(const Eigen::Isometry3d& T_world_base, const GroundQuads& ground) noexcept;

  [[nodiscard]] CellPoint cells(float x, float y, float z) const noexcept {
    return {u + ux * x + uy * y + uz * z, v + vx * x + vy * y + vz * z};
  }
  [[nodiscard]] float height_m(float x, float y, float z) const noexcept {
    return h + hx * x + hy * y + hz * z;
  }
  float u, ux, uy, uz, v, vx, vy, vz, h, hx, hy, hz;
};

}  // namespace wex
