#include "tools/bench/drive_bench.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <map>

#include "tools/bench/drive_bench_cases.hpp"
#include "tools/bench/drive_bench_table.hpp"

namespace wex {
namespace {

std::string pose_text(const Pose2& pose) {
  char text[96];
  std::snprintf(text, sizeof(text), "%.4f,%.4f,%.5f", pose.x_m, pose.y_m, pose.yaw_rad);
  return text;
}

std::vector<std::string> arguments(const DriveBenchRun& run) {
  return {"wex",
          "run",
          run.map.string(),
          "--start=" + pose_text(run.task_map.start),
          "--goal=" + pose_text(run.task_map.goal),
          "--seed=" + std::to_string(run.seed),
          "--out=" + run.folder.string(),
          "--frames=0"};
}

/// Starts this program on a run, its output in the run's log.txt.
Result<pid_t> start(const DriveBenchRun& run) {
  std::error_code error;
  std::filesystem::create_directories(run.folder, error);
  const std::string log = (run.folder / "log.txt").string();
  std::vector<std::string> words = arguments(run);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t pid = fork();
  if (pid < 0) return fail(ErrorCode::kInternal, "no process could be started for a run");
  if (pid == 0) {
    const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (file < 0 || dup2(file, 1) < 0 || dup2(file, 2) < 0) _exit(127);
    execv("/proc/self/exe", argv.data());
    _exit(127);
  }
  return pid;
}

bool has_result(const DriveBenchRun& run) {
  std::error_code ignored;
  return std::filesystem::exists(run.folder / "result.json", ignored);
}

}  // namespace

Result<int> bench_drive(const DriveBenchOptions& options, std::ostream& out, std::ostream& err) {
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
    results[k] =
        read_drive_bench_result(runs[k].folder, WIFEXITED(status) ? WEXITSTATUS(status) : 1);
    note(k);
  };
  for (std::size_t k = 0; k < runs.size(); ++k) {
    if (options.resume && has_result(runs[k])) {
      results[k] = read_drive_bench_result(runs[k].folder, 1);
      note(k);
      continue;
    }
    std::error_code ignored;
    std::filesystem::remove(runs[k].folder / "result.json", ignored);
    while (static_cast<int>(running.size()) >= options.jobs) wait_for_one();
    const Result<pid_t> pid = start(runs[k]);
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
