#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>

#include "tests/hw_interface/socketcan/host_automaton_fixture.hpp"

namespace wex::can {
namespace {

TEST_F(HostAutomaton, IsConfiguredOnceEverythingIsHeardInTheSameDbc) {
  in_.complete = false;
  steps(3);
  EXPECT_EQ(state_.phase, HostPhase::kUnconfigured);
  in_.complete = true;
  in_.dbc_matches = false;
  steps(3);
  EXPECT_EQ(state_.phase, HostPhase::kUnconfigured);
  EXPECT_EQ(state_.cause, HostCause::kOtherDbc);
  in_.dbc_matches = true;
  step();
  EXPECT_EQ(state_.phase, HostPhase::kInactive);
  EXPECT_EQ(out().request, HostRequest::kNone);
}

TEST_F(HostAutomaton, IsNotConfiguredByOldFeedback) {
  in_.feedback_age_s = 0.06;
  steps(3);
  EXPECT_EQ(state_.phase, HostPhase::kUnconfigured);
  in_.feedback_age_s = std::numeric_limits<double>::quiet_NaN();
  steps(3);
  EXPECT_EQ(state_.phase, HostPhase::kUnconfigured);
}

TEST_F(HostAutomaton, AMachineThatFallsSilentBeforeASessionIsJustNotThere) {
  step();
  in_.feedback_age_s = 0.3;
  step();
  EXPECT_EQ(state_.phase, HostPhase::kUnconfigured);
  in_.feedback_age_s = 0.01;
  step();
  EXPECT_EQ(state_.phase, HostPhase::kInactive) << "nothing was moving: no person is needed";
}

TEST_F(HostAutomaton, StaleFeedbackHoldsAt50MsAndFaultsAt200) {
  activate();
  in_.feedback_age_s = 0.049;
  step();
  EXPECT_EQ(state_.phase, HostPhase::kActive);
  in_.feedback_age_s = 0.05;
  step();
  EXPECT_EQ(state_.phase, HostPhase::kHold);
  EXPECT_EQ(state_.cause, HostCause::kStaleFeedback);
  EXPECT_TRUE(out().send_commands) << "neutral ones";
  EXPECT_FALSE(out().live);
  EXPECT_FALSE(out().send_stop);
  in_.feedback_age_s = 0.2;
  step();
  EXPECT_EQ(state_.phase, HostPhase::kFault);
  EXPECT_EQ(state_.cause, HostCause::kLostFeedback);
  EXPECT_FALSE(out().send_commands);
  EXPECT_TRUE(out().send_stop);
  EXPECT_EQ(state_.session, 0U);
  EXPECT_EQ(out().request, HostRequest::kDisable);
  EXPECT_EQ(out().session, 0x5E55U) << "the machine listens to no other";
}

TEST_F(HostAutomaton, HoldIsLeftAfterTenNeutralCommandsWithoutACause) {
  activate();
  in_.feedback_age_s = 0.06;
  in_.neutral_sent = true;
  steps(5);
  in_.feedback_age_s = 0.01;
  steps(9);
  EXPECT_EQ(state_.phase, HostPhase::kHold);
  step();
  EXPECT_EQ(state_.phase, HostPhase::kActive);
  EXPECT_EQ(state_.holds, 1);
  EXPECT_EQ(out().session, 0x5E55U) << "the same session";
}

TEST_F(HostAutomaton, ACauseThatComesBackStartsTheCountAgain) {
  activate();
  in_.feedback_age_s = 0.06;
  step();
  in_.neutral_sent = true;
  in_.feedback_age_s = 0.01;
  steps(9);
  in_.bus_stalled = true;
  step();
  EXPECT_EQ(state_.cause, HostCause::kBusStalled);
  in_.bus_stalled = false;
  steps(9);
  EXPECT_EQ(state_.phase, HostPhase::kHold);
  step();
  EXPECT_EQ(state_.phase, HostPhase::kActive);
}

TEST_F(HostAutomaton, HoldIsNotLeftWithoutNeutralCommandsOnTheBus) {
  activate();
  in_.bus_stalled = true;
  step();
  in_.bus_stalled = false;
  steps(100);
  EXPECT_EQ(state_.phase, HostPhase::kHold);
}

TEST_F(HostAutomaton, EveryCauseOfAHoldHolds) {
  struct Case {
    void (*apply)(HostInputs&);
    HostCause cause;
  };
  const Case cases[] = {
      {[](HostInputs& in) { in.bus_stalled = true; }, HostCause::kBusStalled},
      {[](HostInputs& in) { in.overflowed = true; }, HostCause::kReceiveOverflow},
      {[](HostInputs& in) { in.status_age_s = 0.26; }, HostCause::kStaleStatus},
      {[](HostInputs& in) { in.estop_age_s = 0.11; }, HostCause::kStaleStatus},
      {[](HostInputs& in) { in.mode = MachineMode::kHold; }, HostCause::kMachineHolds},
      {[](HostInputs& in) { in.stop = true; }, HostCause::kStopRequested}};
  for (const Case& c : cases) {
    activate();
    const HostInputs good = in_;
    c.apply(in_);
    step();
    EXPECT_EQ(state_.phase, HostPhase::kHold) << describe(c.cause);
    EXPECT_EQ(state_.cause, c.cause) << describe(c.cause);
    EXPECT_FALSE(out().live);
    in_ = good;
    machine_ready();
    step();
    state_.old_session = 0;
  }
}

TEST_F(HostAutomaton, AHoldThatWasAskedForIsNotCounted) {
  activate();
  in_.stop = true;
  step();
  EXPECT_TRUE(out().send_stop);
  in_.mode = MachineMode::kHold;
  steps(20);
  in_.stop = false;
  in_.neutral_sent = true;
  steps(20);
  EXPECT_EQ(state_.phase, HostPhase::kHold) << "the machine still holds";
  in_.mode = MachineMode::kEnabled;
  step();
  EXPECT_EQ(state_.phase, HostPhase::kActive) << "neutral commands sent meanwhile count";
  EXPECT_EQ(state_.holds, 0);
}

TEST_F(HostAutomaton, AForgedBusOffDoesNothingWhileTheMachineIsHeard) {
  activate();
  in_.bus_off_reported = true;
  steps(20);
  EXPECT_EQ(state_.phase, HostPhase::kActive);
  EXPECT_FALSE(out().silent);
}

TEST_F(HostAutomaton, BusOffWithSilenceStopsSendingAndEndsTheSession) {
  activate();
  in_.bus_off_reported = true;
  in_.feedback_age_s = 0.06;
  step();
  EXPECT_EQ(state_.phase, HostPhase::kHold);
  EXPECT_EQ(state_.cause, HostCause::kBusOff);
  EXPECT_TRUE(out().silent);
  in_.feedback_age_s = 0.01;
  step();
  EXPECT_EQ(state_.phase, HostPhase::kInactive) << "no way back into the session";
  EXPECT_EQ(state_.cause, HostCause::kBusOff);
}

TEST_F(HostAutomaton, AStaleHoldBecomesBusOffOnceItIsReported) {
  activate();
  in_.feedback_age_s = 0.06;
  step();
  in_.bus_off_reported = true;
  step();
  EXPECT_EQ(state_.cause, HostCause::kBusOff);
  step();
  EXPECT_EQ(state_.cause, HostCause::kBusOff);
  in_.feedback_age_s = 0.25;
  step();
  EXPECT_EQ(state_.phase, HostPhase::kFault);
}

TEST_F(HostAutomaton, TheSessionEndsWithTheMachines) {
  const auto ends = {+[](HostInputs& in) { in.session = 0x1234; },
                     +[](HostInputs& in) { in.restarted = true; },
                     +[](HostInputs& in) { in.mode = MachineMode::kReady; },
                     +[](HostInputs& in) { in.mode = MachineMode::kInit; }};
  for (const auto end : ends) {
    activate();
    end(in_);
    step();
    EXPECT_EQ(state_.phase, HostPhase::kInactive);
    EXPECT_EQ(state_.cause, HostCause::kSessionEnded);
    machine_ready();
    steps(50);
    EXPECT_EQ(state_.phase, HostPhase::kInactive) << "nothing resumes by itself";
    state_.old_session = 0;
  }
}

TEST_F(HostAutomaton, DisableEndsTheSession) {
  activate();
  in_.disable = true;
  step();
  EXPECT_EQ(state_.phase, HostPhase::kInactive);
  EXPECT_EQ(out().request, HostRequest::kDisable);
  machine_ready();
  step();
  EXPECT_EQ(out().request, HostRequest::kNone);
}

TEST_F(HostAutomaton, EveryFaultIsLatchedUntilAPersonResets) {
  struct Case {
    void (*apply)(HostInputs&);
    HostCause cause;
  };
  const Case cases[] = {
      {[](HostInputs& in) { in.masquerade = true; }, HostCause::kMasquerade},
      {[](HostInputs& in) { in.crc_fault = true; }, HostCause::kCrcErrors},
      {[](HostInputs& in) { in.mode = MachineMode::kFault; }, HostCause::kMachineFault},
      {[](HostInputs& in) { in.interface_lost = true; }, HostCause::kInterfaceLost},
      {[](HostInputs& in) { in.feedback_age_s = 1.0; }, HostCause::kLostFeedback}};
  for (const Case& c : cases) {
    activate();
    const HostInputs good = in_;
    c.apply(in_);
    step();
    EXPECT_EQ(state_.phase, HostPhase::kFault) << describe(c.cause);
    EXPECT_EQ(state_.cause, c.cause);
    const double now_s = in_.now_s;
    in_ = good;
    in_.now_s = now_s;
    in_.enable = true;
    machine_ready();
    steps(100);
    EXPECT_EQ(state_.phase, HostPhase::kFault);
    in_.operator_reset = true;
    steps(2);
    EXPECT_EQ(state_.phase, HostPhase::kInactive) << describe(c.cause);
    state_.old_session = 0;
  }
}

TEST_F(HostAutomaton, MasqueradeAndCrcErrorsCountOutsideASessionToo) {
  step();
  in_.masquerade = true;
  step();
  EXPECT_EQ(state_.phase, HostPhase::kFault);
}

TEST_F(HostAutomaton, AResetWaitsASecondForTheMachineToFollow) {
  activate();
  in_.mode = MachineMode::kFault;
  step();
  in_.operator_reset = true;
  steps(50);
  EXPECT_EQ(state_.phase, HostPhase::kFault) << "the cause is not gone";
  machine_ready();
  steps(2);
  EXPECT_EQ(state_.phase, HostPhase::kInactive);
}

TEST_F(HostAutomaton, AResetThatTheMachineDoesNotFollowIsForgotten) {
  activate();
  in_.mode = MachineMode::kFault;
  step();
  in_.operator_reset = true;
  steps(110);
  machine_ready();
  steps(50);
  EXPECT_EQ(state_.phase, HostPhase::kFault);
}

TEST_F(HostAutomaton, AnOperatorsStopIsToldFromAnOpenChain) {
  activate();
  in_.mode = MachineMode::kEStop;
  in_.operator_stopped = true;
  step();
  EXPECT_EQ(state_.phase, HostPhase::kEStop);
  EXPECT_EQ(state_.cause, HostCause::kOperatorStop);
  in_.estop_open = true;
  EXPECT_EQ(advance(HostState{}, in_, times_).cause, HostCause::kEStopOpen)
      << "the chain says more";
}

TEST_F(HostAutomaton, TheEStopIsLatchedAndWinsOverEverything) {
  for (const bool by_chain : {true, false}) {
    activate();
    const HostInputs good = in_;
    if (by_chain) {
      in_.estop_open = true;
    } else {
      in_.mode = MachineMode::kEStop;
    }
    in_.masquerade = true;
    step();
    EXPECT_EQ(state_.phase, HostPhase::kEStop);
    EXPECT_EQ(state_.cause, HostCause::kEStopOpen);
    EXPECT_FALSE(out().send_commands);
    EXPECT_EQ(state_.session, 0U);
    in_.operator_reset = true;
    steps(20);
    EXPECT_EQ(state_.phase, HostPhase::kEStop) << "still open";
    const double now_s = in_.now_s;
    in_ = good;
    in_.now_s = now_s + 2.0;
    machine_ready();
    steps(100);
    EXPECT_EQ(state_.phase, HostPhase::kEStop) << "closed, but nobody has reset";
    in_.operator_reset = true;
    steps(2);
    EXPECT_EQ(state_.phase, HostPhase::kInactive);
    state_.old_session = 0;
  }
}

TEST_F(HostAutomaton, AFaultBecomesAnEStop) {
  activate();
  in_.crc_fault = true;
  step();
  in_.estop_open = true;
  step();
  EXPECT_EQ(state_.phase, HostPhase::kEStop);
}

TEST_F(HostAutomaton, EveryCauseHasItsOwnWords) {
  std::set<std::string> words;
  for (int cause = 0; cause <= static_cast<int>(HostCause::kOperatorStop); ++cause) {
    words.insert(describe(static_cast<HostCause>(cause)));
  }
  EXPECT_EQ(words.size(), static_cast<std::size_t>(HostCause::kOperatorStop) + 1);
}

}  // namespace
}  // namespace wex::can
