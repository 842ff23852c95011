#pragma once

#include <mujoco/mujoco.h>

#include "models/excavator/internal/link_shapes.hpp"

namespace wex::shapes {

/// A link's shape as a geom: collides with the ground if it may touch it, else only looked at; a
/// hull is no geom. Geoms carry no mass (the URDF's inertia counts).
void add_geom(mjsBody* body, const Shape& shape);

}  // namespace wex::shapes
