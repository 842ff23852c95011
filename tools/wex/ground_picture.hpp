#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "models/terrain/terrain_map.hpp"
#include "tools/wex/canvas.hpp"

namespace wex::app {

/// The part of a map that is drawn: cells [i0, i1) x [j0, j1) of its grids.
struct MapWindow {
  int i0 = 0, j0 = 0, i1 = 0, j1 = 0;
};

/// Colour of a height within [lo, hi].
[[nodiscard]] Color height_tint(double height_m, double lo_m, double hi_m);

/// Lowest and highest known elevation of a window; (0, 1) if nothing is known.
[[nodiscard]] std::pair<double, double> height_range_m(const Grid& elevation,
                                                       const MapWindow& window);

/// What the tints span: the window's heights, but at least half a metre, so that nearly flat ground
/// does not look like mountains.
[[nodiscard]] std::pair<double, double> tint_range_m(const Grid& elevation,
                                                     const MapWindow& window);

/// Hillshade with height tint, 0xRRGGBB, one pixel per cell, rows from the north; untraversable
/// cells reddened, unknown ones grey.
[[nodiscard]] std::vector<std::uint32_t> ground_pixels(const TerrainMap& terrain,
                                                       const MapWindow& window);

/// Line pieces of the contours at multiples of step_m, local xy, by marching squares.
[[nodiscard]] std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> contour_pieces(
    const Grid& elevation, const MapWindow& window, double step_m);

}  // namespace wex::app
