#pragma once

#include <cstdint>
#include <vector>

namespace wex::terrain_internal {

/// Exact Euclidean distance transform of a mask, between cell centres.
struct DistanceTransform {
  std::vector<double> squared_cells;  ///< to the nearest marked cell; infinity if there is none
  std::vector<std::int32_t> nearest;  ///< index of that cell; -1 if there is none
};

/// [Felzenszwalb and Huttenlocher 2012, "Distance Transforms of Sampled Functions"]: lower envelope
/// of parabolas, one dimension after the other; linear in the number of cells.
///   marked  size_x * size_y cells, row-major, nonzero = a cell to measure the distance to
[[nodiscard]] DistanceTransform transform_distance(const std::vector<std::uint8_t>& marked,
                                                   int size_x, int size_y);

/// Signed distance [m], positive where `inside` is nonzero, to the border between inside and
/// outside cells: half a cell less than the distance between cell centres. All ground beyond the
/// map is outside. Without any inside cell: minus the map's diagonal.
[[nodiscard]] std::vector<float> signed_distance(const std::vector<std::uint8_t>& inside,
                                                 int size_x, int size_y, double cell_m);

}  // namespace wex::terrain_internal
