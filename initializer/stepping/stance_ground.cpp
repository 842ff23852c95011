#include "initializer/stepping/stance_ground.hpp"

#include <cmath>

namespace wex {
namespace {

using Mask = std::vector<std::uint8_t>;

// Slope of the 3 x 3 cells around (least squares, so one noisy cell does not decide). Infinite next
// to the map's edge.
double local_gradient(const Grid& height, int i, int j) {
  if (i < 1 || j < 1 || i + 1 >= height.size_x || j + 1 >= height.size_y) return 1e9;
  double gx = 0.0, gy = 0.0;
  for (int d = -1; d <= 1; ++d) {
    gx += height.at(i + 1, j + d) - height.at(i - 1, j + d);
    gy += height.at(i + d, j + 1) - height.at(i + d, j - 1);
  }
  return std::hypot(gx, gy) / (6.0 * height.cell_m);
}

bool known_within(const Grid& height, int i, int j, int radius) {
  for (int b = j - radius; b <= j + radius; ++b) {
    for (int a = i - radius; a <= i + radius; ++a) {
      const bool inside = a >= 0 && b >= 0 && a < height.size_x && b < height.size_y;
      if (inside && std::isnan(height.at(a, b))) return false;
    }
  }
  return true;
}

// Traversable cells, and those that are not only because the slope there was fitted across a rim.
Mask standing_mask(const TerrainMap& terrain) {
  const TerrainSettings defaults;
  const double max_gradient = std::tan(defaults.max_slope_rad);
  const Grid& height = terrain.elevation();
  const int tyre_cells = static_cast<int>(std::ceil(defaults.wheel_radius_m / height.cell_m));
  Mask mask(height.values.size(), 0);
  for (int j = 0; j < height.size_y; ++j) {
    for (int i = 0; i < height.size_x; ++i) {
      const std::size_t cell = static_cast<std::size_t>(j) * height.size_x + i;
      if (terrain.traversable().values[cell] > 0.5F) {
        mask[cell] = 1;
        continue;
      }
      const double flank_m = terrain.dilated_height().values[cell] - height.values[cell];
      mask[cell] = flank_m <= defaults.touch_tolerance_m &&
                   local_gradient(height, i, j) <= max_gradient &&
                   known_within(height, i, j, tyre_cells);
    }
  }
  return mask;
}

// Distance from every good cell to the edge of the nearest bad one, up to `cap_m`; half a cell
// negative on bad ones. Only good cells near bad ones are visited.
std::vector<float> clear_distance(const Mask& mask, const Grid& shape, double cap_m) {
  const double half_m = 0.5 * shape.cell_m;
  const int reach = static_cast<int>(std::ceil((cap_m + half_m) / shape.cell_m));
  std::vector<float> clear(mask.size(), static_cast<float>(cap_m));
  const auto good = [&](int i, int j) {
    return i >= 0 && j >= 0 && i < shape.size_x && j < shape.size_y &&
           mask[static_cast<std::size_t>(j) * shape.size_x + i] != 0;
  };
  for (int j = 0; j < shape.size_y; ++j) {
    for (int i = 0; i < shape.size_x; ++i) {
      if (good(i, j)) continue;
      clear[static_cast<std::size_t>(j) * shape.size_x + i] = static_cast<float>(-half_m);
      const bool rim = good(i - 1, j) || good(i + 1, j) || good(i, j - 1) || good(i, j + 1);
      if (!rim) continue;
      for (int b = std::max(0, j - reach); b <= std::min(shape.size_y - 1, j + reach); ++b) {
        for (int a = std::max(0, i - reach); a <= std::min(shape.size_x - 1, i + reach); ++a) {
          if (!good(a, b)) continue;
          float& value = clear[static_cast<std::size_t>(b) * shape.size_x + a];
          const double distance_m = std::hypot(a - i, b - j) * shape.cell_m - half_m;
          value = std::min(value, static_cast<float>(distance_m));
        }
      }
    }
  }
  return clear;
}

}  // namespace

StanceGround::StanceGround(const TerrainMap& terrain) {
  const Grid& height = terrain.elevation();
  const Grid& dilated = terrain.dilated_height();
  const std::vector<float> clear = clear_distance(standing_mask(terrain), height, kMaxClear_m);
  constexpr auto kHuge = static_cast<float>(kNowhere_m);

  size_x_ = height.size_x + 2;
  size_y_ = height.size_y + 2;
  per_m_ = 1.0 / height.cell_m;
  x_m_ = height.origin_m.x() - height.cell_m;
  y_m_ = height.origin_m.y() - height.cell_m;
  max_u_ = size_x_ - 1.0 - 1e-9;
  max_v_ = size_y_ - 1.0 - 1e-9;
  max_i_ = size_x_ - 1.0;
  max_j_ = size_y_ - 1.0;
  cells_.assign(static_cast<std::size_t>(size_x_) * size_y_,
                Cell{kHuge, kHuge, static_cast<float>(-kNowhere_m), kHuge});
  const auto known_or_huge = [](float value) { return std::isnan(value) ? kHuge : value; };
  // Highest of three along x, then of three rows.
  std::vector<float> row_max(static_cast<std::size_t>(size_x_) * size_y_, kHuge);
  for (int j = 0; j < height.size_y; ++j) {
    for (int i = 0; i < height.size_x; ++i) {
      float highest = known_or_huge(height.at(i, j));
      if (i > 0) highest = std::max(highest, known_or_huge(height.at(i - 1, j)));
      if (i + 1 < height.size_x) highest = std::max(highest, known_or_huge(height.at(i + 1, j)));
      row_max[static_cast<std::size_t>(j + 1) * size_x_ + i + 1] = highest;
    }
  }
  for (int j = 0; j < height.size_y; ++j) {
    for (int i = 0; i < height.size_x; ++i) {
      const std::size_t from = static_cast<std::size_t>(j) * height.size_x + i;
      const std::size_t to = static_cast<std::size_t>(j + 1) * size_x_ + i + 1;
      float highest = row_max[to];
      if (j > 0) highest = std::max(highest, row_max[to - size_x_]);
      if (j + 1 < height.size_y) highest = std::max(highest, row_max[to + size_x_]);
      if (std::isnan(height.values[from])) continue;
      cells_[to] = {known_or_huge(dilated.values[from]), highest, clear[from], height.values[from]};
    }
  }
}

Eigen::Vector2d StanceGround::dilated_gradient(double x, double y) const noexcept {
  const Corner c = corner(x, y);
  const double a = c.south[0].dilated_m, b = c.south[1].dilated_m, d = c.north[0].dilated_m,
               e = c.north[1].dilated_m;
  return per_m_ *
         Eigen::Vector2d((b - a) + c.v * ((e - d) - (b - a)), (d - a) + c.u * ((e - b) - (d - a)));
}

}  // namespace wex
