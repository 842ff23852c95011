#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/excavator/internal/link_shapes.hpp"

namespace wex::shapes {

/// In the frame of the shape's link.
struct CoverCapsule {
  Eigen::Vector3d p_link_a = Eigen::Vector3d::Zero(), p_link_b = Eigen::Vector3d::Zero();
  double radius_m = 0.0;
};

/// Capsules whose union contains the shape and sticks out of it by little, most at the ends: a box
/// becomes a bundle of rods along its longest side, a disc a ring of eight rods around a ball.
[[nodiscard]] std::vector<CoverCapsule> capsule_cover(const Shape& shape);

}  // namespace wex::shapes
