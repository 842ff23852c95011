#include <gtest/gtest.h>

#include "tests/hw_interface/electronics/machine_automaton_fixture.hpp"

namespace wex::can {
namespace {

TEST_F(MachineAutomatonTest, ReadyNeedsEveryCondition) {
  step();
  EXPECT_EQ(mode(), MachineMode::kInit) << "no host yet";
  to_ready();
  for (bool SelfCheck::* condition :
       {&SelfCheck::sensors_valid, &SelfCheck::base_pose_valid, &SelfCheck::valves_neutral}) {
    check_.*condition = false;
    period();
    EXPECT_EQ(mode(), MachineMode::kInit);
    check_.*condition = true;
    period();
    EXPECT_EQ(mode(), MachineMode::kReady);
  }
  periods(10, false, false);
  EXPECT_EQ(mode(), MachineMode::kReady) << "100 ms without heartbeat";
  period(false, false);
  EXPECT_EQ(mode(), MachineMode::kInit);
}

TEST_F(MachineAutomatonTest, AHostWithAnotherDbcIsNoHost) {
  heartbeat_.dbc_hash = kHash + 1;
  periods(5);
  EXPECT_EQ(mode(), MachineMode::kInit);
}

TEST_F(MachineAutomatonTest, TheWholeHandshakeEnables) {
  to_challenge();
  EXPECT_EQ(mode(), MachineMode::kEnabling);
  period(false);
  EXPECT_EQ(mode(), MachineMode::kEnabling);
  EXPECT_EQ(automaton_.challenge(), 0u);
  EXPECT_NE(automaton_.session(), 0u) << "commands of the count carry it";
  periods(9);
  EXPECT_EQ(mode(), MachineMode::kEnabling);
  period();
  EXPECT_EQ(mode(), MachineMode::kEnabled);
  EXPECT_EQ(automaton_.fault_bits(), 0);
}

TEST_F(MachineAutomatonTest, ALevelAloneNeverEnables) {
  heartbeat_.request = HostRequest::kEnable;  // there since before the electronics were switched on
  heartbeat_.nonce = 3;
  periods(100);
  EXPECT_EQ(mode(), MachineMode::kReady);
}

TEST_F(MachineAutomatonTest, ARequestWithoutNonceIsNone) {
  to_ready();
  heartbeat_.request = HostRequest::kEnable;
  heartbeat_.nonce = 0;
  periods(20);
  EXPECT_EQ(mode(), MachineMode::kReady);
}

TEST_F(MachineAutomatonTest, WithoutEchoWithin200MsTheRequestEnds) {
  to_challenge();
  const std::int64_t start_ms = now_ms_;
  while (mode() == MachineMode::kEnabling && now_ms_ < start_ms + 1000) {
    now_ms_ += 10;
    heartbeat_.challenge_echo = 0;
    beat();
    commands();
    step();
  }
  EXPECT_EQ(now_ms_ - start_ms, 210);
  periods(50);
  EXPECT_EQ(mode(), MachineMode::kReady) << "an echo to nothing, and the level still there";
}

TEST_F(MachineAutomatonTest, ALateEchoIsNone) {
  to_challenge();
  heartbeat_.challenge_echo = automaton_.challenge();
  now_ms_ += 201;
  beat();
  EXPECT_EQ(mode(), MachineMode::kInit);
}

TEST_F(MachineAutomatonTest, AWrongEchoEndsTheRequest) {
  to_challenge();
  heartbeat_.challenge_echo = automaton_.challenge() + 1;
  beat();
  EXPECT_EQ(mode(), MachineMode::kInit);
  EXPECT_EQ(automaton_.challenge(), 0u);
}

TEST_F(MachineAutomatonTest, AnotherNonceEndsTheRequest) {
  to_challenge(9);
  heartbeat_.nonce = 10;
  heartbeat_.challenge_echo = automaton_.challenge();
  beat();
  EXPECT_EQ(mode(), MachineMode::kInit);
}

TEST_F(MachineAutomatonTest, TakingTheRequestBackEndsIt) {
  for (const HostRequest request : {HostRequest::kNone, HostRequest::kDisable}) {
    to_challenge();
    heartbeat_.request = request;
    beat();
    EXPECT_EQ(mode(), MachineMode::kInit);
  }
}

TEST_F(MachineAutomatonTest, CommandsThatAskForMotionDoNotEnable) {
  to_challenge();
  for (int i = 0; i < 100; ++i) {
    now_ms_ += 10;
    heartbeat_.challenge_echo = automaton_.challenge();
    beat();
    commands(false);
    step();
    ASSERT_NE(mode(), MachineMode::kEnabled);
  }
}

TEST_F(MachineAutomatonTest, OneZoneThatIsNotNeutralIsEnough) {
  to_challenge();
  for (int i = 0; i < 100; ++i) {
    now_ms_ += 10;
    heartbeat_.challenge_echo = automaton_.challenge();
    beat();
    for (int zone = 0; zone < kNumZones; ++zone) {
      automaton_.on_good_command(zone, zone != 4 || i % 10 != 9, now_ms_);
    }
    step();
    ASSERT_NE(mode(), MachineMode::kEnabled);
  }
}

TEST_F(MachineAutomatonTest, ABadCommandStartsTheCountAnew) {
  to_challenge();
  period(false);
  periods(9);
  automaton_.on_bad_command(2);
  periods(9);
  EXPECT_EQ(mode(), MachineMode::kEnabling);
  period();
  EXPECT_EQ(mode(), MachineMode::kEnabled);
}

TEST_F(MachineAutomatonTest, AGapStartsTheCountAnew) {
  to_challenge();
  period(false);
  periods(9);
  periods(5, false);
  periods(9);
  EXPECT_EQ(mode(), MachineMode::kEnabling);
  period();
  EXPECT_EQ(mode(), MachineMode::kEnabled);
}

TEST_F(MachineAutomatonTest, EnablingDoesNotWaitForEver) {
  to_challenge();
  periods(250, false);
  EXPECT_EQ(mode(), MachineMode::kReady);
  EXPECT_EQ(automaton_.session(), 0u);
}

TEST_F(MachineAutomatonTest, EnablingEndsWithWhatReadyNeeds) {
  for (bool SelfCheck::* condition : {&SelfCheck::sensors_valid, &SelfCheck::base_pose_valid}) {
    to_challenge();
    check_.*condition = false;
    period();
    EXPECT_EQ(mode(), MachineMode::kInit);
    check_.*condition = true;
  }
  to_challenge();
  automaton_.on_host_stop({true, 0}, now_ms_);
  period();
  EXPECT_EQ(mode(), MachineMode::kInit);
  automaton_.on_host_stop({false, 0}, now_ms_);
  to_challenge();
  periods(11, false, false);
  EXPECT_EQ(mode(), MachineMode::kInit);
}

TEST_F(MachineAutomatonTest, SilenceOfCommandsFor50MsHolds) {
  to_enabled();
  periods(4, false);
  EXPECT_EQ(mode(), MachineMode::kEnabled);
  const std::uint32_t session = automaton_.session();
  period(false);
  EXPECT_EQ(mode(), MachineMode::kHold);
  EXPECT_EQ(automaton_.session(), session) << "the session goes on";
  EXPECT_EQ(automaton_.holds(), 1);
}

TEST_F(MachineAutomatonTest, SilenceOfOneZoneHolds) {
  to_enabled();
  for (int i = 0; i < 5; ++i) {
    now_ms_ += 10;
    heartbeat_.session = automaton_.session();
    beat();
    for (int zone = 0; zone < kNumZones - 1; ++zone) {
      automaton_.on_good_command(zone, true, now_ms_);
    }
    step();
  }
  EXPECT_EQ(mode(), MachineMode::kHold);
}

TEST_F(MachineAutomatonTest, HoldIsLeftByTenGoodNeutralCommandsOfEveryZone) {
  to_enabled();
  periods(10, false);
  ASSERT_EQ(mode(), MachineMode::kHold);
  for (int i = 0; i < 20; ++i) {
    now_ms_ += 10;
    heartbeat_.session = automaton_.session();
    beat();
    commands(false);
    step();
    ASSERT_EQ(mode(), MachineMode::kHold) << "they ask for motion";
  }
  periods(9);
  EXPECT_EQ(mode(), MachineMode::kHold);
  period();
  EXPECT_EQ(mode(), MachineMode::kEnabled);
}

TEST_F(MachineAutomatonTest, HeartbeatsMissingFor100MsHoldAndFor500MsFault) {
  to_enabled();
  const std::int64_t last_heartbeat_ms = now_ms_;
  while (mode() == MachineMode::kEnabled) period(true, false);
  EXPECT_EQ(mode(), MachineMode::kHold);
  EXPECT_EQ(now_ms_ - last_heartbeat_ms, 110);
  while (mode() == MachineMode::kHold) period(true, false);
  EXPECT_TRUE(latched_with(kFaultHeartbeatLost));
  EXPECT_EQ(now_ms_ - last_heartbeat_ms, 510);
  periods(100);
  EXPECT_TRUE(latched_with(kFaultHeartbeatLost)) << "the host is back, a person is not";
}

TEST_F(MachineAutomatonTest, HeartbeatsOfAnotherSessionDoNotCount) {
  to_enabled();
  for (int i = 0; i < 60; ++i) {
    now_ms_ += 10;
    heartbeat_.session = automaton_.session() + 1;  // a host that has restarted
    beat();
    commands();
    step();
  }
  EXPECT_TRUE(latched_with(kFaultHeartbeatLost));
}

TEST_F(MachineAutomatonTest, TheHostsStopHoldsWhileItLasts) {
  to_enabled();
  for (int i = 0; i < 30; ++i) {
    automaton_.on_host_stop({true, 1}, now_ms_);
    period();
    ASSERT_EQ(mode(), MachineMode::kHold);
  }
  automaton_.on_host_stop({false, 0}, now_ms_);
  periods(1);
  EXPECT_EQ(mode(), MachineMode::kEnabled) << "good commands went on meanwhile";
}

TEST_F(MachineAutomatonTest, AHostStopThatIsNotRepeatedEnds) {
  to_enabled();
  automaton_.on_host_stop({true, 1}, now_ms_);
  periods(10);
  EXPECT_EQ(mode(), MachineMode::kHold);
  period();
  EXPECT_EQ(mode(), MachineMode::kEnabled);
}

TEST_F(MachineAutomatonTest, LosingTheBasePoseHolds) {
  to_enabled();
  check_.base_pose_valid = false;
  period();
  EXPECT_EQ(mode(), MachineMode::kHold);
}

TEST_F(MachineAutomatonTest, LosingTheSensorsFaults) {
  to_enabled();
  check_.sensors_valid = false;
  period();
  EXPECT_TRUE(latched_with(kFaultSensors));
  reset();
  EXPECT_EQ(mode(), MachineMode::kFault) << "the cause is still there";
  check_.sensors_valid = true;
  reset();
  EXPECT_EQ(mode(), MachineMode::kInit);
  EXPECT_EQ(automaton_.fault_bits(), 0);
}

TEST_F(MachineAutomatonTest, DisablingEndsTheSession) {
  for (const bool holding : {false, true}) {
    to_enabled();
    if (holding) periods(10, false);
    heartbeat_.session = automaton_.session();
    heartbeat_.request = HostRequest::kDisable;
    beat();
    EXPECT_EQ(mode(), MachineMode::kInit);
    EXPECT_EQ(automaton_.session(), 0u);
    periods(20);
    EXPECT_EQ(mode(), MachineMode::kReady);
  }
}

TEST_F(MachineAutomatonTest, EverySessionIsAnother) {
  to_enabled();
  const std::uint32_t first = automaton_.session();
  heartbeat_.session = first;
  heartbeat_.request = HostRequest::kDisable;
  beat();
  to_enabled();
  EXPECT_NE(automaton_.session(), first);
}

TEST_F(MachineAutomatonTest, MoreThanThreeCrcErrorsInASecondFault) {
  to_enabled();
  for (const int gap_ms : {0, 500, 499}) {
    now_ms_ += gap_ms;
    automaton_.on_crc_error(now_ms_);
    EXPECT_NE(mode(), MachineMode::kFault);
  }
  now_ms_ += 2;
  automaton_.on_crc_error(now_ms_);
  EXPECT_NE(mode(), MachineMode::kFault) << "the first of the four is 1001 ms ago";
  now_ms_ += 1;
  automaton_.on_crc_error(now_ms_);
  EXPECT_TRUE(latched_with(kFaultCrcErrors));
}

TEST_F(MachineAutomatonTest, ThreeRangeRejectsIn100MsFault) {
  to_enabled();
  automaton_.on_range_reject(now_ms_);
  automaton_.on_range_reject(now_ms_ + 60);
  EXPECT_EQ(mode(), MachineMode::kEnabled);
  automaton_.on_range_reject(now_ms_ + 101);
  EXPECT_EQ(mode(), MachineMode::kEnabled);
  automaton_.on_range_reject(now_ms_ + 160);
  EXPECT_TRUE(latched_with(kFaultRangeRejects));
}

TEST_F(MachineAutomatonTest, OneMasqueradeFaultsInEveryMode) {
  automaton_.on_masquerade(now_ms_);
  EXPECT_TRUE(latched_with(kFaultMasquerade));
  reset();
  EXPECT_EQ(mode(), MachineMode::kFault) << "not before the bus has been quiet for a second";
  now_ms_ += 999;
  reset();
  EXPECT_EQ(mode(), MachineMode::kFault);
  now_ms_ += 1;
  reset();
  EXPECT_EQ(mode(), MachineMode::kInit);
  to_enabled();
  automaton_.on_masquerade(now_ms_);
  EXPECT_TRUE(latched_with(kFaultMasquerade));
}

TEST_F(MachineAutomatonTest, TheEStopChainLatchesFromEveryMode) {
  for (const int from : {0, 1, 2, 3, 4}) {
    if (from == 1) to_ready();
    if (from == 2) to_challenge();
    if (from >= 3) to_enabled();
    if (from == 4) automaton_.on_masquerade(now_ms_);
    check_.estop_chain_open = true;
    now_ms_ += 10;
    step();
    EXPECT_EQ(mode(), MachineMode::kEStop) << from;
    EXPECT_EQ(automaton_.session(), 0u);
    EXPECT_NE(automaton_.fault_bits() & kFaultEStopChain, 0);
    now_ms_ += 1000;
    reset();
    EXPECT_EQ(mode(), MachineMode::kEStop) << "still open";
    check_.estop_chain_open = false;
    periods(20);
    EXPECT_EQ(mode(), MachineMode::kEStop) << "closed, but nobody has reset it";
    reset();
    EXPECT_EQ(mode(), MachineMode::kInit);
    EXPECT_EQ(automaton_.fault_bits(), 0);
  }
}

TEST_F(MachineAutomatonTest, AFaultInEStopDoesNotLeaveIt) {
  check_.estop_chain_open = true;
  step();
  automaton_.on_masquerade(now_ms_);
  EXPECT_EQ(mode(), MachineMode::kEStop);
  EXPECT_EQ(automaton_.fault_bits(), kFaultEStopChain | kFaultMasquerade);
}

TEST_F(MachineAutomatonTest, TheOperatorsStopLatches) {
  to_enabled();
  operator_does(OperatorAction::kStop);
  period();
  EXPECT_EQ(mode(), MachineMode::kEStop);
  EXPECT_EQ(automaton_.fault_bits(), kFaultOperatorStop);
  periods(200);
  EXPECT_EQ(mode(), MachineMode::kEStop);
  operator_does(OperatorAction::kReset);
  step();
  EXPECT_EQ(mode(), MachineMode::kEStop) << "no frame without action between stop and reset";
  reset();
  EXPECT_EQ(mode(), MachineMode::kInit);
}

TEST_F(MachineAutomatonTest, AStopBesideAResetWins) {
  to_enabled();
  operator_does(OperatorAction::kStop);
  period();
  operator_does(OperatorAction::kNone);
  operator_does(OperatorAction::kReset);
  operator_does(OperatorAction::kStop);
  step();
  EXPECT_EQ(mode(), MachineMode::kEStop);
}

TEST_F(MachineAutomatonTest, ResetNeedsAnEdge) {
  automaton_.on_masquerade(now_ms_);
  now_ms_ += 2000;
  for (int i = 0; i < 50; ++i) {
    now_ms_ += 10;
    operator_does(OperatorAction::kReset);
    step();
    ASSERT_EQ(mode(), MachineMode::kFault) << "a level, from the first frame on";
  }
  operator_does(OperatorAction::kNone);
  now_ms_ += 1001;
  operator_does(OperatorAction::kReset);
  step();
  EXPECT_EQ(mode(), MachineMode::kFault) << "the frame before is too old";
  reset();
  EXPECT_EQ(mode(), MachineMode::kInit);
}

TEST_F(MachineAutomatonTest, AnEdgeIsUsedUpByTheNextStep) {
  operator_does(OperatorAction::kNone);
  operator_does(OperatorAction::kReset);
  step();
  automaton_.on_masquerade(now_ms_);
  now_ms_ += 2000;
  step();
  EXPECT_EQ(mode(), MachineMode::kFault) << "reset before there was anything to reset";
}

TEST_F(MachineAutomatonTest, AResetNeverEnables) {
  to_enabled();
  automaton_.on_masquerade(now_ms_);
  now_ms_ += 1000;
  reset();
  periods(100);  // the host still asks, and sends good commands
  EXPECT_EQ(mode(), MachineMode::kReady);
}

}  // namespace
}  // namespace wex::can
