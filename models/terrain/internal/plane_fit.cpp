#include "models/terrain/internal/plane_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
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

/// The disc as rows: half width of each row, by its distance from the centre, in cells.
struct Disc {
  std::vector<int> half_widths;
  double count = 0.0;   ///< cells of the whole disc
  double square = 0.0;  ///< sum of dx^2 over them, and of dy^2

  [[nodiscard]] int reach() const { return static_cast<int>(half_widths.size()) - 1; }
};

Disc make_disc(double radius_cells, int largest_reach) {
  Disc disc;
  for (int dy = 0; dy <= std::min(radius_cells, static_cast<double>(largest_reach)); ++dy) {
    const int half_width = static_cast<int>(std::min(
        std::sqrt(radius_cells * radius_cells - dy * dy), static_cast<double>(largest_reach)));
    disc.half_widths.push_back(half_width);
    const double rows = dy == 0 ? 1.0 : 2.0;
    const double width = 2.0 * half_width + 1.0;
    disc.count += rows * width;
    disc.square += rows * width * dy * dy;
  }
  return disc;
}

/// How many cells of a rectangle are known, from a table of sums over all rectangles at the origin.
class KnownCount {
 public:
  explicit KnownCount(const Grid& grid) : size_x_(grid.size_x), size_y_(grid.size_y) {
    const std::size_t stride = static_cast<std::size_t>(size_x_) + 1;
    table_.assign(stride * (size_y_ + 1), 0);
    for (int j = 0; j < size_y_; ++j) {
      std::int32_t row = 0;
      for (int i = 0; i < size_x_; ++i) {
        row += std::isnan(grid.at(i, j)) ? 0 : 1;
        table_[stride * (j + 1) + i + 1] = table_[stride * j + i + 1] + row;
      }
    }
  }
  /// True if the whole rectangle, ends included, is on the map and known.
  [[nodiscard]] bool all_known(int i0, int j0, int i1, int j1) const {
    if (i0 < 0 || j0 < 0 || i1 >= size_x_ || j1 >= size_y_) return false;
    return at(i1 + 1, j1 + 1) - at(i0, j1 + 1) - at(i1 + 1, j0) + at(i0, j0) ==
           (i1 - i0 + 1) * (j1 - j0 + 1);
  }

 private:
  [[nodiscard]] std::int32_t at(int i, int j) const {
    return table_[static_cast<std::size_t>(size_x_ + 1) * j + i];
  }
  int size_x_, size_y_;
  std::vector<std::int32_t> table_;
};

/// Sums of one row of each of kLanes discs side by side.
Lanes row_sum(const RowPrefixes& prefix, RowMoment moment, int row, int first, int half_width) {
  return Eigen::Map<const Lanes>(prefix.at(moment, row, first + half_width + 1)) -
         Eigen::Map<const Lanes>(prefix.at(moment, row, first - half_width));
}

/// Sums of the discs around cells (first, j) .. (first + kLanes - 1, j).
DiscSums sum_discs(const RowPrefixes& prefix, const Disc& disc, int size_y, int first, int j) {
  Lanes n = Lanes::Zero(), x = n, y = n, xx = n, xy = n, yy = n, z = n, xz = n, yz = n;
  const int last_row = std::min(size_y - 1, j + disc.reach());
  for (int row = std::max(0, j - disc.reach()); row <= last_row; ++row) {
    const double dy = row - j;
    const int half_width = disc.half_widths[std::abs(row - j)];
    const Lanes row_n = row_sum(prefix, kN, row, first, half_width);
    const Lanes row_x = row_sum(prefix, kX, row, first, half_width);
    const Lanes row_z = row_sum(prefix, kZ, row, first, half_width);
    n += row_n;
    x += row_x;
    y += dy * row_n;
    xx += row_sum(prefix, kXX, row, first, half_width);
    xy += dy * row_x;
    yy += dy * dy * row_n;
    z += row_z;
    xz += row_sum(prefix, kXZ, row, first, half_width);
    yz += dy * row_z;
  }
  return {n, x, y, xx, xy, yy, z, xz, yz};
}

/// The same where every cell is known: what does not depend on the heights is known beforehand.
///   x_first  x of the first centre, as in the row moments
DiscSums sum_known_discs(const RowPrefixes& prefix, const Disc& disc, double x_first, int first,
                         int j) {
  Lanes z = Lanes::Zero(), xz = z, yz = z;
  for (int dy = -disc.reach(); dy <= disc.reach(); ++dy) {
    const int half_width = disc.half_widths[std::abs(dy)];
    const Lanes row_z = row_sum(prefix, kZ, j + dy, first, half_width);
    z += row_z;
    xz += row_sum(prefix, kXZ, j + dy, first, half_width);
    yz += static_cast<double>(dy) * row_z;
  }
  const Lanes x_centre = Lanes::LinSpaced(kLanes, x_first, x_first + kLanes - 1);
  const Lanes none = Lanes::Zero();
  return {none + disc.count,
          disc.count * x_centre,
          none,
          disc.count * x_centre.square() + disc.square,
          none,
          none + disc.square,
          z,
          xz,
          yz};
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
  const Disc disc = make_disc(radius_cells, std::max(size_x, size_y));
  const int reach = disc.reach();

  const double x_middle = 0.5 * (size_x - 1);
  const double z_mean = known_mean(elevation);
  const RowPrefixes prefix = prefix_sums(elevation, x_middle, z_mean, reach + kLanes);
  const KnownCount known(elevation);

  PlaneFit fit;
  fit.height = elevation;
  fit.gradient.assign(elevation.values.size(), Eigen::Vector2f::Zero());
  for (int j = 0; j < size_y; ++j) {
    for (int first = 0; first < size_x; first += kLanes) {
      const bool all_known =
          known.all_known(first - reach, j - reach, first + kLanes - 1 + reach, j + reach);
      const DiscSums sums = all_known ? sum_known_discs(prefix, disc, first - x_middle, first, j)
                                      : sum_discs(prefix, disc, size_y, first, j);
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
