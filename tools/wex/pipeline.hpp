#pragma once

#include "tools/wex/progress.hpp"
#include "tools/wex/run_report.hpp"

namespace wex::app {

/// The main job: load, plan, refine, drive, report; with Depth::kPlanOnly it ends after the plan.
/// Files go to options.out (README: "Files"); result.json last.
///   returns  a report also where there is no plan, the refinement fails or the machine is stopped
///            (report.failure)
///   errors   kBadInput (nothing is left behind) and kInternal
[[nodiscard]] Result<RunReport> run_pipeline(const RunOptions& options, Progress& progress);

}  // namespace wex::app
