#pragma once

#include <vector>

#include "initializer/drive_path.hpp"

namespace wex {

/// Ways from one pose to another that ignore the ground, cheapest first: the Reeds-Shepp curve,
/// which is the shortest but likes to reverse, and the Dubins curves, all forward and all in
/// reverse.
[[nodiscard]] std::vector<DrivePath> direct_paths(const Pose2& from, const Pose2& to,
                                                  double turning_radius_m,
                                                  const PathCostWeights& weights);

}  // namespace wex
