#pragma once

#include <cstdint>
#include <vector>

#include "models/terrain/terrain_map.hpp"

namespace wex::terrain_internal {

/// Height of the lowest point of a ball of the tyre's radius that rests on the ground with its
/// centre above the cell: max over the disc of z + sqrt(r^2 - d^2) - r. Unknown neighbours are
/// left out; unknown cells stay NaN.
[[nodiscard]] Grid dilate_by_tyre(const Grid& elevation, double wheel_radius_m);

/// 1 where every cell within the radius is on the map and known, else 0; index as in Grid.
[[nodiscard]] std::vector<std::uint8_t> known_within(const Grid& elevation, double radius_m);

}  // namespace wex::terrain_internal
