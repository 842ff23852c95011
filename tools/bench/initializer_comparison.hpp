#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "initializer/make_plan.hpp"
#include "models/types/result.hpp"
#include "tools/bench/initializer_bench.hpp"

namespace wex {

/// What is set side by side.
enum class InitializerComparison {
  kNone,
  kModes,       ///< the default mode and the paper's
  kMechanisms,  ///< either mode, whole and without each of its mechanisms
};

/// One way to plan, as it is called on the command line.
struct InitializerVariant {
  std::string name;  ///< "--mode paper --no-arm-support"
  PlanMode mode = PlanMode::kCertified;
  bool PlanAblation::* off = nullptr;  ///< the mechanism that is switched off, if any
};

/// How a variant fared.
struct InitializerVariantRows {
  InitializerVariant variant;
  std::vector<InitializerRow> rows;
};

[[nodiscard]] std::vector<InitializerVariant> initializer_variants(InitializerComparison what);

/// A line per cell: of every variant the seeds with a path of the base, those with a plan that the
/// checker accepts, and the median time to the first such plan.
[[nodiscard]] std::string comparison_by_cell(const std::vector<InitializerCell>& cells,
                                             const std::vector<InitializerVariantRows>& variants);

/// A line per variant: accepted plans, seeds with a path of the base, and seeds, by terrain and all
/// together; time to the first accepted plan, median and 95 %.
[[nodiscard]] std::string comparison_by_variant(
    const std::vector<InitializerCell>& cells, const std::vector<InitializerVariantRows>& variants);

/// Plans the same cells with the same seeds in every variant, one after the other; each leaves its
/// CSV in a folder of its own, variant_1 and so on.
///   errors  as bench_initializer
[[nodiscard]] Result<void> compare_initializers(const InitializerBenchOptions& options,
                                                InitializerComparison what, std::ostream& out,
                                                std::ostream& err);

}  // namespace wex
