#pragma once

#include <optional>
#include <string>
#include <vector>

#include "initializer/stepping/stance_ground.hpp"
#include "initializer/stepping/stepping_timing.hpp"
#include "models/excavator/collision_model.hpp"
#include "models/excavator/machine_model.hpp"
#include "models/terrain/terrain_map.hpp"

namespace wex {

/// Fills in wheel angles: wheels on the ground roll the way their centres go, less the turn of what
/// carries the axle; lifted ones turn with ground speed while the base drives. Nodes between which
/// a standing wheel slips sideways are given the time for it.
void turn_wheels(const MachineModel& machine, std::vector<MotionNode>& nodes);

/// The first node that breaks a limit of a joint or of stability on its scheduled contacts, has a
/// leg in the ground, or swings a wheel too close to it.
///   ground  of the terrain
struct NodeFault {
  std::size_t node = 0;
  std::string why;
};
[[nodiscard]] std::optional<NodeFault> find_fault(const TerrainMap& terrain,
                                                  const StanceGround& ground,
                                                  const MachineModel& machine,
                                                  const CollisionModel& collision,
                                                  const std::vector<MotionNode>& nodes,
                                                  double min_margin_m, double swing_clearance_m);

}  // namespace wex
