#pragma once

#include <filesystem>

#include "models/types/result.hpp"
#include "tools/bench/initializer_bench.hpp"

namespace wex::app {

/// times.png: time to the first accepted plan, first and last cost by terrain (median, bar from 5
/// to 95 %). success.png: accepted share over difficulty with its 95 % interval.
///   errors  kBadInput naming the file
[[nodiscard]] Result<void> draw_initializer_bench(const InitializerBenchOutcome& outcome,
                                                  const std::filesystem::path& folder);

}  // namespace wex::app
