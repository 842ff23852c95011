#pragma once

#include <Eigen/Geometry>
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

  /// What a query needs, in registers: loops over it become vectors.
  struct View {
    const float* values;
    int stride;
    float max_u, max_v;

    [[nodiscard]] float at(float u, float v) const noexcept {
      const float cu = within(u, max_u), cv = within(v, max_v);
      const int i = static_cast<int>(cu), j = static_cast<int>(cv);
      const int first = 4 * (j * stride + i);
      const float s = cu - static_cast<float>(i), t = cv - static_cast<float>(j);
      const float a = values[first], b = values[first + 1], c = values[first + 2],
                  d = values[first + 3];
      const float low = a + s * (b - a), high = c + s * (d - c);
      return low + t * (high - low);
    }

   private:
    [[nodiscard]] static float within(float value, float most) noexcept {
      const float positive = value > 0.0F ? value : 0.0F;
      return positive < most ? positive : most;
    }
    friend class GroundQuads;
  };
  [[nodiscard]] View view() const noexcept {
    View view;
    view.values = quads_.data()->value;
    view.stride = stride_;
    view.max_u = max_u_;
    view.max_v = max_v_;
    return view;
  }
  [[nodiscard]] float at(CellPoint p) const noexcept { return view().at(p.u, p.v); }

 private:
  struct alignas(16) Quad {
    float value[4];  // (i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)
  };

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
