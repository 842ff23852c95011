#include "hw_interface/socketcan/host_mailbox.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace wex::can {
namespace {

/// Takes as much as there is room for.
class RoomyPort final : public FramePort {
 public:
  SocketStatus send(const CanFrame& frame) noexcept override {
    if (room == 0) return SocketStatus::kWouldBlock;
    --room;
    sent.push_back(frame);
    return SocketStatus::kOk;
  }
  SocketStatus receive(CanFrame&) noexcept override { return SocketStatus::kWouldBlock; }
  SocketStatus wait_readable(double) noexcept override { return SocketStatus::kWouldBlock; }
  SocketStatus reopen() noexcept override { return SocketStatus::kOk; }
  bool purge() noexcept override { return false; }
  std::uint32_t dropped() const noexcept override { return 0; }

  std::size_t room = 1000;
  std::vector<CanFrame> sent;
};

class HostMailboxTest : public ::testing::Test {
 protected:
  static constexpr std::uint32_t kSession = 77;

  void put_all() {
    EXPECT_TRUE(mailbox_.put(HostMailbox::kStep, LockStep{}, 0));
    for (int zone = kNumZones; zone-- > 0;) {
      ZoneCommand command;
      command.zone = zone;
      EXPECT_TRUE(mailbox_.put(HostMailbox::kCommand + zone, command, kSession));
    }
    EXPECT_TRUE(mailbox_.put(HostMailbox::kHeartbeat, HostHeartbeat{}, 0));
    EXPECT_TRUE(mailbox_.put(HostMailbox::kStop, HostStop{}, 0));
  }
  SocketStatus flush() {
    return mailbox_.flush(port_, [this](int slot, const CanFrame&) { slots_.push_back(slot); });
  }

  RoomyPort port_;
  HostMailbox mailbox_;
  std::vector<int> slots_;
};

TEST_F(HostMailboxTest, EveryMessageHasAPlaceInTheOrderOfItsUrgency) {
  EXPECT_EQ(flush(), SocketStatus::kOk);
  EXPECT_TRUE(port_.sent.empty()) << "there is nothing yet";
  put_all();
  EXPECT_EQ(flush(), SocketStatus::kOk);
  ASSERT_EQ(port_.sent.size(), 9U);
  for (std::size_t i = 1; i < port_.sent.size(); ++i) {
    EXPECT_LT(port_.sent[i - 1].id, port_.sent[i].id);
    EXPECT_LT(slots_[i - 1], slots_[i]);
  }
}

TEST_F(HostMailboxTest, WhatIsNotTakenStaysAndItsCounterToo) {
  put_all();
  port_.room = 4;
  EXPECT_EQ(flush(), SocketStatus::kWouldBlock);
  EXPECT_EQ(port_.sent.size(), 4U);
  port_.room = 1000;
  put_all();
  EXPECT_EQ(flush(), SocketStatus::kOk);
  EXPECT_EQ(port_.sent.size(), 13U);
  for (int slot = 0; slot < HostMailbox::kNumSlots; ++slot) {
    EXPECT_EQ(mailbox_.sent_counter(slot), slot < 4 ? 1 : 0) << slot;
  }
}

TEST_F(HostMailboxTest, CommandsCarryTheSession) {
  put_all();
  flush();
  ZoneCommand command;
  EXPECT_FALSE(decode(port_.sent[2], kSession + 1, command));
  const auto meta = decode(port_.sent[2], kSession, command);
  ASSERT_TRUE(meta);
  EXPECT_EQ(meta->counter, 0);
}

TEST_F(HostMailboxTest, ClearedItHoldsNothing) {
  put_all();
  mailbox_.clear();
  EXPECT_EQ(flush(), SocketStatus::kOk);
  EXPECT_TRUE(port_.sent.empty());
}

TEST_F(HostMailboxTest, AValueThatIsRefusedTakesTheOlderWithIt) {
  put_all();
  ZoneCommand command;
  command.active[0] = true;
  command.rate[0] = 1e9;
  EXPECT_FALSE(mailbox_.put(HostMailbox::kCommand, command, kSession));
  flush();
  EXPECT_EQ(port_.sent.size(), 8U);
  EXPECT_EQ(kind_of(port_.sent[2]), MessageKind::kZoneCommand);
  EXPECT_EQ(zone_of(port_.sent[2]), 1);
}

}  // namespace
}  // namespace wex::can
