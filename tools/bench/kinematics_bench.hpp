#pragma once

namespace wex {

/// Times the chain kinematics of the m545 at random postures and prints one line per query: least,
/// median, 90th and 99th percentile in microseconds of thread CPU time per call.
///   returns  process exit code
int bench_kinematics();

}  // namespace wex
