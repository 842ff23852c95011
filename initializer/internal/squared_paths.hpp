#pragma once

#include <functional>
#include <vector>

#include "initializer/drive_path.hpp"
#include "initializer/internal/se2_search.hpp"
#include "models/terrain/terrain_map.hpp"
#include "models/types/pose.hpp"

namespace wex {

/// What a pose of a path asks of the machine.
enum class Footholds { kNone, kSomeWheels, kAllWheels };
using PoseFootholds = std::function<Footholds(const Pose2& pose, double curvature_1_m)>;

/// Paths that meet what must be stepped over squarely: on four wheels to a straight line across the
/// edge of traversable ground, along it as far as wheels must be lifted, on four wheels to the
/// goal. Lines are laid through edges found on rays beside the way from start to goal. Cheapest
/// first, at most `max_paths`; every pose of them has footholds.
[[nodiscard]] std::vector<DrivePath> squared_paths(const TerrainMap& terrain, const Pose2& start,
                                                   const Pose2& goal,
                                                   const SearchSettings& settings,
                                                   const PoseFootholds& footholds,
                                                   std::size_t max_paths);

}  // namespace wex
