#pragma once

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "models/types/result.hpp"

namespace wex {

struct CanBenchOptions {
  bool full = false;              ///< about 75 minutes; else a form of under 6 minutes for CI
  std::vector<std::string> only;  ///< "T6": only these tests, beside what is known of the others
  std::filesystem::path out = "out/can_bench";
};

/// Runs the tests of the bus, T1 to T22, and prints one table: test, what, figure, gate, verdict.
/// Those that are test programs run as processes of their own from this build; the faults of a real
/// bus run inside tools/with_vcan, with real-time priority if that may be had. A test that cannot
/// run says why and counts as failed. can_bench.csv (full: can_bench_full.csv) and log.txt, the
/// programs' whole output, go to options.out; with `only` the rows of the other tests are taken
/// from the CSV of before, so that the whole can be run in parts.
///   returns  0 if all verdicts are "pass", else 5
///   errors   kBadInput: the folder cannot be written; no such test
[[nodiscard]] Result<int> bench_can(const CanBenchOptions& options, std::ostream& out,
                                    std::ostream& err);

}  // namespace wex
