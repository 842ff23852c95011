#include "initializer/replan/replan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "initializer/found_plan.hpp"
#include "initializer/replan/ground_recheck.hpp"
#include "initializer/replan/plan_splice.hpp"
#include "initializer/verify_plan.hpp"
#include "models/types/cpu_clock.hpp"

namespace wex {
namespace {

/// How far a stretch reaches beyond what does not hold, and how hard it is tried.
struct Attempt {
  double margin_m = 0.0;
  bool along_own_path = false;  ///< and nowhere else
};
// Close by along the same path; then with room for a way around.
constexpr std::array<Attempt, 2> kAttempts{{{0.6, true}, {9.0, false}}};
constexpr double kWorthwhileShare = 0.5;  // of the plan: longer ways around are no shorter search
constexpr double kAttemptShare = 0.5;     // of the time the plan before took to be found
constexpr std::size_t kMaxPaths = 6;      // remembered

Pose2 pose_of(const WholeBodyNode& node) {
  return {node.q[kBaseX], node.q[kBaseY], node.q[kBaseYaw]};
}

class Replanner {
 public:
  Replanner(const PlanMemory& before, const TerrainMap& terrain, const MachineModel& machine,
            const PlanSettings& settings)
      : before_(before),
        terrain_(terrain),
        machine_(machine),
        settings_(settings),
        begin_s_(thread_cpu_time_s()) {}

  Result<Replanned> run(const std::optional<GroundRect>& changed) {
    const auto change = GroundChange::between(before_.terrain, terrain_, changed);
    if (!change) return tl::unexpected<Error>(change.error());
    const std::vector<std::size_t> touched = touched_nodes(before_.reach, *change);
    num_touched_ = touched.size();
    if (touched.empty()) return kept(ReplanOutcome::kUntouched);
    unsound_ = unsound_on_changed_ground({before_.plan, machine_, *before_.shape, before_.terrain,
                                          terrain_, &before_.reach, &*change},
                                         touched, settings_);
    if (unsound_.empty()) return kept(ReplanOutcome::kStillGood);

    check_.emplace(terrain_, machine_, settings_, before_.legs);
    distances_m_ = distances_along(before_.paths.back(), before_.plan.nodes);
    for (const Attempt& attempt : kAttempts) {
      const auto ends = stretch_around(attempt.margin_m);
      if (!ends) break;
      const double share =
          (distances_m_[ends->second] - distances_m_[ends->first]) / distances_m_.back();
      if (!attempt.along_own_path && share > kWorthwhileShare) break;
      if (auto replanned = with_new_stretch(ends->first, ends->second, attempt)) {
        return *std::move(replanned);
      }
    }
    return with_new_plan();
  }

 private:
  [[nodiscard]] Replanned result(ReplanOutcome outcome, PlanMemory memory) const {
    Replanned replanned{std::move(memory), outcome, num_touched_, unsound_.size(), 0, 0.0};
    replanned.time_s = thread_cpu_time_s() - begin_s_;
    return replanned;
  }

  [[nodiscard]] Replanned kept(ReplanOutcome outcome) const {
    PlanMemory memory = before_;
    memory.terrain = terrain_;
    return result(outcome, std::move(memory));
  }

  /// The nodes between which to plan anew: on four wheels, at least a distance from what does not
  /// hold. Nothing if that is no less than the whole plan.
  [[nodiscard]] std::optional<std::pair<std::size_t, std::size_t>> stretch_around(
      double margin_m) const {
    const auto good = [&](std::size_t i) {
      return may_be_cut(machine_, before_.plan.nodes[i]) && on_path(i) &&
             check_->stand(pose_of(before_.plan.nodes[i]), PoseCheck::Steering{}).ok();
    };
    std::size_t first = unsound_.front(), last = unsound_.back();
    const double from_m = distances_m_[first] - margin_m, to_m = distances_m_[last] + margin_m;
    while (first > 0 && (distances_m_[first] > from_m || !good(first))) --first;
    while (last + 1 < distances_m_.size() && (distances_m_[last] < to_m || !good(last))) ++last;
    if (first == 0 && last + 1 == distances_m_.size()) return std::nullopt;
    return std::pair(first, last);
  }

  [[nodiscard]] bool on_path(std::size_t i) const {
    constexpr double kSamePlaceM = 1e-5;
    const DrivePath rest = part_of(before_.paths.back(), 0.0, distances_m_[i]);
    if (rest.empty()) return i == 0;
    const Pose2 pose = pose_along(rest.back(), rest.back().length_m);
    const Pose2 node = pose_of(before_.plan.nodes[i]);
    return std::hypot(pose.x_m - node.x_m, pose.y_m - node.y_m) < kSamePlaceM &&
           std::abs(wrap_angle(pose.yaw_rad - node.yaw_rad)) < kSamePlaceM;
  }

  [[nodiscard]] std::optional<Replanned> with_new_stretch(std::size_t first, std::size_t last,
                                                          const Attempt& attempt) {
    const Plan& plan = before_.plan;
    const DrivePath& path = before_.paths.back();
    const Task between{pose_of(plan.nodes[first]), pose_of(plan.nodes[last])};
    DrivePath own = part_of(path, distances_m_[first], distances_m_[last]);
    SearchAids aids;
    aids.tables = before_.tables;
    aids.paths = {own};
    aids.begin = plan.nodes[first].q.head<kNumBaseCoordinates>();
    aids.first_will_do = true;
    aids.other_paths = !attempt.along_own_path;
    PlanSettings settings = settings_;
    settings.time_budget_s =
        std::min(settings.time_budget_s, kAttemptShare * plan.first_solution_time_s);
    auto stretch = find_plan(terrain_, machine_, between, settings, *check_, std::move(aids), {},
                             thread_cpu_time_s());
    if (!stretch) {
      own_path_failed_ = own_path_failed_ || attempt.along_own_path;
      return std::nullopt;
    }
    auto spliced = splice(machine_, *check_, plan, first, last, stretch->plan, settings_);
    if (!spliced) return std::nullopt;
    const PlanVerdict verdict = verify_plan(terrain_, machine_, *spliced, settings_);
    if (!verdict.ok) return std::nullopt;

    DrivePath whole = part_of(path, 0.0, distances_m_[first]);
    append_path(whole, stretch->paths.back());
    append_path(whole, part_of(path, distances_m_[last], std::numeric_limits<double>::infinity()));
    spliced->min_stability_margin_m = verdict.min_stability_margin_m;
    spliced->cost += stretch_cost(stretch->paths.back(), stretch->plan.nodes, 0,
                                  stretch->plan.nodes.size() - 1, settings_) -
                     stretch_cost(own, plan.nodes, first, last, settings_);
    spliced->path_length_m = path_length_m(whole);
    spliced->iterations = stretch->plan.iterations;
    num_replaced_ = last - first - 1;
    std::vector<DrivePath> paths = before_.paths;
    paths.push_back(std::move(whole));
    return planned(ReplanOutcome::kNewStretch, *std::move(spliced), std::move(paths));
  }

  [[nodiscard]] Result<Replanned> with_new_plan() {
    SearchAids aids;
    aids.tables = before_.tables;
    aids.paths.assign(before_.paths.rbegin(), before_.paths.rend());
    if (own_path_failed_) {
      aids.hopeless = aids.paths.front();
      aids.paths.erase(aids.paths.begin());
    }
    aids.first_will_do = true;
    auto found = find_plan(terrain_, machine_, before_.plan.task, settings_, *check_,
                           std::move(aids), {}, begin_s_);
    if (!found) return tl::unexpected<Error>(found.error());
    num_replaced_ = before_.plan.nodes.size();
    std::vector<DrivePath> paths = before_.paths;
    paths.push_back(found->paths.back());
    return planned(ReplanOutcome::kNewPlan, std::move(found->plan), std::move(paths));
  }

  [[nodiscard]] Replanned planned(ReplanOutcome outcome, Plan plan,
                                  std::vector<DrivePath> paths) const {
    PlanMemory memory = before_;
    memory.terrain = terrain_;
    memory.plan = std::move(plan);
    if (paths.size() > kMaxPaths) {
      paths.erase(paths.begin(), paths.end() - static_cast<std::ptrdiff_t>(kMaxPaths));
    }
    memory.paths = std::move(paths);
    memory.reach = reach_of(machine_, *memory.shape, memory.plan.nodes);
    Replanned replanned = result(outcome, std::move(memory));
    replanned.num_replaced = num_replaced_;
    replanned.memory.plan.total_time_s = replanned.time_s;
    replanned.memory.plan.first_solution_time_s = replanned.time_s;
    return replanned;
  }

  const PlanMemory& before_;
  const TerrainMap& terrain_;
  const MachineModel& machine_;
  const PlanSettings& settings_;
  double begin_s_;
  std::optional<PoseCheck> check_;
  std::vector<double> distances_m_;   // of nodes, along the path
  std::vector<std::size_t> unsound_;  // nodes
  bool own_path_failed_ = false;
  std::size_t num_touched_ = 0, num_replaced_ = 0;
};

}  // namespace

const char* name_of(ReplanOutcome outcome) {
  switch (outcome) {
    case ReplanOutcome::kUntouched:
      return "untouched";
    case ReplanOutcome::kStillGood:
      return "still good";
    case ReplanOutcome::kNewStretch:
      return "new stretch";
    case ReplanOutcome::kNewPlan:
      break;
  }
  return "new plan";
}

Result<Replanned> replan(const PlanMemory& before, const TerrainMap& terrain,
                         const MachineModel& machine, const PlanSettings& settings,
                         const std::optional<GroundRect>& changed) {
  return Replanner(before, terrain, machine, settings).run(changed);
}

}  // namespace wex
