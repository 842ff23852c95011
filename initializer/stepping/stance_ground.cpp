#include "initializer/stepping/stance_ground.hpp"

#include <cmath>

namespace wex {
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
      cells_[to] = {known_or_huge(dilated.values[from]), highest, clear.values[from],
                    height.values[from]};
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
