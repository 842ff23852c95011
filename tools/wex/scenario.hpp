#pragma once

#include <functional>

#include "models/excavator/machine_model.hpp"
#include "models/terrain/terrain_map.hpp"
#include "models/types/plan.hpp"
#include "tools/wex/options.hpp"

namespace wex::app {

/// Everything a run needs to know before it plans. `task` is in the terrain's local world frame.
struct Scenario {
  TerrainMap terrain;
  MachineModel machine;
  Task task;
};

/// Pose in the local world frame from one in the map's frame, and back.
[[nodiscard]] Pose2 local_from_map(const Pose2& pose_map, const TerrainMap& terrain);
[[nodiscard]] Pose2 map_from_local(const Pose2& pose_local, const TerrainMap& terrain);

/// Where the machine stands, in the local world frame.
using MeasureStart = std::function<Result<Pose2>(const TerrainMap&, const MachineModel&)>;

/// Reads map, machine and task. With `measure_start` the start is what it says, and neither the
/// option nor the JSON's start counts; its errors are passed on.
///   errors  kBadInput from the loaders; no start or goal (says how to give them); a pose that is
///           not finite or lies off the map; start and goal the same
[[nodiscard]] Result<Scenario> load_scenario(const RunOptions& options,
                                             const MeasureStart& measure_start = {});

}  // namespace wex::app
