#include "tools/wex/machine_runner.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

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

  /// What a host sends in one period, from the handshake to the session, all commands neutral.
  void act_as_host() {
    const can::MachineAutomaton& machine = electronics_->automaton();
    const std::uint32_t now_ms =
        ticks_.empty() ? 0 : static_cast<std::uint32_t>(ticks_.back().first);
    can::CanFrame frame;
    can::HostHeartbeat heartbeat;
    heartbeat.dbc_hash = can::dbc_hash();
    heartbeat.session = machine.session();
    heartbeat.request = machine.mode() == can::MachineMode::kInit ? can::HostRequest::kNone
                                                                  : can::HostRequest::kEnable;
    heartbeat.nonce = 77;
    heartbeat.challenge_echo = machine.challenge();
    ASSERT_TRUE(encode(heartbeat, heartbeat_context_, frame));
    bus_.host().send(frame);
    for (int zone = 0; zone < can::kNumZones && machine.session() != 0; ++zone) {
      can::ZoneCommand command;
      command.zone = zone;
      command.valid_for_ms = 60;
      command.echo_time_ms = now_ms;
      command_context_[zone].session = machine.session();
      ASSERT_TRUE(encode(command, command_context_[zone], frame));
      bus_.host().send(frame);
    }
    allow(now_ms + 10);
  }

  can::FramePipe bus_;
  can::FakePlant plant_{m545()};
  can::SeededRandom random_{1};
  std::unique_ptr<can::Electronics> electronics_;
  TestPacer pacer_;
  std::atomic<bool> stop_{false};
  can::SendContext step_context_, heartbeat_context_;
  std::array<can::SendContext, can::kNumZones> command_context_;
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

TEST_F(MachineRunnerTest, ALongSolveWithinASessionIsWaitedFor) {
  constexpr std::int64_t kSolve_ns = 3000 * kMs;
  std::int64_t silent_until_ns = 0;
  bool solved = false;
  on_wait_ = [&] {
    if (pacer_.time_ns < silent_until_ns) return;
    if (!solved && electronics_->automaton().mode() == can::MachineMode::kEnabled) {
      solved = true;
      silent_until_ns = pacer_.time_ns + kSolve_ns;
      return;
    }
    act_as_host();
  };
  on_tick_ = [&](std::int64_t) {
    EXPECT_GE(pacer_.time_ns, silent_until_ns) << "the clock ran while the host was busy";
  };
  run({.lock_step = true, .exit_after_s = 3.0});
  ASSERT_TRUE(solved);
  EXPECT_EQ(electronics_->automaton().mode(), can::MachineMode::kEnabled);
  EXPECT_EQ(electronics_->automaton().holds(), 0);
}

TEST_F(MachineRunnerTest, AHostThatDiesWithinASessionLeavesAMachineThatHoldsAndFaults) {
  std::int64_t died_ns = 0, died_ms = 0;
  on_wait_ = [&] {
    if (died_ns > 0) return;
    act_as_host();
    if (electronics_->automaton().mode() != can::MachineMode::kEnabled) return;
    died_ns = pacer_.time_ns;
    died_ms = ticks_.back().first + 10;  // as far as the last LockStep allows
  };
  std::map<can::MachineMode, std::int64_t> first_ms;
  std::int64_t ran_free_ns = 0;
  on_tick_ = [&](std::int64_t now_ms) {
    if (died_ns == 0 || now_ms <= died_ms) return;
    if (ran_free_ns == 0) ran_free_ns = pacer_.time_ns;
    first_ms.emplace(electronics_->automaton().mode(), now_ms - died_ms);
    stop_ = electronics_->automaton().mode() == can::MachineMode::kFault;
  };
  run({.lock_step = true, .exit_after_s = 60.0, .free_run_in_session_after_s = 4.0});
  EXPECT_NEAR(1e-9 * static_cast<double>(ran_free_ns - died_ns), 4.0, 0.05);
  ASSERT_TRUE(first_ms.contains(can::MachineMode::kHold));
  EXPECT_LE(first_ms[can::MachineMode::kHold], 60);
  ASSERT_TRUE(first_ms.contains(can::MachineMode::kFault));
  EXPECT_LE(first_ms[can::MachineMode::kFault], 520);
}

TEST_F(MachineRunnerTest, OneFrameCannotLetTheClockRunForEver) {
  on_tick_ = [&](std::int64_t now_ms) { stop_ = now_ms >= 10'000; };
  allow(2'000'000'000);
  run({.lock_step = true});
  EXPECT_EQ(ticks_.back().first, 10'000);
}

}  // namespace
}  // namespace wex::app
