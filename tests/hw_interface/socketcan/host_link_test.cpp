#include "hw_interface/socketcan/host_link.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <vector>

namespace wex::can {
namespace {

constexpr std::int64_t kMs = 1'000'000;

const MachineModel& m545() {
  static const MachineModel machine = load_machine().value();
  return machine;
}

/// A port whose every answer a test decides.
class ScriptedPort final : public FramePort {
 public:
  SocketStatus send(const CanFrame& frame) noexcept override {
    if (room == 0) return full;
    --room;
    sent.push_back(frame);
    return SocketStatus::kOk;
  }
  SocketStatus receive(CanFrame& frame) noexcept override {
    if (inbox.empty()) return receive_status;
    frame = inbox.front();
    inbox.pop_front();
    return SocketStatus::kOk;
  }
  SocketStatus wait_readable(double) noexcept override { return SocketStatus::kOk; }
  SocketStatus reopen() noexcept override {
    ++reopens;
    return reopen_status;
  }
  bool purge() noexcept override {
    ++purges;
    return true;
  }
  std::uint32_t dropped() const noexcept override { return drops; }

  int room = 1'000'000, reopens = 0, purges = 0;
  std::uint32_t drops = 0;
  SocketStatus full = SocketStatus::kWouldBlock, receive_status = SocketStatus::kWouldBlock;
  SocketStatus reopen_status = SocketStatus::kOk;
  std::vector<CanFrame> sent;
  std::deque<CanFrame> inbox;
};

class HostLinkTest : public ::testing::Test {
 protected:
  void receive() {
    for (bool more = true; more;) {
      more = link_.collect();
      link_.receive(feedback_, now_ns_);
    }
  }
  /// One period with a heartbeat and a stop in the mailbox.
  void cycle() {
    EXPECT_TRUE(link_.mailbox().put(HostMailbox::kStop, HostStop{true, 1}, 0));
    EXPECT_TRUE(link_.mailbox().put(HostMailbox::kHeartbeat, HostHeartbeat{}, 0));
    receive();
    link_.send(now_ns_);
    link_.end_cycle(now_ns_);
    now_ns_ += 10 * kMs;
  }
  void cycles(int count) {
    for (int i = 0; i < count; ++i) cycle();
  }
  static CanFrame error_frame(std::uint32_t bits) {
    CanFrame frame;
    frame.error = true;
    frame.id = bits;
    frame.length = 8;
    return frame;
  }

  ScriptedPort port_;
  LinkSettings settings_;
  HostLink link_{port_, settings_};
  HostFeedback feedback_ = HostFeedback::create(m545(), {0.0, 0.0}).value();
  std::int64_t now_ns_ = 1'000'000 * kMs;
};

TEST(HostMailbox, TheUrgentIdGoesFirstAndANewerValueReplacesTheOlder) {
  ScriptedPort port;
  HostMailbox mailbox;
  const auto nothing = [](int, const CanFrame&) {};
  EXPECT_TRUE(mailbox.put(HostMailbox::kHeartbeat, HostHeartbeat{}, 0));
  HostHeartbeat newer;
  newer.nonce = 7;
  EXPECT_TRUE(mailbox.put(HostMailbox::kHeartbeat, newer, 0));
  EXPECT_TRUE(mailbox.put(HostMailbox::kStop, HostStop{}, 0));
  EXPECT_EQ(mailbox.flush(port, nothing), SocketStatus::kOk);
  ASSERT_EQ(port.sent.size(), 2U);
  EXPECT_EQ(kind_of(port.sent[0]), MessageKind::kHostStop);
  HostHeartbeat received;
  ASSERT_TRUE(decode(port.sent[1], 0, received));
  EXPECT_EQ(received.nonce, 7);
  EXPECT_EQ(mailbox.flush(port, nothing), SocketStatus::kOk);
  EXPECT_EQ(port.sent.size(), 2U) << "nothing is sent twice";
}

TEST(HostMailbox, CountersGoUpWithWhatWasTakenOnly) {
  ScriptedPort port;
  HostMailbox mailbox;
  std::vector<int> counters;
  const auto note = [&](int slot, const CanFrame& frame) {
    HostHeartbeat heartbeat;
    counters.push_back(decode(frame, 0, heartbeat)->counter);
    EXPECT_EQ(mailbox.sent_counter(slot), counters.back());
  };
  for (const int room : {1, 0, 0, 0, 0, 1, 1}) {
    port.room = room;
    EXPECT_TRUE(mailbox.put(HostMailbox::kHeartbeat, HostHeartbeat{}, 0));
    mailbox.flush(port, note);
  }
  EXPECT_EQ(counters, (std::vector<int>{0, 1, 2}));
}

TEST(HostMailbox, WhatCannotBeEncodedIsNotSentNorIsWhatStoodThere) {
  ScriptedPort port;
  HostMailbox mailbox;
  ZoneCommand command;
  EXPECT_TRUE(mailbox.put(HostMailbox::kCommand, command, 1));
  command.active[0] = true;
  command.rate[0] = 1e9;
  EXPECT_FALSE(mailbox.put(HostMailbox::kCommand, command, 1));
  mailbox.flush(port, [](int, const CanFrame&) {});
  EXPECT_TRUE(port.sent.empty());
}

TEST(HostMailbox, ClearForgetsWhatWaits) {
  ScriptedPort port;
  HostMailbox mailbox;
  EXPECT_TRUE(mailbox.put(HostMailbox::kStop, HostStop{}, 0));
  mailbox.clear();
  mailbox.flush(port, [](int, const CanFrame&) {});
  EXPECT_TRUE(port.sent.empty());
}

// T10: a bus that takes nothing costs nothing but the stall.
TEST_F(HostLinkTest, ThreeCyclesWithoutRoomAreAStall) {
  cycle();
  EXPECT_FALSE(link_.stalled());
  port_.room = 0;
  cycles(2);
  EXPECT_FALSE(link_.stalled());
  cycle();
  EXPECT_TRUE(link_.stalled());
  cycles(10'000);
  EXPECT_EQ(link_.statistics().stalls, 1);
  EXPECT_EQ(link_.statistics().not_taken, 10'003);
  EXPECT_EQ(port_.purges, 5);
  EXPECT_EQ(link_.statistics().purges, 5) << "once per second, five times";
  port_.room = 2;
  port_.sent.clear();
  cycle();
  EXPECT_FALSE(link_.stalled());
  EXPECT_EQ(port_.sent.size(), 2U) << "only the newest values: nothing has queued up";
}

TEST_F(HostLinkTest, PurgesAreAllowedAgainOnceTheBusWasWell) {
  port_.room = 0;
  cycles(600);
  EXPECT_EQ(port_.purges, 5);
  port_.room = 1'000'000;
  cycles(310);
  port_.room = 0;
  cycles(4);
  EXPECT_EQ(port_.purges, 6);
}

TEST_F(HostLinkTest, PurgingCanBeForbidden) {
  settings_.purge_by_link_flap = false;
  HostLink link(port_, settings_);
  link.restart_controller(now_ns_);
  EXPECT_EQ(port_.purges, 0);
}

TEST_F(HostLinkTest, AnInterfaceThatGoesDownIsOneEventAndIsReopenedWithBackOff) {
  port_.receive_status = SocketStatus::kInterfaceDown;
  port_.reopen_status = SocketStatus::kGone;
  cycle();
  EXPECT_TRUE(link_.take_lost());
  EXPECT_FALSE(link_.take_lost());
  EXPECT_TRUE(link_.degraded(now_ns_));
  cycles(1000);  // 10 s: after 0.1, 0.2, 0.4, 0.8, 1.6, 2, 2 s
  EXPECT_FALSE(link_.take_lost());
  EXPECT_NEAR(port_.reopens, 7, 1);
  EXPECT_EQ(link_.statistics().reopens, 0);
  EXPECT_TRUE(port_.sent.empty()) << "nothing goes to a port that is not usable";
  port_.reopen_status = SocketStatus::kOk;
  port_.receive_status = SocketStatus::kWouldBlock;
  cycles(210);
  EXPECT_EQ(link_.statistics().reopens, 1);
  EXPECT_FALSE(port_.sent.empty());
  CanFrame frame;
  frame.id = 0x555;
  port_.inbox.push_back(frame);
  cycle();
  port_.full = SocketStatus::kGone;
  port_.room = 0;
  cycle();
  EXPECT_TRUE(link_.take_lost()) << "a new loss is a new event";
}

TEST_F(HostLinkTest, AClosedPortDoesNotKeepWhatItHears) {
  port_.receive_status = SocketStatus::kGone;
  cycle();
  CanFrame frame;
  frame.id = 0x555;
  port_.inbox.assign(5, frame);
  receive();
  EXPECT_TRUE(port_.inbox.empty());
  EXPECT_EQ(link_.statistics().unknown, 0);
}

TEST_F(HostLinkTest, BusOffIsRememberedForASecondOrUntilTheRestart) {
  port_.inbox.push_back(error_frame(0x40));
  receive();
  EXPECT_TRUE(link_.bus_off_reported(now_ns_));
  EXPECT_FALSE(link_.bus_off_reported(now_ns_ + 1001 * kMs));
  port_.inbox.push_back(error_frame(0x100));
  receive();
  EXPECT_FALSE(link_.bus_off_reported(now_ns_));
  EXPECT_EQ(link_.statistics().error_frames, 2);
}

TEST_F(HostLinkTest, TwoOverflowsWithinASecondAreAnOverflow) {
  receive();
  port_.drops = 4;
  receive();
  EXPECT_FALSE(link_.overflowed(now_ns_));
  now_ns_ += 1100 * kMs;
  port_.drops = 5;
  receive();
  EXPECT_FALSE(link_.overflowed(now_ns_));
  now_ns_ += 500 * kMs;
  port_.drops = 6;
  receive();
  EXPECT_TRUE(link_.overflowed(now_ns_));
  EXPECT_FALSE(link_.overflowed(now_ns_ + 1100 * kMs));
  EXPECT_EQ(link_.statistics().receive_overflows, 6);
}

TEST_F(HostLinkTest, EveryVerdictIsCounted) {
  SendContext context;
  CanFrame good;
  ASSERT_TRUE(encode(EStopState{}, context, good));
  CanFrame corrupted = good, foreign = good, shorter = good, own, late;
  corrupted.data[4] ^= 1;
  foreign.id = 0x555;
  shorter.length = 7;
  context.counter = 0;
  ASSERT_TRUE(encode(HostStop{}, context, own));
  context.counter = 100;
  ASSERT_TRUE(encode(EStopState{}, context, late));
  port_.inbox = {good, good, late, corrupted, foreign, shorter, own};
  receive();
  const BusStatistics& s = link_.statistics();
  EXPECT_EQ(s.repeated, 1);
  EXPECT_EQ(s.wrong_sequence, 1);
  EXPECT_EQ(s.crc_errors, 1);
  EXPECT_EQ(s.unknown, 1);
  EXPECT_EQ(s.malformed, 1);
  EXPECT_EQ(s.own_ids, 1);
  EXPECT_EQ(s.frames_received(), 7);
  EXPECT_EQ(s.frames_sent(), 0);
  EXPECT_TRUE(link_.degraded(now_ns_));
  EXPECT_EQ(link_.recorder().size(), 7U);
}

TEST(BusStatistics, AFrameTakesTheTimeOfItsBits) {
  CanFrame frame;
  frame.length = 8;
  EXPECT_NEAR(bus_time_s(frame), 270e-6, 1e-6) << "classic, worst case of stuffing, 500 kbit/s";
  frame.fd = true;
  frame.length = 64;
  EXPECT_NEAR(bus_time_s(frame), 406e-6, 10e-6) << "FD, 64 bytes at 2 Mbit/s";
  CanFrame small = frame;
  small.length = 8;
  EXPECT_LT(bus_time_s(small), 0.4 * bus_time_s(frame));
}

TEST(BusStatistics, LatenciesFallIntoTheirBins) {
  LatencyHistogram histogram;
  EXPECT_EQ(histogram.percentile_ms(0.5), 0.0);
  for (int i = 0; i < 98; ++i) histogram.add(0.9e-3);
  histogram.add(12e-3);
  histogram.add(0.4);
  EXPECT_EQ(histogram.count(), 100);
  EXPECT_EQ(histogram.bins()[3], 98);
  EXPECT_EQ(histogram.bins()[9], 1);
  EXPECT_EQ(histogram.bins().back(), 1);
  EXPECT_EQ(histogram.percentile_ms(0.5), 1.0);
  EXPECT_EQ(histogram.percentile_ms(0.99), 15.0);
  EXPECT_EQ(histogram.percentile_ms(1.0), 400.0);
  EXPECT_NEAR(histogram.max_ms(), 400.0, 1e-9);
}

TEST(BusStatistics, EveryKindHasAName) {
  for (int kind = 0; kind < static_cast<int>(MessageKind::kUnknown); ++kind) {
    EXPECT_STRNE(name_of(static_cast<MessageKind>(kind)), "unknown") << kind;
  }
}

}  // namespace
}  // namespace wex::can
