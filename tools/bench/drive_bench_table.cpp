#include "tools/bench/drive_bench_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

namespace wex {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  char text[640];
  std::snprintf(text, sizeof(text), pattern, values...);
  return text;
}

/// A number of a result file; null (not measurable) reads as zero.
double number(const nlohmann::json& json, const char* pointer) {
  const nlohmann::json value = json.value(nlohmann::json::json_pointer(pointer), nlohmann::json());
  return value.is_number() ? value.get<double>() : 0.0;
}

std::string row(const std::string& name, const std::vector<const DriveBenchResult*>& runs) {
  int successes = 0, misses = 0, solves = 0, unusable = 0;
  DriveBenchResult worst;
  worst.margin_m = worst.real_time_factor = std::numeric_limits<double>::infinity();
  std::vector<double> p50;
  const auto raise = [](double& value, double candidate) { value = std::max(value, candidate); };
  for (const DriveBenchResult* r : runs) {
    successes += r->success;
    if (!r->driven) continue;
    misses += r->misses;
    solves += r->solves;
    unusable += r->unusable;
    p50.push_back(r->solve_p50_ms);
    raise(worst.goal_error_m, r->goal_error_m);
    raise(worst.goal_error_rad, r->goal_error_rad);
    raise(worst.side_slip_ratio, r->side_slip_ratio);
    raise(worst.roll_rad, r->roll_rad);
    raise(worst.pitch_rad, r->pitch_rad);
    raise(worst.penetration_m, r->penetration_m);
    raise(worst.hold_rate_m_s, r->hold_rate_m_s);
    raise(worst.lift_off_s, r->lift_off_s);
    raise(worst.solve_p99_ms, r->solve_p99_ms);
    raise(worst.solve_max_ms, r->solve_max_ms);
    worst.margin_m = std::min(worst.margin_m, r->margin_m);
    worst.real_time_factor = std::min(worst.real_time_factor, r->real_time_factor);
  }
  const std::string count = format("%-14s %3d/%-2zu", name.c_str(), successes, runs.size());
  if (p50.empty()) return count + "  (none came to a drive)\n";
  std::sort(p50.begin(), p50.end());
  return count + format(
                     "  %5.3f %5.2f  %5.2f  %5.2f  %4.1f %5.1f  %5.1f  %5.2f  %5.1f  %4.0f %4.0f "
                     "%5.0f  %4d/%-6d %4d  %5.2f\n",
                     worst.goal_error_m, worst.goal_error_rad * kDegrees,
                     100.0 * worst.side_slip_ratio, worst.margin_m, worst.roll_rad * kDegrees,
                     worst.pitch_rad * kDegrees, 1e3 * worst.penetration_m,
                     100.0 * worst.hold_rate_m_s, worst.lift_off_s, p50[p50.size() / 2],
                     worst.solve_p99_ms, worst.solve_max_ms, misses, solves, unusable,
                     worst.real_time_factor);
}

DriveBenchBus bus_figures(const nlohmann::json& json) {
  const auto count = [&](const char* key) { return json.at(key).get<long>(); };
  DriveBenchBus bus;
  bus.frames_sent = count("frames_sent");
  bus.frames_received = count("frames_received");
  bus.frames_lost = count("frames_lost");
  for (const char* key :
       {"repeated", "wrong_sequence", "crc_errors", "malformed", "unknown_ids", "own_ids"}) {
    bus.not_used += count(key);
  }
  bus.overflows = count("receive_overflows");
  bus.stalls = count("stalls");
  bus.false_holds = count("false_holds");
  bus.faults = count("faults");
  bus.load = number(json, "/load_machine_time");
  bus.max_feedback_age_s = number(json, "/max_feedback_age_s");
  const nlohmann::json& latency = json.at("command_to_report_ms");
  bus.latency_edges_ms = latency.at("upper_edges").get<std::vector<double>>();
  bus.latency_counts = latency.at("counts").get<std::vector<long>>();
  bus.latency_max_ms = number(latency, "/max");
  return bus;
}

/// Upper edge of the bin that a share of all durations stays below.
double percentile_ms(const DriveBenchBus& pooled, double share) {
  long all = 0, below = 0;
  for (const long count : pooled.latency_counts) all += count;
  for (std::size_t bin = 0; bin < pooled.latency_edges_ms.size(); ++bin) {
    below += pooled.latency_counts[bin];
    if (static_cast<double>(below) >= share * static_cast<double>(all)) {
      return std::min(pooled.latency_edges_ms[bin], pooled.latency_max_ms);
    }
  }
  return pooled.latency_max_ms;
}

/// Sums of counts, worst of loads and ages.
void pool(const DriveBenchBus& run, DriveBenchBus& pooled) {
  pooled.frames_sent += run.frames_sent;
  pooled.frames_received += run.frames_received;
  pooled.frames_lost += run.frames_lost;
  pooled.not_used += run.not_used;
  pooled.overflows += run.overflows;
  pooled.stalls += run.stalls;
  pooled.false_holds += run.false_holds;
  pooled.faults += run.faults;
  pooled.load = std::max(pooled.load, run.load);
  pooled.max_feedback_age_s = std::max(pooled.max_feedback_age_s, run.max_feedback_age_s);
  pooled.latency_edges_ms = run.latency_edges_ms;
  pooled.latency_counts.resize(std::max(pooled.latency_counts.size(), run.latency_counts.size()));
  for (std::size_t bin = 0; bin < run.latency_counts.size(); ++bin) {
    pooled.latency_counts[bin] += run.latency_counts[bin];
  }
  pooled.latency_max_ms = std::max(pooled.latency_max_ms, run.latency_max_ms);
  pooled.machine_holds += run.machine_holds;
  pooled.commands_rejected += run.commands_rejected;
}

std::string bus_row(const std::string& name, const std::vector<const DriveBenchResult*>& runs) {
  DriveBenchBus pooled;
  int count = 0;
  for (const DriveBenchResult* run : runs) {
    if (!run->bus) continue;
    ++count;
    pool(*run->bus, pooled);
  }
  if (count == 0) return "";
  return format(
      "%-14s %4d %9ld %9ld %5ld %8ld %5ld %6ld %5ld %6ld %7d %8ld %5.1f %4.0f %5.1f %5.1f "
      "%6.1f\n",
      name.c_str(), count, pooled.frames_sent, pooled.frames_received, pooled.frames_lost,
      pooled.not_used, pooled.overflows, pooled.stalls, pooled.false_holds, pooled.faults,
      pooled.machine_holds, pooled.commands_rejected, 100.0 * pooled.load,
      1e3 * pooled.max_feedback_age_s, percentile_ms(pooled, 0.5), percentile_ms(pooled, 0.99),
      pooled.latency_max_ms);
}

constexpr const char* kBusHeader =
    "the bus, as the host saw it: sums over the runs, worst load (of machine time) and age;\n"
    "machine: times it held (one each is the arrival), commands it refused\n"
    "case           runs frames    frames                                           machine  "
    "machine  load  age  command to report ms\n"
    "                    sent      received   lost   unused  over stalls holds faults   holds  "
    "refused     %   ms   p50   p99    max\n";

}  // namespace

DriveBenchResult read_drive_bench_result(const std::filesystem::path& folder, int exit_code) {
  DriveBenchResult result;
  result.exit_code = exit_code;
  std::ifstream stream(folder / "result.json");
  const nlohmann::json json = nlohmann::json::parse(stream, nullptr, false);
  if (!json.is_object()) {
    result.reason = "no result.json, see " + (folder / "log.txt").string();
    return result;
  }
  try {
    result.success = json.value("success", false);
    result.exit_code = json.value("exit_code", exit_code);
    result.reason = json.value("reason", "");
    result.driven = json.contains("drive");
    result.goal_error_m = number(json, "/goal_error_m");
    result.goal_error_rad = number(json, "/goal_error_rad");
    result.path_m = number(json, "/plan/path_length_m");
    result.planned_s = number(json, "/refinement/duration_s");
    result.driven_s = number(json, "/drive/duration_s");
    result.side_slip_ratio = number(json, "/drive/side_slip_ratio");
    result.margin_m = number(json, "/drive/min_stability_margin_m");
    result.roll_rad = number(json, "/drive/max_roll_rad");
    result.pitch_rad = number(json, "/drive/max_pitch_rad");
    result.penetration_m = number(json, "/drive/max_wheel_penetration_m");
    result.hold_rate_m_s = number(json, "/drive/hold_vertical_rate_m_s");
    for (const char* wheel : {"LF", "RF", "LH", "RH"}) {
      result.lift_off_s += number(json, (std::string("/drive/wheel_lift_off_s/") + wheel).c_str());
    }
    result.solve_p50_ms = number(json, "/mpc/solve_time_ms/p50");
    result.solve_p99_ms = number(json, "/mpc/solve_time_ms/p99");
    result.solve_max_ms = number(json, "/mpc/solve_time_ms/max");
    result.solves = static_cast<int>(number(json, "/mpc/solves"));
    result.misses = static_cast<int>(number(json, "/mpc/misses"));
    result.unusable = static_cast<int>(number(json, "/mpc/unusable"));
    result.real_time_factor = number(json, "/drive/real_time_factor");
    if (json.contains("bus")) result.bus = bus_figures(json.at("bus"));
  } catch (const nlohmann::json::exception& exception) {
    result.success = false;
    result.reason = "unreadable result.json: " + std::string(exception.what());
  }
  return result;
}

std::pair<double, double> wilson_interval(int successes, int runs) {
  WEX_EXPECTS(runs > 0 && successes >= 0 && successes <= runs);
  constexpr double z = 1.959963985;  // 97.5 % quantile of the normal distribution
  const double n = runs, p = successes / n;
  const double centre = (p + z * z / (2.0 * n)) / (1.0 + z * z / n);
  const double half = z / (1.0 + z * z / n) * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n));
  return {std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

std::string drive_bench_table(const std::vector<DriveBenchRun>& runs,
                              const std::vector<DriveBenchResult>& results) {
  WEX_EXPECTS(runs.size() == results.size() && !runs.empty());
  std::string table =
      "worst over the runs of a case; solve times: median of the runs' p50, worst p99, worst\n"
      "case              ok/n    goal   yaw   slip margin  roll pitch  sink   hold   lift    solve "
      "ms"
      "           misses/  un-   real\n"
      "                            m   deg      %      m   deg   deg    mm   cm/s      s   p50  p99"
      "   max  solves     usable time\n";
  std::vector<std::string> names;
  for (const DriveBenchRun& run : runs) {
    if (names.empty() || names.back() != run.name) names.push_back(run.name);
  }
  std::string bus_table;
  for (const std::string& name : names) {
    std::vector<const DriveBenchResult*> members;
    for (std::size_t k = 0; k < runs.size(); ++k) {
      if (runs[k].name == name) members.push_back(&results[k]);
    }
    table += row(name, members);
    bus_table += bus_row(name, members);
  }
  const auto successes = static_cast<int>(
      std::count_if(results.begin(), results.end(), [](const auto& r) { return r.success; }));
  const auto [lo, hi] = wilson_interval(successes, static_cast<int>(results.size()));
  table += format("pooled: %d of %zu = %.1f %% (Wilson 95 %%: %.1f to %.1f %%)\n", successes,
                  results.size(), 100.0 * successes / static_cast<double>(results.size()),
                  100.0 * lo, 100.0 * hi);
  if (!bus_table.empty()) table += kBusHeader + bus_table;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    if (results[k].success) continue;
    table += format("failed: %s seed %d, exit code %d: ", runs[k].name.c_str(), runs[k].seed,
                    results[k].exit_code) +
             results[k].reason + "\n";
  }
  for (const DriveBenchRun& run : runs) {
    if (run.rejected_draws == 0) continue;
    table += format("drawn again: %s seed %d, %d pairs where the machine cannot stand\n",
                    run.name.c_str(), run.seed, run.rejected_draws);
  }
  return table;
}

std::string drive_bench_csv(const std::vector<DriveBenchRun>& runs,
                            const std::vector<DriveBenchResult>& results) {
  WEX_EXPECTS(runs.size() == results.size());
  std::string csv =
      "case,seed,start_x,start_y,start_yaw,goal_x,goal_y,goal_yaw,rejected_draws,success,exit_code,"
      "goal_error_m,goal_error_rad,path_m,planned_s,driven_s,side_slip_ratio,margin_m,roll_rad,"
      "pitch_rad,penetration_m,hold_rate_m_s,lift_off_s,solve_p50_ms,solve_p99_ms,solve_max_ms,"
      "solves,misses,unusable,real_time_factor,frames_sent,frames_received,frames_lost,not_used,"
      "overflows,stalls,false_holds,faults,machine_holds,commands_refused,load,"
      "max_feedback_age_s,latency_p50_ms,latency_p99_ms,latency_max_ms,reason\n";
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const DriveBenchRun& run = runs[k];
    const DriveBenchResult& r = results[k];
    csv += format("%s,%d,%.3f,%.3f,%.4f,%.3f,%.3f,%.4f,%d,%d,%d,", run.name.c_str(), run.seed,
                  run.task_map.start.x_m, run.task_map.start.y_m, run.task_map.start.yaw_rad,
                  run.task_map.goal.x_m, run.task_map.goal.y_m, run.task_map.goal.yaw_rad,
                  run.rejected_draws, r.success, r.exit_code);
    csv += format(
        "%.4f,%.5f,%.2f,%.2f,%.2f,%.5f,%.4f,%.5f,%.5f,%.5f,%.5f,%.2f,%.1f,%.1f,%.1f,%d,%d,"
        "%d,%.3f,",
        r.goal_error_m, r.goal_error_rad, r.path_m, r.planned_s, r.driven_s, r.side_slip_ratio,
        r.margin_m, r.roll_rad, r.pitch_rad, r.penetration_m, r.hold_rate_m_s, r.lift_off_s,
        r.solve_p50_ms, r.solve_p99_ms, r.solve_max_ms, r.solves, r.misses, r.unusable,
        r.real_time_factor);
    const DriveBenchBus bus = r.bus.value_or(DriveBenchBus{});  // without a bus: zeros
    csv += format("%ld,%ld,%ld,%ld,%ld,%ld,%ld,%ld,%d,%ld,%.4f,%.4f,%.2f,%.2f,%.2f,",
                  bus.frames_sent, bus.frames_received, bus.frames_lost, bus.not_used,
                  bus.overflows, bus.stalls, bus.false_holds, bus.faults, bus.machine_holds,
                  bus.commands_rejected, bus.load, bus.max_feedback_age_s, percentile_ms(bus, 0.5),
                  percentile_ms(bus, 0.99), bus.latency_max_ms);
    std::string reason = r.reason;
    std::replace(reason.begin(), reason.end(), '"', '\'');
    csv += "\"" + reason + "\"\n";
  }
  return csv;
}

}  // namespace wex
