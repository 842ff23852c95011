#include "tools/bench/initializer_bench_cells.hpp"

#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <random>

namespace wex {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kSizeX_m = 30.0, kSizeY_m = 16.0, kCell_m = 0.1, kRoute_m = 15.0;

InitializerCell cell(const std::string& terrain, double difficulty, bool has_levels) {
  char name[64];
  std::snprintf(name, sizeof name, has_levels ? "%s %.2f" : "%s", terrain.c_str(), difficulty);
  // Slopes beyond 30 degrees close the way on rough ground beyond 0.5.
  const bool judged = !(terrain == "rough" && difficulty > 0.5);
  return {name, terrain, difficulty, has_levels, judged};
}

/// What goes beyond the paper: a profile along x, and how far the obstacle is turned.
struct Obstacle {
  const char* name;
  std::function<double(double along_m)> height;
  double turn_rad = 0.0;
};

const std::vector<Obstacle>& obstacles() {
  static const std::vector<Obstacle> all{
      {"gap 4.2 m", [](double x) { return std::abs(x) < 2.1 ? -2.0 : 0.0; }},
      {"step 2 m up", [](double x) { return x > 0.0 ? 2.0 : 0.0; }},
      {"step 2 m down", [](double x) { return x < 0.0 ? 2.0 : 0.0; }},
      {"wall 0.9 m", [](double x) { return std::abs(x) < 0.2 ? 0.9 : 0.0; }},
      {"gap 2 m at 15 degrees", [](double x) { return std::abs(x) < 1.0 ? -2.0 : 0.0; },
       15.0 * kDegree}};
  return all;
}

/// Poses by the usual spread: y within 1 m, yaw within 10 degrees of the line, unless said.
Task draw(std::mt19937_64& random, double offset_m, double yaw_rad) {
  const auto uniform = [&random](double extent) {
    return extent * (2.0 * static_cast<double>(random() >> 11) * 0x1p-53 - 1.0);
  };
  Task task;
  task.start = {0.5 * (kSizeX_m - kRoute_m), 0.5 * kSizeY_m + uniform(offset_m), uniform(yaw_rad)};
  task.goal = {0.5 * (kSizeX_m + kRoute_m), 0.5 * kSizeY_m + uniform(offset_m), uniform(yaw_rad)};
  return task;
}

SyntheticTerrain beyond(const Obstacle& obstacle, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  SyntheticTerrain terrain;
  terrain.task = draw(random, 1.0, 10.0 * kDegree);
  Grid& grid = terrain.raster.elevation;
  grid.cell_m = kCell_m;
  grid.size_x = static_cast<int>(kSizeX_m / kCell_m);
  grid.size_y = static_cast<int>(kSizeY_m / kCell_m);
  const double c = std::cos(obstacle.turn_rad), s = std::sin(obstacle.turn_rad);
  for (int j = 0; j < grid.size_y; ++j) {
    for (int i = 0; i < grid.size_x; ++i) {
      const double x = (i + 0.5) * kCell_m - 0.5 * kSizeX_m;
      const double y = (j + 0.5) * kCell_m - 0.5 * kSizeY_m;
      grid.values.push_back(static_cast<float>(obstacle.height(c * x + s * y)));
    }
  }
  terrain.raster.map_origin_m << 0.5 * kSizeX_m, 0.5 * kSizeY_m;
  grid.origin_m = Eigen::Vector2d::Constant(0.5 * kCell_m) - terrain.raster.map_origin_m;
  return terrain;
}

}  // namespace

std::vector<InitializerCell> initializer_cells(InitializerBenchSet set) {
  std::vector<InitializerCell> cells;
  if (set == InitializerBenchSet::kBeyond) {
    for (const Obstacle& obstacle : obstacles()) {
      cells.push_back({obstacle.name, obstacle.name, 0.0, false, true});
    }
    return cells;
  }
  const bool all = set == InitializerBenchSet::kCells;
  if (all) cells.push_back(cell("flat", 0.0, false));
  for (const char* terrain : {"rough", "gap", "step"}) {
    if (!all && std::string(terrain) == "rough") continue;
    for (const double difficulty : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      cells.push_back(cell(terrain, difficulty, true));
    }
  }
  cells.push_back(cell("wall", 0.0, false));
  if (all) {
    for (const char* terrain : {"ramp", "hole", "bridge", "side_slope"}) {
      cells.push_back(cell(terrain, 0.0, false));
    }
  }
  return cells;
}

Result<SyntheticTerrain> initializer_task(InitializerBenchSet set, const InitializerCell& cell,
                                          std::uint64_t seed) {
  if (set == InitializerBenchSet::kBeyond) {
    for (const Obstacle& obstacle : obstacles()) {
      if (cell.name == obstacle.name) return beyond(obstacle, seed);
    }
  }
  auto terrain = make_synthetic_terrain(cell.terrain, cell.difficulty, seed);
  if (terrain && set == InitializerBenchSet::kHard) {
    std::mt19937_64 random(seed);
    terrain->task = draw(random, 3.0, 90.0 * kDegree);
  }
  return terrain;
}

}  // namespace wex
