#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tools/bench/drive_bench_cases.hpp"

namespace wex {

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
};

/// Reads a run's result.json.
///   exit_code  what the process returned; used where there is no file
[[nodiscard]] DriveBenchResult read_drive_bench_result(const std::filesystem::path& folder,
                                                       int exit_code);

/// Wilson score interval of a success rate, 95 %.
[[nodiscard]] std::pair<double, double> wilson_interval(int successes, int runs);

/// The table for stdout: one row per case, the pooled rate, every failure with its reason.
[[nodiscard]] std::string drive_bench_table(const std::vector<DriveBenchRun>& runs,
                                            const std::vector<DriveBenchResult>& results);

/// One line per run.
[[nodiscard]] std::string drive_bench_csv(const std::vector<DriveBenchRun>& runs,
                                          const std::vector<DriveBenchResult>& results);

}  // namespace wex
