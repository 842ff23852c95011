#pragma once

#include <filesystem>

namespace wex {

/// Runs the tests of the bus, T1 to T22, and prints one table: test, what, figure, gate, verdict.
/// Those that are test programs run as processes of their own from this build; the faults of a real
/// bus run inside tools/with_vcan. A test that cannot run says why and counts as failed.
///   full    about 75 minutes; else a form of under 6 minutes for CI
///   folder  can_bench.csv and the programs' whole output go there
///   returns 0 if all verdicts are "pass", else 5; 1 if the folder cannot be written
int bench_can(bool full, const std::filesystem::path& folder = "out/can_bench");

}  // namespace wex
