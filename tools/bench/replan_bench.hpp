#pragma once

#include <cstdint>
#include <ostream>

#include "initializer/make_plan.hpp"
#include "models/types/result.hpp"

namespace wex {

struct ReplanBenchOptions {
  int seeds = 3;         ///< per terrain
  bool verbose = false;  ///< a line for every change
  PlanSettings plan;
};

/// Plans over gap, step, wall and rough ground; then raises or lowers 10 m² of it: anywhere between
/// start and goal, drawn at random; and, chosen to be hard, beside the way, on a stretch that is
/// driven and where a wheel is put down. Plans again: from scratch until the first plan, and from
/// what is remembered. Prints medians of both times and their ratio, what became of the plan, both
/// plans' costs, and how many of both the independent checker accepts. Building the map's layers is
/// not part of the times.
///   errors  those of machine and terrain
[[nodiscard]] Result<void> bench_replan(const ReplanBenchOptions& options, std::ostream& out);

}  // namespace wex
