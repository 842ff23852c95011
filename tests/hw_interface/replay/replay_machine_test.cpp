#include "hw_interface/replay/replay_machine.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "tests/support/host_bench.hpp"
#include "tests/support/machine_io_contract.hpp"
#include "tests/support/scratch_folder.hpp"

namespace wex {
namespace {

using can::HostBench;

std::shared_ptr<const MachineModel> machine() {
  return {&can::bench_machine(), [](const MachineModel*) {}};
}

std::string log_named(const std::string& name) {
  static const ScratchFolder folder("replay");
  return folder / name;
}

/// 40 s of a machine that is enabled and does nothing.
std::string idle_log() {
  static const std::string file = [] {
    HostBench bench;
    bench.activate();
    bench.wait(40.0);
    std::string name = log_named("idle.log");
    EXPECT_TRUE(bench.host->recorder().write(name));
    return name;
  }();
  return file;
}

std::unique_ptr<MachineIo> replay_of_idle_machine() {
  auto replay = ReplayMachine::open(idle_log(), *machine(), {0.0, 0.0}).value();
  const auto activated = replay->activate();
  EXPECT_TRUE(activated) << activated.error().message;
  return replay;
}

const MachineIoSubject kSubject{"Replay", replay_of_idle_machine, machine()};
INSTANTIATE_TEST_SUITE_P(ReplayMachine, MachineIoContract, ::testing::Values(kSubject),
                         subject_name);
// Commands do not move a replay.
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(MachineIoMotionContract);

/// What the program does to a machine, live or replayed: a drive with a steering joint.
class Drive {
 public:
  static void start(MachineIo& io) { ASSERT_TRUE(io.activate()); }
  static void run(MachineIo& io, std::vector<MachineState>& states, double wheel_rate = 0.5) {
    for (int i = 0; i < 400; ++i) {
      const MachineState state = io.read();
      states.push_back(state);
      JointCommand command;
      command.num_joints = state.num_joints;
      command.valid_until_s = state.t_s + 0.3;
      for (const WheeledLeg& leg : machine()->legs) {
        command.rate[leg.wheel - kNumBaseCoordinates] = leg.wheel_sign * wheel_rate;
      }
      const int steer = machine()->legs[0].steer - kNumBaseCoordinates;
      command.has_position_target[steer] = true;
      command.position_target[steer] = 0.2;
      io.write(command);
      io.wait_until(state.t_s + state.age_s + 0.01);
    }
  }
};

bool bit_equal(const std::vector<MachineState>& a, const std::vector<MachineState>& b) {
  if (a.size() != b.size()) return false;
  const auto same = [](const auto& x, const auto& y) {
    return std::memcmp(x.data(), y.data(), sizeof(x)) == 0;
  };
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].t_s != b[i].t_s || a[i].age_s != b[i].age_s || a[i].base != b[i].base ||
        a[i].base_velocity != b[i].base_velocity || !same(a[i].position, b[i].position) ||
        !same(a[i].rate, b[i].rate) || !same(a[i].effort, b[i].effort) ||
        !same(a[i].joint_age_s, b[i].joint_age_s) || a[i].joint_quality != b[i].joint_quality) {
      return false;
    }
  }
  return true;
}

class ReplayOfADrive : public ::testing::Test {
 protected:
  ReplayOfADrive() {
    HostBench bench;
    bench.connect();
    Drive::start(*bench.host);
    Drive::run(*bench.host, live_);
    EXPECT_GT(bench.plant.fastest_rate(), 0.4);
    EXPECT_TRUE(bench.host->recorder().write(file_, "vcan0"));
  }
  std::unique_ptr<ReplayMachine> open() {
    return ReplayMachine::open(file_, *machine(), {0.0, 0.0}).value();
  }

  std::string file_ = log_named("drive.log");
  std::vector<MachineState> live_;
};

// T19
TEST_F(ReplayOfADrive, TwoReplaysGiveTheSameStatesBitForBit) {
  std::vector<MachineState> first, second;
  for (auto* states : {&first, &second}) {
    const auto replay = open();
    Drive::start(*replay);
    Drive::run(*replay, *states);
  }
  EXPECT_TRUE(bit_equal(first, second));
  EXPECT_EQ(first.size(), 400U);
  first[17].rate[3] += 1e-12;
  EXPECT_FALSE(bit_equal(first, second)) << "the comparison must see it";
}

TEST_F(ReplayOfADrive, TheStatesAreThoseOfTheDrive) {
  const auto replay = open();
  std::vector<MachineState> states;
  Drive::start(*replay);
  Drive::run(*replay, states);
  // The moment of activation is seen a tick earlier or later; from there on they are the same.
  std::size_t shift = 0;
  while (shift < live_.size() && live_[shift].t_s < states.front().t_s) ++shift;
  std::size_t start = 0;
  while (start < states.size() && states[start].t_s < live_.front().t_s) ++start;
  long compared = 0;
  for (std::size_t i = 0; i + std::max(shift, start) < states.size(); ++i) {
    const MachineState &a = live_[i + shift], &b = states[i + start];
    ASSERT_EQ(a.t_s, b.t_s);
    ASSERT_EQ(a.position, b.position) << "at " << a.t_s;
    ASSERT_EQ(a.rate, b.rate);
    ASSERT_EQ(a.base, b.base);
    ++compared;
  }
  EXPECT_GT(compared, 350);
}

TEST_F(ReplayOfADrive, TheSameCommandsAgreeWithTheRecordedOnes) {
  const auto replay = open();
  std::vector<MachineState> states;
  Drive::start(*replay);
  while (replay->read().t_s < live_.front().t_s - 1e-9) {
    replay->wait_until(replay->read().t_s + 0.01);
  }
  Drive::run(*replay, states);
  const ReplayReport report = replay->report();
  EXPECT_GT(report.commands_compared, 300 * can::kNumZones);
  EXPECT_EQ(report.commands_unreadable, 0);
  EXPECT_EQ(report.frames_refused, 0);
  EXPECT_EQ(report.commands_differing, 0) << report.worst_joint;
  EXPECT_LT(report.max_rate_difference, 1e-4);
}

TEST_F(ReplayOfADrive, OtherCommandsAreReported) {
  const auto replay = open();
  std::vector<MachineState> states;
  Drive::start(*replay);
  Drive::run(*replay, states, 0.3);
  const ReplayReport report = replay->report();
  EXPECT_GT(report.commands_differing, 100);
  EXPECT_NEAR(report.max_rate_difference, 0.2, 0.1);
  EXPECT_NE(report.worst_joint.find("WHEEL"), std::string::npos) << report.worst_joint;
}

TEST_F(ReplayOfADrive, WhenTheLogIsOverTheStateGrowsOldAndWritesAreRejected) {
  const auto replay = open();
  Drive::start(*replay);
  replay->wait_until(1e6);
  EXPECT_TRUE(replay->finished());
  EXPECT_GT(replay->read().age_s, 1.0);
  EXPECT_EQ(replay->read().joint_quality[0], SignalQuality::kStale);
  EXPECT_EQ(replay->lifecycle(), Lifecycle::kInactive);
  JointCommand command;
  command.num_joints = machine()->num_joints();
  command.valid_until_s = 1e9;
  EXPECT_EQ(replay->write(command), WriteOutcome::kRejectedNotActive);
  EXPECT_FALSE(replay->activate());
}

TEST(ReplayMachine, ShowsAnEStopAndAFaultThatWereRecorded) {
  HostBench bench;
  bench.drive();
  bench.far.electronics().set_estop_chain(true);
  bench.wait(0.5);
  const std::string file = log_named("estop.log");
  ASSERT_TRUE(bench.host->recorder().write(file));
  const auto replay = ReplayMachine::open(file, *machine(), {0.0, 0.0}).value();
  ASSERT_TRUE(replay->activate());
  bool seen = false;
  while (!replay->finished()) {
    replay->wait_until(replay->read().t_s + 0.01);
    if (replay->lifecycle() == Lifecycle::kEStop) {
      seen = true;
      EXPECT_EQ(replay->health().level, HealthLevel::kFault);
    }
  }
  EXPECT_TRUE(seen);
}

TEST(ReplayMachine, ALogWithoutAMachineIsRefused) {
  const std::string file = log_named("foreign.log");
  std::ofstream(file) << "(1.000000) can0 123#00\n";
  const auto replay = ReplayMachine::open(file, *machine(), {0.0, 0.0});
  ASSERT_FALSE(replay);
  EXPECT_EQ(replay.error().code, ErrorCode::kBadInput);
  EXPECT_NE(replay.error().message.find(file), std::string::npos);
  EXPECT_FALSE(ReplayMachine::open("/no/such.log", *machine(), {0.0, 0.0}));
}

}  // namespace
}  // namespace wex
