// wex can and wex replay, at the electronics behind a pipe and at recorded buses.
#include "tools/wex/can_command.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/host_bench.hpp"
#include "tools/wex/bus_monitor.hpp"
#include "tools/wex/cli.hpp"
#include "tools/wex/replay_command.hpp"

namespace wex::app {
namespace {

using ::testing::HasSubstr;

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

struct CliOutcome {
  int code = -1;
  std::string out, err;
};

CliOutcome cli(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "wex");
  std::ostringstream out, err;
  const int code = run_cli(static_cast<int>(arguments.size()), arguments.data(), out, err);
  return {code, out.str(), err.str()};
}

TEST(CanOptions, BadArgumentsAreRefusedInOneSentence) {
  const std::vector<std::vector<const char*>> cases{
      {"can"},
      {"can", "look", "vcan0"},
      {"can", "monitor"},
      {"can", "monitor", "a/b"},
      {"can", "monitor", "an_interface_name_too_long"},
      {"can", "monitor", "vcan0", "--duration", "-1"},
      {"can", "enable", "vcan0", "--duration", "soon"},
      {"can", "stop"},
      {"can", "reset", "vcan0", "--hard"},
      {"replay"},
      {"replay", "/nonexistent/bus.log"},
      {"run", "map.asc", "--lock-step"},
      {"run", "map.asc", "--can", "vcan0", "--lock-step", "--real-time"},
      {"run", "map.asc", "--can", "vcan0", "--start", "1,2,0"},
      {"run", "map.asc", "--can", ""}};
  for (const auto& arguments : cases) {
    const CliOutcome outcome = cli(arguments);
    std::string text;
    for (const char* argument : arguments) text += std::string(argument) + " ";
    EXPECT_EQ(outcome.code, 2) << text;
    EXPECT_EQ(outcome.out, "") << text;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << text << outcome.err;
    EXPECT_EQ(outcome.err.rfind("wex: ", 0), 0u) << outcome.err;
  }
  EXPECT_THAT(cli(cases[13]).err, HasSubstr("--start and --can exclude each other"));
}

TEST(CanOptions, AnInterfaceThatDoesNotExistIsNamed) {
  for (const char* tool : {"monitor", "enable", "stop", "reset"}) {
    const CliOutcome outcome = cli({"can", tool, "nocan9"});
    EXPECT_EQ(outcome.code, 2) << tool;
    EXPECT_THAT(outcome.err, ::testing::AnyOf(HasSubstr("nocan9"), HasSubstr("no CAN"))) << tool;
  }
}

TEST(BusMonitorTest, ShowsRatesAgesLossesAndCrcErrorsById) {
  BusMonitor monitor;
  can::SendContext context;
  constexpr std::int64_t kStart_ns = 1'000'000'000, kPeriod_ns = 10'000'000;
  std::int64_t now_ns = kStart_ns;
  for (int i = 0; i <= 200; ++i) {
    can::CanFrame frame;
    ASSERT_TRUE(can::encode(can::EStopState{false, 0}, context, frame));
    now_ns = kStart_ns + i * kPeriod_ns;
    if (i == 50) continue;               // lost
    if (i == 60) frame.data[3] ^= 0x10;  // altered
    monitor.take(frame, now_ns);
  }
  can::CanFrame foreign;
  foreign.id = 0x123;
  monitor.take(foreign, now_ns);
  can::CanFrame error;
  error.error = true;
  monitor.take(error, now_ns);
  const auto json = nlohmann::json::parse(monitor.json(now_ns + 7'000'000, 3));
  EXPECT_EQ(json["dropped"], 3);
  EXPECT_EQ(json["error_frames"], 1);
  EXPECT_EQ(json["unknown_ids"], 1);
  ASSERT_EQ(json["messages"].size(), 2u);
  const auto& estop = json["messages"][0];
  EXPECT_EQ(estop["id"], "0x010");
  EXPECT_EQ(estop["name"], "EStopState");
  EXPECT_EQ(estop["frames"], 200);
  EXPECT_EQ(estop["crc_errors"], 1);
  EXPECT_EQ(estop["lost"], 2);  // the altered one counts as missing, too
  EXPECT_NEAR(estop["rate_per_s"].get<double>(), 100.0, 2.0);
  EXPECT_NEAR(estop["age_ms"].get<double>(), 7.0, 1e-6);
  EXPECT_THAT(estop["values"].get<std::string>(), HasSubstr("="));
  EXPECT_GT(json["load"].get<double>(), 0.0);
  const std::string table = monitor.table(now_ns, 3, 60);
  EXPECT_THAT(table, HasSubstr("EStopState"));
  EXPECT_THAT(table, HasSubstr("unknown"));
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 60u);
}

/// A bystander's port on the bench's bus: hears the machine, is heard by both ends.
class Bystander final : public can::FramePort {
 public:
  explicit Bystander(can::HostBench& bench) : bench_(bench) {}
  can::SocketStatus send(const can::CanFrame& frame) noexcept override {
    ++sent;
    bench_.far.inject(frame);
    return can::SocketStatus::kOk;
  }
  can::SocketStatus receive(can::CanFrame& frame) noexcept override {
    if (next_ >= heard_.size()) return can::SocketStatus::kWouldBlock;
    frame = heard_[next_++];
    return can::SocketStatus::kOk;
  }
  can::SocketStatus wait_readable(double timeout_s) noexcept override {
    if (deaf) {
      bench_.clock.time_ns += static_cast<std::int64_t>(1e9 * timeout_s);
      return can::SocketStatus::kWouldBlock;
    }
    // What the machine reports, as the host hears it meanwhile.
    bench_.wait_one();
    bench_.wait_one();
    for (int zone = 0; zone < can::kNumZones; ++zone) {
      can::ZoneStatus status;
      status.zone = zone;
      status.mode = bench_.far.mode();
      can::CanFrame frame;
      if (can::encode(status, context_[zone], frame)) heard_.push_back(frame);
    }
    return can::SocketStatus::kOk;
  }
  can::SocketStatus reopen() noexcept override { return can::SocketStatus::kOk; }
  bool purge() noexcept override { return false; }
  std::uint32_t dropped() const noexcept override { return 0; }
  bool deaf = false;
  long sent = 0;

 private:
  can::HostBench& bench_;
  std::array<can::SendContext, can::kNumZones> context_{};
  std::vector<can::CanFrame> heard_;
  std::size_t next_ = 0;
};

TEST(Operate, StopsAndResetsAndSaysTheModeThatFollowed) {
  can::HostBench bench(false);
  bench.drive();
  Bystander port(bench);
  const auto stopped = operate(port, bench.clock, can::OperatorAction::kStop);
  ASSERT_TRUE(stopped) << stopped.error().message;
  EXPECT_EQ(*stopped, can::MachineMode::kEStop);
  EXPECT_EQ(bench.host->lifecycle(), Lifecycle::kEStop);
  EXPECT_EQ(bench.host->cause(), can::HostCause::kOperatorStop);

  const auto reset = operate(port, bench.clock, can::OperatorAction::kReset);
  ASSERT_TRUE(reset) << reset.error().message;
  EXPECT_TRUE(*reset == can::MachineMode::kInit || *reset == can::MachineMode::kReady);
  bench.wait(0.5);
  EXPECT_EQ(bench.host->lifecycle(), Lifecycle::kInactive);  // a reset enables nothing
}

TEST(Operate, AResetWithTheChainOpenIsNotConfirmed) {
  can::HostBench bench(false);
  bench.activate();
  bench.far.electronics().set_estop_chain(true);
  bench.wait(0.1);
  Bystander port(bench);
  const auto reset = operate(port, bench.clock, can::OperatorAction::kReset);
  ASSERT_FALSE(reset);
  EXPECT_EQ(reset.error().code, ErrorCode::kStoppedSafely);
  EXPECT_THAT(reset.error().message, HasSubstr("not confirmed"));
}

TEST(Operate, NobodyThereIsSaidSo) {
  can::HostBench bench(false);
  Bystander port(bench);
  port.deaf = true;
  const auto stopped = operate(port, bench.clock, can::OperatorAction::kStop);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::kBadInput);
  EXPECT_GT(port.sent, 0) << "a stop does not wait until somebody is heard";
  port.sent = 0;
  EXPECT_FALSE(operate(port, bench.clock, can::OperatorAction::kReset));
  EXPECT_EQ(port.sent, 0);
}

TEST(Monitor, OnceShowsOneTableAndFailsWhereNothingIsHeard) {
  can::HostBench bench(false);
  bench.activate();
  Bystander port(bench);
  std::ostringstream out;
  const std::atomic<bool> stop = false;
  CanOptions options;
  options.once = true;
  ASSERT_TRUE(monitor_bus(port, bench.clock, options, std::nullopt, out, stop));
  EXPECT_THAT(out.str(), HasSubstr("ZoneStatus"));
  EXPECT_EQ(out.str().find("\033"), std::string::npos);  // plain lines where no terminal is
  port.deaf = true;
  BusMonitor none;
  Bystander deaf(bench);
  deaf.deaf = true;
  const auto silent = monitor_bus(deaf, bench.clock, options, std::nullopt, out, stop);
  ASSERT_FALSE(silent);
  EXPECT_EQ(silent.error().code, ErrorCode::kBadInput);
}

TEST(KeepEnabled, TellsEveryChangeAndWhyItEnded) {
  can::HostBench bench(false);
  bench.connect();
  std::ostringstream out;
  const std::atomic<bool> stop = false;
  double fastest = 0.0;
  bool enabled = false;
  int ticks = 0;
  bench.far.on_tick = [&] {
    fastest = std::max(fastest, bench.plant.fastest_rate());
    enabled = enabled || bench.far.mode() == can::MachineMode::kEnabled;
    if (enabled && ++ticks == 100) bench.far.electronics().set_estop_chain(true);
  };
  const auto kept = keep_enabled(*bench.host, std::nullopt, out, stop);
  ASSERT_FALSE(kept);
  EXPECT_EQ(kept.error().code, ErrorCode::kStoppedSafely);
  EXPECT_THAT(kept.error().message, HasSubstr(can::describe(can::HostCause::kEStopOpen)));
  EXPECT_THAT(out.str(), HasSubstr("inactive"));
  EXPECT_THAT(out.str(), HasSubstr("active\n"));
  EXPECT_THAT(out.str(), HasSubstr("e-stop: "));
  EXPECT_LT(fastest, 1e-6);  // neutral commands move nothing
}

class Replay : public ::testing::Test {
 protected:
  Replay()
      : folder_(std::filesystem::temp_directory_path() /
                ("wex_replay_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~Replay() override { std::filesystem::remove_all(folder_); }
  std::string recorded_drive() {
    can::HostBench bench;
    bench.drive();
    bench.wait(1.0);
    const std::string file = (folder_ / "bus.log").string();
    EXPECT_TRUE(bench.host->recorder().write(file, "vcan0"));
    return file;
  }
  std::filesystem::path folder_;
};

TEST_F(Replay, SummarizesALogAndWritesTheSameMotionTwice) {
  const std::string log = recorded_drive();
  const std::string a = (folder_ / "a").string(), b = (folder_ / "b").string();
  const CliOutcome outcome = cli({"replay", log.c_str(), "--out", a.c_str()});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("enabled"));
  EXPECT_THAT(outcome.out, HasSubstr("0 refused"));
  ASSERT_EQ(cli({"replay", log.c_str(), "--out", b.c_str()}).code, 0);
  const std::string csv = text_of(a + "/executed.csv");
  EXPECT_EQ(csv.rfind("t,base_x,", 0), 0u);
  EXPECT_GT(std::count(csv.begin(), csv.end(), '\n'), 40);
  EXPECT_EQ(csv, text_of(b + "/executed.csv"));
}

TEST_F(Replay, ABadLineIsNamed) {
  const std::string log = recorded_drive();
  {
    std::ofstream stream(log, std::ios::app);
    stream << "(1.5) vcan0 nonsense\n";
  }
  std::ifstream stream(log);
  const auto lines = std::count(std::istreambuf_iterator<char>(stream), {}, '\n');
  const CliOutcome outcome = cli({"replay", log.c_str()});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("line " + std::to_string(lines)));
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1);
}

}  // namespace
}  // namespace wex::app
