#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "initializer/drive_path.hpp"
#include "initializer/make_plan.hpp"
#include "initializer/pose_check.hpp"
#include "models/excavator/machine_model.hpp"
#include "models/types/plan.hpp"

namespace wex {

/// On four wheels, everything but legs and wheels in transport posture: where a plan can be cut.
[[nodiscard]] bool may_be_cut(const MachineModel& machine, const WholeBodyNode& node);

/// Distances along a path at which a plan's nodes are, starting at 0, never decreasing [m].
[[nodiscard]] std::vector<double> distances_along(const DrivePath& path,
                                                  const std::vector<WholeBodyNode>& nodes);

/// The part of a path between two distances; empty if there is none.
[[nodiscard]] DrivePath part_of(const DrivePath& path, double from_m, double to_m);

/// What a stretch of a plan costs by its path and its changes of support, small costs of quiet
/// motion left out.
[[nodiscard]] double stretch_cost(const DrivePath& path, const std::vector<WholeBodyNode>& nodes,
                                  std::size_t first, std::size_t last,
                                  const PlanSettings& settings);

/// `plan` up to node `first` and from node `last` on, `stretch` in between, which leads from the
/// base pose of the one to that of the other. The machine stands still at both ends, where base
/// height, tilt and steering go over into each other with all wheels on the ground; times follow.
/// Nothing is verified. Cost, length and margin are left to the caller.
///   nullopt  the machine cannot stand somewhere in between
[[nodiscard]] std::optional<Plan> splice(const MachineModel& machine, const PoseCheck& check,
                                         const Plan& plan, std::size_t first, std::size_t last,
                                         const Plan& stretch, const PlanSettings& settings);

}  // namespace wex
