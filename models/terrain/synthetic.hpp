#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "models/terrain/raster_io.hpp"
#include "models/types/plan.hpp"

namespace wex {

/// A generated terrain with the task that goes with it (map frame = local frame + map_origin_m;
/// task in the map frame). Geometry as in the decisions; deterministic in (kind, difficulty, seed).
struct SyntheticTerrain {
  Raster raster;
  Task task;
};

/// flat, rough, gap, step, hole, ramp, wall, bridge, side_slope
[[nodiscard]] const std::vector<std::string>& synthetic_kinds();

/// errors  kBadInput: unknown kind (lists the kinds), difficulty outside [0, 1] or not finite
[[nodiscard]] Result<SyntheticTerrain> make_synthetic_terrain(const std::string& kind,
                                                              double difficulty,
                                                              std::uint64_t seed);

/// The JSON beside a map: {"start":[x,y,yaw],"goal":[x,y,yaw]}, map frame, metres and radians.
[[nodiscard]] Result<Task> read_task(const std::filesystem::path& json_file);
[[nodiscard]] Result<void> write_task(const Task& task, const std::filesystem::path& json_file);

}  // namespace wex
