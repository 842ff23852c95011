#pragma once

#include <ompl/base/Planner.h>

#include <cstdint>
#include <functional>

#include "initializer/internal/se2_search.hpp"

namespace wex {

/// A planner of OMPL that goes on improving its solution, and what all of them can be asked.
struct AnytimePlanner {
  ompl::base::PlannerPtr planner;
  std::function<int()> iterations;
  std::function<double()> best_cost_m;  ///< not finite until there is a solution
};

/// Set up for a problem, with linear nearest neighbours (exact, without random pivots) and its own
/// random draws by the seed where OMPL lets them be seeded (BIT* draws a few that it does not).
[[nodiscard]] AnytimePlanner make_planner(const ompl::base::SpaceInformationPtr& si,
                                          const ompl::base::ProblemDefinitionPtr& problem,
                                          const SearchSettings& settings, std::uint64_t seed);

}  // namespace wex
