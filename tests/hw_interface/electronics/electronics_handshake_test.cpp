#include "tests/hw_interface/electronics/electronics_bench.hpp"

// Attacks on the way to kEnabled: whatever is wrong, the machine is never enabled and nothing
// moves.

namespace wex::can {
namespace {

class HandshakeTest : public ::testing::Test {
 protected:
  /// Ten seconds in which the host goes on as the test has set it up.
  void expect_never_enabled(int periods = 1000) {
    for (int i = 0; i < periods; ++i) {
      bench_.step();
      ASSERT_NE(bench_.mode(), MachineMode::kEnabled);
      ASSERT_FALSE(bench_.plant.last_input.motion_released);
    }
    EXPECT_EQ(bench_.plant.fastest_rate(), 0.0);
    EXPECT_EQ(bench_.electronics->counters().commands_accepted, 0);
  }

  ElectronicsBench bench_;
};

TEST_F(HandshakeTest, DoneRightItEnablesWithinHalfASecond) {
  bench_.ask_for_enable();
  const std::int64_t start_ms = bench_.now_ms;
  bench_.enable();
  EXPECT_LT(bench_.now_ms - start_ms, 500);
  EXPECT_EQ(bench_.status.session, bench_.electronics->automaton().session());
  EXPECT_EQ(bench_.electronics->counters().crc_errors, 0);
  EXPECT_EQ(bench_.electronics->counters().sequence_errors, 0);
  EXPECT_EQ(bench_.plant.fastest_rate(), 0.0) << "bumpless";
}

TEST_F(HandshakeTest, AMissingEchoDoesNotEnable) {
  bench_.echoes = false;
  bench_.ask_for_enable();
  expect_never_enabled();
}

TEST_F(HandshakeTest, AWrongEchoDoesNotEnable) {
  bench_.echoes = false;
  bench_.ask_for_enable();
  for (int i = 0; i < 200; ++i) {
    bench_.heartbeat.challenge_echo = bench_.status.challenge ^ 1u;
    bench_.step();
    ASSERT_NE(bench_.mode(), MachineMode::kEnabled);
  }
}

TEST_F(HandshakeTest, AChangingNonceDoesNotEnable) {
  bench_.ask_for_enable();
  for (int i = 0; i < 1000; ++i) {
    ++bench_.heartbeat.nonce;
    bench_.step();
    ASSERT_NE(bench_.mode(), MachineMode::kEnabled);
  }
}

TEST_F(HandshakeTest, ANonceOfZeroDoesNotEnable) {
  bench_.ask_for_enable(0);
  expect_never_enabled();
}

TEST_F(HandshakeTest, AnotherDbcDoesNotEnable) {
  bench_.heartbeat.dbc_hash ^= 1;
  bench_.ask_for_enable();
  expect_never_enabled();
  EXPECT_EQ(bench_.mode(), MachineMode::kInit);
}

TEST_F(HandshakeTest, CommandsOfNoSessionDoNotEnable) {
  bench_.ask_for_enable();
  for (int i = 0; i < 1000; ++i) {
    const std::uint32_t session = std::exchange(bench_.status.session, 0u);
    bench_.step();
    ASSERT_NE(bench_.mode(), MachineMode::kEnabled) << session;
  }
}

TEST_F(HandshakeTest, CommandsThatAskForMotionDoNotEnable) {
  bench_.set_rate(0, 1, 0.05);
  bench_.ask_for_enable();
  expect_never_enabled();
}

TEST_F(HandshakeTest, CommandsFromOldFeedbackDoNotEnable) {
  bench_.echo_age_ms = 100;
  bench_.ask_for_enable();
  expect_never_enabled();
}

TEST_F(HandshakeTest, AMissingZoneDoesNotEnable) {
  bench_.on_the_wire = [](CanFrame& frame) {
    return kind_of(frame) != MessageKind::kZoneCommand || zone_of(frame) != 3;
  };
  bench_.ask_for_enable();
  expect_never_enabled();
}

TEST_F(HandshakeTest, NoBasePoseNoEnable) {
  bench_.plant.state().base_pose_valid = false;
  bench_.ask_for_enable();
  expect_never_enabled();
}

TEST_F(HandshakeTest, NoSensorsNoEnable) {
  bench_.plant.state().sensors_valid = false;
  bench_.ask_for_enable();
  expect_never_enabled();
}

TEST_F(HandshakeTest, AnOpenChainDoesNotEnable) {
  bench_.electronics->set_estop_chain(true);
  bench_.ask_for_enable();
  expect_never_enabled();
}

TEST_F(HandshakeTest, AHandshakeThatIsPlayedAgainDoesNotEnable) {
  std::vector<std::vector<CanFrame>> recording(1);
  bench_.on_the_wire = [&](CanFrame& frame) {
    recording.back().push_back(frame);
    return true;
  };
  bench_.ask_for_enable();
  for (int i = 0; i < 60; ++i) {
    bench_.step();
    recording.emplace_back();
  }
  ASSERT_EQ(bench_.mode(), MachineMode::kEnabled);

  // The same frames, to electronics that have restarted and to others with another past.
  for (const std::uint64_t seed : {1000u, 2000u}) {
    ElectronicsBench other(seed);
    other.send_heartbeat = other.send_commands = false;
    for (int repetition = 0; repetition < 3; ++repetition) {
      for (const auto& frames : recording) {
        for (const CanFrame& frame : frames) other.port.inbox.push_back(frame);
        other.step();
        ASSERT_NE(other.mode(), MachineMode::kEnabled);
      }
    }
    EXPECT_EQ(other.electronics->counters().commands_accepted, 0);
  }
}

TEST_F(HandshakeTest, CommandsOfTheSessionBeforeAreNotUsed) {
  std::vector<CanFrame> old;
  bench_.enable();
  bench_.on_the_wire = [&](CanFrame& frame) {
    if (kind_of(frame) == MessageKind::kZoneCommand) old.push_back(frame);
    return true;
  };
  bench_.ramp(0, 1, 0.1);
  bench_.heartbeat.request = HostRequest::kDisable;
  bench_.commands = {};
  bench_.steps(20);
  ASSERT_NE(bench_.mode(), MachineMode::kEnabled);

  bench_.on_the_wire = [](CanFrame&) { return true; };
  bench_.enable();
  const ElectronicsCounters before = bench_.electronics->counters();
  for (const CanFrame& frame : old) bench_.port.inbox.push_back(frame);
  bench_.step();
  const ElectronicsCounters& after = bench_.electronics->counters();
  EXPECT_EQ(after.commands_accepted - before.commands_accepted, kNumZones) << "those of now";
  EXPECT_EQ(after.other_session - before.other_session, static_cast<long>(old.size()));
  EXPECT_EQ(bench_.mode(), MachineMode::kEnabled) << "old is not corrupted: no fault";
  bench_.steps(5);
  EXPECT_LT(bench_.plant.fastest_rate(), 1e-4);
}

TEST_F(HandshakeTest, ARestartOfTheElectronicsEndsTheSession) {
  bench_.enable();
  bench_.ramp(0, 1, 0.1);
  // New electronics on the same bus; the host has not noticed and goes on.
  bench_.electronics =
      Electronics::create(m545(), bench_.plant, bench_.port, bench_.random).value();
  bench_.follows_session = false;
  for (int i = 0; i < 200; ++i) {
    bench_.step();
    ASSERT_NE(bench_.mode(), MachineMode::kEnabled);
  }
  EXPECT_EQ(bench_.electronics->counters().commands_accepted, 0);
}

}  // namespace
}  // namespace wex::can
