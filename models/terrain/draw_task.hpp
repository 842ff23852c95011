#pragma once

#include <cstdint>

#include "models/terrain/terrain_map.hpp"
#include "models/types/plan.hpp"

namespace wex {

/// Where drawn poses may lie.
struct DrawSettings {
  double clearance_m = 3.5;  ///< signed distance at the base: the wheels' outer circle
  double min_distance_m = 10.0;
  int max_tries = 10000;
};

/// Start and goal drawn uniformly over the map by seed, yaw in all directions, in the local frame
/// of the map. Only the ground under the machine is asked for: whether a way exists is not.
///   errors  kBadInput: the map has too little traversable ground for two such poses
[[nodiscard]] Result<Task> draw_task(const TerrainMap& terrain, std::uint64_t seed,
                                     const DrawSettings& settings = {});

}  // namespace wex
