#pragma once

#include <mujoco/mujoco.h>

#include <string>

#include "models/terrain/terrain_map.hpp"

namespace wex {

inline constexpr const char* kGroundName = "ground";

/// Adds the elevation as a height field to a model specification: samples on the grid, local world
/// frame. Unknown cells become a pit 2 m below the lowest known one, so that nothing can rest
/// there.
void add_ground(mjSpec* spec, const Grid& elevation, double friction);

/// For rendering: squares of one metre on the ground, a sky, and a sun that follows a body so that
/// the shadows near it are sharp.
void add_scenery(mjSpec* spec, const Grid& elevation, const std::string& followed_body);

}  // namespace wex
