// `wex run --can` at one end of a real bus and `wex machine` at the other, in lock step: a whole
// drive, and drives that something goes wrong with. tools/with_vcan gives the bus. What the machine
// did is judged by its own log.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "hw_interface/socketcan/can_socket.hpp"
#include "hw_interface/socketcan/codec.hpp"
#include "models/terrain/raster_io.hpp"
#include "models/terrain/synthetic.hpp"
#include "tests/support/machine_log_file.hpp"
#include "tests/support/process.hpp"
#include "tests/support/scratch_folder.hpp"

namespace wex::can {
namespace {

namespace fs = std::filesystem;
using test::MachineLogFile;
using test::Process;
using test::wait_for;

class CanRun : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto terrain = make_synthetic_terrain("flat", 0.0, 1);
    ASSERT_TRUE(terrain.has_value());
    ASSERT_TRUE(write_esri_ascii(terrain->raster, map()).has_value());
    auto opened = CanSocket::open("vcan0");
    ASSERT_TRUE(opened.has_value()) << opened.error().message;
    socket_.emplace(std::move(*opened));
  }
  void TearDown() override {
    host_.reset();
    machine_.reset();
  }

  fs::path map() const { return folder_ / "map.asc"; }
  void start_machine() {
    machine_.emplace(WEX_PROGRAM,
                     std::vector<std::string>{"machine", map().string(), "--can", "vcan0",
                                              "--start", "8,8,0", "--lock-step", "--patience", "2",
                                              "--log", (folder_ / "machine.csv").string()},
                     folder_ / "machine.txt");
    ASSERT_TRUE(wait_for(20.0, [&] { return heard(MessageKind::kZoneStatus); }))
        << machine_->output();
  }
  void start_run() {
    host_.emplace(
        WEX_PROGRAM,
        std::vector<std::string>{"run", map().string(), "--can", "vcan0", "--goal", "12,8.2,0.05",
                                 "--seed", "1", "--iterations", "300", "--solve-delay", "30",
                                 "--frames", "0", "--quiet", "--out", (folder_ / "run").string()},
        folder_ / "run.txt");
  }
  /// Ends the machine and reads its log.
  MachineLogFile end_machine() {
    machine_->send(SIGTERM);
    EXPECT_EQ(machine_->wait(10.0), 0) << machine_->output();
    return MachineLogFile(folder_ / "machine.csv");
  }
  nlohmann::json result() const {
    std::ifstream stream(folder_ / "run" / "result.json");
    return nlohmann::json::parse(stream, nullptr, false);
  }
  Process wex(const std::vector<std::string>& arguments) {
    return Process(WEX_PROGRAM, arguments, folder_ / "tool.txt");
  }

  void listen() {
    CanFrame frame;
    while (socket_->receive(frame) == SocketStatus::kOk) {
      ++heard_[kind_of(frame)];
      ZoneStatus status;
      if (decode(frame, 0, status)) mode_ = status.mode;
      ZoneFeedback feedback;
      if (decode(frame, 0, feedback) && feedback.zone == 0) wheel_rate_ = feedback.rate[3];
    }
  }
  bool heard(MessageKind kind) {
    listen();
    return heard_[kind] > 0;
  }
  MachineMode mode() {
    listen();
    return mode_;
  }
  /// Waits until the run drives at more than 0.2 m/s.
  void wait_for_motion() {
    ASSERT_TRUE(wait_for(60.0, [&] {
      listen();
      return (mode_ == MachineMode::kEnabled && std::abs(wheel_rate_) > 0.35) ||
             host_->poll().has_value();
    }));
    ASSERT_FALSE(host_->poll().has_value()) << host_->output();
  }
  /// From the last command accepted before the row `end`, until which it is looked at.
  void expect_stopped(const MachineLogFile& log, std::size_t end) {
    const std::size_t from = log.last_accepted(end);
    ASSERT_GT(from, 100u);
    const double joints_ms = log.ms_until_zero("moving", from, end);
    const double wheels_ms = log.ms_until_zero("travelling", from, end);
    std::printf("last good command -> outputs shut %.0f ms, joints stand %.0f ms, wheels %.0f ms\n",
                log.ms_until_zero("driven", from, end), joints_ms, wheels_ms);
    EXPECT_LE(joints_ms, 150.0);
    EXPECT_LE(wheels_ms, 150.0);
    EXPECT_EQ(log.text("brakes", end - 1), "1");
  }

  ScratchFolder folder_{"can_run"};
  std::optional<CanSocket> socket_;
  std::optional<Process> machine_, host_;
  std::map<MessageKind, int> heard_;
  MachineMode mode_ = MachineMode::kInit;
  double wheel_rate_ = 0.0;
};

TEST_F(CanRun, DrivesToItsGoalOverTheBus) {
  start_machine();
  start_run();
  ASSERT_EQ(host_->wait(200.0), 0) << host_->output();
  const MachineLogFile log = end_machine();
  const nlohmann::json report = result();
  ASSERT_TRUE(report.is_object());
  EXPECT_EQ(report["success"], true);
  const nlohmann::json& bus = report["bus"];
  ASSERT_TRUE(bus.is_object()) << report.dump(1);
  EXPECT_EQ(bus["pace"], "lock step");
  EXPECT_GT(bus["frames_sent"], 5000);
  EXPECT_GT(bus["frames_received"], 10'000);
  for (const char* key : {"frames_lost", "false_holds", "faults", "crc_errors", "own_ids", "stalls",
                          "receive_overflows", "reopens", "rates_limited"}) {
    EXPECT_EQ(bus[key], 0) << key;
  }
  EXPECT_LE(bus["max_feedback_age_s"], 0.011);
  EXPECT_TRUE(log.ever("enabled"));
  EXPECT_FALSE(log.ever("fault"));
  EXPECT_NEAR(log.number("base_x", log.size() - 1), 12.0, 0.3);
  EXPECT_NEAR(log.number("base_y", log.size() - 1), 8.2, 0.3);
  EXPECT_EQ(log.text("brakes", log.size() - 1), "1");
}

TEST_F(CanRun, AKilledHostLeavesAMachineThatStands) {
  start_machine();
  start_run();
  wait_for_motion();
  host_->send(SIGKILL);
  // The clock of an enabled machine in lock step waits for --patience before it runs by itself.
  ASSERT_TRUE(wait_for(10.0, [&] { return mode() == MachineMode::kFault; }));
  sleep(1);
  const MachineLogFile log = end_machine();
  expect_stopped(log, log.size());
}

TEST_F(CanRun, AFrozenHostDoesNotMoveTheMachineWhenItGoesOn) {
  start_machine();
  start_run();
  wait_for_motion();
  host_->send(SIGSTOP);
  ASSERT_TRUE(wait_for(10.0, [&] { return mode() == MachineMode::kFault; }));
  host_->send(SIGCONT);
  EXPECT_EQ(host_->wait(30.0), 5) << host_->output();
  const MachineLogFile log = end_machine();
  expect_stopped(log, log.size());
}

TEST_F(CanRun, AMachineThatDiesEndsTheRunSafely) {
  start_machine();
  start_run();
  wait_for_motion();
  machine_->send(SIGKILL);
  EXPECT_EQ(host_->wait(30.0), 5) << host_->output();
  EXPECT_EQ(result()["success"], false);
}

TEST_F(CanRun, AnEmergencyStopIsLatchedUntilAPersonResetsIt) {
  start_machine();
  start_run();
  wait_for_motion();
  Process stop = wex({"can", "stop", "vcan0"});
  EXPECT_EQ(stop.wait(10.0), 0) << stop.output();
  EXPECT_EQ(host_->wait(30.0), 5) << host_->output();
  EXPECT_EQ(mode(), MachineMode::kEStop);

  Process refused = wex({"can", "enable", "vcan0", "--duration", "1"});
  EXPECT_EQ(refused.wait(20.0), 5) << refused.output();
  EXPECT_EQ(mode(), MachineMode::kEStop);

  Process reset = wex({"can", "reset", "vcan0"});
  EXPECT_EQ(reset.wait(10.0), 0) << reset.output();
  EXPECT_TRUE(wait_for(5.0, [&] { return mode() != MachineMode::kEStop; }));
  Process enabled = wex({"can", "enable", "vcan0", "--duration", "1"});
  EXPECT_EQ(enabled.wait(20.0), 0) << enabled.output();
  const MachineLogFile log = end_machine();
  std::size_t end = log.first("estop");
  while (end < log.size() && log.text("mode", end) == "estop") ++end;
  expect_stopped(log, end);
}

}  // namespace
}  // namespace wex::can
