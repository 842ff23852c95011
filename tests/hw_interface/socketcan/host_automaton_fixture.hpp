#pragma once

#include <gtest/gtest.h>

#include "hw_interface/socketcan/host_automaton.hpp"

namespace wex::can {

inline constexpr double kPeriod_s = 0.01;

/// The automaton with a machine that does what it should; a test changes one thing.
class HostAutomaton : public ::testing::Test {
 protected:
  HostAutomaton() {
    in_.complete = in_.dbc_matches = true;
    in_.mode = MachineMode::kReady;
    in_.nonce = 77;
  }

  void step() {
    in_.now_s += kPeriod_s;
    state_ = advance(state_, in_, times_);
    in_.enable = in_.disable = in_.operator_reset = in_.masquerade = in_.crc_fault = false;
    in_.restarted = in_.interface_lost = false;
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) step();
  }
  HostOutputs out() const { return outputs_of(state_, in_); }

  void ask() {
    step();
    ASSERT_EQ(state_.phase, HostPhase::kInactive);
    in_.enable = true;
    step();
    ASSERT_EQ(state_.phase, HostPhase::kAsking);
  }
  void challenge(std::uint32_t value = 0xC0FFEE) {
    in_.mode = MachineMode::kEnabling;
    in_.challenge = value;
    step();
  }
  void prove(std::uint32_t session = 0x5E55) {
    in_.challenge = 0;
    in_.session = session;
    in_.neutral_sent = true;
    steps(10);
  }
  void activate(std::uint32_t session = 0x5E55) {
    ask();
    challenge();
    prove(session);
    in_.mode = MachineMode::kEnabled;
    step();
    ASSERT_EQ(state_.phase, HostPhase::kActive);
    in_.neutral_sent = false;
  }
  /// The electronics drop the session and become ready again.
  void machine_ready() {
    in_.mode = MachineMode::kReady;
    in_.session = 0;
    in_.challenge = 0;
  }

  HostInputs in_;
  HostState state_;
  HostTimes times_;
};

}  // namespace wex::can
