#include "hw_interface/fault_injection/faulty_port.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <map>

#include "hw_interface/socketcan/frame_pipe.hpp"

namespace wex::can {
namespace {

class TestClock final : public MonotonicClock {
 public:
  std::int64_t now_ns() noexcept override { return time_ns; }
  std::int64_t time_ns = 0;
};

class FaultyPortTest : public ::testing::Test {
 protected:
  static CanFrame numbered(std::uint32_t number) {
    CanFrame frame;
    frame.id = 0x100;
    frame.fd = true;
    frame.length = 8;
    for (int i = 0; i < 4; ++i) frame.data[i] = static_cast<std::uint8_t>(number >> (8 * i));
    return frame;
  }
  static std::uint32_t number_of(const CanFrame& frame) {
    std::uint32_t number = 0;
    for (int i = 3; i >= 0; --i) number = (number << 8) | frame.data[i];
    return number;
  }
  /// Sends `count` frames, one per millisecond, and returns what the far end hears, in order.
  std::vector<std::uint32_t> send(std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) {
      port_.send(numbered(i));
      clock_.time_ns += 1'000'000;
      hear();
    }
    for (int i = 0; i < 1000; ++i) {
      clock_.time_ns += 1'000'000;
      CanFrame frame;
      port_.receive(frame);
      hear();
    }
    return std::move(heard_);
  }
  void hear() {
    CanFrame frame;
    while (pipe_.machine().receive(frame) == SocketStatus::kOk) {
      heard_.push_back(number_of(frame));
      heard_at_ns_[heard_.back()] = clock_.time_ns;
    }
  }

  TestClock clock_;
  FramePipe pipe_;
  FaultyPort port_{pipe_.host(), clock_, 42};
  std::vector<std::uint32_t> heard_;
  std::map<std::uint32_t, std::int64_t> heard_at_ns_;
};

TEST_F(FaultyPortTest, WithoutFaultsItIsTransparent) {
  const auto heard = send(1000);
  ASSERT_EQ(heard.size(), 1000U);
  for (std::uint32_t i = 0; i < 1000; ++i) EXPECT_EQ(heard[i], i);
  pipe_.machine().send(numbered(5));
  CanFrame frame;
  EXPECT_EQ(port_.receive(frame), SocketStatus::kOk);
  EXPECT_EQ(number_of(frame), 5U);
  EXPECT_EQ(port_.receive(frame), SocketStatus::kWouldBlock);
}

TEST_F(FaultyPortTest, TheSameSeedDoesTheSameHarm) {
  std::vector<std::uint32_t> runs[3];
  const std::uint64_t seeds[] = {7, 7, 8};
  for (int run = 0; run < 3; ++run) {
    FramePipe pipe;
    FaultyPort port(pipe.host(), clock_, seeds[run]);
    port.set_sending({.loss = 0.3, .duplicate = 0.1});
    for (std::uint32_t i = 0; i < 500; ++i) port.send(numbered(i));
    CanFrame frame;
    while (pipe.machine().receive(frame) == SocketStatus::kOk) {
      runs[run].push_back(number_of(frame));
    }
  }
  EXPECT_EQ(runs[0], runs[1]);
  EXPECT_NE(runs[0], runs[2]);
}

TEST_F(FaultyPortTest, LosesAndDuplicatesAsOftenAsAsked) {
  port_.set_sending({.loss = 0.2, .duplicate = 0.1});
  const auto heard = send(10'000);
  EXPECT_NEAR(static_cast<double>(port_.counters().lost), 2000.0, 120.0);
  EXPECT_NEAR(static_cast<double>(port_.counters().duplicated), 800.0, 90.0);
  EXPECT_EQ(static_cast<long>(heard.size()),
            10'000 - port_.counters().lost + port_.counters().duplicated);
}

TEST_F(FaultyPortTest, DelaysWithinTheJitter) {
  port_.set_sending({.delay_s = 0.020, .jitter_s = 0.010});
  const auto heard = send(2000);
  EXPECT_EQ(heard.size(), 2000U);
  double least_s = 1.0, greatest_s = 0.0;
  for (const auto& [number, at_ns] : heard_at_ns_) {
    const double delay_s = 1e-9 * static_cast<double>(at_ns - number * 1'000'000LL);
    least_s = std::min(least_s, delay_s);
    greatest_s = std::max(greatest_s, delay_s);
  }
  EXPECT_GE(least_s, 0.010);
  EXPECT_LT(least_s, 0.013);
  EXPECT_LE(greatest_s, 0.032);
  EXPECT_GT(greatest_s, 0.028);
}

TEST_F(FaultyPortTest, ReordersSomeFrames) {
  port_.set_sending({.reorder = 0.05});
  const auto heard = send(2000);
  EXPECT_EQ(heard.size(), 2000U);
  long overtaken = 0;
  for (std::size_t i = 1; i < heard.size(); ++i) overtaken += heard[i] < heard[i - 1] ? 1 : 0;
  EXPECT_GT(overtaken, 50);
  EXPECT_NEAR(static_cast<double>(port_.counters().reordered), 100.0, 40.0);
}

TEST_F(FaultyPortTest, CorruptsOneToThreeBits) {
  port_.set_receiving({.corrupt = 1.0});
  std::map<int, int> flips;
  for (int i = 0; i < 1000; ++i) {
    pipe_.machine().send(numbered(0));
    CanFrame frame;
    ASSERT_EQ(port_.receive(frame), SocketStatus::kOk);
    int count = 0;
    for (int byte = 0; byte < 8; ++byte) count += std::popcount(frame.data[byte]);
    ++flips[count];
  }
  EXPECT_GT(flips[1], 200);
  EXPECT_GT(flips[2], 200);
  EXPECT_GT(flips[3], 200);
  EXPECT_EQ(flips[0] + flips[1] + flips[2] + flips[3], 1000);
}

TEST_F(FaultyPortTest, AStalledBusTakesFiveFramesThatGoOutAfterwards) {
  port_.set_stalled(true);
  for (std::uint32_t i = 0; i < 5; ++i) EXPECT_EQ(port_.send(numbered(i)), SocketStatus::kOk);
  EXPECT_EQ(port_.send(numbered(5)), SocketStatus::kWouldBlock);
  hear();
  EXPECT_TRUE(heard_.empty());
  port_.set_stalled(false);
  hear();
  EXPECT_EQ(heard_.size(), 5U);
  EXPECT_EQ(port_.counters().replayed_after_stall, 5);
}

TEST_F(FaultyPortTest, APurgeForgetsWhatTheStallHolds) {
  port_.set_stalled(true);
  port_.send(numbered(1));
  EXPECT_FALSE(port_.purge()) << "not allowed yet";
  port_.set_purge_possible(true);
  EXPECT_TRUE(port_.purge());
  port_.set_stalled(false);
  hear();
  EXPECT_TRUE(heard_.empty());
}

TEST_F(FaultyPortTest, AnInterfaceThatIsDownTellsOnceAndWorksAgainAfterwards) {
  CanFrame frame;
  port_.set_interface(FaultyPort::Interface::kDown);
  EXPECT_EQ(port_.send(frame), SocketStatus::kInterfaceDown);
  pipe_.machine().send(numbered(1));
  EXPECT_EQ(port_.receive(frame), SocketStatus::kInterfaceDown);
  EXPECT_EQ(port_.receive(frame), SocketStatus::kWouldBlock);
  port_.set_interface(FaultyPort::Interface::kUp);
  EXPECT_EQ(port_.receive(frame), SocketStatus::kWouldBlock) << "what was said meanwhile is lost";
  EXPECT_EQ(port_.send(frame), SocketStatus::kOk);
}

TEST_F(FaultyPortTest, ADeletedInterfaceNeedsReopening) {
  CanFrame frame;
  port_.set_interface(FaultyPort::Interface::kGone);
  EXPECT_EQ(port_.reopen(), SocketStatus::kGone);
  port_.set_interface(FaultyPort::Interface::kUp);
  EXPECT_EQ(port_.send(frame), SocketStatus::kGone) << "the old socket is dead for ever";
  EXPECT_EQ(port_.receive(frame), SocketStatus::kGone);
  EXPECT_EQ(port_.receive(frame), SocketStatus::kWouldBlock);
  EXPECT_EQ(port_.reopen(), SocketStatus::kOk);
  EXPECT_EQ(port_.send(frame), SocketStatus::kOk);
  EXPECT_EQ(port_.reopens(), 1);
}

TEST_F(FaultyPortTest, AFrozenJointKeepsItsPositionWithQualityStale) {
  SendContext context;
  ZoneFeedback feedback;
  feedback.zone = 4;
  port_.freeze_joint(JointSlot{4, 1});
  for (int i = 0; i < 3; ++i) {
    feedback.position = {0.1 * i, 0.2 + 0.1 * i, 0.0, 0.0};
    feedback.rate[1] = 0.1;
    CanFrame frame;
    ASSERT_TRUE(encode(feedback, context, frame));
    pipe_.machine().send(frame);
    ASSERT_EQ(port_.receive(frame), SocketStatus::kOk);
    ZoneFeedback heard;
    const auto meta = decode(frame, 0, heard);
    ASSERT_TRUE(meta) << "its CRC is right";
    EXPECT_EQ(meta->counter, i);
    EXPECT_NEAR(heard.position[0], 0.1 * i, 1e-6);
    EXPECT_EQ(heard.quality[0], JointQuality::kOk);
    EXPECT_NEAR(heard.position[1], 0.2, 1e-6);
    EXPECT_EQ(heard.rate[1], 0.0);
    EXPECT_EQ(heard.quality[1], JointQuality::kStale);
  }
  EXPECT_EQ(port_.counters().frozen, 3);
}

TEST_F(FaultyPortTest, DroppedFramesAreCountedOnTopOfTheInnerPorts) {
  EXPECT_EQ(port_.dropped(), 0U);
  port_.add_dropped(3);
  EXPECT_EQ(port_.dropped(), 3U);
}

}  // namespace
}  // namespace wex::can
