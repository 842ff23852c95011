#include "hw_interface/electronics/machine_limits.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace wex::can {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMaxRate = 0.5, kMaxAcceleration = 0.4, kUpper = 1.0, kLower = -2.0;
constexpr int kJoint = 0, kWheel = 1;

class MachineLimitsTest : public ::testing::Test {
 protected:
  MachineLimitsTest() { limits_.reset(now_ms_); }

  static MachineLimits make(const MachineLimitsSettings& settings) {
    MachineLimits::Limits limits{};
    limits[kJoint] = {kLower, kUpper, kMaxRate, kMaxAcceleration};
    limits[kWheel] = {-kInfinity, kInfinity, 2.5, 0.8};
    std::array<bool, kMaxZoneJoints> is_wheel{};
    is_wheel[kWheel] = true;
    return {limits, is_wheel, settings};
  }
  ZoneCommand command(int joint, double rate) const {
    ZoneCommand command;
    command.active[joint] = true;
    command.rate[joint] = rate;
    command.echo_time_ms = static_cast<std::uint32_t>(now_ms_);
    return command;
  }
  LimitVerdict judge(int joint, double rate) const {
    return limits_.judge(command(joint, rate), position_, now_ms_);
  }
  /// One command per cycle, each accepted without being judged.
  void history(int joint, double rate, int cycles) {
    for (int i = 0; i < cycles; ++i) {
      now_ms_ += settings_.cycle_ms;
      limits_.accept(command(joint, rate), now_ms_);
    }
  }

  MachineLimitsSettings settings_;
  MachineLimits limits_ = make(settings_);
  std::array<double, kMaxZoneJoints> position_{};
  std::int64_t now_ms_ = 5000;
};

TEST_F(MachineLimitsTest, AgesOfTheEchoedFeedbackUpTo60MsAreGood) {
  for (const int age_ms : {0, 10, 60}) {
    EXPECT_EQ(limits_.judge_echo(static_cast<std::uint32_t>(now_ms_ - age_ms), now_ms_),
              LimitVerdict::kOk);
  }
  for (const int age_ms : {61, 100, 5000, -1, -1000}) {
    EXPECT_EQ(limits_.judge_echo(static_cast<std::uint32_t>(now_ms_ - age_ms), now_ms_),
              LimitVerdict::kStaleEcho)
        << age_ms;
  }
}

TEST_F(MachineLimitsTest, TheEchoMayWrapWithTheClock) {
  const std::int64_t wrapped_ms = (1LL << 32) + 20;
  EXPECT_EQ(limits_.judge_echo(static_cast<std::uint32_t>(wrapped_ms - 50), wrapped_ms),
            LimitVerdict::kOk);
  EXPECT_EQ(limits_.judge_echo(static_cast<std::uint32_t>(wrapped_ms - 90), wrapped_ms),
            LimitVerdict::kStaleEcho);
}

TEST_F(MachineLimitsTest, AStaleCommandIsRefusedEvenIfItAsksForNothing) {
  ZoneCommand old = command(kJoint, 0.0);
  old.echo_time_ms -= 61;
  EXPECT_EQ(limits_.judge(old, position_, now_ms_), LimitVerdict::kStaleEcho);
}

TEST_F(MachineLimitsTest, RatesBeyondTheJointsOwnAreRefused) {
  history(kJoint, kMaxRate, 30);
  EXPECT_EQ(judge(kJoint, kMaxRate), LimitVerdict::kOk);
  EXPECT_EQ(judge(kJoint, kMaxRate + 0.01), LimitVerdict::kRate);
  EXPECT_EQ(judge(kJoint, -kMaxRate - 0.01), LimitVerdict::kRate);
  EXPECT_EQ(judge(kJoint, std::numeric_limits<double>::quiet_NaN()), LimitVerdict::kRate);
}

TEST_F(MachineLimitsTest, InactiveJointsAreNotJudged) {
  ZoneCommand idle = command(kJoint, 100.0);
  idle.active[kJoint] = false;
  EXPECT_EQ(limits_.judge(idle, position_, now_ms_), LimitVerdict::kOk);
}

TEST_F(MachineLimitsTest, TowardsAStopTheRateIsWhatCanBeBraked) {
  settings_.latency_allowance_s = 0.0;
  limits_ = make(settings_);
  limits_.reset(now_ms_);
  for (const double way : {0.0, 0.01, 0.1, 0.2}) {
    const double fastest = std::sqrt(2.0 * kMaxAcceleration * way);
    for (const double sign : {1.0, -1.0}) {
      position_[kJoint] = sign > 0.0 ? kUpper - way : kLower + way;
      history(kJoint, sign * kMaxRate, 30);
      EXPECT_EQ(judge(kJoint, sign * (fastest + 0.001)), LimitVerdict::kOk) << way;
      EXPECT_EQ(judge(kJoint, sign * (fastest + 0.01)), LimitVerdict::kSoftStop) << way;
      history(kJoint, -sign * kMaxRate, 30);
      EXPECT_EQ(judge(kJoint, -sign * kMaxRate), LimitVerdict::kOk) << "away from the stop";
    }
  }
}

TEST_F(MachineLimitsTest, BeyondAStopOnlyTheWayBackIsOpen) {
  position_[kJoint] = kUpper + 0.1;
  history(kJoint, 0.2, 30);
  EXPECT_EQ(judge(kJoint, 0.2), LimitVerdict::kSoftStop);
  EXPECT_EQ(judge(kJoint, 0.0), LimitVerdict::kOk);
  history(kJoint, -0.2, 30);
  EXPECT_EQ(judge(kJoint, -0.2), LimitVerdict::kOk);
}

TEST_F(MachineLimitsTest, TheHostsPositionsMayBeAFewPeriodsOld) {
  position_[kJoint] = kUpper;
  history(kJoint, 0.1, 30);
  // 0.5 rad/s for 30 ms are 0.015 rad: sqrt(2 * 0.4 * 0.015) = 0.1095.
  EXPECT_EQ(judge(kJoint, 0.105), LimitVerdict::kOk);
  EXPECT_EQ(judge(kJoint, 0.115), LimitVerdict::kSoftStop);
}

TEST_F(MachineLimitsTest, JointsWithoutStopsHaveNone) {
  position_[kWheel] = 1e6;
  history(kWheel, 2.5, 30);
  EXPECT_EQ(judge(kWheel, 2.5), LimitVerdict::kOk);
}

TEST_F(MachineLimitsTest, ARateGrowsAsTheAccelerationAllows) {
  history(kJoint, 0.1, 30);
  now_ms_ += 10;
  const double most = 0.1 + 1.2 * kMaxAcceleration * 0.01 + 2e-3;
  EXPECT_EQ(judge(kJoint, most - 1e-6), LimitVerdict::kOk);
  EXPECT_EQ(judge(kJoint, most + 1e-6), LimitVerdict::kRateChange);
}

TEST_F(MachineLimitsTest, LostCommandsGiveTimeButNotForEver) {
  history(kJoint, 0.1, 30);
  const double per_cycle = 1.2 * kMaxAcceleration * 0.01;
  now_ms_ += 30;
  EXPECT_EQ(judge(kJoint, 0.1 + 3.0 * per_cycle), LimitVerdict::kOk);
  EXPECT_EQ(judge(kJoint, 0.1 + 4.0 * per_cycle), LimitVerdict::kRateChange);
  now_ms_ += 970;
  EXPECT_EQ(judge(kJoint, 0.1 + 5.0 * per_cycle + 1.9e-3), LimitVerdict::kOk);
  EXPECT_EQ(judge(kJoint, 0.1 + 5.0 * per_cycle + 2.1e-3), LimitVerdict::kRateChange);
}

TEST_F(MachineLimitsTest, TwoCommandsInOneInstantAreEachAllowedOneCycle) {
  history(kJoint, 0.1, 30);
  EXPECT_EQ(judge(kJoint, 0.1 + 0.0048), LimitVerdict::kOk);
}

TEST_F(MachineLimitsTest, SlowingDownIsAlwaysAllowed) {
  for (const double sign : {1.0, -1.0}) {
    history(kJoint, sign * kMaxRate, 30);
    now_ms_ += 10;
    EXPECT_EQ(judge(kJoint, 0.0), LimitVerdict::kOk);
    EXPECT_EQ(judge(kJoint, sign * 0.2), LimitVerdict::kOk);
    EXPECT_EQ(judge(kJoint, -sign * 0.005), LimitVerdict::kOk) << "one cycle from zero";
    EXPECT_EQ(judge(kJoint, -sign * 0.05), LimitVerdict::kRateChange);
  }
}

TEST_F(MachineLimitsTest, ABurstOfCommandsDoesNotOutrunThe250MsWindow) {
  // Many commands in no time, each within one cycle of the one before.
  history(kJoint, 0.0, 30);
  const double window = 1.2 * kMaxAcceleration * 0.25 + 2e-3;
  double rate = 0.0;
  LimitVerdict verdict = LimitVerdict::kOk;
  while (verdict == LimitVerdict::kOk && rate < 1.0) {
    limits_.accept(command(kJoint, rate), now_ms_);
    rate += 0.0047;
    verdict = judge(kJoint, rate);
  }
  EXPECT_EQ(verdict, LimitVerdict::kWindow);
  EXPECT_NEAR(rate, window, 0.005);
}

TEST_F(MachineLimitsTest, TheWindowForgetsWhatIsOlderThan250Ms) {
  history(kJoint, 0.0, 30);
  history(kJoint, 0.3, 24);
  EXPECT_EQ(judge(kJoint, 0.3), LimitVerdict::kWindow) << "0 is 240 ms ago";
  history(kJoint, 0.3, 1);
  EXPECT_EQ(judge(kJoint, 0.3), LimitVerdict::kWindow) << "0 is 250 ms ago";
  history(kJoint, 0.3, 1);
  EXPECT_EQ(judge(kJoint, 0.3), LimitVerdict::kOk) << "0 is 260 ms ago";
  history(kJoint, 0.0, 1);
  history(kJoint, -0.3, 24);
  EXPECT_EQ(judge(kJoint, -0.3), LimitVerdict::kWindow) << "the other way likewise";
}

TEST_F(MachineLimitsTest, TheWindowKnowsBothExtremesOfOneInstant) {
  for (const double sign : {1.0, -1.0}) {
    limits_.reset(now_ms_);  // 0, and in the same instant 0.3
    limits_.accept(command(kJoint, sign * 0.3), now_ms_);
    EXPECT_EQ(judge(kJoint, sign * 0.3), LimitVerdict::kWindow);
    EXPECT_EQ(judge(kJoint, sign * 0.1), LimitVerdict::kOk);
  }
}

TEST_F(MachineLimitsTest, TheWindowKnowsWhatWasBetweenTwoCommandsOfOneInstant) {
  for (const double sign : {1.0, -1.0}) {
    history(kJoint, sign * 0.3, 30);
    limits_.accept(command(kJoint, 0.0), now_ms_);
    limits_.accept(command(kJoint, sign * 0.3), now_ms_);
    EXPECT_EQ(judge(kJoint, sign * 0.3), LimitVerdict::kWindow);
  }
}

TEST_F(MachineLimitsTest, TheWindowIsAsWideAsItSays) {
  history(kJoint, 0.0, 30);
  history(kJoint, 0.1219, 1);
  EXPECT_EQ(judge(kJoint, 0.1219), LimitVerdict::kOk) << "1.2 * 0.4 * 0.25 + 0.002 = 0.122";
  EXPECT_EQ(judge(kJoint, 0.1221), LimitVerdict::kWindow);
}

TEST_F(MachineLimitsTest, TheWindowMovesInStepsOf10Ms) {
  now_ms_ = 4993;
  history(kJoint, 0.0, 1);  // at 5003
  now_ms_ = 5015;
  history(kJoint, 0.3, 1);
  limits_.accept(command(kJoint, 0.3), now_ms_);
  now_ms_ = 5259;
  EXPECT_EQ(judge(kJoint, 0.3), LimitVerdict::kWindow);
  now_ms_ = 5260;
  EXPECT_EQ(judge(kJoint, 0.3), LimitVerdict::kOk);
}

TEST_F(MachineLimitsTest, TheLongestWindowForgetsNothingTooEarly) {
  settings_.window_ms = MachineLimits::kMaxWindow_ms;
  ASSERT_EQ(settings_.window_ms, 500);
  limits_ = make(settings_);
  limits_.reset(now_ms_);
  history(kJoint, kMaxRate, 50);
  EXPECT_EQ(judge(kJoint, kMaxRate), LimitVerdict::kWindow) << "0 is 500 ms ago";
  history(kJoint, kMaxRate, 1);
  EXPECT_EQ(judge(kJoint, kMaxRate), LimitVerdict::kOk) << "0 is 510 ms ago";
}

TEST_F(MachineLimitsTest, BeforeTheFirstCommandEverythingStood) {
  limits_ = make(settings_);
  now_ms_ = 20;
  EXPECT_EQ(judge(kJoint, 0.0115), LimitVerdict::kOk) << "1.2 * 0.4 * 0.02 + 0.002 = 0.0116";
  EXPECT_EQ(judge(kJoint, 0.0117), LimitVerdict::kRateChange);
  now_ms_ = 235;
  limits_.accept(command(kJoint, 0.3), now_ms_);
  now_ms_ = 240;
  EXPECT_EQ(judge(kJoint, 0.3), LimitVerdict::kWindow);
  now_ms_ = 250;
  EXPECT_EQ(judge(kJoint, 0.3), LimitVerdict::kOk);
}

TEST_F(MachineLimitsTest, TheLimitsThemselvesAreAllowed) {
  // Numbers without rounding: what stands exactly at a limit passes, the next number does not.
  const auto next = [](double rate) { return std::nextafter(rate, kInfinity); };
  settings_.rate_tolerance = settings_.latency_allowance_s = 0.0;
  MachineLimits::Limits limits{};
  limits[kJoint] = {-1.0, 1.0, 0.5, 0.5};
  limits_ = MachineLimits(limits, {}, settings_);
  history(kJoint, 0.5, 30);
  EXPECT_EQ(judge(kJoint, 0.5), LimitVerdict::kOk);
  EXPECT_EQ(judge(kJoint, next(0.5)), LimitVerdict::kRate);
  limits[kJoint].max_rate = 1.0;
  limits_ = MachineLimits(limits, {}, settings_);
  history(kJoint, 1.0, 30);
  position_[kJoint] = 0.75;
  EXPECT_EQ(judge(kJoint, 0.5), LimitVerdict::kOk) << "sqrt(2 * 0.5 * 0.25)";
  EXPECT_EQ(judge(kJoint, next(0.5)), LimitVerdict::kSoftStop);
  position_[kJoint] = 0.0;
  settings_.acceleration_factor = settings_.window_factor = 1000.0;
  limits[kJoint] = {-1e6, 1e6, 5.0, 0.125};
  limits_ = MachineLimits(limits, {}, settings_);
  history(kJoint, 0.25, 30);
  EXPECT_EQ(judge(kJoint, 0.25 + 1.25), LimitVerdict::kOk) << "1000 * 0.125 * 0.01 = 1.25";
  EXPECT_EQ(judge(kJoint, next(1.5)), LimitVerdict::kRateChange);
}

TEST_F(MachineLimitsTest, WheelsMayChangeByTheirCorrectionsAtOnce) {
  history(kWheel, 0.5, 30);
  EXPECT_EQ(judge(kWheel, 0.64), LimitVerdict::kOk);
  EXPECT_EQ(judge(kWheel, 0.68), LimitVerdict::kRateChange);
}

TEST_F(MachineLimitsTest, ResetCountsChangesFromZero) {
  history(kJoint, 0.4, 30);
  limits_.reset(now_ms_);
  now_ms_ += 10;
  EXPECT_EQ(judge(kJoint, 0.005), LimitVerdict::kOk);
  EXPECT_EQ(judge(kJoint, 0.4), LimitVerdict::kRateChange);
}

TEST_F(MachineLimitsTest, OneJointOutOfFiveIsEnough) {
  ZoneCommand many = command(kWheel, 0.0);
  many.active[kJoint] = true;
  many.rate[kJoint] = 0.3;
  EXPECT_EQ(limits_.judge(many, position_, now_ms_), LimitVerdict::kRateChange);
}

TEST(IsNeutral, AsksAboutActiveJointsOnly) {
  for (std::size_t joint = 0; joint < kMaxZoneJoints; ++joint) {
    ZoneCommand command;
    EXPECT_TRUE(is_neutral(command, 0.005));
    command.rate[joint] = 0.3;
    EXPECT_TRUE(is_neutral(command, 0.005)) << "not active";
    command.active[joint] = true;
    EXPECT_FALSE(is_neutral(command, 0.005));
    command.rate[joint] = -0.005;
    EXPECT_TRUE(is_neutral(command, 0.005));
    command.rate[joint] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(is_neutral(command, 0.005));
  }
}

}  // namespace
}  // namespace wex::can
