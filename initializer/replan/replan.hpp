#pragma once

#include <optional>

#include "initializer/replan/ground_change.hpp"
#include "initializer/replan/plan_memory.hpp"

namespace wex {

/// What became of the plan before.
enum class ReplanOutcome {
  kUntouched,   ///< the change is nowhere near it
  kStillGood,   ///< what the change touches was checked again and holds
  kNewStretch,  ///< a part of it was planned anew and put in
  kNewPlan,     ///< planned from start to goal
};
[[nodiscard]] const char* name_of(ReplanOutcome outcome);

struct Replanned {
  PlanMemory memory;  ///< with the plan for the new ground
  ReplanOutcome outcome = ReplanOutcome::kUntouched;
  std::size_t num_touched = 0;   ///< nodes of the plan before that were checked again
  std::size_t num_unsound = 0;   ///< of these, that do not hold
  std::size_t num_replaced = 0;  ///< nodes of the plan before that are not in the new one
  double time_s = 0.0;           ///< thread CPU time
};

/// A plan for ground that has changed since the plan before was made. Nodes on ground that has not
/// changed stay as they are; the others are checked again; if any does not hold, the stretch around
/// it is planned anew between two nodes on four wheels, first along its own path, then directly,
/// then by a search; only then everything, along remembered paths first. The first plan found is
/// returned: it may cost more than what make_plan finds in its whole budget.
///   terrain   the whole new map, of the old one's grid
///   changed   outside of it heights are as before; not given: found by comparing
///   settings  as for the plan before (contract)
///   errors    as make_plan; kBadInput: a map of another grid
[[nodiscard]] Result<Replanned> replan(const PlanMemory& before, const TerrainMap& terrain,
                                       const MachineModel& machine,
                                       const PlanSettings& settings = {},
                                       const std::optional<GroundRect>& changed = std::nullopt);

}  // namespace wex
