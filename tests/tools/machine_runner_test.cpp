#include "tools/wex/machine_runner.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "hw_interface/socketcan/frame_pipe.hpp"
#include "tests/support/fake_plant.hpp"

namespace wex::app {
namespace {

constexpr std::int64_t kMs = 1'000'000;

const MachineModel& m545() {
  static const MachineModel machine = load_machine().value();
  return machine;
}

/// Time goes on only while somebody sleeps or waits.
class TestPacer final : public Pacer {
 public:
  std::int64_t now_ns() noexcept override { return time_ns; }
  void sleep_until(std::int64_t until_ns) noexcept override {
    time_ns = std::max(time_ns, until_ns) + oversleep_ns;
    oversleep_ns = 0;
  }
  std::int64_t time_ns = 7'000'000'000'000, oversleep_ns = 0;
};

class MachineRunnerTest : public ::testing::Test {
 protected:
  MachineRunnerTest() {
    bus_.machine().on_wait = [this](double timeout_s) {
      pacer_.time_ns += static_cast<std::int64_t>(1e9 * timeout_s);
      if (on_wait_) on_wait_();
    };
  }
  void run(const MachineRunnerSettings& settings) {
    can::ElectronicsSettings electronics_settings;
    electronics_settings.lock_step = settings.lock_step;
    electronics_ =
        can::Electronics::create(m545(), plant_, bus_.machine(), random_, electronics_settings)
            .value();
    MachineRunner runner(*electronics_, bus_.machine(), pacer_, settings,
                         [this](std::int64_t now_ms) {
                           ticks_.emplace_back(now_ms, pacer_.time_ns);
                           if (on_tick_) on_tick_(now_ms);
                         });
    runner.run(stop_);
  }
  void allow(std::uint32_t until_ms) {
    can::CanFrame frame;
    ASSERT_TRUE(encode(can::LockStep{until_ms}, step_context_, frame).has_value());
    bus_.host().send(frame);
  }

  can::FramePipe bus_;
  can::FakePlant plant_{m545()};
  can::SeededRandom random_{1};
  std::unique_ptr<can::Electronics> electronics_;
  TestPacer pacer_;
  std::atomic<bool> stop_{false};
  can::SendContext step_context_;
  std::vector<std::pair<std::int64_t, std::int64_t>> ticks_;  ///< machine ms, wall ns
  std::function<void(std::int64_t)> on_tick_;
  std::function<void()> on_wait_;
};

TEST_F(MachineRunnerTest, RealTimeIsAPeriodEvery10Ms) {
  run({.exit_after_s = 1.0});
  ASSERT_EQ(ticks_.size(), 100u);
  for (std::size_t i = 0; i < ticks_.size(); ++i) {
    EXPECT_EQ(ticks_[i].first, 10 * static_cast<std::int64_t>(i + 1));
    EXPECT_EQ(ticks_[i].second - ticks_[0].second, 10 * kMs * static_cast<std::int64_t>(i));
  }
}

TEST_F(MachineRunnerTest, ASmallDelayIsCaughtUp) {
  on_tick_ = [&](std::int64_t now_ms) {
    if (now_ms == 500) pacer_.oversleep_ns = 45 * kMs;
  };
  run({.exit_after_s = 1.0});
  EXPECT_EQ(ticks_.size(), 100u);
  EXPECT_EQ(ticks_.back().second - ticks_.front().second, 990 * kMs);
}

TEST_F(MachineRunnerTest, AfterALongPauseTheClockGoesOnAndThePeriodsAreLost) {
  on_tick_ = [&](std::int64_t now_ms) {
    if (now_ms == 500) pacer_.oversleep_ns = 2000 * kMs;
  };
  run({.exit_after_s = 3.0});
  EXPECT_EQ(ticks_.size(), 100u);
  EXPECT_EQ(ticks_.back().first, 3000);
  EXPECT_EQ(ticks_.back().second - ticks_.front().second, 2990 * kMs);
  EXPECT_EQ(ticks_[50].first, 2510);
}

TEST_F(MachineRunnerTest, TheChainOpensWhenAsked) {
  can::MachineMode before = can::MachineMode::kInit, after = before;
  on_tick_ = [&](std::int64_t now_ms) {
    if (now_ms == 490) before = electronics_->automaton().mode();
    if (now_ms == 500) after = electronics_->automaton().mode();
  };
  run({.estop_after_s = 0.5, .exit_after_s = 1.0});
  EXPECT_NE(before, can::MachineMode::kEStop);
  EXPECT_EQ(after, can::MachineMode::kEStop);
}

TEST_F(MachineRunnerTest, ASignalEndsIt) {
  on_tick_ = [&](std::int64_t now_ms) { stop_ = now_ms == 200; };
  run({});
  EXPECT_EQ(ticks_.size(), 20u);
}

TEST_F(MachineRunnerTest, BeforeAHostIsThereTheClockRunsByItselfInLockStepToo) {
  run({.lock_step = true, .exit_after_s = 0.5});
  EXPECT_EQ(ticks_.size(), 50u);
  EXPECT_NEAR(1e-9 * static_cast<double>(ticks_.back().second - ticks_.front().second), 0.49, 0.02);
}

TEST_F(MachineRunnerTest, LockStepLetsTheClockGoExactlyAsFarAsAsked) {
  std::uint32_t allowed_ms = 0;
  on_wait_ = [&] {
    EXPECT_TRUE(ticks_.empty() || ticks_.back().first == allowed_ms);
    allowed_ms += 30;
    allow(allowed_ms);
    stop_ = allowed_ms > 3000;
  };
  allow(0);
  run({.lock_step = true});
  EXPECT_EQ(ticks_.size(), 300u);
  EXPECT_EQ(ticks_.back().first, 3000);
}

TEST_F(MachineRunnerTest, AStepThatIsAskedForTwiceIsDoneOnce) {
  int waits = 0;
  on_wait_ = [&] {
    allow(50);
    stop_ = ++waits == 5;
  };
  allow(50);
  run({.lock_step = true});
  EXPECT_EQ(ticks_.size(), 5u);
}

TEST_F(MachineRunnerTest, WithoutLockStepForASecondTheClockRunsByItself) {
  int waits = 0;
  on_wait_ = [&] {
    if (++waits == 1) allow(100);
  };
  allow(0);
  const std::int64_t start_ns = pacer_.time_ns;
  run({.lock_step = true, .exit_after_s = 1.0});
  ASSERT_EQ(ticks_.size(), 100u);
  EXPECT_EQ(ticks_[9].first, 100);
  EXPECT_LT(ticks_[9].second - start_ns, 100 * kMs) << "as asked";
  EXPECT_GT(ticks_[10].second - ticks_[9].second, 980 * kMs) << "then it waits";
  EXPECT_NEAR(1e-9 * static_cast<double>(ticks_[99].second - ticks_[10].second), 0.89, 0.03);
}

TEST_F(MachineRunnerTest, OneFrameCannotLetTheClockRunForEver) {
  on_tick_ = [&](std::int64_t now_ms) { stop_ = now_ms >= 10'000; };
  allow(2'000'000'000);
  run({.lock_step = true});
  EXPECT_EQ(ticks_.back().first, 10'000);
}

}  // namespace
}  // namespace wex::app
