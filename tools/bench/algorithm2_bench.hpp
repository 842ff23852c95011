#pragma once

#include <ostream>

#include "models/types/result.hpp"

namespace wex {

struct Algorithm2BenchOptions {
  int poses = 4096;
  int repeats = 15;
};

/// Checks per second of the paper's Algorithm 2 on one core beside the plain loop over all leg
/// vertices, over flat, rough and gap ground; how often each kind of pose occurs; whether both
/// ground the same legs.
///   errors  those of machine, terrain and roadmaps; kInternal: the two loops disagree
[[nodiscard]] Result<void> bench_algorithm2(const Algorithm2BenchOptions& options,
                                            std::ostream& out);

}  // namespace wex
