#include "initializer/stepping/stance_ground.hpp"

#include <cmath>
#include <limits>

namespace wex {
namespace {

// Maximum over windows of 2 * radius + 1 values along a line of `size` values `stride` apart,
// clipped at its ends. Windows double until two of them cover the wanted one.
void window_max_along(float* values, int size, std::ptrdiff_t stride, int radius,
                      std::vector<float>& buffer) {
  constexpr float kLow = -std::numeric_limits<float>::infinity();
  const int width = 2 * radius + 1;
  buffer.assign(static_cast<std::size_t>(size + 2 * radius), kLow);
  for (int i = 0; i < size; ++i) buffer[static_cast<std::size_t>(i + radius)] = values[i * stride];
  const int total = static_cast<int>(buffer.size());
  int window = 1;
  while (2 * window <= width) {
    for (int i = 0; i + window < total; ++i) {
      buffer[static_cast<std::size_t>(i)] = std::max(buffer[static_cast<std::size_t>(i)],
                                                     buffer[static_cast<std::size_t>(i + window)]);
    }
    window *= 2;
  }
  for (int i = 0; i < size; ++i) {
    values[i * stride] = std::max(buffer[static_cast<std::size_t>(i)],
                                  buffer[static_cast<std::size_t>(i + width - window)]);
  }
}

std::vector<float> window_max(std::vector<float> values, int size_x, int size_y, int radius) {
  std::vector<float> buffer;
  for (int j = 0; j < size_y; ++j) {
    window_max_along(values.data() + static_cast<std::ptrdiff_t>(j) * size_x, size_x, 1, radius,
                     buffer);
  }
  for (int i = 0; i < size_x; ++i) {
    window_max_along(values.data() + i, size_y, size_x, radius, buffer);
  }
  return values;
}

}  // namespace

StanceGround::StanceGround(const TerrainMap& terrain) {
  const Grid& height = terrain.elevation();
  const Grid& dilated = terrain.dilated_height();
  const Grid& clear = terrain.signed_distance();
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
  std::vector<float> ground(cells_.size(), kHuge), rolled(cells_.size(), kHuge);
  for (int j = 0; j < height.size_y; ++j) {
    for (int i = 0; i < height.size_x; ++i) {
      const std::size_t from = static_cast<std::size_t>(j) * height.size_x + i;
      const std::size_t to = static_cast<std::size_t>(j + 1) * size_x_ + i + 1;
      if (std::isnan(height.values[from])) continue;
      ground[to] = height.values[from];
      rolled[to] = known_or_huge(dilated.values[from]);
      cells_[to] = {rolled[to], kHuge, clear.values[from], height.values[from]};
    }
  }
  const std::vector<float> highest = window_max(ground, size_x_, size_y_, 1);
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    cells_[cell].highest_m = highest[cell];
  }
  const auto cells_within = [&](double reach_m) {
    return static_cast<int>(std::ceil(reach_m * per_m_)) + 1;
  };
  const std::vector<float> rolled_top =
      window_max(std::move(rolled), size_x_, size_y_, cells_within(kDilatedTopReach_m));
  const std::vector<float> ground_top =
      window_max(std::move(ground), size_x_, size_y_, cells_within(kGroundTopReach_m));
  tops_.reserve(cells_.size());
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    tops_.push_back({rolled_top[cell], ground_top[cell]});
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
