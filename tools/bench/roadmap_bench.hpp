#pragma once

#include <ostream>
#include <string>

#include "models/types/result.hpp"

namespace wex {

struct RoadmapBenchOptions {
  std::string machine = "m545";
  int repeats = 5;
};

/// Times the roadmaps of all limbs at their default sizes, on one core: building by limb, loading
/// from a cache file, and arm motions over the arm's; thread CPU time, median of the repeats.
///   errors  kBadInput: the machine; a temporary folder that cannot be written
[[nodiscard]] Result<void> bench_roadmap(const RoadmapBenchOptions& options, std::ostream& out);

}  // namespace wex
