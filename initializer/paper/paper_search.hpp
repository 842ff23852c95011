#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "initializer/internal/se2_search.hpp"
#include "initializer/make_plan.hpp"
#include "initializer/paper/paper_check.hpp"
#include "initializer/paper/post_processing.hpp"
#include "initializer/search_census.hpp"

namespace wex {

/// The paper's initialization step for one task: a tree over SE(2) whose states pass Algorithms 1
/// and 2; every better path is post-processed and verified, and lost if that fails. No place is
/// blocked and nothing fed back to the tree: that is the scheme as it was published.
class PaperSearch {
 public:
  /// Everything must outlive it.
  ///   begin_s  thread CPU time at which the budget began
  PaperSearch(const TerrainMap& terrain, const MachineModel& machine, const Task& task,
              const PlanSettings& settings,
              const std::function<void(const PlanProgress&)>& observer, const PaperCheck& check,
              PostProcessing& post_processing, double begin_s);

  /// The best verified plan when the budget ends, or earlier if nothing more is to be gained.
  ///   errors  kNoPlan: with what was refused, paths lost after they were found among it;
  ///           kInternal: OMPL failed
  [[nodiscard]] Result<Plan> run();
  /// Refused poses by Algorithm 2's reasons, and where paths were lost.
  [[nodiscard]] SearchCensus census() const;

 private:
  [[nodiscard]] double elapsed_s() const;
  [[nodiscard]] bool out_of_budget();
  [[nodiscard]] bool is_valid(const Pose2& pose);
  void report(const Plan* better);
  void consider(const DrivePath& path);
  void lose(PaperFailure failure);
  [[nodiscard]] std::string sentence() const;

  const TerrainMap& terrain_;
  const MachineModel& machine_;
  const Task& task_;
  const PlanSettings& settings_;
  const std::function<void(const PlanProgress&)>& observer_;
  const PaperCheck& check_;
  PostProcessing& post_processing_;
  SearchSettings search_settings_;
  std::optional<Se2Search> search_;
  double begin_s_, reported_s_ = 0.0, improved_s_ = 0.0, lower_bound_m_ = 0.0;
  std::optional<Plan> best_;
  int num_paths_ = 0;
  std::uint64_t num_poses_ = 0;
  std::array<std::uint64_t, kNumPaperRejections> rejections_{};
  std::array<int, kNumPaperStages> lost_{};
  SearchCensus lost_paths_;
};

/// Roadmaps from the cache (or built: the paper's offline computation, not counted against the
/// budget), check, post-processing and search in one call.
[[nodiscard]] Result<Plan> make_paper_plan(const TerrainMap& terrain, const MachineModel& machine,
                                           const Task& task, const PlanSettings& settings,
                                           const std::function<void(const PlanProgress&)>& observer,
                                           double begin_s, SearchCensus& turned_down);

}  // namespace wex
