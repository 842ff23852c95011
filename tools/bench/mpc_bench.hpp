#pragma once

namespace wex {

/// Refinement and receding horizon on synthetic rough ground; prints iterations and thread CPU
/// times (min, median, percentiles) and the ratio to the cold-started optimizer, solved on the same
/// states.
///   returns  process exit code
int bench_mpc();

}  // namespace wex
