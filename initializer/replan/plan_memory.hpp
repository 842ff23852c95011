#pragma once

#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "initializer/drive_path.hpp"
#include "initializer/leg_table.hpp"
#include "initializer/make_plan.hpp"
#include "initializer/replan/node_reach.hpp"
#include "models/excavator/collision_model.hpp"
#include "models/excavator/machine_model.hpp"
#include "models/terrain/terrain_map.hpp"

namespace wex {

struct StanceTables;

/// A plan with what making it left behind, for making the next one when the ground has changed. A
/// plain value: copies share what does not change.
struct PlanMemory {
  Plan plan;
  std::vector<DrivePath> paths;  ///< every path that was the best of its time; last: the plan's
  TerrainMap terrain;            ///< the plan was made for
  std::vector<NodeReach> reach;  ///< per node, the ground that matters to it
  // Of the machine alone:
  std::array<LegTable, kNumWheels> legs;
  std::shared_ptr<const StanceTables> tables;
  std::shared_ptr<const CollisionModel> shape;
};

/// make_plan that remembers; the paper's mode leaves nothing to remember.
///   errors  as make_plan; kBadInput: the paper's mode
[[nodiscard]] Result<PlanMemory> plan_and_remember(
    const TerrainMap& terrain, const MachineModel& machine, const Task& task,
    const PlanSettings& settings = {},
    const std::function<void(const PlanProgress&)>& observer = {});

}  // namespace wex
