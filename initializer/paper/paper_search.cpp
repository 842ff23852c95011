#include "initializer/paper/paper_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "initializer/verify_plan.hpp"
#include "models/types/cpu_clock.hpp"

namespace wex {
namespace {

constexpr double kGoodEnough = 1.02;       // of the Reeds-Shepp length, which no path beats
constexpr double kWorthwhileShare = 0.99;  // of the tree's cost, to look at a path again
constexpr double kStagnationShare = 0.25;  // of the time budget without a better plan
constexpr double kProgressPeriodS = 0.1;

}  // namespace

PaperSearch::PaperSearch(const TerrainMap& terrain, const MachineModel& machine, const Task& task,
                         const PlanSettings& settings,
                         const std::function<void(const PlanProgress&)>& observer,
                         const PaperCheck& check, PostProcessing& post_processing, double begin_s)
    : terrain_(terrain),
      machine_(machine),
      task_(task),
      settings_(settings),
      observer_(observer),
      check_(check),
      post_processing_(post_processing),
      begin_s_(begin_s) {
  search_settings_.planner = settings.planner;
  search_settings_.turning_radius_m = machine.min_turning_radius_m;
  search_settings_.range_m = settings.range_m;
  search_settings_.subnode_spacing_m = settings.subnode_spacing_m;
  search_settings_.yaw_weight_m_rad = settings.yaw_weight_m_rad;
  search_settings_.x_min_m = terrain.min_corner_m().x();
  search_settings_.x_max_m = terrain.max_corner_m().x();
  search_settings_.y_min_m = terrain.min_corner_m().y();
  search_settings_.y_max_m = terrain.max_corner_m().y();
}

double PaperSearch::elapsed_s() const { return thread_cpu_time_s() - begin_s_; }

bool PaperSearch::out_of_budget() {
  if (observer_ && elapsed_s() - reported_s_ > kProgressPeriodS) report(nullptr);
  if (best_ && best_->cost <= kGoodEnough * lower_bound_m_) return true;
  if (settings_.iterations) return search_->iterations() >= *settings_.iterations;
  const double now_s = elapsed_s();
  return now_s >= settings_.time_budget_s ||
         (best_ && now_s - improved_s_ >= kStagnationShare * settings_.time_budget_s);
}

void PaperSearch::report(const Plan* better) {
  if (!observer_) return;
  reported_s_ = elapsed_s();
  PlanProgress progress;
  progress.elapsed_s = reported_s_;
  if (best_) progress.best_cost = best_->cost;
  progress.better = better;
  progress.num_paths = num_paths_;
  observer_(progress);
}

bool PaperSearch::is_valid(const Pose2& pose) {
  const PaperRejection rejection = check_.stand(pose).rejection;
  ++num_poses_;
  ++rejections_[static_cast<std::size_t>(rejection)];
  return rejection == PaperRejection::kNone;
}

void PaperSearch::lose(PaperFailure failure) {
  ++lost_[static_cast<std::size_t>(failure.stage)];
  lost_paths_.add(
      {failure.where, std::string(describe(failure.stage)) + ": " + failure.why, failure.stepping});
}

void PaperSearch::consider(const DrivePath& path) {
  ++num_paths_;
  const double cost_m = path_cost_m(path, search_settings_.cost);
  if (best_ && cost_m >= best_->cost) return;
  auto nodes = post_processing_.nodes(path);
  if (!nodes) {
    lose(nodes.error());
    return report(nullptr);
  }
  Plan plan;
  plan.task = task_;
  plan.seed = settings_.seed;
  plan.nodes = *std::move(nodes);
  plan.path_length_m = path_length_m(path);
  plan.cost = cost_m;
  const PlanVerdict verdict = verify_plan(terrain_, machine_, plan, settings_);
  if (!verdict.ok) {
    const Eigen::VectorXd& q = plan.nodes[std::min(verdict.node, plan.nodes.size() - 1)].q;
    const bool stepping =
        std::any_of(plan.nodes.begin(), plan.nodes.end(),
                    [](const WholeBodyNode& node) { return node.contacts != kDrivingContacts; });
    lose({PaperStage::kVerified, {q[kBaseX], q[kBaseY], q[kBaseYaw]}, verdict.violation, stepping});
    return report(nullptr);
  }
  plan.min_stability_margin_m = verdict.min_stability_margin_m;
  plan.first_solution_time_s = best_ ? best_->first_solution_time_s : elapsed_s();
  best_ = std::move(plan);
  improved_s_ = elapsed_s();
  report(&*best_);
}

Result<Plan> PaperSearch::run() {
  lower_bound_m_ =
      path_length_m(reeds_shepp_path(task_.start, task_.goal, search_settings_.turning_radius_m));
  search_.emplace(
      task_.start, task_.goal, search_settings_,
      [this](const Pose2& pose, double) { return is_valid(pose); }, settings_.seed);
  double wanted_m = std::numeric_limits<double>::infinity();
  while (!out_of_budget()) {
    const auto path = search_->find_cheaper_than(wanted_m, [this] { return out_of_budget(); });
    if (!path) return tl::unexpected<Error>(path.error());
    if (!*path) break;
    wanted_m = kWorthwhileShare * search_->best_cost_m();
    consider(**path);
  }
  report(nullptr);
  if (!best_) return fail(ErrorCode::kNoPlan, sentence());
  best_->iterations = search_->iterations();
  best_->total_time_s = elapsed_s();
  return *std::move(best_);
}

SearchCensus PaperSearch::census() const {
  SearchCensus census = lost_paths_;
  census.count_poses(num_poses_);
  for (std::size_t i = 1; i < rejections_.size(); ++i) {
    census.count(describe(static_cast<PaperRejection>(i)), rejections_[i]);
  }
  return census;
}

std::string PaperSearch::sentence() const {
  char text[320];
  std::snprintf(text, sizeof text,
                "no plan from start to goal in %.2f s of computing and %d iterations; ",
                elapsed_s(), search_->iterations());
  std::string sentence = text;
  if (num_paths_ > 0) {
    sentence += std::to_string(num_paths_) + " path(s) of the base found and lost (";
    bool first = true;
    for (std::size_t i = 0; i < lost_.size(); ++i) {
      if (lost_[i] == 0) continue;
      sentence += (first ? "" : ", ") + std::string(describe(static_cast<PaperStage>(i))) + " " +
                  std::to_string(lost_[i]);
      first = false;
    }
    const Eigen::Vector2d origin = terrain_.map_origin_m();
    const FailedPath& last = lost_paths_.failed_paths().back();
    std::snprintf(text, sizeof text, "), the last at (%.2f, %.2f): ", last.where.x_m + origin.x(),
                  last.where.y_m + origin.y());
    sentence += text + last.why + "; ";
  }
  const std::uint64_t refused = num_poses_ - rejections_[0];
  std::snprintf(text, sizeof text,
                "%llu of %llu poses were refused: ", static_cast<unsigned long long>(refused),
                static_cast<unsigned long long>(num_poses_));
  sentence += text;
  bool first = true;
  for (const auto& [count, reason] : census().rejections()) {
    std::snprintf(text, sizeof text, "%s%s %.0f %%", first ? "" : ", ", reason.c_str(),
                  100.0 * static_cast<double>(count) / static_cast<double>(refused));
    sentence += text;
    first = false;
  }
  return sentence;
}

Result<Plan> make_paper_plan(const TerrainMap& terrain, const MachineModel& machine,
                             const Task& task, const PlanSettings& settings,
                             const std::function<void(const PlanProgress&)>& observer,
                             double begin_s, SearchCensus& turned_down) {
  const double offline_s = thread_cpu_time_s();
  const auto roadmaps = load_or_build_roadmaps(machine);
  if (!roadmaps) return tl::unexpected<Error>(roadmaps.error());
  begin_s += thread_cpu_time_s() - offline_s;
  const auto check = PaperCheck::build(terrain, machine, *roadmaps, settings);
  if (!check) return tl::unexpected<Error>(check.error());
  auto post_processing = PostProcessing::build(terrain, machine, *roadmaps, *check, settings);
  if (!post_processing) return tl::unexpected<Error>(post_processing.error());
  PaperSearch search(terrain, machine, task, settings, observer, *check, *post_processing, begin_s);
  Result<Plan> plan = search.run();
  turned_down = search.census();
  return plan;
}

}  // namespace wex
