#pragma once

#include <functional>
#include <limits>

#include "models/terrain/terrain_map.hpp"
#include "tests/support/scratch_folder.hpp"

namespace wex {

inline constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// A grid with cell (i, j) = height(x, y) at the cell's position; origin at (0, 0).
inline Grid make_grid(int size_x, int size_y, double cell_m,
                      const std::function<double(double x, double y)>& height) {
  Grid grid;
  grid.size_x = size_x;
  grid.size_y = size_y;
  grid.cell_m = cell_m;
  for (int j = 0; j < size_y; ++j) {
    for (int i = 0; i < size_x; ++i) {
      grid.values.push_back(static_cast<float>(height(i * cell_m, j * cell_m)));
    }
  }
  return grid;
}

}  // namespace wex
