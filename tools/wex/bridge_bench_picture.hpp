#pragma once

#include <filesystem>

#include "models/types/result.hpp"
#include "tools/bench/bridge_bench.hpp"

namespace wex::app {

/// bridge_without_penalty.png, bridge_with_penalty.png: contact schedules of the first seed's
/// plans.
///   errors  kBadInput naming the file
[[nodiscard]] Result<void> draw_bridge_bench(const BridgeBenchOutcome& outcome,
                                             const std::filesystem::path& folder);

}  // namespace wex::app
