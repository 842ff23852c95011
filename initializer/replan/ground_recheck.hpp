#pragma once

#include <cstddef>
#include <vector>

#include "initializer/make_plan.hpp"
#include "initializer/replan/ground_change.hpp"
#include "initializer/replan/node_reach.hpp"
#include "models/excavator/collision_model.hpp"
#include "models/excavator/machine_model.hpp"
#include "models/terrain/terrain_map.hpp"
#include "models/types/plan.hpp"

namespace wex {

/// A plan that was good on the ground before, looked at on the ground after.
struct RecheckedPlan {
  const Plan& plan;
  const MachineModel& machine;
  const CollisionModel& shape;
  const TerrainMap& before;
  const TerrainMap& after;
  /// Parts of the machine whose ground has not changed need no second look; null: all get one.
  const std::vector<NodeReach>* reach = nullptr;
  const GroundChange* change = nullptr;
};

/// Those of some nodes that the ground after does not allow: what verify_plan refuses at them; and
/// at them and half-way to the next, whatever comes closer to the ground than it was and than its
/// clearance, or a standing wheel that is lifted or sunk. In ascending order.
[[nodiscard]] std::vector<std::size_t> unsound_on_changed_ground(
    const RecheckedPlan& rechecked, const std::vector<std::size_t>& nodes,
    const PlanSettings& settings);

}  // namespace wex
