#pragma once

#include <gtest/gtest.h>

#include <deque>
#include <functional>
#include <memory>
#include <vector>

#include "hw_interface/electronics/electronics.hpp"
#include "tests/support/fake_plant.hpp"

namespace wex::can {

inline const MachineModel& m545() {
  static const MachineModel machine = load_machine().value();
  return machine;
}

/// The electronics' end of a bus whose other end is the test: what they send is kept, what they
/// receive is what the test has put in.
class TestPort final : public FramePort {
 public:
  SocketStatus send(const CanFrame& frame) noexcept override {
    sent.push_back(frame);
    return SocketStatus::kOk;
  }
  SocketStatus receive(CanFrame& frame) noexcept override {
    if (inbox.empty()) return SocketStatus::kWouldBlock;
    frame = inbox.front();
    inbox.pop_front();
    return SocketStatus::kOk;
  }
  SocketStatus wait_readable(double) noexcept override { return SocketStatus::kOk; }
  SocketStatus reopen() noexcept override { return SocketStatus::kOk; }
  bool purge() noexcept override { return false; }
  std::uint32_t dropped() const noexcept override { return 0; }

  std::vector<CanFrame> sent;
  std::deque<CanFrame> inbox;
};

/// A host as small as can be, with every knob a test may want to turn, and electronics before a
/// plant. One step is one period of 10 ms: the host sends, the electronics tick, the host listens.
class ElectronicsBench {
 public:
  explicit ElectronicsBench(std::uint64_t seed = 1, const ElectronicsSettings& settings = {},
                            Plant* other_plant = nullptr)
      : plant(m545()),
        random(seed),
        electronics(
            Electronics::create(m545(), other_plant ? *other_plant : plant, port, random, settings)
                .value()) {
    heartbeat.dbc_hash = dbc_hash();
  }

  // The host's knobs.
  HostHeartbeat heartbeat;
  bool send_heartbeat = true, send_commands = true, echoes = true, follows_session = true;
  std::array<ZoneCommand, kNumZones> commands{};
  int valid_for_ms = 100, echo_age_ms = 0;
  /// Last touch on every frame of the host; false: it is lost.
  std::function<bool(CanFrame&)> on_the_wire = [](CanFrame&) { return true; };

  void put(CanFrame frame) {
    if (on_the_wire(frame)) port.inbox.push_back(frame);
  }
  template <typename Message>
  CanFrame frame_of(const Message& message, SendContext& context) {
    CanFrame frame;
    EXPECT_TRUE(encode(message, context, frame).has_value());
    return frame;
  }

  void send() {
    if (send_heartbeat && (now_ms / 10) % 2 == 0) {
      if (echoes) heartbeat.challenge_echo = status.challenge;
      if (follows_session) heartbeat.session = status.session;
      put(frame_of(heartbeat, heartbeat_context));
    }
    if (!send_commands) return;
    for (int zone = 0; zone < kNumZones; ++zone) {
      commands[zone].zone = zone;
      commands[zone].valid_for_ms = static_cast<std::uint8_t>(valid_for_ms);
      commands[zone].echo_time_ms = static_cast<std::uint32_t>(now_ms - echo_age_ms);
      command_context[zone].session = status.session;
      put(frame_of(commands[zone], command_context[zone]));
    }
  }
  void listen() {
    for (const CanFrame& frame : port.sent) {
      ZoneStatus new_status;
      EStopState new_estop;
      if (decode(frame, 0, new_status)) status = new_status;
      if (decode(frame, 0, new_estop)) estop = new_estop;
    }
    last_sent = std::exchange(port.sent, {});
  }
  void step() {
    send();
    now_ms += 10;
    electronics->tick(now_ms);
    listen();
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) step();
  }

  MachineMode mode() const { return electronics->automaton().mode(); }
  void operator_does(OperatorAction action) {
    put(frame_of(OperatorCommand{action}, operator_context));
    step();
  }
  void operator_resets() {
    operator_does(OperatorAction::kNone);
    operator_does(OperatorAction::kReset);
  }
  void ask_for_enable(std::uint16_t nonce = 7) {
    heartbeat.request = HostRequest::kNone;
    heartbeat.challenge_echo = 0;
    steps(4);
    heartbeat.request = HostRequest::kEnable;
    heartbeat.nonce = nonce;
  }
  /// The whole handshake with everything as it should be.
  void enable() {
    ask_for_enable();
    for (int i = 0; i < 100 && mode() != MachineMode::kEnabled; ++i) step();
    ASSERT_EQ(mode(), MachineMode::kEnabled);
  }
  void set_rate(int zone, int index, double rate) {
    commands[zone].active[index] = true;
    commands[zone].rate[index] = rate;
  }
  /// Brings one joint up to a rate as its acceleration allows.
  void ramp(int zone, int index, double rate) {
    const double step_rate = limits_of({zone, index}).max_acceleration * 0.01;
    double now = commands[zone].active[index] ? commands[zone].rate[index] : 0.0;
    while (now != rate) {
      now += std::clamp(rate - now, -step_rate, step_rate);
      set_rate(zone, index, now);
      step();
    }
  }

  TestPort port;
  FakePlant plant;
  SeededRandom random;
  std::unique_ptr<Electronics> electronics;
  std::int64_t now_ms = 1000;
  ZoneStatus status;
  EStopState estop;
  std::vector<CanFrame> last_sent;
  SendContext heartbeat_context, operator_context, stop_context;
  std::array<SendContext, kNumZones> command_context{};
};

}  // namespace wex::can
