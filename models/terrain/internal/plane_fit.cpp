#include "models/terrain/internal/plane_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace wex::terrain_internal {
namespace {

/// Moments of one row, as prefix sums; x in cells from the map's middle, z from the map's mean, so
/// that the sums stay small next to what they are differenced for.
enum RowMoment { kN, kX, kXX, kZ, kXZ, kNumRowMoments };
/// Moments of a disc; y in cells from the centre of the disc.
enum DiscMoment {
  kDiscN,
  kDiscX,
  kDiscY,
  kDiscXX,
  kDiscXY,
  kDiscYY,
  kDiscZ,
  kDiscXZ,
  kDiscYZ,
  kNumDiscMoments
};

/// Discs summed side by side, so that their sums stay in vector registers.
constexpr int kLanes = 4;
using Lanes = Eigen::Array<double, kLanes, 1>;
using DiscSums = std::array<Lanes, kNumDiscMoments>;

/// Prefix sums along every row, continued beyond both ends by a margin so that no disc needs
/// clipping: the sum of cells first..last of row j is at(j, last + 1) - at(j, first).
struct RowPrefixes {
  std::ptrdiff_t stride = 0;
  std::ptrdiff_t margin = 0;
  std::array<std::vector<double>, kNumRowMoments> sums;

  [[nodiscard]] const double* at(RowMoment moment, int row, int i) const {
    return sums[moment].data() + row * stride + margin + i;
  }
};

RowPrefixes prefix_sums(const Grid& elevation, double x_middle, double z_mean, int margin) {
  RowPrefixes prefix;
  prefix.margin = margin;
  prefix.stride = elevation.size_x + 1 + 2 * margin;
  for (auto& sums : prefix.sums) sums.resize(prefix.stride * elevation.size_y);
  for (int j = 0; j < elevation.size_y; ++j) {
    std::array<double, kNumRowMoments> sum{};
    for (std::ptrdiff_t k = 0; k < prefix.stride; ++k) {
      const std::ptrdiff_t i = k - margin - 1;
      if (i >= 0 && i < elevation.size_x) {
        const float height = elevation.at(static_cast<int>(i), j);
        if (!std::isnan(height)) {
          const double x = static_cast<double>(i) - x_middle;
          const double z = height - z_mean;
          sum[kN] += 1.0;
          sum[kX] += x;
          sum[kXX] += x * x;
          sum[kZ] += z;
          sum[kXZ] += x * z;
        }
      }
      for (int m = 0; m < kNumRowMoments; ++m) prefix.sums[m][j * prefix.stride + k] = sum[m];
    }
  }
  return prefix;
}

/// Sums of the discs around cells (first, j) .. (first + kLanes - 1, j).
///   half_widths  of the disc's rows, by the distance of the row from the centre
DiscSums sum_discs(const RowPrefixes& prefix, const std::vector<int>& half_widths, int size_y,
                   int first, int j) {
  Lanes n = Lanes::Zero(), x = n, y = n, xx = n, xy = n, yy = n, z = n, xz = n, yz = n;
  const int reach = static_cast<int>(half_widths.size()) - 1;
  for (int row = std::max(0, j - reach); row <= std::min(size_y - 1, j + reach); ++row) {
    const double dy = row - j;
    const int half_width = half_widths[std::abs(row - j)];
    const auto row_sum = [&](RowMoment moment) -> Lanes {
      return Eigen::Map<const Lanes>(prefix.at(moment, row, first + half_width + 1)) -
             Eigen::Map<const Lanes>(prefix.at(moment, row, first - half_width));
    };
    const Lanes row_n = row_sum(kN);
    const Lanes row_x = row_sum(kX);
    const Lanes row_z = row_sum(kZ);
    n += row_n;
    x += row_x;
    y += dy * row_n;
    xx += row_sum(kXX);
    xy += dy * row_x;
    yy += dy * dy * row_n;
    z += row_z;
    xz += row_sum(kXZ);
    yz += dy * row_z;
  }
  return {n, x, y, xx, xy, yy, z, xz, yz};
}

struct Plane {
  double height = 0.0;  ///< at the centre, same origin as z
  Eigen::Vector2d gradient_per_cell = Eigen::Vector2d::Zero();
};

/// The plane of one disc; x_centre in the x of the row moments.
Plane solve_plane(const DiscSums& sums, int lane, double x_centre) {
  const double n = sums[kDiscN][lane];
  const double x_mean = sums[kDiscX][lane] / n;
  const double y_mean = sums[kDiscY][lane] / n;
  const double z_mean = sums[kDiscZ][lane] / n;
  const double xx = sums[kDiscXX][lane] / n - x_mean * x_mean;
  const double xy = sums[kDiscXY][lane] / n - x_mean * y_mean;
  const double yy = sums[kDiscYY][lane] / n - y_mean * y_mean;
  const double xz = sums[kDiscXZ][lane] / n - x_mean * z_mean;
  const double yz = sums[kDiscYZ][lane] / n - y_mean * z_mean;

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
  // Rows and columns beyond the map add nothing, however large the radius.
  const double largest = std::max(size_x, size_y);
  std::vector<int> half_widths;
  for (int dy = 0; dy <= std::min(radius_cells, largest); ++dy) {
    half_widths.push_back(
        static_cast<int>(std::min(std::sqrt(radius_cells * radius_cells - dy * dy), largest)));
  }

  const double x_middle = 0.5 * (size_x - 1);
  const double z_mean = known_mean(elevation);
  const RowPrefixes prefix = prefix_sums(elevation, x_middle, z_mean, half_widths.front() + kLanes);

  PlaneFit fit;
  fit.height = elevation;
  fit.gradient.assign(elevation.values.size(), Eigen::Vector2f::Zero());
  for (int j = 0; j < size_y; ++j) {
    for (int first = 0; first < size_x; first += kLanes) {
      const DiscSums sums = sum_discs(prefix, half_widths, size_y, first, j);
      for (int i = first; i < std::min(first + kLanes, size_x); ++i) {
        float& height = fit.height.at(i, j);
        if (std::isnan(height)) continue;
        const Plane plane = solve_plane(sums, i - first, i - x_middle);
        height = static_cast<float>(plane.height + z_mean);
        fit.gradient[static_cast<std::size_t>(j) * size_x + i] =
            (plane.gradient_per_cell / elevation.cell_m).cast<float>();
      }
    }
  }
  return fit;
}

}  // namespace wex::terrain_internal
