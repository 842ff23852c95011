#pragma once

#include <gtest/gtest.h>

#include "hw_interface/electronics/machine_automaton.hpp"

namespace wex::can {

inline constexpr std::uint32_t kHash = 0x1234ABCD;

/// Hands out zeros first: "none" on the bus, so never a challenge or session.
class CountingRandom final : public RandomSource {
 public:
  std::uint32_t next() noexcept override { return static_cast<std::uint32_t>(calls_++ / 2); }

 private:
  int calls_ = 0;
};

class MachineAutomatonTest : public ::testing::Test {
 protected:
  MachineAutomatonTest() {
    check_ = {.sensors_valid = true,
              .base_pose_valid = true,
              .valves_neutral = true,
              .estop_chain_open = false};
    heartbeat_.dbc_hash = kHash;
  }
  void step() { automaton_.step(check_, now_ms_); }
  void beat() { automaton_.on_heartbeat(heartbeat_, now_ms_); }
  void commands(bool neutral = true) {
    for (int zone = 0; zone < kNumZones; ++zone) automaton_.on_good_command(zone, neutral, now_ms_);
  }
  /// One period of a host that does everything right.
  void period(bool with_commands = true, bool with_heartbeat = true) {
    now_ms_ += 10;
    heartbeat_.session = automaton_.session();
    heartbeat_.challenge_echo = automaton_.challenge();
    if (with_heartbeat) beat();
    if (with_commands) commands();
    step();
  }
  void periods(int count, bool with_commands = true, bool with_heartbeat = true) {
    for (int i = 0; i < count; ++i) period(with_commands, with_heartbeat);
  }
  void to_ready() {
    heartbeat_.request = HostRequest::kNone;
    periods(2, false);
    ASSERT_EQ(mode(), MachineMode::kReady);
  }
  /// Ready, and the request has been answered by a challenge.
  void to_challenge(std::uint16_t nonce = 9) {
    to_ready();
    heartbeat_.request = HostRequest::kEnable;
    heartbeat_.nonce = nonce;
    now_ms_ += 10;
    heartbeat_.challenge_echo = 0;
    beat();
    step();
    ASSERT_EQ(mode(), MachineMode::kEnabling);
    ASSERT_NE(automaton_.challenge(), 0u);
    ASSERT_EQ(automaton_.session(), 0u);
  }
  void to_enabled() {
    to_challenge();
    for (int i = 0; i < 20 && mode() != MachineMode::kEnabled; ++i) period();
    ASSERT_EQ(mode(), MachineMode::kEnabled);
    ASSERT_NE(automaton_.session(), 0u);
  }
  void operator_does(OperatorAction action) { automaton_.on_operator({action}, now_ms_); }
  void reset() {
    operator_does(OperatorAction::kNone);
    operator_does(OperatorAction::kReset);
    step();
  }
  MachineMode mode() const { return automaton_.mode(); }
  bool latched_with(std::uint16_t bit) const {
    return mode() == MachineMode::kFault && (automaton_.fault_bits() & bit) != 0 &&
           automaton_.session() == 0;
  }

  CountingRandom random_;
  MachineAutomaton automaton_{kHash, random_};
  SelfCheck check_;
  HostHeartbeat heartbeat_;
  std::int64_t now_ms_ = 100'000;
};

}  // namespace wex::can
