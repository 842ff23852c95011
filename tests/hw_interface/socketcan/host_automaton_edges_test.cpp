#include <gtest/gtest.h>

#include "tests/hw_interface/socketcan/host_automaton_fixture.hpp"

// Every limit where it begins, every phase, and what is left over from before.

namespace wex::can {
namespace {

TEST_F(HostAutomaton, NewItHasNoSessionAndSaysNothing) {
  EXPECT_EQ(state_.phase, HostPhase::kUnconfigured);
  EXPECT_EQ(state_.cause, HostCause::kNone);
  EXPECT_EQ(state_.nonce, 0);
  EXPECT_EQ(state_.challenge, 0U);
  EXPECT_EQ(state_.old_challenge, 0U);
  EXPECT_EQ(state_.session, 0U);
  EXPECT_EQ(state_.old_session, 0U);
  EXPECT_EQ(state_.since_s, 0.0);
  EXPECT_EQ(state_.neutral_frames, 0);
  EXPECT_EQ(state_.holds, 0);
  EXPECT_LT(state_.reset_until_s, 0.0);
  const HostOutputs silent = outputs_of(HostState{}, HostInputs{});
  EXPECT_EQ(silent.request, HostRequest::kNone);
  EXPECT_EQ(silent.nonce, 0);
  EXPECT_EQ(silent.challenge_echo, 0U);
  EXPECT_EQ(silent.session, 0U);
  EXPECT_FALSE(silent.send_commands || silent.live || silent.send_stop || silent.silent);
}

TEST_F(HostAutomaton, WhatIsNotKnownIsNotGood) {
  const HostInputs in;
  EXPECT_FALSE(in.complete || in.dbc_matches || in.enable || in.neutral_sent);
  EXPECT_FALSE(in.disable || in.stop || in.operator_reset || in.operator_stopped || in.estop_open);
  EXPECT_FALSE(in.bus_stalled || in.bus_off_reported || in.overflowed || in.masquerade);
  EXPECT_FALSE(in.crc_fault || in.restarted || in.interface_lost);
  EXPECT_EQ(in.mode, MachineMode::kInit);
  EXPECT_EQ(in.session, 0U);
  EXPECT_EQ(in.challenge, 0U);
  EXPECT_EQ(in.nonce, 0);
  EXPECT_EQ(in.now_s, 0.0);
  EXPECT_EQ(in.feedback_age_s + in.status_age_s + in.estop_age_s, 0.0);
}

TEST_F(HostAutomaton, WhatNothingFollowsFromIsNeitherSentNorMoved) {
  const HostOutputs nothing;
  EXPECT_EQ(nothing.request, HostRequest::kNone);
  EXPECT_EQ(nothing.session, 0U);
  EXPECT_FALSE(nothing.send_commands || nothing.live || nothing.send_stop || nothing.silent);
}

TEST_F(HostAutomaton, AgesCountFromAMicrosecondBeforeTheirLimit) {
  struct Case {
    double HostInputs::* age;
    double limit_s;
  };
  for (const Case& c :
       {Case{&HostInputs::feedback_age_s, 0.05}, Case{&HostInputs::status_age_s, 0.25},
        Case{&HostInputs::estop_age_s, 0.1}}) {
    activate();
    in_.*c.age = c.limit_s - 1.1e-6;
    step();
    EXPECT_EQ(state_.phase, HostPhase::kActive) << c.limit_s;
    in_.*c.age = c.limit_s - 1e-6;
    step();
    EXPECT_EQ(state_.phase, HostPhase::kHold) << c.limit_s;
    in_ = HostInputs{};
    state_ = HostState{};
    in_.complete = in_.dbc_matches = true;
    in_.mode = MachineMode::kReady;
    in_.nonce = 77;
  }
}

TEST_F(HostAutomaton, ALostInterfaceIsAFaultOnTheWayToMotionOnly) {
  const auto lost_in = [](HostPhase phase) {
    HostState state;
    state.phase = phase;
    HostInputs in;
    in.complete = in.dbc_matches = true;
    in.mode = MachineMode::kEnabled;
    in.interface_lost = true;
    return advance(state, in, HostTimes{}).phase == HostPhase::kFault;
  };
  EXPECT_FALSE(lost_in(HostPhase::kUnconfigured));
  EXPECT_FALSE(lost_in(HostPhase::kInactive));
  EXPECT_TRUE(lost_in(HostPhase::kAsking));
  EXPECT_TRUE(lost_in(HostPhase::kProving));
  EXPECT_TRUE(lost_in(HostPhase::kActive));
  EXPECT_TRUE(lost_in(HostPhase::kHold));
  EXPECT_FALSE(lost_in(HostPhase::kEStop)) << "latched already, and stricter";
}

TEST_F(HostAutomaton, NothingOfASessionIsLeftAfterIt) {
  activate();
  in_.disable = true;
  step();
  EXPECT_EQ(state_.session, 0U);
  EXPECT_EQ(state_.challenge, 0U);
  EXPECT_EQ(state_.nonce, 0);
  EXPECT_EQ(state_.neutral_frames, 0);
  EXPECT_EQ(state_.old_session, 0x5E55U);
}

TEST_F(HostAutomaton, AnySessionButZeroIsOne) {
  for (const std::uint32_t session : {1U, 0xFFFFFFFFU}) {
    activate(session);
    EXPECT_TRUE(out().send_commands);
    EXPECT_EQ(out().session, session);
    machine_ready();
    step();
    ASSERT_EQ(state_.phase, HostPhase::kInactive);
  }
}

TEST_F(HostAutomaton, AnyNonceButZeroIsOne) {
  step();
  in_.nonce = 0;
  in_.enable = true;
  step();
  EXPECT_EQ(state_.phase, HostPhase::kInactive);
  in_.nonce = 1;
  ask();
  EXPECT_EQ(out().nonce, 1);
}

TEST_F(HostAutomaton, AChallengeCountsWhenItIsNewAndTheMachineIsEnabling) {
  in_.challenge = 0xBAD;
  ask();
  challenge(0);
  EXPECT_EQ(state_.phase, HostPhase::kAsking) << "another than before, but none";
  in_.mode = MachineMode::kReady;
  in_.challenge = 0xC0FFEE;
  step();
  EXPECT_EQ(state_.phase, HostPhase::kAsking) << "the machine is not enabling";
  challenge(0xC0FFEE);
  EXPECT_EQ(state_.phase, HostPhase::kProving);
  EXPECT_FALSE(out().send_commands) << "without a session they would be refused";
}

TEST_F(HostAutomaton, ExactlyTenNeutralCommandsWithinTheSessionProveIt) {
  ask();
  challenge();
  in_.neutral_sent = true;
  steps(10);  // no session yet: these do not count
  in_.challenge = 0;
  in_.session = 9;
  steps(9);
  const HostState nine = state_;
  in_.mode = MachineMode::kEnabled;
  step();
  EXPECT_EQ(state_.phase, HostPhase::kActive);
  state_ = nine;
  in_.neutral_sent = false;
  step();
  EXPECT_EQ(state_.cause, HostCause::kHandshakeViolated) << "nine are not ten";
}

TEST_F(HostAutomaton, EveryStepOfTheHandshakeHasItsOwnSecond) {
  ask();
  steps(50);
  challenge();
  steps(99);
  EXPECT_EQ(state_.phase, HostPhase::kProving);
  steps(3);
  EXPECT_EQ(state_.phase, HostPhase::kInactive);
}

TEST_F(HostAutomaton, AnAnswerAfterExactlyASecondIsInTime) {
  state_.phase = HostPhase::kAsking;
  in_.now_s = 1.0;
  EXPECT_EQ(advance(state_, in_, times_).phase, HostPhase::kAsking);
  in_.now_s = 1.0 + 1e-9;
  EXPECT_EQ(advance(state_, in_, times_).phase, HostPhase::kInactive);
}

TEST_F(HostAutomaton, TheRequestStandsThroughTheSession) {
  ask();
  EXPECT_EQ(out().request, HostRequest::kEnable);
  challenge();
  EXPECT_EQ(out().request, HostRequest::kEnable);
  prove();
  in_.mode = MachineMode::kEnabled;
  step();
  ASSERT_EQ(state_.phase, HostPhase::kActive);
  EXPECT_EQ(out().request, HostRequest::kEnable);
  in_.stop = true;
  step();
  ASSERT_EQ(state_.phase, HostPhase::kHold);
  EXPECT_EQ(out().request, HostRequest::kEnable);
}

TEST_F(HostAutomaton, DisablingOrStoppingTakesTheRequestBack) {
  for (const bool stop : {false, true}) {
    ask();
    (stop ? in_.stop : in_.disable) = true;
    step();
    EXPECT_EQ(state_.phase, HostPhase::kInactive);
    EXPECT_EQ(state_.cause, HostCause::kNone);
  }
}

TEST_F(HostAutomaton, AHoldOfTheMachineIsLeftAfterTenNeutralCommandsToo) {
  activate();
  in_.mode = MachineMode::kHold;
  step();
  ASSERT_EQ(state_.phase, HostPhase::kHold);
  EXPECT_FALSE(out().silent) << "neutral commands are what lets it go on";
  in_.mode = MachineMode::kEnabled;
  in_.neutral_sent = true;
  steps(9);
  EXPECT_EQ(state_.phase, HostPhase::kHold);
  step();
  EXPECT_EQ(state_.phase, HostPhase::kActive);
}

TEST_F(HostAutomaton, AStopTakesEffectWithinItsCycle) {
  activate();
  in_.stop = true;
  EXPECT_FALSE(outputs_of(state_, in_).live);
  EXPECT_TRUE(outputs_of(state_, in_).send_stop);
}

TEST_F(HostAutomaton, WhatIsLostWhileInactiveIsLookedForAgain) {
  const auto losses = {+[](HostInputs& in) { in.complete = false; },
                       +[](HostInputs& in) { in.dbc_matches = false; },
                       +[](HostInputs& in) { in.feedback_age_s = 0.2; }};
  for (const auto lose : losses) {
    step();
    ASSERT_EQ(state_.phase, HostPhase::kInactive);
    const HostInputs good = in_;
    in_.feedback_age_s = 0.19;
    step();
    EXPECT_EQ(state_.phase, HostPhase::kInactive);
    lose(in_);
    step();
    EXPECT_EQ(state_.phase, HostPhase::kUnconfigured);
    EXPECT_EQ(state_.cause, HostCause::kLostFeedback);
    in_ = good;
  }
}

TEST_F(HostAutomaton, AnEnablingMachineThatNobodyAskedIsToldToStop) {
  step();
  in_.mode = MachineMode::kEnabling;
  step();
  EXPECT_EQ(out().request, HostRequest::kDisable);
}

TEST_F(HostAutomaton, AResetCountsForASecondAndOnce) {
  activate();
  in_.masquerade = true;
  step();
  in_.mode = MachineMode::kFault;
  in_.operator_reset = true;
  step();
  const double reset_s = in_.now_s;
  machine_ready();
  HostInputs late = in_;
  late.now_s = state_.reset_until_s;
  EXPECT_EQ(advance(state_, late, times_).phase, HostPhase::kUnconfigured);
  EXPECT_NEAR(late.now_s, reset_s + 1.0, 1e-9);
  step();
  ASSERT_EQ(state_.phase, HostPhase::kUnconfigured);
  in_.masquerade = true;
  steps(50);
  EXPECT_EQ(state_.phase, HostPhase::kFault) << "one reset, one fault";
}

TEST_F(HostAutomaton, AFaultDoesNotEndAnEStop) {
  activate();
  in_.estop_open = true;
  step();
  in_.estop_open = false;
  machine_ready();
  in_.masquerade = true;
  step();
  EXPECT_EQ(state_.phase, HostPhase::kEStop);
}

}  // namespace
}  // namespace wex::can
