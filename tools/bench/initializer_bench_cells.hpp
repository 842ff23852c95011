#pragma once

#include <string>
#include <vector>

#include "models/terrain/synthetic.hpp"
#include "tools/bench/initializer_bench.hpp"

namespace wex {

[[nodiscard]] std::vector<InitializerCell> initializer_cells(InitializerBenchSet set);

/// The cell's map and task for a seed (task in the map frame).
[[nodiscard]] Result<SyntheticTerrain> initializer_task(InitializerBenchSet set,
                                                        const InitializerCell& cell,
                                                        std::uint64_t seed);

}  // namespace wex
