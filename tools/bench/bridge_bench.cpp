#include "tools/bench/bridge_bench.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include "initializer/make_plan.hpp"
#include "models/terrain/synthetic.hpp"
#include "models/types/contact_schedule.hpp"
#include "tools/check/plan_checker.hpp"

namespace wex {
namespace {

// Durations of the paper's refined motions, of its own machine and map.
constexpr double kPaperStepping_s = 114.98, kPaperDriving_s = 156.33;

BridgeRow planned(const BridgeBenchOptions& options, const MachineModel& machine,
                  std::uint64_t seed, double stepping_penalty) {
  BridgeRow row;
  row.seed = seed;
  row.stepping_penalty = stepping_penalty;
  const auto synthetic = make_synthetic_terrain("bridge", 0.0, seed);
  if (!synthetic) return row.reason = synthetic.error().message, row;
  const Raster& raster = synthetic->raster;
  const auto terrain = TerrainMap::build(raster.elevation, {}, raster.map_origin_m);
  if (!terrain) return row.reason = terrain.error().message, row;
  Task task = synthetic->task;
  for (Pose2* pose : {&task.start, &task.goal}) {
    pose->x_m -= raster.map_origin_m.x();
    pose->y_m -= raster.map_origin_m.y();
  }
  PlanSettings settings;
  settings.seed = seed;
  settings.stepping_penalty = stepping_penalty;
  settings.time_budget_s = options.time_budget_s;
  auto plan = make_plan(*terrain, machine, task, settings);
  if (!plan) return row.reason = plan.error().message, row;
  const auto report = check::check_plan(machine, raster, *plan);
  if (!report) {
    row.reason = report.error().message;
  } else if (!report->accepted) {
    row.reason = "checker: " + report->verdict();
  }
  row.wheel_lifts = num_wheel_lifts(plan->nodes);
  row.bucket_supports = num_lifts(plan->nodes, Limb::kArm);
  row.plan = *std::move(plan);
  return row;
}

std::string line(const BridgeRow& row) {
  char text[200];
  if (!row.plan) {
    std::snprintf(text, sizeof text, "%4d  %7g  ", static_cast<int>(row.seed),
                  row.stepping_penalty);
    return text + row.reason + "\n";
  }
  std::snprintf(text, sizeof text, "%4d  %7g  %10.2f  %8.2f  %6d  %6d  %7.2f  %s\n",
                static_cast<int>(row.seed), row.stepping_penalty, row.plan->nodes.back().t_s,
                row.plan->path_length_m, row.wheel_lifts, row.bucket_supports,
                row.plan->min_stability_margin_m,
                row.reason.empty() ? "accepted" : row.reason.c_str());
  return text;
}

double median_duration_s(const std::vector<BridgeRow>& rows, bool with_penalty) {
  std::vector<double> durations;
  for (const BridgeRow& row : rows) {
    if (row.plan && (row.stepping_penalty > 0.0) == with_penalty) {
      durations.push_back(row.plan->nodes.back().t_s);
    }
  }
  if (durations.empty()) return 0.0;
  std::sort(durations.begin(), durations.end());
  return durations[durations.size() / 2];
}

}  // namespace

Result<BridgeBenchOutcome> bench_bridge(const BridgeBenchOptions& options, std::ostream& out) {
  auto machine = load_machine();
  if (!machine) return tl::unexpected<Error>(machine.error());
  BridgeBenchOutcome outcome;
  outcome.machine = *std::move(machine);
  outcome.holds = true;
  out << "seed  penalty  duration s  length m  wheels  bucket  margin m\n"
      << "                                     lifted   down\n";
  for (int seed = 1; seed <= options.seeds; ++seed) {
    std::array<BridgeRow, 2> pair;
    for (std::size_t k = 0; k < pair.size(); ++k) {
      pair[k] = planned(options, outcome.machine, static_cast<std::uint64_t>(seed),
                        k == 0 ? 0.0 : options.stepping_penalty);
      out << line(pair[k]) << std::flush;
      outcome.holds = outcome.holds && pair[k].plan && pair[k].reason.empty();
    }
    outcome.holds = outcome.holds && pair[0].wheel_lifts >= kNumWheels &&
                    pair[1].wheel_lifts < pair[0].wheel_lifts;
    outcome.rows.insert(outcome.rows.end(), pair.begin(), pair.end());
  }
  char text[240];
  std::snprintf(text, sizeof text,
                "median duration: %.2f s without the penalty (the paper's: %.2f s), "
                "%.2f s with it (the paper's: %.2f s)\n",
                median_duration_s(outcome.rows, false), kPaperStepping_s,
                median_duration_s(outcome.rows, true), kPaperDriving_s);
  out << text
      << (outcome.holds ? "without the penalty it steps over, with it it drives over the bridge\n"
                        : "not every pair of plans steps without and drives with the penalty\n");
  return outcome;
}

}  // namespace wex
