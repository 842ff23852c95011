#pragma once

#include <filesystem>
#include <ostream>

#include "models/types/result.hpp"

namespace wex {

struct CanBenchOptions {
  bool full = false;  ///< about 75 minutes; else a form of under 6 minutes for CI
  std::filesystem::path out = "out/can_bench";
};

/// Runs the tests of the bus, T1 to T22, and prints one table: test, what, figure, gate, verdict.
/// Those that are test programs run as processes of their own from this build; the faults of a real
/// bus run inside tools/with_vcan. A test that cannot run says why and counts as failed.
/// can_bench.csv and log.txt, the programs' whole output, go to options.out.
///   returns  0 if all verdicts are "pass", else 5
///   errors   kBadInput: the folder cannot be written
[[nodiscard]] Result<int> bench_can(const CanBenchOptions& options, std::ostream& out,
                                    std::ostream& err);

}  // namespace wex
