#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "models/excavator/machine_model.hpp"
#include "models/terrain/terrain_map.hpp"

namespace wex {

using HeightFunction = std::function<double(double x_m, double y_m)>;

/// A map of 0.1 m cells, centred on `centre`; the height function gets coordinates from the centre.
inline TerrainMap make_map(double size_x_m, double size_y_m, const HeightFunction& height,
                           const Eigen::Vector2d& centre = Eigen::Vector2d::Zero(),
                           const Eigen::Vector2d& map_origin_m = Eigen::Vector2d::Zero()) {
  Grid grid;
  grid.cell_m = 0.1;
  grid.size_x = static_cast<int>(std::lround(size_x_m / grid.cell_m)) + 1;
  grid.size_y = static_cast<int>(std::lround(size_y_m / grid.cell_m)) + 1;
  grid.origin_m = centre - 0.5 * Eigen::Vector2d(size_x_m, size_y_m);
  for (int j = 0; j < grid.size_y; ++j) {
    for (int i = 0; i < grid.size_x; ++i) {
      grid.values.push_back(static_cast<float>(
          height(i * grid.cell_m - 0.5 * size_x_m, j * grid.cell_m - 0.5 * size_y_m)));
    }
  }
  auto map = TerrainMap::build(std::move(grid), {}, map_origin_m);
  if (!map) throw std::runtime_error(map.error().message);
  return *std::move(map);
}

inline TerrainMap flat_map(double size_x_m = 40.0, double size_y_m = 30.0) {
  return make_map(size_x_m, size_y_m, [](double, double) { return 0.0; });
}

/// Smooth bumps with no symmetry, steep enough at amplitude 1 that some poses fail.
inline double bumps(double x_m, double y_m) {
  return 0.5 * std::sin(0.9 * x_m + 0.3) * std::cos(0.7 * y_m - 0.4) +
         0.25 * std::sin(1.7 * y_m + 0.5 * x_m) + 0.1 * std::cos(2.3 * x_m - 1.1 * y_m);
}

inline const MachineModel& test_machine() {
  static const MachineModel machine = [] {
    auto loaded = load_machine();
    if (!loaded) throw std::runtime_error(loaded.error().message);
    return *std::move(loaded);
  }();
  return machine;
}

}  // namespace wex
