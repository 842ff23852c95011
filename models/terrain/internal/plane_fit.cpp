#include "models/terrain/internal/plane_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace wex::terrain_internal {
namespace {

/// Moments of one row, as prefix sums; x in cells from the map's middle, z from the map's mean, so
/// that the sums stay small next to what they are differenced for.
enum RowMoment { kN, kX, kXX, kZ, kXZ, kNumRowMoments };
/// Moments of a disc; y in cells from the centre of the disc.
enum DiscMoment { kD_N, kD_X, kD_Y, kD_XX, kD_XY, kD_YY, kD_Z, kD_XZ, kD_YZ, kNumDiscMoments };

using RowPrefix = std::array<std::vector<double>, kNumRowMoments>;
using DiscSums = std::array<std::vector<double>, kNumDiscMoments>;

/// Prefix sums over all rows; row j starts at j * (size_x + 1).
RowPrefix prefix_sums(const Grid& elevation, double x_middle, double z_mean) {
  RowPrefix prefix;
  const std::size_t stride = static_cast<std::size_t>(elevation.size_x) + 1;
  for (auto& sums : prefix) sums.assign(stride * elevation.size_y, 0.0);
  for (int j = 0; j < elevation.size_y; ++j) {
    std::array<double, kNumRowMoments> sum{};
    for (int i = 0; i < elevation.size_x; ++i) {
      const float height = elevation.at(i, j);
      if (!std::isnan(height)) {
        const double x = i - x_middle;
        const double z = height - z_mean;
        sum[kN] += 1.0;
        sum[kX] += x;
        sum[kXX] += x * x;
        sum[kZ] += z;
        sum[kXZ] += x * z;
      }
      for (int m = 0; m < kNumRowMoments; ++m) prefix[m][stride * j + i + 1] = sum[m];
    }
  }
  return prefix;
}

/// Adds the row at offset dy to the sums of every disc whose whole span lies inside the row.
void add_row(const RowPrefix& prefix, std::size_t row_start, int size_x, int half_width, double dy,
             DiscSums& sums) {
  const auto add = [&](int i, int first, int last) {
    const std::size_t a = row_start + first;
    const std::size_t b = row_start + last + 1;
    const double n = prefix[kN][b] - prefix[kN][a];
    const double x = prefix[kX][b] - prefix[kX][a];
    const double z = prefix[kZ][b] - prefix[kZ][a];
    sums[kD_N][i] += n;
    sums[kD_X][i] += x;
    sums[kD_Y][i] += dy * n;
    sums[kD_XX][i] += prefix[kXX][b] - prefix[kXX][a];
    sums[kD_XY][i] += dy * x;
    sums[kD_YY][i] += dy * dy * n;
    sums[kD_Z][i] += z;
    sums[kD_XZ][i] += prefix[kXZ][b] - prefix[kXZ][a];
    sums[kD_YZ][i] += dy * z;
  };
  const int inside_begin = std::min(half_width, size_x);
  const int inside_end = std::max(inside_begin, size_x - half_width);
  for (int i = 0; i < inside_begin; ++i) add(i, 0, std::min(i + half_width, size_x - 1));
  for (int i = inside_end; i < size_x; ++i) {
    add(i, std::max(i - half_width, 0), std::min(i + half_width, size_x - 1));
  }

  // The bulk of the work: the same sums with plain pointers, which the compiler vectorises.
  const double* const n_prefix = prefix[kN].data() + row_start;
  const double* const x_prefix = prefix[kX].data() + row_start;
  const double* const xx_prefix = prefix[kXX].data() + row_start;
  const double* const z_prefix = prefix[kZ].data() + row_start;
  const double* const xz_prefix = prefix[kXZ].data() + row_start;
  double* __restrict const sum_n = sums[kD_N].data();
  double* __restrict const sum_x = sums[kD_X].data();
  double* __restrict const sum_y = sums[kD_Y].data();
  double* __restrict const sum_xx = sums[kD_XX].data();
  double* __restrict const sum_xy = sums[kD_XY].data();
  double* __restrict const sum_yy = sums[kD_YY].data();
  double* __restrict const sum_z = sums[kD_Z].data();
  double* __restrict const sum_xz = sums[kD_XZ].data();
  double* __restrict const sum_yz = sums[kD_YZ].data();
  for (int i = inside_begin; i < inside_end; ++i) {
    const int a = i - half_width;
    const int b = i + half_width + 1;
    const double n = n_prefix[b] - n_prefix[a];
    const double x = x_prefix[b] - x_prefix[a];
    const double z = z_prefix[b] - z_prefix[a];
    sum_n[i] += n;
    sum_x[i] += x;
    sum_y[i] += dy * n;
    sum_xx[i] += xx_prefix[b] - xx_prefix[a];
    sum_xy[i] += dy * x;
    sum_yy[i] += dy * dy * n;
    sum_z[i] += z;
    sum_xz[i] += xz_prefix[b] - xz_prefix[a];
    sum_yz[i] += dy * z;
  }
}

struct Plane {
  double height = 0.0;  ///< at the centre, same origin as z
  Eigen::Vector2d gradient_per_cell = Eigen::Vector2d::Zero();
};

/// The plane of one disc; x_centre in the x of the row moments.
Plane solve_plane(const DiscSums& sums, int i, double x_centre) {
  const double n = sums[kD_N][i];
  const double x_mean = sums[kD_X][i] / n;
  const double y_mean = sums[kD_Y][i] / n;
  const double z_mean = sums[kD_Z][i] / n;
  const double xx = sums[kD_XX][i] / n - x_mean * x_mean;
  const double xy = sums[kD_XY][i] / n - x_mean * y_mean;
  const double yy = sums[kD_YY][i] / n - y_mean * y_mean;
  const double xz = sums[kD_XZ][i] / n - x_mean * z_mean;
  const double yz = sums[kD_YZ][i] / n - y_mean * z_mean;

  Plane plane;
  const double trace = xx + yy;
  const double determinant = xx * yy - xy * xy;
  constexpr double kSmallestTrace = 1e-3;           // cells^2; two cells give 0.25
  constexpr double kSmallestRelativeSpread = 1e-6;  // ratio of the spreads across and along
  if (trace > kSmallestTrace) {
    if (determinant > kSmallestRelativeSpread * trace * trace) {
      plane.gradient_per_cell << (yy * xz - xy * yz) / determinant,
          (xx * yz - xy * xz) / determinant;
    } else {
      plane.gradient_per_cell << xz / trace, yz / trace;
    }
  }
  plane.height = z_mean + plane.gradient_per_cell.x() * (x_centre - x_mean) -
                 plane.gradient_per_cell.y() * y_mean;
  return plane;
}

double known_mean(const Grid& grid) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const float value : grid.values) {
    if (std::isnan(value)) continue;
    sum += value;
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

}  // namespace

Eigen::Vector3d PlaneFit::normal_at(std::size_t cell) const {
  const Eigen::Vector2d slope = gradient[cell].cast<double>();
  return Eigen::Vector3d(-slope.x(), -slope.y(), 1.0).normalized();
}

PlaneFit fit_planes(const Grid& elevation, double radius_m) {
  const int size_x = elevation.size_x;
  const int size_y = elevation.size_y;
  constexpr double kSmallestRadiusCells = 1.5;  // the 3 x 3 neighbourhood
  constexpr double kRoundOff = 1e-9;            // 0.3 m is exactly three cells of 0.1 m
  const double radius_cells =
      std::max(radius_m / elevation.cell_m, kSmallestRadiusCells) + kRoundOff;
  const int reach = static_cast<int>(
      std::min(std::floor(radius_cells), static_cast<double>(std::max(size_x, size_y))));

  const double x_middle = 0.5 * (size_x - 1);
  const double z_mean = known_mean(elevation);
  const RowPrefix prefix = prefix_sums(elevation, x_middle, z_mean);

  PlaneFit fit;
  fit.height = elevation;
  fit.gradient.assign(elevation.values.size(), Eigen::Vector2f::Zero());
  DiscSums sums;
  for (int j = 0; j < size_y; ++j) {
    for (auto& sum : sums) sum.assign(size_x, 0.0);
    for (int dy = std::max(-reach, -j); dy <= std::min(reach, size_y - 1 - j); ++dy) {
      const int half_width = static_cast<int>(
          std::min(std::sqrt(radius_cells * radius_cells - dy * dy), static_cast<double>(size_x)));
      add_row(prefix, static_cast<std::size_t>(size_x + 1) * (j + dy), size_x, half_width, dy,
              sums);
    }
    for (int i = 0; i < size_x; ++i) {
      float& height = fit.height.at(i, j);
      if (std::isnan(height)) continue;
      const Plane plane = solve_plane(sums, i, i - x_middle);
      height = static_cast<float>(plane.height + z_mean);
      fit.gradient[static_cast<std::size_t>(j) * size_x + i] =
          (plane.gradient_per_cell / elevation.cell_m).cast<float>();
    }
  }
  return fit;
}

}  // namespace wex::terrain_internal
