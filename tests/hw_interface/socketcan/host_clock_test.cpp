#include "hw_interface/socketcan/host_clock.hpp"

#include <gtest/gtest.h>

namespace wex::can {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kHour_ns = 3'600'000 * kMs;

TEST(HostClock, SaysNothingBeforeTheFirstStamp) {
  HostClock clock;
  EXPECT_FALSE(clock.valid());
  EXPECT_EQ(clock.now_s(123 * kMs), 0.0);
  EXPECT_EQ(clock.newest_stamp_ms(), 0U);
}

TEST(HostClock, FollowsTheSmallestOffsetSeen) {
  HostClock clock;
  clock.observe(1000, 50'007 * kMs);
  EXPECT_NEAR(clock.now_s(50'007 * kMs), 1.000, 1e-9);
  clock.observe(1010, 50'012 * kMs);  // 5 ms faster than the first
  EXPECT_NEAR(clock.now_s(50'012 * kMs), 1.010, 1e-9);
  clock.observe(1020, 50'040 * kMs);  // late: its age shows
  EXPECT_NEAR(clock.now_s(50'040 * kMs), 1.038, 1e-5);
  EXPECT_NEAR(clock.seconds_of(1020), 1.020, 1e-12);
}

TEST(HostClock, FollowsAMachineClockThatIsSlower) {
  HostClock clock;
  constexpr double kSlow = 1.0 - 5e-5;
  std::int64_t now_ns = 0;
  for (int i = 0; i < 60'000; ++i) {
    now_ns = i * 10 * kMs;
    clock.observe(static_cast<std::uint32_t>(kSlow * 10.0 * i), now_ns);
  }
  EXPECT_NEAR(clock.now_s(now_ns), kSlow * 1e-9 * static_cast<double>(now_ns), 2e-3);
}

TEST(HostClock, OneLateFrameMovesItByTheDriftOfThatTimeOnly) {
  constexpr std::int64_t kLong_ns = 1'000'000'000 * kMs;  // of whatever the host did before
  HostClock clock;
  clock.observe(1000, kLong_ns);
  clock.observe(1010, kLong_ns + 40 * kMs);
  EXPECT_NEAR(clock.now_s(kLong_ns + 40 * kMs), 1.040, 5e-6);
  std::int64_t now_ns = kLong_ns + 40 * kMs;
  for (std::uint32_t stamp_ms = 1020; stamp_ms <= 101'000; stamp_ms += 10) {
    now_ns = kLong_ns + (stamp_ms - 1000) * kMs;
    clock.observe(stamp_ms, now_ns);
  }
  clock.observe(101'010, now_ns + 30 * kMs);
  EXPECT_NEAR(clock.now_s(now_ns + 30 * kMs), 101.030, 5e-6);
}

TEST(HostClock, AfterALongSilenceALateFrameMovesItByTheLargestDrift) {
  HostClock clock;
  clock.observe(1000, 0);
  clock.observe(101'000, 100'500 * kMs);  // 100 s in 100.5 s
  EXPECT_NEAR(clock.now_s(100'500 * kMs), 101.5 - 1e-4 * 100.5, 1e-6);
}

TEST(HostClock, AStampHeardAgainTellsNothing) {
  HostClock clock;
  clock.observe(1000, 0);
  clock.observe(1000, 10'000 * kMs);
  EXPECT_NEAR(clock.now_s(10'000 * kMs), 11.0, 1e-6);
}

TEST(HostClock, CountsOnThroughTheWrapOfTheStamp) {
  HostClock clock;
  clock.observe(0xFFFFFFF0U, 0);
  const double before_s = clock.now_s(0);
  EXPECT_EQ(clock.observe(0x00000010U, 32 * kMs), HostClock::Verdict::kOk);
  EXPECT_NEAR(clock.now_s(32 * kMs) - before_s, 0.032, 1e-9);
  EXPECT_EQ(clock.newest_stamp_ms(), 0x10U);
}

TEST(HostClock, InLockStepTimeStandsWhileNothingIsHeard) {
  HostClock clock;
  clock.observe(1000, 0);
  clock.set_mode(HostClock::Mode::kLockStep, 5 * kMs);
  EXPECT_NEAR(clock.now_s(kHour_ns), 1.0, 1e-12);
  EXPECT_EQ(clock.observe(1010, kHour_ns), HostClock::Verdict::kOk);
  EXPECT_NEAR(clock.now_s(2 * kHour_ns), 1.010, 1e-12);
  clock.set_mode(HostClock::Mode::kFreeRunning, 2 * kHour_ns);
  EXPECT_NEAR(clock.now_s(2 * kHour_ns + 30 * kMs), 1.040, 1e-9) << "goes on from where it stood";
  clock.observe(1020, 2 * kHour_ns + 30 * kMs);
  EXPECT_NEAR(clock.now_s(2 * kHour_ns + 30 * kMs), 1.040, 1e-5) << "no drift for the hours before";
}

TEST(HostClock, InLockStepTimeMayRunAsFastAsItCan) {
  HostClock clock;
  clock.observe(1000, 0);
  clock.set_mode(HostClock::Mode::kLockStep, 0);
  EXPECT_EQ(clock.observe(100'000, 1 * kMs), HostClock::Verdict::kOk);
  EXPECT_NEAR(clock.now_s(1 * kMs), 100.0, 1e-9);
}

TEST(HostClock, RunningFreelyAgainChangesNothing) {
  HostClock clock;
  clock.observe(1000, 0);
  clock.set_mode(HostClock::Mode::kFreeRunning, 30 * kMs);
  EXPECT_NEAR(clock.now_s(30 * kMs), 1.030, 1e-9);
}

TEST(HostClock, WhereReorderedEndsAndRestartedBegins) {
  for (const int back_ms : {1000, 1001}) {
    HostClock clock;
    clock.observe(5000, 0);
    EXPECT_EQ(clock.observe(static_cast<std::uint32_t>(5000 - back_ms), 1 * kMs) ==
                  HostClock::Verdict::kRestarted,
              back_ms == 1001);
  }
  for (const int early_ns : {0, 1}) {  // 10 s of stamps in no time at all
    HostClock clock;
    clock.observe(5000, 20 * kMs);
    EXPECT_EQ(clock.observe(15'000, 20 * kMs - early_ns) == HostClock::Verdict::kRestarted,
              early_ns == 1);
  }
}

TEST(HostClock, AReorderedStampChangesNothing) {
  HostClock clock;
  clock.observe(1020, 20 * kMs);
  EXPECT_EQ(clock.observe(1010, 21 * kMs), HostClock::Verdict::kOk);
  EXPECT_EQ(clock.newest_stamp_ms(), 1020U);
  EXPECT_NEAR(clock.seconds_of(1010), 1.010, 1e-12);
}

TEST(HostClock, AMachineSwitchedOnAnewIsNoticedAndTimeGoesOn) {
  HostClock clock;
  clock.observe(500'000, 0);
  clock.observe(500'010, 10 * kMs);
  EXPECT_EQ(clock.observe(20, 2000 * kMs), HostClock::Verdict::kRestarted);
  EXPECT_NEAR(clock.now_s(2000 * kMs), 502.0, 1e-6);
  EXPECT_EQ(clock.observe(30, 2010 * kMs), HostClock::Verdict::kOk);
  EXPECT_NEAR(clock.seconds_of(30), 502.010, 1e-6);
  EXPECT_EQ(clock.newest_stamp_ms(), 30U) << "stamps on the bus stay the machine's";
}

TEST(HostClock, AJumpOfTheMachinesClockIsARestartInBothDirections) {
  for (const std::uint32_t jump_ms : {3'600'000U, 0U - 3'600'000U}) {
    HostClock clock;
    clock.observe(10'000'000, 0);
    EXPECT_EQ(clock.observe(10'000'010 + jump_ms, 10 * kMs), HostClock::Verdict::kRestarted);
    EXPECT_NEAR(clock.now_s(10 * kMs), 10'000.010, 2e-3);
  }
}

}  // namespace
}  // namespace wex::can
