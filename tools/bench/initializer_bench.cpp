#include "tools/bench/initializer_bench.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>

#include "models/types/contact_schedule.hpp"
#include "tools/bench/initializer_bench_cells.hpp"
#include "tools/bench/initializer_bench_table.hpp"
#include "tools/check/plan_checker.hpp"

namespace wex {
namespace {

struct Work {
  const InitializerCell* cell = nullptr;
  std::uint64_t seed = 0;
};

std::optional<std::string> rejected(const MachineModel& machine, const Raster& raster,
                                    const Plan& plan) {
  const auto report = check::check_plan(machine, raster, plan);
  if (!report) return report.error().message;
  if (report->accepted) return std::nullopt;
  return "checker: " + report->verdict();
}

InitializerRow planned(const InitializerBenchOptions& options, const MachineModel& machine,
                       const Work& work) {
  InitializerRow row;
  row.cell = work.cell->name;
  row.seed = work.seed;
  const auto synthetic = initializer_task(options.set, *work.cell, work.seed);
  if (!synthetic) {
    row.reason = synthetic.error().message;
    return row;
  }
  const Raster& raster = synthetic->raster;
  const auto terrain = TerrainMap::build(raster.elevation, {}, raster.map_origin_m);
  if (!terrain) {
    row.reason = terrain.error().message;
    return row;
  }
  Task task = synthetic->task;
  for (Pose2* pose : {&task.start, &task.goal}) {
    pose->x_m -= raster.map_origin_m.x();
    pose->y_m -= raster.map_origin_m.y();
  }
  PlanSettings settings = options.plan;
  settings.seed = work.seed;
  std::optional<Plan> first;
  const auto plan = make_plan(*terrain, machine, task, settings, [&](const PlanProgress& progress) {
    row.paths = std::max(row.paths, progress.num_paths);
    if (first || progress.better == nullptr) return;
    first = *progress.better;
    row.first_s = progress.elapsed_s;
  });
  if (!plan) {
    row.reason = plan.error().message;
    return row;
  }
  row.found = true;
  row.paths = std::max(row.paths, 1);
  row.total_s = plan->total_time_s;
  row.cost = plan->cost;
  row.first_cost = first ? first->cost : plan->cost;
  row.length_m = plan->path_length_m;
  row.duration_s = plan->nodes.back().t_s;
  row.margin_m = plan->min_stability_margin_m;
  row.lifts = num_wheel_lifts(plan->nodes);
  const auto why_not_last = rejected(machine, raster, *plan);
  const auto why_not_first = first ? rejected(machine, raster, *first) : why_not_last;
  row.accepted = !why_not_last;
  row.first_accepted = !why_not_first;
  if (!row.first_accepted) row.first_s = row.total_s;
  row.reason = why_not_last ? *why_not_last : "";
  return row;
}

std::filesystem::path part_file(const InitializerBenchOptions& options, int job) {
  return options.out / ("part_" + std::to_string(job) + ".csv");
}

InitializerRow lost_row(const Work& work) {
  InitializerRow row;
  row.cell = work.cell->name;
  row.seed = work.seed;
  row.reason = "the process ended";
  return row;
}

bool ended_well(pid_t pid) {
  int status = 0;
  waitpid(pid, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// In a process of its own: a task that crashes spoils only its own row.
void run_task(const InitializerBenchOptions& options, const MachineModel& machine, const Work& work,
              const std::filesystem::path& part_csv, const std::string& label, std::ostream& err) {
  const pid_t pid = fork();
  if (pid == 0) {
    const InitializerRow row = planned(options, machine, work);
    std::ofstream part(part_csv, std::ios::app);
    part << csv_line(row) << std::flush;
    err << label << row.cell << " seed " << row.seed
        << (row.accepted ? ": accepted" : ": " + row.reason.substr(0, 160)) << std::endl;
    _exit(part ? 0 : 1);
  }
  if (pid > 0 && ended_well(pid)) return;
  std::ofstream(part_csv, std::ios::app) << csv_line(lost_row(work));
  err << label << work.cell->name << " seed " << work.seed << ": the process ended" << std::endl;
}

/// Every `jobs`-th task is one worker's.
Result<void> run_parts(const InitializerBenchOptions& options, const MachineModel& machine,
                       const std::vector<Work>& works, std::ostream& err) {
  std::vector<pid_t> workers;
  for (int job = 0; job < options.jobs; ++job) {
    err.flush();
    const pid_t pid = fork();
    if (pid < 0) return fail(ErrorCode::kInternal, "no process could be started for the benchmark");
    if (pid > 0) {
      workers.push_back(pid);
      continue;
    }
    std::ofstream{part_file(options, job)};  // empties what an earlier run left
    for (std::size_t k = static_cast<std::size_t>(job); k < works.size();
         k += static_cast<std::size_t>(options.jobs)) {
      char label[48];
      std::snprintf(label, sizeof label, "[%zu of %zu] ", k + 1, works.size());
      run_task(options, machine, works[k], part_file(options, job), label, err);
    }
    _exit(0);
  }
  for (const pid_t pid : workers) ended_well(pid);
  return {};
}

}  // namespace

Result<InitializerBenchOutcome> bench_initializer(const InitializerBenchOptions& asked,
                                                  std::ostream& out, std::ostream& err) {
  InitializerBenchOptions options = asked;
  if (options.quick) {
    options.seeds = std::min(options.seeds, 2);
    options.plan.time_budget_s = std::min(options.plan.time_budget_s, 1.0);
  }
  std::vector<InitializerCell> cells = initializer_cells(options.set);
  if (!options.cells.empty()) {
    for (const std::string& wanted : options.cells) {
      if (std::none_of(cells.begin(), cells.end(), [&](const InitializerCell& cell) {
            return cell.name.starts_with(wanted);
          })) {
        std::string names;
        for (const InitializerCell& cell : cells) names += (names.empty() ? "" : ", ") + cell.name;
        return fail(ErrorCode::kBadInput, "there is no cell '" + wanted + "', only " + names);
      }
    }
    std::erase_if(cells, [&](const InitializerCell& cell) {
      return std::none_of(options.cells.begin(), options.cells.end(),
                          [&](const std::string& wanted) { return cell.name.starts_with(wanted); });
    });
  }
  std::error_code error;
  std::filesystem::create_directories(options.out, error);
  const std::filesystem::path csv_file = options.out / "initializer_bench.csv";
  std::ofstream csv(csv_file);
  if (!csv)
    return fail(ErrorCode::kBadInput, "--out " + options.out.string() + " cannot be written");
  const auto machine = load_machine();
  if (!machine) return tl::unexpected<Error>(machine.error());

  std::vector<Work> works;
  for (const InitializerCell& cell : cells) {
    for (int seed = 1; seed <= options.seeds; ++seed) {
      works.push_back({&cell, static_cast<std::uint64_t>(seed)});
    }
  }
  if (auto ran = run_parts(options, *machine, works, err); !ran) {
    return tl::unexpected<Error>(ran.error());
  }
  std::vector<InitializerRow> rows;
  for (int job = 0; job < options.jobs; ++job) {
    std::ifstream part(part_file(options, job));
    for (std::string line; std::getline(part, line);) {
      if (auto row = row_of(line)) rows.push_back(*row);
    }
    std::filesystem::remove(part_file(options, job), error);
  }
  for (const Work& work : works) {
    const bool is_there = std::any_of(rows.begin(), rows.end(), [&](const InitializerRow& row) {
      return row.cell == work.cell->name && row.seed == work.seed;
    });
    if (is_there) continue;
    rows.push_back(lost_row(work));
  }
  const auto place = [&](const InitializerRow& row) {
    return std::find_if(cells.begin(), cells.end(),
                        [&](const InitializerCell& cell) { return cell.name == row.cell; }) -
           cells.begin();
  };
  std::sort(rows.begin(), rows.end(), [&](const InitializerRow& a, const InitializerRow& b) {
    return std::pair(place(a), a.seed) < std::pair(place(b), b.seed);
  });
  csv << initializer_csv(rows);
  csv.close();
  if (!csv) return fail(ErrorCode::kBadInput, "cannot write " + csv_file.string());
  out << initializer_table(cells, rows) << "rows: " << csv_file.string() << "\n";
  const bool hold = rates_hold(cells, rows);
  return InitializerBenchOutcome{std::move(cells), std::move(rows), hold};
}

}  // namespace wex
