#pragma once

#include <array>
#include <vector>

#include "initializer/replan/ground_change.hpp"
#include "models/excavator/collision_model.hpp"
#include "models/excavator/machine_model.hpp"
#include "models/types/plan.hpp"

namespace wex {

/// The ground that matters to one node: below every part of the machine (CollisionModel::Part; legs
/// with their wheels and what those rest on).
using NodeReach = std::array<GroundRect, CollisionModel::kNumParts>;

[[nodiscard]] std::vector<NodeReach> reach_of(const MachineModel& machine,
                                              const CollisionModel& shape,
                                              const std::vector<WholeBodyNode>& nodes);

/// The parts (bit: CollisionModel::Part) whose ground at a node, or on the way to or from it, has
/// changed.
[[nodiscard]] unsigned touched_parts(const std::vector<NodeReach>& reach,
                                     const GroundChange& change, std::size_t node);

/// The nodes whose ground, or the ground on the way to or from them, has changed; ascending.
[[nodiscard]] std::vector<std::size_t> touched_nodes(const std::vector<NodeReach>& reach,
                                                     const GroundChange& change);

}  // namespace wex
