#include "initializer/replan/plan_memory.hpp"

#include <utility>

#include "initializer/found_plan.hpp"
#include "initializer/stepping/stance_tables.hpp"
#include "models/types/cpu_clock.hpp"

namespace wex {

Result<PlanMemory> plan_and_remember(const TerrainMap& terrain, const MachineModel& machine,
                                     const Task& task, const PlanSettings& settings,
                                     const std::function<void(const PlanProgress&)>& observer) {
  const double begin_s = thread_cpu_time_s();
  if (std::string complaint = settings_complaint(settings); !complaint.empty()) {
    return fail(ErrorCode::kBadInput, std::move(complaint));
  }
  if (settings.mode == PlanMode::kPaper) {
    return fail(ErrorCode::kBadInput, "plans of the paper's mode cannot be remembered");
  }
  const auto check = PoseCheck::build(terrain, machine, settings);
  if (!check) return tl::unexpected<Error>(check.error());
  auto found = find_plan(terrain, machine, task, settings, *check, {}, observer, begin_s);
  if (!found) return tl::unexpected<Error>(found.error());
  if (!found->tables && settings.mode == PlanMode::kCertified && machine.arm) {
    // The next plan may have to step.
    auto tables = StanceTables::build(machine);
    if (!tables) return tl::unexpected<Error>(tables.error());
    found->tables = std::make_shared<const StanceTables>(*std::move(tables));
  }
  auto shape = std::make_shared<const CollisionModel>(CollisionModel::build(machine));
  auto reach = reach_of(machine, *shape, found->plan.nodes);
  return PlanMemory{std::move(found->plan), std::move(found->paths), terrain,
                    std::move(reach),       check->legs(),           std::move(found->tables),
                    std::move(shape)};
}

}  // namespace wex
