#pragma once

#include <mujoco/mujoco.h>

#include "models/terrain/terrain_map.hpp"

namespace wex {

inline constexpr const char* kGroundName = "ground";

/// Adds the elevation as a height field to a model specification: samples on the grid, local world
/// frame. Unknown cells become a pit 2 m below the lowest known one, so that nothing can rest
/// there.
void add_ground(mjSpec* spec, const Grid& elevation, double friction);

/// Colours by checker, a light and a sky, for rendering.
void add_scenery(mjSpec* spec, const Grid& elevation);

}  // namespace wex
