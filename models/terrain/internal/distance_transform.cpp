#include "models/terrain/internal/distance_transform.hpp"

#include <cmath>
#include <limits>

namespace wex::terrain_internal {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Scratch of the lower envelope of the parabolas height[q] + (x - q)^2.
class LowerEnvelope {
 public:
  explicit LowerEnvelope(int size) : vertex_(size), left_border_(size + 1) {}

  /// Calls visit(x, q) with the parabola q that is lowest at x, for every x; not at all if every
  /// height is infinite.
  template <typename Visit>
  void scan(const std::vector<double>& height, const Visit& visit) {
    const int size = static_cast<int>(height.size());
    int count = 0;
    for (int q = 0; q < size; ++q) {
      if (height[q] == kInfinity) continue;
      double border = -kInfinity;
      while (count > 0) {
        const int p = vertex_[count - 1];
        border = (height[q] - height[p] + static_cast<double>(q) * q - static_cast<double>(p) * p) /
                 (2.0 * (q - p));
        if (border > left_border_[count - 1]) break;
        --count;
        border = -kInfinity;
      }
      vertex_[count] = q;
      left_border_[count] = border;
      ++count;
    }
    if (count == 0) return;
    left_border_[count] = kInfinity;
    for (int x = 0, k = 0; x < size; ++x) {
      while (left_border_[k + 1] < x) ++k;
      visit(x, vertex_[k]);
    }
  }

 private:
  std::vector<int> vertex_;
  std::vector<double> left_border_;
};

/// First dimension: distance along each column to its nearest marked cell, by two sweeps.
DistanceTransform transform_columns(const std::vector<std::uint8_t>& marked, int size_x,
                                    int size_y) {
  DistanceTransform columns{std::vector<double>(marked.size(), kInfinity),
                            std::vector<std::int32_t>(marked.size(), -1)};
  const auto sweep = [&](int first, int last, int step) {
    std::vector<int> nearest_row(size_x, -1);
    for (int j = first; j != last; j += step) {
      for (int i = 0; i < size_x; ++i) {
        const std::size_t cell = static_cast<std::size_t>(j) * size_x + i;
        if (marked[cell] != 0) nearest_row[i] = j;
        if (nearest_row[i] < 0) continue;
        const double distance = j - nearest_row[i];
        if (distance * distance < columns.squared_cells[cell]) {
          columns.squared_cells[cell] = distance * distance;
          columns.nearest[cell] = static_cast<std::int32_t>(nearest_row[i] * size_x + i);
        }
      }
    }
  };
  sweep(0, size_y, 1);
  sweep(size_y - 1, -1, -1);
  return columns;
}

}  // namespace

DistanceTransform transform_distance(const std::vector<std::uint8_t>& marked, int size_x,
                                     int size_y) {
  DistanceTransform transform = transform_columns(marked, size_x, size_y);
  LowerEnvelope envelope(size_x);
  std::vector<double> height(size_x);
  std::vector<std::int32_t> nearest(size_x);
  for (int j = 0; j < size_y; ++j) {
    const std::size_t row = static_cast<std::size_t>(j) * size_x;
    for (int i = 0; i < size_x; ++i) {
      height[i] = transform.squared_cells[row + i];
      nearest[i] = transform.nearest[row + i];
    }
    envelope.scan(height, [&](int x, int q) {
      const double distance = x - q;
      transform.squared_cells[row + x] = height[q] + distance * distance;
      transform.nearest[row + x] = nearest[q];
    });
  }
  return transform;
}

std::vector<float> signed_distance(const std::vector<std::uint8_t>& inside, int size_x, int size_y,
                                   double cell_m) {
  // One ring of outside cells around the map stands for everything beyond it.
  const int padded_x = size_x + 2;
  const int padded_y = size_y + 2;
  std::vector<std::uint8_t> is_inside(static_cast<std::size_t>(padded_x) * padded_y, 0);
  for (int j = 0; j < size_y; ++j) {
    for (int i = 0; i < size_x; ++i) {
      is_inside[static_cast<std::size_t>(j + 1) * padded_x + i + 1] =
          inside[static_cast<std::size_t>(j) * size_x + i];
    }
  }
  std::vector<std::uint8_t> is_outside(is_inside.size());
  for (std::size_t cell = 0; cell < is_inside.size(); ++cell) {
    is_outside[cell] = is_inside[cell] != 0 ? 0 : 1;
  }
  const DistanceTransform to_inside = transform_distance(is_inside, padded_x, padded_y);
  const DistanceTransform to_outside = transform_distance(is_outside, padded_x, padded_y);

  const double diagonal_m = cell_m * std::hypot(size_x, size_y);
  std::vector<float> distance_m(inside.size());
  for (int j = 0; j < size_y; ++j) {
    for (int i = 0; i < size_x; ++i) {
      const std::size_t padded = static_cast<std::size_t>(j + 1) * padded_x + i + 1;
      double signed_m = -diagonal_m;
      if (is_inside[padded] != 0) {
        signed_m = cell_m * (std::sqrt(to_outside.squared_cells[padded]) - 0.5);
      } else if (to_inside.nearest[padded] >= 0) {
        signed_m = -cell_m * (std::sqrt(to_inside.squared_cells[padded]) - 0.5);
      }
      distance_m[static_cast<std::size_t>(j) * size_x + i] = static_cast<float>(signed_m);
    }
  }
  return distance_m;
}

}  // namespace wex::terrain_internal
