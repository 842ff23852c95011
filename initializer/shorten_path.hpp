#pragma once

#include "initializer/drive_path.hpp"
#include "initializer/internal/se2_search.hpp"

namespace wex {

/// Replaces stretches of a valid path by valid Reeds-Shepp curves between poses on it (about a
/// metre apart), so that the cost is the lowest such curves give. Never returns a costlier path.
/// The first paths of a random tree wander; this straightens them long before the tree would.
[[nodiscard]] DrivePath shorten_path(const DrivePath& path, const SearchSettings& settings,
                                     const PoseValidity& is_valid);

}  // namespace wex
