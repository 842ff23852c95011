#include "tools/bench/drive_bench.hpp"

#include <sys/wait.h>

#include <fstream>
#include <map>

#include "tools/bench/drive_bench_bus.hpp"
#include "tools/bench/drive_bench_process.hpp"
#include "tools/bench/drive_bench_table.hpp"

namespace wex {
namespace {

/// Starts this program on a run, its output in the run's log.txt.
Result<pid_t> start(const DriveBenchRun& run, const DriveBenchOptions& options) {
  std::error_code ignored;
  std::filesystem::create_directories(run.folder, ignored);
  std::vector<std::string> words = run_words(run, options);
  words.push_back("--start=" + pose_text(run.task_map.start));
  return start_program(std::move(words), run.folder / "log.txt");
}

bool has_result(const DriveBenchRun& run) {
  std::error_code ignored;
  return std::filesystem::exists(run.folder / "result.json", ignored);
}

}  // namespace

Result<int> bench_drive(const DriveBenchOptions& options, std::ostream& out, std::ostream& err) {
  const bool on_bus = !options.can_interface.empty();
  const Result<std::vector<DriveBenchRun>> prepared = prepare_drive_bench(options);
  if (!prepared) return tl::unexpected(prepared.error());
  const std::vector<DriveBenchRun>& runs = *prepared;
  std::vector<DriveBenchResult> results(runs.size());
  std::map<pid_t, std::size_t> running;
  std::size_t done = 0;
  const auto note = [&](std::size_t k) {
    err << "[" << ++done << " of " << runs.size() << "] " << runs[k].name << " seed "
        << runs[k].seed << ": " << results[k].reason << std::endl;
  };
  const auto wait_for_one = [&] {
    int status = 0;
    const pid_t pid = wait(&status);
    const auto entry = running.find(pid);
    if (entry == running.end()) return;
    const std::size_t k = entry->second;
    running.erase(entry);
    results[k] = read_drive_bench_result(runs[k].folder, exit_code_of(status));
    note(k);
  };
  for (std::size_t k = 0; k < runs.size(); ++k) {
    if (options.resume && has_result(runs[k])) {
      results[k] =
          on_bus ? read_bus_result(runs[k], 1) : read_drive_bench_result(runs[k].folder, 1);
      note(k);
      continue;
    }
    std::error_code ignored;
    std::filesystem::remove(runs[k].folder / "result.json", ignored);
    if (on_bus) {  // there is one machine on a bus
      Result<DriveBenchResult> driven = drive_on_bus(runs[k], options);
      if (!driven) return tl::unexpected(driven.error());
      results[k] = std::move(*driven);
      note(k);
      continue;
    }
    while (static_cast<int>(running.size()) >= options.jobs) wait_for_one();
    const Result<pid_t> pid = start(runs[k], options);
    if (!pid) {
      while (!running.empty()) wait_for_one();
      return tl::unexpected(pid.error());
    }
    running[*pid] = k;
  }
  while (!running.empty()) wait_for_one();

  out << drive_bench_table(runs, results);
  const std::filesystem::path csv_file = options.out / "drive_bench.csv";
  std::ofstream csv(csv_file);
  csv << drive_bench_csv(runs, results);
  csv.close();
  if (!csv) return fail(ErrorCode::kBadInput, "cannot write " + csv_file.string());
  out << "runs: " << csv_file.string() << "\n";
  for (const DriveBenchResult& result : results) {
    if (!result.success) return 5;
  }
  return 0;
}

}  // namespace wex
