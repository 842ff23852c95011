#pragma once

#include <functional>

#include "initializer/make_plan.hpp"
#include "initializer/search_census.hpp"

namespace wex {

/// make_plan, and what its search turned down on the way, plan or not; left alone where nothing was
/// searched.
[[nodiscard]] Result<Plan> make_plan(const TerrainMap& terrain, const MachineModel& machine,
                                     const Task& task, const PlanSettings& settings,
                                     const std::function<void(const PlanProgress&)>& observer,
                                     SearchCensus& turned_down);

}  // namespace wex
