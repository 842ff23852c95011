#pragma once

#include "models/types/plan.hpp"
#include "tools/bench/drive_bench.hpp"

namespace wex {

/// One run of the benchmark, with its input already written.
struct DriveBenchRun {
  std::string name;  ///< of the case
  int seed = 0;
  std::filesystem::path map;
  Task task_map;           ///< map frame
  int rejected_draws = 0;  ///< starts and goals drawn where the machine cannot stand
  std::filesystem::path folder;
};

/// Names of the synthetic cases, and of the real map's where one is given.
[[nodiscard]] std::vector<std::string> drive_bench_case_names(const DriveBenchOptions& options);

/// Writes the maps of all asked cases below options.out and lists the runs.
[[nodiscard]] Result<std::vector<DriveBenchRun>> prepare_drive_bench(
    const DriveBenchOptions& options);

}  // namespace wex
