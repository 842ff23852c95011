#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/bench/drive_bench_cases.hpp"

namespace wex {

/// What the host saw of the bus (object "bus" of result.json), and the machine's log of the same.
struct DriveBenchBus {
  long frames_sent = 0, frames_received = 0, frames_lost = 0;
  long not_used = 0;  ///< received, but altered, repeated, out of order, malformed or foreign
  long overflows = 0, stalls = 0, false_holds = 0, faults = 0;
  double load = 0.0;  ///< share of machine time
  double max_feedback_age_s = 0.0;
  std::vector<double> latency_edges_ms;  ///< command to report: upper edges, the last bin is open
  std::vector<long> latency_counts;
  double latency_max_ms = 0.0;
  int machine_holds = 0;  ///< one of them is the arrival
  long commands_rejected = 0;
};

/// What one run's result.json says, in the units of the table.
struct DriveBenchResult {
  bool success = false;
  int exit_code = 1;
  std::string reason;
  bool driven = false;  ///< it came to a drive; otherwise the figures below are zero
  double goal_error_m = 0.0, goal_error_rad = 0.0;
  double planned_s = 0.0, driven_s = 0.0, path_m = 0.0;
  double side_slip_ratio = 0.0, margin_m = 0.0;
  double roll_rad = 0.0, pitch_rad = 0.0;
  double penetration_m = 0.0, hold_rate_m_s = 0.0, lift_off_s = 0.0;
  double solve_p50_ms = 0.0, solve_p99_ms = 0.0, solve_max_ms = 0.0;
  int solves = 0, misses = 0, unusable = 0;
  double real_time_factor = 0.0;
  std::optional<DriveBenchBus> bus;  ///< of a run over a bus
};

/// Reads a run's result.json.
///   exit_code  what the process returned; used where there is no file
[[nodiscard]] DriveBenchResult read_drive_bench_result(const std::filesystem::path& folder,
                                                       int exit_code);

/// Wilson score interval of a success rate, 95 %.
[[nodiscard]] std::pair<double, double> wilson_interval(int successes, int runs);

/// The table for stdout: one row per case, the pooled rate, every failure with its reason; of runs
/// over a bus also a row of its figures per case.
[[nodiscard]] std::string drive_bench_table(const std::vector<DriveBenchRun>& runs,
                                            const std::vector<DriveBenchResult>& results);

/// One line per run.
[[nodiscard]] std::string drive_bench_csv(const std::vector<DriveBenchRun>& runs,
                                          const std::vector<DriveBenchResult>& results);

}  // namespace wex
