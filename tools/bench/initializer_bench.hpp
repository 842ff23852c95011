#pragma once

#include <cstdint>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "initializer/make_plan.hpp"
#include "models/types/result.hpp"

namespace wex {

/// Which tasks a benchmark of the initializer is made of.
enum class InitializerBenchSet {
  kCells,   ///< the twenty cells of terrain and difficulty, and the side slope
  kHard,    ///< gap, step, wall with start and goal within 3 m and 90 degrees of the line
  kBeyond,  ///< more than the paper: gap 4.2 m, step 2 m, wall 0.9 m, a gap at 15 degrees
};

struct InitializerBenchOptions {
  InitializerBenchSet set = InitializerBenchSet::kCells;
  int seeds = 20;                  ///< per cell
  bool quick = false;              ///< two seeds of a second each
  int jobs = 2;                    ///< processes
  std::vector<std::string> cells;  ///< only those whose names begin so; empty: all
  std::filesystem::path out = "out/initializer_bench";
  PlanSettings plan;
};

/// One terrain at one difficulty.
struct InitializerCell {
  std::string name;     ///< "gap 0.25"
  std::string terrain;  ///< "gap"
  double difficulty = 0.0;
  bool has_levels = false;  ///< a point of the picture over difficulty
  bool judged = true;       ///< counts for the demanded rates
};

/// One planned task.
struct InitializerRow {
  std::string cell;
  std::uint64_t seed = 0;
  int paths = 0;  ///< of the base, found on the way; in other modes than the paper's: the plan
  bool found = false, first_accepted = false, accepted = false;
  double first_s = 0.0;  ///< thread CPU time to the first accepted plan
  double total_s = 0.0;  ///< of the whole search
  double first_cost = 0.0, cost = 0.0;
  double length_m = 0.0, duration_s = 0.0, margin_m = 0.0;
  int lifts = 0;       ///< of wheels, over the plan
  std::string reason;  ///< why there is no accepted plan; empty if there is
};

struct InitializerBenchOutcome {
  std::vector<InitializerCell> cells;
  std::vector<InitializerRow> rows;
  bool rates_hold = false;  ///< at least 95 % pooled, no judged cell under 80 %
};

/// Plans every cell with every seed, has every first and every last plan judged by the independent
/// checker, writes initializer_bench.csv to the folder and a table to `out`.
///   errors  kBadInput: unknown cell, unwritable folder; kInternal: no process
[[nodiscard]] Result<InitializerBenchOutcome> bench_initializer(
    const InitializerBenchOptions& options, std::ostream& out, std::ostream& err);

}  // namespace wex
