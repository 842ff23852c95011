#pragma once

#include <filesystem>

#include "initializer/roadmap/limb_roadmap.hpp"
#include "models/excavator/machine_model.hpp"
#include "models/types/result.hpp"

namespace wex::app {

enum class RoadmapView { kSide, kTop };

/// Contact points and edges of every limb in the base frame, over the machine's capsules in default
/// posture: from its right (x to the right, z up) or from above (x to the right, y up).
///   errors  kBadInput naming the file
[[nodiscard]] Result<void> draw_roadmaps(const MachineModel& machine, const Roadmaps& roadmaps,
                                         RoadmapView view, const std::filesystem::path& file);

}  // namespace wex::app
