#pragma once

#include <string>
#include <vector>

#include "initializer/make_plan.hpp"
#include "models/excavator/machine_model.hpp"
#include "models/terrain/terrain_map.hpp"
#include "models/types/plan.hpp"

namespace wex {

/// What an independent look at a plan found.
struct PlanVerdict {
  bool ok = false;
  std::string violation;  ///< the first one, empty if ok: what, where, by how much
  std::size_t node = 0;   ///< where it is
  double min_stability_margin_m = 0.0;
  double worst_height_error_m = 0.0;  ///< wheel centre against a disc at rest there
};

/// Checks every node of a plan through the machine's full kinematics, sharing no code with the
/// search: joint limits, scheduled contacts on known and traversable ground at the right height,
/// lifted wheels above it, tilt, clearance under the chassis, stability; between nodes: spacing,
/// joint rates, increasing time, one contact change at a time, a bucket that stays where it stands;
/// both ends against the task. Runs on every plan before it is returned.
[[nodiscard]] PlanVerdict verify_plan(const TerrainMap& terrain, const MachineModel& machine,
                                      const Plan& plan, const PlanSettings& settings = {});

/// Those of some nodes that verify_plan would refuse by themselves, in the same order; what lies
/// between nodes is not looked at.
[[nodiscard]] std::vector<std::size_t> unsound_nodes(const TerrainMap& terrain,
                                                     const MachineModel& machine, const Plan& plan,
                                                     const std::vector<std::size_t>& nodes,
                                                     const PlanSettings& settings = {});

}  // namespace wex
