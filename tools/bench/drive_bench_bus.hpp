#pragma once

#include "tools/bench/drive_bench_table.hpp"

namespace wex {

/// One run over a bus: `wex machine` and `wex run` as two processes. Into the run's folder come
/// both processes' output (machine.txt, log.txt), the machine's own log (machine.csv) and what the
/// run leaves.
///   errors  kInternal: no process
[[nodiscard]] Result<DriveBenchResult> drive_on_bus(const DriveBenchRun& run,
                                                    const DriveBenchOptions& options);

/// The result of such a run: a success only if the machine's own log says so too; what its log
/// knows better than the host stands in place of the host's figures.
[[nodiscard]] DriveBenchResult read_bus_result(const DriveBenchRun& run, int exit_code);

}  // namespace wex
