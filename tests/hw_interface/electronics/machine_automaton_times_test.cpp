#include <gtest/gtest.h>

#include "tests/hw_interface/electronics/machine_automaton_fixture.hpp"

// To the millisecond and to the frame: when each time-out bites, and where counts begin again.

namespace wex::can {
namespace {

TEST_F(MachineAutomatonTest, NewItKnowsNothingAndPermitsNothing) {
  EXPECT_EQ(mode(), MachineMode::kInit);
  EXPECT_EQ(automaton_.fault_bits(), 0);
  EXPECT_EQ(automaton_.challenge(), 0u);
  EXPECT_EQ(automaton_.session(), 0u);
  EXPECT_EQ(automaton_.holds(), 0);
  const SelfCheck unknown;
  EXPECT_FALSE(unknown.sensors_valid || unknown.base_pose_valid || unknown.valves_neutral);
  EXPECT_TRUE(unknown.estop_chain_open);
}

TEST_F(MachineAutomatonTest, ItsClockMayBeginAtZero) {
  now_ms_ = 0;
  step();
  EXPECT_EQ(mode(), MachineMode::kInit) << "no heartbeat yet, not one of just now";
  to_enabled();
}

TEST_F(MachineAutomatonTest, NothingIsLeftOverFromBeforeItsFirstStep) {
  now_ms_ = 0;
  automaton_.on_masquerade(now_ms_);
  now_ms_ += 1000;
  step();
  EXPECT_EQ(mode(), MachineMode::kFault) << "no edge without an operator";
  operator_does(OperatorAction::kReset);
  step();
  EXPECT_EQ(mode(), MachineMode::kFault) << "the first frame ever is no edge";
}

TEST_F(MachineAutomatonTest, TheFaultBitsAreThoseOfTheBus) {
  EXPECT_EQ(kFaultHeartbeatLost, 0x01);
  EXPECT_EQ(kFaultCrcErrors, 0x02);
  EXPECT_EQ(kFaultRangeRejects, 0x04);
  EXPECT_EQ(kFaultMasquerade, 0x08);
  EXPECT_EQ(kFaultSensors, 0x10);
  EXPECT_EQ(kFaultEStopChain, 0x20);
  EXPECT_EQ(kFaultOperatorStop, 0x40);
}

TEST_F(MachineAutomatonTest, AnEchoAfter200MsIsInTime) {
  to_challenge();
  heartbeat_.challenge_echo = automaton_.challenge();
  now_ms_ += 200;
  beat();
  EXPECT_NE(automaton_.session(), 0u);
}

TEST_F(MachineAutomatonTest, TheHostMayGoOnEchoing) {
  to_challenge();
  heartbeat_.challenge_echo = automaton_.challenge();
  for (int i = 0; i < 11; ++i) {
    now_ms_ += 10;
    beat();
    if (i > 0) commands();
    step();
  }
  EXPECT_EQ(mode(), MachineMode::kEnabled);
}

TEST_F(MachineAutomatonTest, EnablingLasts2000MsFromTheEcho) {
  to_challenge();
  now_ms_ += 100;
  heartbeat_.challenge_echo = automaton_.challenge();
  beat();
  now_ms_ += 2000;
  beat();
  step();
  EXPECT_EQ(mode(), MachineMode::kEnabling);
  now_ms_ += 1;
  step();
  EXPECT_EQ(mode(), MachineMode::kInit);
}

TEST_F(MachineAutomatonTest, SilenceWhileEnablingIsNoFault) {
  to_challenge();
  now_ms_ += 600;
  step();
  EXPECT_EQ(mode(), MachineMode::kInit);
  EXPECT_EQ(automaton_.fault_bits(), 0);
}

TEST_F(MachineAutomatonTest, CommandsLastFor50Ms) {
  to_enabled();
  now_ms_ += 49;
  step();
  EXPECT_EQ(mode(), MachineMode::kEnabled);
  now_ms_ += 1;
  step();
  EXPECT_EQ(mode(), MachineMode::kHold);
  EXPECT_EQ(automaton_.holds(), 1);
  periods(5, false);
  EXPECT_EQ(automaton_.holds(), 1) << "one hold, however long";
}

TEST_F(MachineAutomatonTest, AGapOf50MsStartsTheCountAnew) {
  for (const int gap_ms : {49, 50}) {
    to_challenge();
    period(false);
    periods(9);
    now_ms_ += gap_ms - 10;
    period();
    EXPECT_EQ(mode() == MachineMode::kEnabled, gap_ms == 49);
    heartbeat_.session = automaton_.session();
    heartbeat_.request = HostRequest::kDisable;
    beat();
  }
}

TEST_F(MachineAutomatonTest, HeartbeatsLastFor100AndFor500Ms) {
  to_enabled();
  const std::int64_t last_ms = now_ms_;
  const auto mode_after = [&](int age_ms) {
    now_ms_ = last_ms + age_ms;
    commands();
    step();
    return mode();
  };
  for (int age_ms = 10; age_ms < 100; age_ms += 10) mode_after(age_ms);
  EXPECT_EQ(mode_after(100), MachineMode::kEnabled);
  EXPECT_EQ(mode_after(101), MachineMode::kHold);
  EXPECT_EQ(mode_after(500), MachineMode::kHold);
  EXPECT_EQ(mode_after(501), MachineMode::kFault);
}

TEST_F(MachineAutomatonTest, HeartbeatsOfTheSessionAreAwaitedFromItsBeginning) {
  to_challenge();
  period(false);
  periods(4);
  periods(6, true, false);
  ASSERT_EQ(mode(), MachineMode::kEnabled) << "the last heartbeat is 60 ms old";
  periods(10, true, false);
  EXPECT_EQ(mode(), MachineMode::kEnabled);
  period(true, false);
  EXPECT_EQ(mode(), MachineMode::kHold);
}

TEST_F(MachineAutomatonTest, AHostStopLastsFor100Ms) {
  to_enabled();
  std::int64_t last_ms = 0;
  for (int i = 0; i < 30; ++i) {
    last_ms = now_ms_;
    automaton_.on_host_stop({true, 1}, now_ms_);
    period();
  }
  while (now_ms_ < last_ms + 100) period();
  EXPECT_EQ(mode(), MachineMode::kHold);
  now_ms_ += 1;
  step();
  EXPECT_EQ(mode(), MachineMode::kEnabled) << "good commands went on meanwhile";
}

TEST_F(MachineAutomatonTest, EveryHoldIsLeftByTenGoodCommands) {
  to_enabled();
  check_.base_pose_valid = false;
  period();
  check_.base_pose_valid = true;
  periods(9);
  EXPECT_EQ(mode(), MachineMode::kHold) << "those before the hold do not count";
  period();
  EXPECT_EQ(mode(), MachineMode::kEnabled);
}

TEST_F(MachineAutomatonTest, ARequestToDisableDoesNotLeaveFaultOrEStop) {
  heartbeat_.request = HostRequest::kDisable;
  automaton_.on_masquerade(now_ms_);
  periods(3);
  EXPECT_EQ(mode(), MachineMode::kFault);
  check_.estop_chain_open = true;
  periods(3);
  EXPECT_EQ(mode(), MachineMode::kEStop);
}

TEST_F(MachineAutomatonTest, AResetInASessionIsNone) {
  to_enabled();
  reset();
  EXPECT_EQ(mode(), MachineMode::kEnabled);
}

TEST_F(MachineAutomatonTest, AnEdgeOutlastsTheFramesBeforeTheNextStep) {
  automaton_.on_masquerade(now_ms_);
  now_ms_ += 1000;
  operator_does(OperatorAction::kNone);
  now_ms_ += 1000;
  operator_does(OperatorAction::kReset);  // exactly a second after the frame without action
  operator_does(OperatorAction::kNone);
  step();
  EXPECT_EQ(mode(), MachineMode::kInit);
}

TEST_F(MachineAutomatonTest, TheWindowsOfBadFramesAreAsLongAsTheySay) {
  const auto crc_errors = [&](std::int64_t last_ms) {
    automaton_ = MachineAutomaton(kHash, random_);
    for (const std::int64_t t_ms : {std::int64_t{0}, std::int64_t{1}, std::int64_t{2}, last_ms}) {
      automaton_.on_crc_error(now_ms_ + t_ms);
    }
    return mode();
  };
  EXPECT_EQ(crc_errors(1000), MachineMode::kFault);
  EXPECT_EQ(crc_errors(1001), MachineMode::kInit);
  const auto range_rejects = [&](std::int64_t last_ms) {
    automaton_ = MachineAutomaton(kHash, random_);
    for (const std::int64_t t_ms : {std::int64_t{0}, std::int64_t{1}, last_ms}) {
      automaton_.on_range_reject(now_ms_ + t_ms);
    }
    return mode();
  };
  EXPECT_EQ(range_rejects(100), MachineMode::kFault);
  EXPECT_EQ(range_rejects(101), MachineMode::kInit);
}

TEST_F(MachineAutomatonTest, AfterAResetBadFramesAreCountedAnew) {
  AutomatonSettings settings;
  settings.quiet_before_reset_ms = 10;
  automaton_ = MachineAutomaton(kHash, random_, settings);
  const auto cause = [&](bool crc) {
    crc ? automaton_.on_crc_error(now_ms_) : automaton_.on_range_reject(now_ms_);
  };
  for (const bool crc : {true, false}) {
    for (int i = 0; i < 4; ++i) cause(crc);
    ASSERT_EQ(mode(), MachineMode::kFault);
    now_ms_ += 9;
    reset();
    EXPECT_EQ(mode(), MachineMode::kFault) << "not quiet long enough";
    now_ms_ += 1;
    reset();
    EXPECT_EQ(mode(), MachineMode::kInit);
    cause(crc);
    EXPECT_EQ(mode(), MachineMode::kInit);
  }
}

}  // namespace
}  // namespace wex::can
