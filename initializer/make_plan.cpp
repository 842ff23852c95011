#include "initializer/make_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "initializer/explained_plan.hpp"
#include "initializer/found_plan.hpp"
#include "initializer/paper/paper_search.hpp"
#include "initializer/plan_search.hpp"
#include "initializer/pose_check.hpp"
#include "initializer/whole_body.hpp"
#include "models/types/cpu_clock.hpp"

namespace wex {
namespace {

std::string text_of(const Pose2& pose, const Eigen::Vector2d& map_origin_m) {
  char text[96];
  std::snprintf(text, sizeof text, "(x %.2f, y %.2f, yaw %.2f)", pose.x_m + map_origin_m.x(),
                pose.y_m + map_origin_m.y(), pose.yaw_rad);
  return text;
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

}  // namespace

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

Result<Plan> make_plan(const TerrainMap& terrain, const MachineModel& machine, const Task& task,
                       const PlanSettings& settings,
                       const std::function<void(const PlanProgress&)>& observer) {
  SearchCensus ignored;
  return make_plan(terrain, machine, task, settings, observer, ignored);
}

Result<Plan> make_plan(const TerrainMap& terrain, const MachineModel& machine, const Task& task,
                       const PlanSettings& settings,
                       const std::function<void(const PlanProgress&)>& observer,
                       SearchCensus& turned_down) {
  const double begin_s = thread_cpu_time_s();
  if (std::string complaint = settings_complaint(settings); !complaint.empty()) {
    return fail(ErrorCode::kBadInput, std::move(complaint));
  }
  const auto check = PoseCheck::build(terrain, machine, settings);
  if (!check) return tl::unexpected<Error>(check.error());
  const auto start = standing_at(*check, terrain, task.start, "the start");
  if (!start) return tl::unexpected<Error>(start.error());
  if (auto goal = standing_at(*check, terrain, task.goal, "the goal"); !goal) {
    return tl::unexpected<Error>(goal.error());
  }
  if (settings.mode == PlanMode::kPaper) {
    return make_paper_plan(terrain, machine, task, settings, observer, begin_s, turned_down);
  }
  PlanSearch search(terrain, machine, task, settings, observer, *check, start->base, begin_s, {});
  Result<Plan> plan = search.run();
  turned_down = search.census();
  return plan;
}

Result<FoundPlan> find_plan(const TerrainMap& terrain, const MachineModel& machine,
                            const Task& task, const PlanSettings& settings, const PoseCheck& check,
                            SearchAids aids,
                            const std::function<void(const PlanProgress&)>& observer,
                            double begin_s) {
  const auto start = standing_at(check, terrain, task.start, "the start");
  if (!start) return tl::unexpected<Error>(start.error());
  if (auto goal = standing_at(check, terrain, task.goal, "the goal"); !goal) {
    return tl::unexpected<Error>(goal.error());
  }
  const BaseCoordinates begin = aids.begin.value_or(start->base);
  PlanSearch search(terrain, machine, task, settings, observer, check, begin, begin_s,
                    std::move(aids));
  auto plan = search.run();
  if (!plan) return tl::unexpected<Error>(plan.error());
  return FoundPlan{*std::move(plan), search.paths(), search.tables()};
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
