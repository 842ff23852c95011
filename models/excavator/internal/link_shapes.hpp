#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "models/excavator/machine_model.hpp"

// Plain shapes of the machine's links, one source for the simulation's geoms and the planners'
// capsules. All positions in the link's frame, lengths in m.

namespace wex::shapes {

struct Colour {
  std::array<float, 4> rgba;
};

enum class Form { kBox, kCylinder, kCapsule };

enum class Use {
  kBody,         ///< touches the ground in simulation, and must not
  kLoadBearing,  ///< touches the ground in simulation: wheel or bucket
  kSolid,        ///< takes up space, but the simulation leaves it out
  kHull,         ///< takes up space as a whole; only its walls are shown
  kDecoration    ///< inside or on something solid
};

/// Box: half sizes. Cylinder and capsule along z: radius, half length (of the axis), unused.
struct Shape {
  Form form = Form::kBox;
  Eigen::Isometry3d T_link_shape = Eigen::Isometry3d::Identity();
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();
  Colour colour{};
  Use use = Use::kSolid;
};

/// Shapes of every body of the tree. Those of a wheel stand around the wheel's centre.
[[nodiscard]] std::vector<std::vector<Shape>> link_shapes(const MachineModel& machine);

}  // namespace wex::shapes
