#include "tools/wex/bridge_bench_picture.hpp"

#include <cstdio>

#include "tools/wex/timeline_picture.hpp"

namespace wex::app {

Result<void> draw_bridge_bench(const BridgeBenchOutcome& outcome,
                               const std::filesystem::path& folder) {
  for (const BridgeRow& row : outcome.rows) {
    if (row.seed != 1 || !row.plan) continue;
    const bool with_penalty = row.stepping_penalty > 0.0;
    char title[120];
    std::snprintf(title, sizeof title, "Bridge, stepping penalty %g: %.1f s, %d wheels lifted",
                  row.stepping_penalty, row.plan->nodes.back().t_s, row.wheel_lifts);
    const Result<void> drawn = draw_plan_timeline(
        *row.plan, outcome.machine, title,
        folder / (with_penalty ? "bridge_with_penalty.png" : "bridge_without_penalty.png"));
    if (!drawn) return drawn;
  }
  return {};
}

}  // namespace wex::app
