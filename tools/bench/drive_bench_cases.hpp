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

/// "X,Y,YAW" as the command line takes it.
[[nodiscard]] std::string pose_text(const Pose2& pose);

/// What `wex run` is asked in every run, but for the start, which a machine on a bus knows itself.
[[nodiscard]] std::vector<std::string> run_words(const DriveBenchRun& run,
                                                 const DriveBenchOptions& options);

/// Names of the synthetic cases, and of the real map's where one is given.
[[nodiscard]] std::vector<std::string> drive_bench_case_names(const DriveBenchOptions& options);

/// Writes the maps of all asked cases below options.out and lists the runs.
[[nodiscard]] Result<std::vector<DriveBenchRun>> prepare_drive_bench(
    const DriveBenchOptions& options);

}  // namespace wex
