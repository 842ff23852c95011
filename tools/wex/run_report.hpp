#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "initializer/search_census.hpp"
#include "models/types/plan.hpp"
#include "tools/wex/bus_report.hpp"
#include "tools/wex/drive_record.hpp"
#include "tools/wex/options.hpp"

namespace wex::app {

struct StageTime {
  double cpu_s = 0.0;   ///< of the calling thread
  double wall_s = 0.0;  ///< elapsed
};

/// Everything a run produced; what result.json and the summary are made of.
struct RunReport {
  RunOptions options;
  Task task_map;                            ///< in the map frame
  Eigen::Vector2d map_origin_m{0.0, 0.0};   ///< map frame = local + this
  std::map<std::string, StageTime> stages;  ///< load, plan, refine, drive, report
  std::optional<Plan> plan;
  std::optional<SearchCensus> search;  ///< of a search that found no plan: what it turned down
  std::optional<RefinedTrajectory> refined;
  std::optional<DriveRecord> drive;
  double simulation_cpu_s = 0.0;      ///< part of the drive spent in the simulation; NaN: none
  std::optional<BusReport> bus;       ///< of a run on a CAN bus
  std::optional<Error> failure;       ///< nothing: the goal was reached (or the plan was made)
  std::vector<std::string> warnings;  ///< what could not be reported, e.g. a picture
};

[[nodiscard]] inline int exit_code(const RunReport& report) {
  return report.failure ? exit_code(report.failure->code) : 0;
}

/// The p-th percentile (0 to 100, linear between order statistics); 0 for no values.
[[nodiscard]] double percentile(std::vector<double> values, double p);

/// Side slip of the whole machine: sum over the wheels of the integral of |patch velocity along
/// the axle| while loaded, divided by their travel; 0 without travel, NaN where it is not known.
[[nodiscard]] double side_slip_ratio(const DriveExtremes& extremes);

/// result.json, schema "wex-result-1" (fields: tools/wex/README.md).
[[nodiscard]] std::string result_json(const RunReport& report);

/// The short table for stdout.
[[nodiscard]] std::string summary_table(const RunReport& report);

}  // namespace wex::app
