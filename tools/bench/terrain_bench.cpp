#include "tools/bench/terrain_bench.hpp"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <vector>

#include "models/terrain/internal/bspline_surface.hpp"
#include "models/terrain/internal/distance_transform.hpp"
#include "models/terrain/internal/plane_fit.hpp"
#include "models/terrain/internal/tyre_dilation.hpp"
#include "models/terrain/synthetic.hpp"

namespace wex {
namespace {

constexpr int kSize = 400;
constexpr int kRepeats = 40;
constexpr int kQueries = 100000;

double thread_time_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Prints one row; `per` divides the time (1e-3 for ms, 1e-9 * count for ns a call).
void report(const char* name, const char* unit, double per, const std::function<void()>& work) {
  std::vector<double> times;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    const double start_s = thread_time_s();
    work();
    times.push_back((thread_time_s() - start_s) / per);
  }
  std::sort(times.begin(), times.end());
  const auto percentile = [&](int percent) { return times[(times.size() - 1) * percent / 100]; };
  std::printf("%-42s %9.2f %9.2f %9.2f %9.2f  %s\n", name, times.front(), percentile(50),
              percentile(95), times.back(), unit);
}

/// Hills of several lengths, slopes up to about 25 degrees, with a walled pit and an unknown patch.
Grid bench_map() {
  Grid grid;
  grid.size_x = grid.size_y = kSize;
  for (int j = 0; j < kSize; ++j) {
    for (int i = 0; i < kSize; ++i) {
      const double x = 0.1 * i;
      const double y = 0.1 * j;
      double height = 0.6 * std::sin(0.5 * x + 0.2 * y) + 0.25 * std::sin(0.9 * y - 0.7 * x) +
                      0.05 * std::sin(3.1 * x) * std::sin(2.7 * y);
      if (std::abs(x - 20.0) < 1.5 && std::abs(y - 10.0) < 5.0) height -= 2.0;
      if (std::hypot(x - 30.0, y - 30.0) < 2.0) height = std::nan("");
      grid.values.push_back(static_cast<float>(height));
    }
  }
  return grid;
}

/// Where a query reads, in a fixed irregular order over the map.
Eigen::Vector2d query_point(int k) {
  return {std::fmod(0.618034 * 37.0 * k, 39.9), std::fmod(0.754878 * 41.0 * k, 39.9)};
}

void bench_queries(const TerrainMap& map) {
  std::vector<Eigen::Vector2d> points;
  for (int k = 0; k < kQueries; ++k) points.push_back(query_point(k));
  volatile double sink = 0.0;  // keeps the calls from being left out
  const auto time_query = [&](const char* name, const auto& query) {
    report(name, "ns", 1e-9 * kQueries, [&] {
      double sum = 0.0;
      for (const Eigen::Vector2d& p : points) sum += query(p);
      sink = sink + sum;
    });
  };
  time_query("bilinear height", [&](const Eigen::Vector2d& p) { return map.height_m(p); });
  time_query("spline with gradient and Hessian",
             [&](const Eigen::Vector2d& p) { return map.dilated_surface(p).hessian.sum(); });
  time_query("nearest traversable cell",
             [&](const Eigen::Vector2d& p) { return map.nearest_traversable(p).x(); });
}

}  // namespace

int bench_terrain() {
  const Grid grid = bench_map();
  const TerrainMap map = *TerrainMap::build(grid);
  std::vector<std::uint8_t> mask(map.traversable().values.begin(), map.traversable().values.end());

  std::printf("terrain: %d x %d cells of 0.1 m, %d repeats, thread CPU time\n", kSize, kSize,
              kRepeats);
  std::printf("%-42s %9s %9s %9s %9s\n", "", "min", "p50", "p95", "max");
  report("all layers (TerrainMap::build)", "ms", 1e-3, [&] { (void)TerrainMap::build(grid); });
  for (const double radius_m : {0.3, 0.6, 1.2, 2.5, 5.0}) {
    char name[64];
    std::snprintf(name, sizeof name, "plane fit, radius %.1f m", radius_m);
    report(name, "ms", 1e-3, [&] { (void)terrain_internal::fit_planes(grid, radius_m); });
  }
  report("tyre dilation, radius 0.6 m", "ms", 1e-3,
         [&] { (void)terrain_internal::dilate_by_tyre(grid, 0.6); });
  report("known within 0.6 m", "ms", 1e-3,
         [&] { (void)terrain_internal::known_within(grid, 0.6); });
  report("signed distance", "ms", 1e-3,
         [&] { (void)terrain_internal::signed_distance(mask, kSize, kSize, 0.1); });
  report("nearest traversable", "ms", 1e-3,
         [&] { (void)terrain_internal::transform_distance(mask, kSize, kSize); });
  report("B-spline prefilter", "ms", 1e-3,
         [&] { (void)terrain_internal::BsplineSurface(map.signed_distance()); });

  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / "wex_terrain_bench.asc";
  if (const auto written = write_esri_ascii({grid, {0.0, 0.0}}, file); !written) {
    std::fprintf(stderr, "%s\n", written.error().message.c_str());
    return 1;
  }
  report("read ESRI ASCII", "ms", 1e-3, [&] { (void)read_raster(file); });
  std::filesystem::remove(file);
  report("make rough terrain (300 x 160)", "ms", 1e-3,
         [&] { (void)make_synthetic_terrain("rough", 0.5, 1); });
  bench_queries(map);
  return 0;
}

}  // namespace wex
