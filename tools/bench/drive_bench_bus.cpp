#include "tools/bench/drive_bench_bus.hpp"

#include <signal.h>
#include <sys/wait.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "tools/bench/drive_bench_process.hpp"
#include "tools/bench/drive_bench_truth.hpp"

namespace wex {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kPoll = std::chrono::milliseconds(20);
constexpr auto kReadyWithin = std::chrono::seconds(120), kEndWithin = std::chrono::seconds(20);
constexpr const char* kReady = "wex machine: ";  ///< its first words once it is on the bus

std::string first_line(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line;
}

/// The simulated machine at the other end, ended with this object.
class MachineProcess {
 public:
  MachineProcess(pid_t pid, std::filesystem::path output) : pid_(pid), output_(std::move(output)) {}
  MachineProcess(const MachineProcess&) = delete;
  MachineProcess& operator=(const MachineProcess&) = delete;
  ~MachineProcess() { end(); }

  /// False if it ended, or takes too long.
  bool wait_until_on_bus() {
    const auto give_up = Clock::now() + kReadyWithin;
    while (Clock::now() < give_up) {
      if (first_line(output_).starts_with(kReady)) return true;
      if (ended()) return false;
      std::this_thread::sleep_for(kPoll);
    }
    return false;
  }
  /// Lets it write its log to the end.
  void end() {
    if (ended()) return;
    kill(pid_, SIGTERM);
    const auto give_up = Clock::now() + kEndWithin;
    while (!ended()) {
      if (Clock::now() > give_up) kill(pid_, SIGKILL);
      std::this_thread::sleep_for(kPoll);
    }
  }

 private:
  bool ended() {
    int status = 0;
    ended_ = ended_ || waitpid(pid_, &status, WNOHANG) == pid_;
    return ended_;
  }
  pid_t pid_;
  std::filesystem::path output_;
  bool ended_ = false;
};

std::filesystem::path machine_log(const DriveBenchRun& run) { return run.folder / "machine.csv"; }

}  // namespace

DriveBenchResult read_bus_result(const DriveBenchRun& run, int exit_code) {
  DriveBenchResult result = read_drive_bench_result(run.folder, exit_code);
  const Result<DriveTruth> truth = read_drive_truth(machine_log(run));
  if (!truth) {
    result.success = false;
    result.reason += "; " + truth.error().message;
    return result;
  }
  const Pose2& goal = run.task_map.goal;
  result.goal_error_m = goal_error_m(*truth, goal);
  result.goal_error_rad = goal_error_rad(*truth, goal);
  result.side_slip_ratio = truth->side_slip_ratio;
  result.roll_rad = truth->max_roll_rad;
  result.pitch_rad = truth->max_pitch_rad;
  result.penetration_m = truth->penetration_m;
  result.hold_rate_m_s = truth->hold_rate_m_s;
  result.lift_off_s = truth->lift_off_s;
  if (result.bus) {
    result.bus->machine_holds = truth->holds;
    result.bus->commands_rejected = truth->commands_rejected;
  }
  if (const std::string problem = objection(*truth, goal); !problem.empty()) {
    result.success = false;
    result.reason += "; by the machine's log: " + problem;
  }
  return result;
}

Result<DriveBenchResult> drive_on_bus(const DriveBenchRun& run, const DriveBenchOptions& options) {
  const std::string can = "--can=" + options.can_interface;
  std::error_code ignored;
  std::filesystem::create_directories(run.folder, ignored);
  std::filesystem::remove(machine_log(run), ignored);
  const std::filesystem::path output = run.folder / "machine.txt";
  std::filesystem::remove(output, ignored);
  std::vector<std::string> machine_words{"machine", run.map.string(), can,
                                         "--start=" + pose_text(run.task_map.start),
                                         "--log=" + machine_log(run).string()};
  if (!options.real_time) machine_words.emplace_back("--lock-step");
  const Result<pid_t> started = start_program(std::move(machine_words), output);
  if (!started) return tl::unexpected(started.error());
  MachineProcess machine(*started, output);
  if (!machine.wait_until_on_bus()) {
    DriveBenchResult result;
    result.reason = "no machine on the bus: " + first_line(output);
    return result;
  }
  std::vector<std::string> host_words = run_words(run, options);
  host_words.push_back(can);
  const Result<pid_t> host = start_program(std::move(host_words), run.folder / "log.txt");
  if (!host) return tl::unexpected(host.error());
  int status = 0;
  while (waitpid(*host, &status, 0) != *host) {
  }
  machine.end();
  return read_bus_result(run, exit_code_of(status));
}

}  // namespace wex
