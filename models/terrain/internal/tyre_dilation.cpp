#include "models/terrain/internal/tyre_dilation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "models/terrain/internal/distance_transform.hpp"

namespace wex::terrain_internal {
namespace {

constexpr double kRoundOff = 1e-9;  // cells; a neighbour at exactly the radius belongs to the disc

/// out[i] = max(out[i], in[i + dx] + drop) over the part of the row that exists.
void raise_row(const float* in, float* __restrict out, int size_x, int dx, float drop) {
  const int begin = std::max(0, -dx);
  const int end = size_x - std::max(0, dx);
  for (int i = begin; i < end; ++i) {
    const float height = in[i + dx] + drop;
    out[i] = height > out[i] ? height : out[i];
  }
}

}  // namespace

Grid dilate_by_tyre(const Grid& elevation, double wheel_radius_m) {
  constexpr float kNothing = -std::numeric_limits<float>::infinity();
  const int size_x = elevation.size_x;
  const int size_y = elevation.size_y;
  const double radius_cells = wheel_radius_m / elevation.cell_m + kRoundOff;
  const int reach = static_cast<int>(
      std::min(std::floor(radius_cells), static_cast<double>(std::max(size_x, size_y))));

  // Minus infinity never wins the maximum, so unknown neighbours drop out without a branch.
  std::vector<float> known_heights = elevation.values;
  for (float& height : known_heights) {
    if (std::isnan(height)) height = kNothing;
  }

  Grid dilated = elevation;
  std::fill(dilated.values.begin(), dilated.values.end(), kNothing);
  for (int j = 0; j < size_y; ++j) {
    float* const out = dilated.values.data() + static_cast<std::size_t>(j) * size_x;
    for (int dy = std::max(-reach, -j); dy <= std::min(reach, size_y - 1 - j); ++dy) {
      const float* const in = known_heights.data() + static_cast<std::size_t>(j + dy) * size_x;
      const double square_left = radius_cells * radius_cells - dy * dy;
      const int half_width =
          static_cast<int>(std::min(std::sqrt(square_left), static_cast<double>(size_x - 1)));
      for (int dx = -half_width; dx <= half_width; ++dx) {
        const double distance_m = elevation.cell_m * std::hypot(dx, dy);
        const double drop_m =
            std::sqrt(std::max(0.0, wheel_radius_m * wheel_radius_m - distance_m * distance_m)) -
            wheel_radius_m;
        raise_row(in, out, size_x, dx, static_cast<float>(drop_m));
      }
    }
  }
  for (std::size_t cell = 0; cell < dilated.values.size(); ++cell) {
    if (std::isnan(elevation.values[cell])) {
      dilated.values[cell] = std::numeric_limits<float>::quiet_NaN();
    }
  }
  return dilated;
}

std::vector<std::uint8_t> known_within(const Grid& elevation, double radius_m) {
  // One ring of cells around the map stands for all the unknown ground beyond it.
  const int padded_x = elevation.size_x + 2;
  const int padded_y = elevation.size_y + 2;
  std::vector<std::uint8_t> unknown(static_cast<std::size_t>(padded_x) * padded_y, 1);
  for (int j = 0; j < elevation.size_y; ++j) {
    for (int i = 0; i < elevation.size_x; ++i) {
      unknown[static_cast<std::size_t>(j + 1) * padded_x + i + 1] =
          std::isnan(elevation.at(i, j)) ? 1 : 0;
    }
  }
  const DistanceTransform to_unknown = transform_distance(unknown, padded_x, padded_y);
  const double radius_cells = radius_m / elevation.cell_m + kRoundOff;
  std::vector<std::uint8_t> known(elevation.values.size());
  for (int j = 0; j < elevation.size_y; ++j) {
    for (int i = 0; i < elevation.size_x; ++i) {
      const double squared =
          to_unknown.squared_cells[static_cast<std::size_t>(j + 1) * padded_x + i + 1];
      known[static_cast<std::size_t>(j) * elevation.size_x + i] =
          squared > radius_cells * radius_cells ? 1 : 0;
    }
  }
  return known;
}

}  // namespace wex::terrain_internal
