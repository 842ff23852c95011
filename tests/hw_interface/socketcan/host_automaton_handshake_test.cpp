#include <gtest/gtest.h>

#include "tests/hw_interface/socketcan/host_automaton_fixture.hpp"

// From the request to a session, and everything that ends on the way.

namespace wex::can {
namespace {

TEST_F(HostAutomaton, TheHandshakeEndsInANewSession) {
  ask();
  EXPECT_EQ(out().request, HostRequest::kEnable);
  EXPECT_EQ(out().nonce, 77);
  EXPECT_EQ(out().challenge_echo, 0U);
  EXPECT_FALSE(out().send_commands);
  challenge();
  EXPECT_EQ(state_.phase, HostPhase::kProving);
  EXPECT_EQ(out().challenge_echo, 0xC0FFEEU);
  EXPECT_EQ(out().nonce, 77) << "the same through the handshake";
  prove();
  EXPECT_EQ(out().session, 0x5E55U);
  EXPECT_TRUE(out().send_commands);
  EXPECT_FALSE(out().live);
  in_.mode = MachineMode::kEnabled;
  step();
  EXPECT_EQ(state_.phase, HostPhase::kActive);
  EXPECT_TRUE(out().live);
}

TEST_F(HostAutomaton, WithoutARequestNothingIsEverEnabled) {
  step();
  in_.mode = MachineMode::kEnabled;
  in_.session = 0x5E55;
  steps(50);
  EXPECT_EQ(state_.phase, HostPhase::kInactive);
  EXPECT_EQ(out().request, HostRequest::kDisable) << "a session of nobody is to end";
  EXPECT_FALSE(out().send_commands);
}

TEST_F(HostAutomaton, ARequestCountsOnceAndOnlyWhenTheMachineIsReady) {
  in_.mode = MachineMode::kInit;
  step();
  in_.enable = true;
  step();
  EXPECT_EQ(state_.phase, HostPhase::kInactive);
  in_.mode = MachineMode::kReady;
  steps(5);
  EXPECT_EQ(state_.phase, HostPhase::kInactive);
}

TEST_F(HostAutomaton, ARequestUnderAStopIsIgnored) {
  step();
  in_.stop = true;
  in_.enable = true;
  step();
  EXPECT_EQ(state_.phase, HostPhase::kInactive);
  EXPECT_TRUE(out().send_stop);
}

TEST_F(HostAutomaton, AMachineThatDoesNotAnswerIsGivenUp) {
  ask();
  steps(99);
  EXPECT_EQ(state_.phase, HostPhase::kAsking);
  steps(3);
  EXPECT_EQ(state_.phase, HostPhase::kInactive);
  EXPECT_EQ(state_.cause, HostCause::kNoAnswer);
  EXPECT_EQ(out().nonce, 0);
}

TEST_F(HostAutomaton, AChallengeFromBeforeTheRequestDoesNotCount) {
  in_.challenge = 0xBAD;
  ask();
  challenge(0xBAD);
  EXPECT_EQ(state_.phase, HostPhase::kAsking);
  challenge(0xC0FFEE);
  EXPECT_EQ(state_.phase, HostPhase::kProving);
}

TEST_F(HostAutomaton, ASessionBeforeAnythingWasProvedIsAViolation) {
  ask();
  in_.mode = MachineMode::kEnabling;
  in_.session = 0x5E55;
  step();
  EXPECT_EQ(state_.phase, HostPhase::kInactive);
  EXPECT_EQ(state_.cause, HostCause::kHandshakeViolated);
}

TEST_F(HostAutomaton, AnotherChallengeInTheMiddleIsAViolation) {
  ask();
  challenge();
  challenge(0xBEEF);
  EXPECT_EQ(state_.phase, HostPhase::kInactive);
  EXPECT_EQ(state_.cause, HostCause::kHandshakeViolated);
}

TEST_F(HostAutomaton, ASessionThatChangesInTheMiddleIsAViolation) {
  ask();
  challenge();
  prove(1);
  in_.session = 2;
  step();
  EXPECT_EQ(state_.phase, HostPhase::kInactive);
  EXPECT_EQ(state_.cause, HostCause::kHandshakeViolated);
}

TEST_F(HostAutomaton, TheSessionOfLastTimeIsNotAccepted) {
  activate(0x5E55);
  machine_ready();
  step();
  ASSERT_EQ(state_.phase, HostPhase::kInactive);
  ask();
  challenge();
  prove(0x5E55);
  EXPECT_EQ(state_.phase, HostPhase::kInactive);
  EXPECT_EQ(state_.cause, HostCause::kHandshakeViolated);
}

TEST_F(HostAutomaton, EnabledBeforeTenNeutralCommandsIsAViolation) {
  ask();
  challenge();
  in_.challenge = 0;
  in_.session = 9;
  in_.neutral_sent = true;
  steps(8);
  in_.mode = MachineMode::kEnabled;
  step();
  EXPECT_EQ(state_.phase, HostPhase::kInactive);
  EXPECT_EQ(state_.cause, HostCause::kHandshakeViolated);
}

TEST_F(HostAutomaton, EnabledWithoutASessionIsAViolation) {
  ask();
  challenge();
  in_.challenge = 0;
  in_.neutral_sent = true;
  in_.mode = MachineMode::kEnabled;
  steps(12);
  EXPECT_EQ(state_.phase, HostPhase::kInactive);
}

TEST_F(HostAutomaton, TheHandshakeEndsWithTheMachineARestartAStopOrADisable) {
  const auto interruptions = {+[](HostInputs& in) { in.mode = MachineMode::kInit; },
                              +[](HostInputs& in) { in.restarted = true; },
                              +[](HostInputs& in) { in.stop = true; },
                              +[](HostInputs& in) { in.disable = true; }};
  for (const auto interrupt : interruptions) {
    in_ = HostInputs{};
    in_.complete = in_.dbc_matches = true;
    in_.mode = MachineMode::kReady;
    in_.nonce = 5;
    state_ = HostState{};
    ask();
    challenge();
    interrupt(in_);
    step();
    EXPECT_EQ(state_.phase, HostPhase::kInactive);
    EXPECT_FALSE(out().send_commands);
  }
}

TEST_F(HostAutomaton, ATooLongProofIsGivenUp) {
  ask();
  challenge();
  steps(102);
  EXPECT_EQ(state_.phase, HostPhase::kInactive);
  EXPECT_EQ(state_.cause, HostCause::kNoAnswer);
}

}  // namespace
}  // namespace wex::can
