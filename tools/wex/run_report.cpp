#include "tools/wex/run_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numeric>

#include "models/types/contact_schedule.hpp"

namespace wex::app {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has no infinities: what could not be measured becomes null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json pose_json(const Pose2& pose) { return Json::array({pose.x_m, pose.y_m, pose.yaw_rad}); }

Json residuals_json(const std::map<std::string, double>& residuals) {
  Json json = Json::object();
  for (const auto& [name, value] : residuals) json[name] = number(value);
  return json;
}

template <typename Values>
Json per_wheel(const Values& values) {
  Json json = Json::object();
  for (int i = 0; i < kNumWheels; ++i) json[std::string(kLimbNames[i])] = number(values[i]);
  return json;
}

double duration_s(const std::vector<WholeBodyNode>& nodes) {
  return nodes.empty() ? 0.0 : nodes.back().t_s - nodes.front().t_s;
}

Json plan_json(const Plan& plan) {
  Json lifts = Json::object();
  for (int i = 0; i < kNumWheels; ++i) {
    lifts[std::string(kLimbNames[i])] = num_lifts(plan.nodes, Limb{i});
  }
  return {{"iterations", plan.iterations},
          {"first_solution_cpu_s", number(plan.first_solution_time_s)},
          {"total_cpu_s", number(plan.total_time_s)},
          {"path_length_m", number(plan.path_length_m)},
          {"cost", number(plan.cost)},
          {"duration_s", number(duration_s(plan.nodes))},
          {"nodes", plan.nodes.size()},
          {"min_stability_margin_m", number(plan.min_stability_margin_m)},
          {"wheel_lifts", lifts},
          {"bucket_supports", num_lifts(plan.nodes, Limb::kArm)}};
}

Json search_json(const SearchCensus& search, const Eigen::Vector2d& map_origin_m) {
  Json rejections = Json::object();
  for (const auto& [count, reason] : search.rejections()) rejections[reason] = count;
  Json places = Json::array();
  for (const FailedPlace& place : search.failed_places()) {
    const Pose2& where = place.last.where;
    places.push_back({{"where", pose_json({where.x_m + map_origin_m.x(),
                                           where.y_m + map_origin_m.y(), where.yaw_rad})},
                      {"stepping", place.last.stepping},
                      {"count", place.count},
                      {"last_reason", place.last.why}});
  }
  return {{"poses", search.num_poses()},
          {"rejected_poses", rejections},
          {"failed_paths", search.failed_paths().size()},
          {"failed_places", places}};
}

Json refinement_json(const RefinedTrajectory& refined) {
  return {{"feasible", refined.report.feasible},
          {"status", refined.report.status},
          {"iterations", refined.report.iterations},
          {"cpu_s", number(refined.report.cpu_time_s)},
          {"objective", number(refined.report.objective)},
          {"duration_s", number(duration_s(refined.nodes))},
          {"dt_s", number(refined.dt_s)},
          {"nodes", refined.nodes.size()},
          {"min_stability_margin_m", number(refined.min_stability_margin_m)},
          {"worst_residual", residuals_json(refined.report.worst_residual)}};
}

struct SolveStatistics {
  std::vector<double> times_ms;
  int misses = 0, unusable = 0, infeasible = 0;
  double mean_iterations = 0.0, longest_delay_ms = 0.0;
};

SolveStatistics statistics(const std::vector<SolveSample>& solves) {
  constexpr double kMissMs = 100.0;
  SolveStatistics s;
  for (const SolveSample& solve : solves) {
    s.times_ms.push_back(1e3 * solve.cpu_time_s);
    s.misses += solve.late || s.times_ms.back() > kMissMs;
    s.unusable += !solve.usable;
    s.infeasible += !solve.feasible;
    s.mean_iterations += solve.iterations / static_cast<double>(solves.size());
    s.longest_delay_ms = std::max(s.longest_delay_ms, 1e3 * (solve.applied_s - solve.t_s));
  }
  return s;
}

Json mpc_json(const DriveRecord& drive) {
  const SolveStatistics s = statistics(drive.solves);
  return {{"solves", drive.solves.size()},
          {"unusable", s.unusable},
          {"infeasible", s.infeasible},
          {"misses", s.misses},
          {"mean_iterations", number(s.mean_iterations)},
          {"longest_delay_ms", number(s.longest_delay_ms)},
          {"solve_time_ms",
           {{"p50", percentile(s.times_ms, 50)},
            {"p90", percentile(s.times_ms, 90)},
            {"p99", percentile(s.times_ms, 99)},
            {"max", percentile(s.times_ms, 100)}}},
          {"worst_residual", residuals_json(drive.worst_residual)}};
}

/// Machine time per CPU second of the drive, simulation and optimizer together.
double real_time_factor(const RunReport& report) {
  const auto stage = report.stages.find("drive");
  if (!report.drive || stage == report.stages.end() || stage->second.cpu_s <= 0.0) return 0.0;
  return report.drive->simulated_s / stage->second.cpu_s;
}

Json drive_json(const RunReport& report) {
  const DriveRecord& drive = *report.drive;
  const DriveExtremes& x = drive.extremes;
  return {{"duration_s", number(drive.duration_s)},
          {"min_stability_margin_m", number(x.min_scheduled_margin_m)},
          {"min_loaded_stability_margin_m", number(x.min_loaded_margin_m)},
          {"max_roll_rad", number(x.max_roll_rad)},
          {"max_pitch_rad", number(x.max_pitch_rad)},
          {"side_slip_ratio", number(side_slip_ratio(x))},
          {"wheel_side_slip_m", per_wheel(x.side_slip_m)},
          {"wheel_travel_m", per_wheel(x.travel_m)},
          {"wheel_lift_off_s", per_wheel(x.airborne_s)},
          {"max_wheel_penetration_m", number(x.max_wheel_penetration_m)},
          {"max_tyre_deflection_m", number(x.max_tyre_deflection_m)},
          {"hold_vertical_rate_m_s", number(x.hold_vertical_rate_m_s)},
          {"max_reference_error_m", number(x.max_reference_error_m)},
          {"real_time_factor", number(real_time_factor(report))},
          {"simulation_cpu_s", number(report.simulation_cpu_s)},
          {"commands_accepted", drive.health.commands_accepted},
          {"commands_rejected", drive.health.commands_rejected},
          {"command_expiries", drive.health.expiries},
          {"wheel_stall_stops", drive.health.stall_stops}};
}

std::string reason(const RunReport& report) {
  if (report.failure) return report.failure->message;
  return report.options.depth == Depth::kDrive ? "goal reached" : "plan made";
}

}  // namespace

double percentile(std::vector<double> values, double p) {
  WEX_EXPECTS(p >= 0.0 && p <= 100.0);
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const double position = p / 100.0 * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (position - static_cast<double>(below)) * (values[above] - values[below]);
}

double side_slip_ratio(const DriveExtremes& extremes) {
  const auto sum = [](const auto& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
  };
  const double travel_m = sum(extremes.travel_m);
  return travel_m <= 0.0 ? 0.0 : sum(extremes.side_slip_m) / travel_m;
}

std::string result_json(const RunReport& report) {
  const RunOptions& options = report.options;
  Json json;
  json["schema"] = "wex-result-1";
  json["program"] = "wex " WEX_VERSION;
  json["command"] = options.depth == Depth::kDrive ? "run" : "plan";
  json["success"] = !report.failure.has_value();
  json["exit_code"] = exit_code(report);
  json["reason"] = reason(report);
  json["map"] = options.map.string();
  json["machine"] = options.machine;
  json["seed"] = options.seed;
  json["iterations"] = options.iterations ? Json(*options.iterations) : Json(nullptr);
  json["time_budget_s"] = options.time_budget_s;
  json["solve_delay_ms"] =
      options.solve_delay_s ? Json(1e3 * *options.solve_delay_s) : Json("measured");
  json["start"] = pose_json(report.task_map.start);
  json["goal"] = pose_json(report.task_map.goal);
  if (report.drive) {
    json["goal_error_m"] = number(report.drive->goal_error_m);
    json["goal_error_rad"] = number(report.drive->goal_error_rad);
  }
  for (const auto& [stage, time] : report.stages) {
    json["stages"][stage] = {{"cpu_s", number(time.cpu_s)}, {"wall_s", number(time.wall_s)}};
  }
  if (report.plan) json["plan"] = plan_json(*report.plan);
  if (report.search) json["search"] = search_json(*report.search, report.map_origin_m);
  if (report.refined) json["refinement"] = refinement_json(*report.refined);
  if (report.drive) {
    json["mpc"] = mpc_json(*report.drive);
    json["drive"] = drive_json(report);
  }
  if (report.bus) json["bus"] = bus_json(*report.bus);
  json["warnings"] = report.warnings;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string summary_table(const RunReport& report) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  std::string table;
  const auto row = [&table](const char* name, const char* pattern, auto... values) {
    char value[512];
    std::snprintf(value, sizeof(value), pattern, values...);
    char line[600];
    std::snprintf(line, sizeof(line), "  %-18s %s\n", name, value);
    table += line;
  };
  table += report.failure ? "FAILED: " : "SUCCESS: ";
  table += reason(report) + "\n";
  if (report.plan) {
    row("plan", "%.2f m in %.1f s, margin %.2f m, %d iterations, first after %.2f s",
        report.plan->path_length_m, duration_s(report.plan->nodes),
        report.plan->min_stability_margin_m, report.plan->iterations,
        report.plan->first_solution_time_s);
    if (const int lifts = num_wheel_lifts(report.plan->nodes); lifts > 0) {
      row("steps", "%d wheels lifted, bucket down %d times, cost %.1f m of driving", lifts,
          num_lifts(report.plan->nodes, Limb::kArm), report.plan->cost);
    }
  }
  if (report.refined) {
    row("refinement", "%s, %d iterations, %.1f s CPU, margin %.2f m",
        report.refined->report.status.c_str(), report.refined->report.iterations,
        report.refined->report.cpu_time_s, report.refined->min_stability_margin_m);
  }
  if (report.drive) {
    const DriveRecord& drive = *report.drive;
    const DriveExtremes& x = drive.extremes;
    const SolveStatistics s = statistics(drive.solves);
    row("goal error", "%.3f m, %.2f degrees", drive.goal_error_m, drive.goal_error_rad * kDegrees);
    row("drive", "%.1f s of machine time, %.1f x real time", drive.duration_s,
        real_time_factor(report));
    row("optimizer", "%zu solves, p50 %.0f ms, p99 %.0f ms, %d misses, %d unusable",
        drive.solves.size(), percentile(s.times_ms, 50), percentile(s.times_ms, 99), s.misses,
        s.unusable);
    row("stability margin", "%.2f m at least", x.min_scheduled_margin_m);
    row("tilt", "roll %.1f, pitch %.1f degrees at most", x.max_roll_rad * kDegrees,
        x.max_pitch_rad * kDegrees);
    const double slip = side_slip_ratio(x);
    if (std::isfinite(slip)) row("side slip", "%.2f %%", 100.0 * slip);
  }
  if (report.bus) {
    const can::BusStatistics& bus = report.bus->statistics;
    row("bus", "%s, %s, load %.0f %%, %ld frames lost, %ld CRC errors, %ld holds, %ld faults",
        report.bus->interface_name.c_str(), report.bus->lock_step ? "lock step" : "real time",
        100.0 * bus.bus_load, bus.frames_lost(), bus.crc_errors, bus.holds, bus.faults);
  }
  row("results", "%s", report.options.out.string().c_str());
  for (const std::string& warning : report.warnings) table += "  warning: " + warning + "\n";
  return table;
}

}  // namespace wex::app
