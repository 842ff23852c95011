#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "models/excavator/machine_model.hpp"
#include "models/types/plan.hpp"
#include "models/types/result.hpp"

namespace wex {

struct BridgeBenchOptions {
  int seeds = 5;
  double stepping_penalty = 10.0;  ///< of the plans that prefer to drive
  double time_budget_s = 4.0;      ///< of each plan
  std::filesystem::path out = "out/bridge_bench";
};

/// One plan over the gap that a bridge spans.
struct BridgeRow {
  std::uint64_t seed = 0;
  double stepping_penalty = 0.0;
  std::optional<Plan> plan;
  int wheel_lifts = 0, bucket_supports = 0;
  std::string reason;  ///< why there is no accepted plan; empty if there is
};

struct BridgeBenchOutcome {
  MachineModel machine;
  std::vector<BridgeRow> rows;  ///< by seed: without the penalty, with it
  /// Every plan accepted by the checker; without the penalty all wheels are stepped over the gap,
  /// with it fewer wheels are lifted.
  bool holds = false;
};

/// The paper's experiment with the stepping penalty: plans over the bridge without it and with it,
/// judged by the independent checker. Writes a table, beside the paper's durations, to `out`.
///   errors  kBadInput: a machine that cannot be loaded
[[nodiscard]] Result<BridgeBenchOutcome> bench_bridge(const BridgeBenchOptions& options,
                                                      std::ostream& out);

}  // namespace wex
