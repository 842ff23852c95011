#include "initializer/make_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "initializer/internal/direct_paths.hpp"
#include "initializer/internal/se2_search.hpp"
#include "initializer/pose_check.hpp"
#include "initializer/shorten_path.hpp"
#include "initializer/timing.hpp"
#include "initializer/verify_plan.hpp"
#include "initializer/whole_body.hpp"
#include "models/types/cpu_clock.hpp"

namespace wex {
namespace {

constexpr double kGoodEnough = 1.02;       // of the Reeds-Shepp length, which no path beats
constexpr double kWorthwhileShare = 0.99;  // of the tree's cost, to look at a path again
constexpr double kStagnationShare = 0.25;  // of the time budget without a better plan
constexpr double kProgressPeriodS = 0.1;   // between two calls of the observer
constexpr double kBlockRadiusM = 0.5;      // around a pose where a path failed
constexpr double kBlockYawRad = 0.1;       // 6 degrees
constexpr std::uint64_t kSeedStride = 0x9E3779B97F4A7C15ULL;  // independent streams per tree

std::string text_of(const Pose2& pose, const Eigen::Vector2d& map_origin_m) {
  char text[96];
  std::snprintf(text, sizeof text, "(x %.2f, y %.2f, yaw %.2f)", pose.x_m + map_origin_m.x(),
                pose.y_m + map_origin_m.y(), pose.yaw_rad);
  return text;
}

// What is wrong with the first unusable setting; empty if nothing is.
std::string settings_complaint(const PlanSettings& s) {
  const std::array<std::pair<const char*, double>, 8> positive{
      {{"time_budget_s", s.time_budget_s},
       {"range_m", s.range_m},
       {"subnode_spacing_m", s.subnode_spacing_m},
       {"yaw_weight_m_rad", s.yaw_weight_m_rad},
       {"max_tilt_rad", s.max_tilt_rad},
       {"nominal_speed_m_s", s.nominal_speed_m_s},
       {"rate_fraction", s.rate_fraction},
       {"iterations", s.iterations.value_or(1)}}};
  for (const auto& [name, value] : positive) {
    if (!(std::isfinite(value) && value > 0.0)) {
      return "plan setting " + std::string(name) + " must be finite and positive";
    }
  }
  const std::array<std::pair<const char*, double>, 3> finite{
      {{"min_stability_margin_m", s.min_stability_margin_m},
       {"min_signed_distance_m", s.min_signed_distance_m},
       {"belly_clearance_m", s.belly_clearance_m}}};
  for (const auto& [name, value] : finite) {
    if (!std::isfinite(value)) return "plan setting " + std::string(name) + " must be finite";
  }
  return {};
}

Result<StandingPose> standing_at(const PoseCheck& check, const TerrainMap& terrain,
                                 const Pose2& pose, const std::string& name) {
  const std::string intro =
      name + " " + text_of(pose, terrain.map_origin_m()) + " cannot be used: ";
  if (!std::isfinite(pose.x_m) || !std::isfinite(pose.y_m) || !std::isfinite(pose.yaw_rad)) {
    return fail(ErrorCode::kBadInput, intro + "its values must be finite numbers");
  }
  const Eigen::Vector2d here(pose.x_m, pose.y_m);
  if (!terrain.contains(here)) return fail(ErrorCode::kBadInput, intro + "it is off the map");
  if (!terrain.known(here)) {
    return fail(ErrorCode::kBadInput, intro + "it is on unknown ground");
  }
  StandingPose standing = check.stand(pose, PoseCheck::Steering{});
  if (!standing.ok()) {
    return fail(ErrorCode::kBadInput, intro + describe(standing, terrain.map_origin_m()));
  }
  return standing;
}

// One call of make_plan.
class Planning {
 public:
  Planning(const TerrainMap& terrain, const MachineModel& machine, const Task& task,
           const PlanSettings& settings, const std::function<void(const PlanProgress&)>& observer,
           const PoseCheck& check)
      : terrain_(terrain),
        machine_(machine),
        task_(task),
        settings_(settings),
        observer_(observer),
        check_(check) {
    search_settings_.turning_radius_m = machine.min_turning_radius_m;
    search_settings_.range_m = settings.range_m;
    search_settings_.subnode_spacing_m = settings.subnode_spacing_m;
    search_settings_.yaw_weight_m_rad = settings.yaw_weight_m_rad;
    search_settings_.x_min_m = terrain.min_corner_m().x();
    search_settings_.x_max_m = terrain.max_corner_m().x();
    search_settings_.y_min_m = terrain.min_corner_m().y();
    search_settings_.y_max_m = terrain.max_corner_m().y();
    const double curvature = 1.0 / machine.min_turning_radius_m;
    steering_ = {check.steering_for(-curvature, check.default_hfe_rad()),
                 check.steering_for(0.0, check.default_hfe_rad()),
                 check.steering_for(curvature, check.default_hfe_rad())};
  }

  Result<Plan> run() {
    const PoseValidity valid = [this](const Pose2& pose, double curvature_1_m) {
      return is_valid(pose, curvature_1_m);
    };
    lower_bound_m_ =
        path_length_m(reeds_shepp_path(task_.start, task_.goal, search_settings_.turning_radius_m));
    const std::vector<DrivePath> direct = direct_paths(
        task_.start, task_.goal, search_settings_.turning_radius_m, search_settings_.cost);
    for (const DrivePath& path : direct) {
      if (!path_is_valid(path, settings_.subnode_spacing_m, valid)) continue;
      consider(path);
      if (best_ && &path == &direct.front()) return finished();  // nothing is cheaper
    }
    while (!out_of_budget(0)) {
      Se2Search tree(task_.start, task_.goal, search_settings_, valid,
                     settings_.seed + kSeedStride * num_trees_++);
      const auto stop = [&] { return out_of_budget(tree.iterations()); };
      double wanted_m = std::numeric_limits<double>::infinity();
      bool tree_is_sound = true;
      while (tree_is_sound && !stop()) {
        auto path = tree.find_cheaper_than(wanted_m, stop);
        if (!path) return tl::unexpected<Error>(path.error());
        if (!*path) break;
        wanted_m = kWorthwhileShare * tree.best_cost_m();
        tree_is_sound = consider(shorten_path(**path, search_settings_, valid));
      }
      iterations_ += tree.iterations();
    }
    if (!best_) return fail(ErrorCode::kNoPlan, why_not());
    return finished();
  }

 private:
  struct Block {
    Pose2 pose;
    double radius_m;
  };

  [[nodiscard]] double elapsed_s() const { return thread_cpu_time_s() - begin_s_; }

  bool is_valid(const Pose2& pose, double curvature_1_m) {
    ++num_poses_;
    for (const Block& block : blocks_) {
      if (std::hypot(pose.x_m - block.pose.x_m, pose.y_m - block.pose.y_m) < block.radius_m &&
          std::abs(wrap_angle(pose.yaw_rad - block.pose.yaw_rad)) < kBlockYawRad) {
        ++num_blocked_;
        return false;
      }
    }
    const std::size_t side = curvature_1_m < 0.0 ? 0 : (curvature_1_m > 0.0 ? 2 : 1);
    const Rejection rejection = check_.stand(pose, steering_[side]).rejection;
    ++rejections_[static_cast<std::size_t>(rejection)];
    return rejection == Rejection::kNone;
  }

  bool out_of_budget(int tree_iterations) {
    if (observer_ && elapsed_s() - reported_s_ > kProgressPeriodS) report();
    if (best_ && best_->cost <= kGoodEnough * lower_bound_m_) return true;
    if (settings_.iterations) return iterations_ + tree_iterations >= *settings_.iterations;
    const double now_s = elapsed_s();
    return now_s >= settings_.time_budget_s ||
           (best_ && now_s - improved_s_ >= kStagnationShare * settings_.time_budget_s);
  }

  void report() {
    reported_s_ = elapsed_s();
    observer_({reported_s_, best_ ? std::optional<double>(best_->cost) : std::nullopt});
  }

  // Makes the path a plan and keeps it if it is the best so far. False if the machine cannot
  // follow it; the place is then blocked for later trees.
  bool consider(const DrivePath& path) {
    const double cost_m = path_cost_m(path, search_settings_.cost);
    if (best_ && cost_m >= best_->cost) return true;
    const std::vector<Station> stations = path_stations(path, settings_.subnode_spacing_m);
    auto nodes = whole_body_nodes(check_, machine_, path, stations);
    if (!nodes) {
      failed_path(describe(nodes.error().pose, terrain_.map_origin_m()),
                  stations[nodes.error().station].pose);
      return false;
    }
    assign_times(machine_, stations,
                 {.nominal_speed_m_s = settings_.nominal_speed_m_s,
                  .rate_fraction = settings_.rate_fraction},
                 *nodes);
    Plan plan;
    plan.task = task_;
    plan.seed = settings_.seed;
    plan.nodes = *std::move(nodes);
    plan.path_length_m = path_length_m(path);
    plan.cost = cost_m;
    const PlanVerdict verdict = verify_plan(terrain_, machine_, plan, settings_);
    if (!verdict.ok) {
      failed_path(verdict.violation, stations[verdict.node].pose);
      return false;
    }
    plan.min_stability_margin_m = verdict.min_stability_margin_m;
    plan.first_solution_time_s = best_ ? best_->first_solution_time_s : elapsed_s();
    best_ = std::move(plan);
    improved_s_ = elapsed_s();
    if (observer_) report();
    return true;
  }

  void failed_path(const std::string& why, const Pose2& where) {
    ++num_failed_paths_;
    last_failure_ = why;
    double radius_m = kBlockRadiusM;
    for (const Pose2& end : {task_.start, task_.goal}) {
      radius_m = std::min(radius_m, 0.9 * std::hypot(where.x_m - end.x_m, where.y_m - end.y_m));
    }
    blocks_.push_back({where, radius_m});
  }

  Plan finished() {
    best_->iterations = iterations_;
    best_->total_time_s = elapsed_s();
    return *std::move(best_);
  }

  [[nodiscard]] std::string why_not() const;

  const TerrainMap& terrain_;
  const MachineModel& machine_;
  const Task& task_;
  const PlanSettings& settings_;
  const std::function<void(const PlanProgress&)>& observer_;
  const PoseCheck& check_;
  SearchSettings search_settings_;
  std::array<PoseCheck::Steering, 3> steering_;  // right, straight, left

  double begin_s_ = thread_cpu_time_s();
  double reported_s_ = 0.0, improved_s_ = 0.0, lower_bound_m_ = 0.0;
  std::optional<Plan> best_;
  int iterations_ = 0;
  std::uint64_t num_trees_ = 0, num_poses_ = 0, num_blocked_ = 0;
  std::array<std::uint64_t, kNumRejections> rejections_{};
  std::vector<Block> blocks_;
  int num_failed_paths_ = 0;
  std::string last_failure_;
};

std::string Planning::why_not() const {
  std::vector<std::pair<std::uint64_t, std::string>> reasons;
  std::uint64_t num_rejected = num_blocked_;
  for (std::size_t i = 1; i < kNumRejections; ++i) {
    if (rejections_[i] == 0) continue;
    reasons.emplace_back(rejections_[i], describe(static_cast<Rejection>(i)));
    num_rejected += rejections_[i];
  }
  if (num_blocked_ > 0) reasons.emplace_back(num_blocked_, "near a place where a path failed");
  std::sort(reasons.rbegin(), reasons.rend());

  char effort[96];
  std::snprintf(effort, sizeof effort, "%.2f s of computing and %d iterations", elapsed_s(),
                iterations_);
  std::string text = "no plan from start to goal in " + std::string(effort) + "; " +
                     std::to_string(num_rejected) + " of " + std::to_string(num_poses_) +
                     " poses tried were rejected";
  for (std::size_t i = 0; i < reasons.size(); ++i) {
    text += (i == 0 ? ": " : ", ") + reasons[i].second + " " +
            std::to_string(100 * reasons[i].first / num_rejected) + " %";
  }
  if (num_failed_paths_ > 0) {
    text += "; " + std::to_string(num_failed_paths_) +
            " path(s) could not be followed with the whole body, the last because " + last_failure_;
  }
  return text;
}

}  // namespace

Result<Plan> make_plan(const TerrainMap& terrain, const MachineModel& machine, const Task& task,
                       const PlanSettings& settings,
                       const std::function<void(const PlanProgress&)>& observer) {
  if (std::string complaint = settings_complaint(settings); !complaint.empty()) {
    return fail(ErrorCode::kBadInput, std::move(complaint));
  }
  const auto check = PoseCheck::build(terrain, machine, settings);
  if (!check) return tl::unexpected<Error>(check.error());
  if (auto start = standing_at(*check, terrain, task.start, "the start"); !start) {
    return tl::unexpected<Error>(start.error());
  }
  if (auto goal = standing_at(*check, terrain, task.goal, "the goal"); !goal) {
    return tl::unexpected<Error>(goal.error());
  }
  return Planning(terrain, machine, task, settings, observer, *check).run();
}

Result<Eigen::VectorXd> standing_posture(const TerrainMap& terrain, const MachineModel& machine,
                                         const Pose2& pose, const PlanSettings& settings) {
  if (std::string complaint = settings_complaint(settings); !complaint.empty()) {
    return fail(ErrorCode::kBadInput, std::move(complaint));
  }
  const auto check = PoseCheck::build(terrain, machine, settings);
  if (!check) return tl::unexpected<Error>(check.error());
  const auto standing = standing_at(*check, terrain, pose, "the pose");
  if (!standing) return tl::unexpected<Error>(standing.error());
  return coordinates_of(machine, *standing);
}

}  // namespace wex
