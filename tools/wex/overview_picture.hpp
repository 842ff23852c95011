#pragma once

#include <filesystem>

#include "models/excavator/machine_model.hpp"
#include "models/terrain/terrain_map.hpp"
#include "tools/wex/run_report.hpp"

namespace wex::app {

/// overview.png: the ground from above (hillshade, height tint, contour lines, untraversable cells)
/// with start, goal, the planned, refined and driven path and the wheel tracks; of a plan that
/// steps its footholds, lifted stretches and bucket points; of a search without a plan the places
/// where its paths died, and why.
///   errors  kBadInput if the file cannot be written
[[nodiscard]] Result<void> draw_overview(const RunReport& report, const TerrainMap& terrain,
                                         const MachineModel& machine,
                                         const std::filesystem::path& file);

}  // namespace wex::app
