#include "hw_interface/socketcan/host_limits.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "hw_interface/electronics/machine_limits.hpp"

namespace wex::can {
namespace {

const MachineModel& m545() {
  static const MachineModel machine = load_machine().value();
  return machine;
}
int joint(const char* name) { return m545().coordinate(name).value() - kNumBaseCoordinates; }

JointCommand command_of_zero() {
  JointCommand command;
  command.num_joints = m545().num_joints();
  command.valid_until_s = 1.0;
  return command;
}

class HostLimitsTest : public ::testing::Test {
 protected:
  HostLimits limits_{m545()};
  std::array<double, kMaxJoints> position_{};
};

TEST_F(HostLimitsTest, ACommandWithinTheLimitsIsLeftAlone) {
  JointCommand command = command_of_zero();
  command.rate[joint("BOOM")] = 0.35;
  command.position_target[joint("BOOM")] = 0.3;
  command.has_position_target[joint("BOOM")] = true;
  const JointCommand before = command;
  EXPECT_EQ(limits_.check(command, position_), LimitOutcome::kOk);
  EXPECT_EQ(command.rate, before.rate);
  EXPECT_EQ(command.position_target, before.position_target);
}

TEST_F(HostLimitsTest, RoundingBeyondALimitIsNotReported) {
  JointCommand command = command_of_zero();
  command.rate[joint("BOOM")] = 0.35 + 1e-9;
  EXPECT_EQ(limits_.check(command, position_), LimitOutcome::kOk);
  EXPECT_EQ(command.rate[joint("BOOM")], 0.35);
}

TEST_F(HostLimitsTest, SlightlyBeyondIsClampedFarBeyondIsRefused) {
  JointCommand command = command_of_zero();
  command.rate[joint("LF_WHEEL")] = -4.9;
  EXPECT_EQ(limits_.check(command, position_), LimitOutcome::kClamped);
  EXPECT_EQ(command.rate[joint("LF_WHEEL")], -2.5);
  command.rate[joint("LF_WHEEL")] = -5.1;
  EXPECT_EQ(limits_.check(command, position_), LimitOutcome::kRejectedRange);

  command = command_of_zero();
  command.has_position_target[joint("BOOM")] = true;
  position_[joint("BOOM")] = 1.2;
  command.position_target[joint("BOOM")] = 1.3;
  EXPECT_EQ(limits_.check(command, position_), LimitOutcome::kClamped);
  EXPECT_EQ(command.position_target[joint("BOOM")], 1.28);
  for (const double target : {1.54, -0.36}) {
    command.position_target[joint("BOOM")] = target;
    EXPECT_EQ(limits_.check(command, position_), LimitOutcome::kRejectedRange) << target;
  }
}

TEST_F(HostLimitsTest, ATargetFarFromTheMeasuredPositionIsBroughtNearer) {
  JointCommand command = command_of_zero();
  command.has_position_target[joint("DIPPER")] = true;
  command.position_target[joint("DIPPER")] = 0.9;
  EXPECT_EQ(limits_.check(command, position_), LimitOutcome::kClamped);
  EXPECT_EQ(command.position_target[joint("DIPPER")], 0.5);
}

TEST_F(HostLimitsTest, WhereClampingAndRefusingBegin) {
  const auto outcome_of_rate = [&](const char* name, double rate) {
    JointCommand command = command_of_zero();
    command.rate[joint(name)] = rate;
    return limits_.check(command, position_);
  };
  EXPECT_EQ(outcome_of_rate("BOOM", 0.35 + 0.9e-6), LimitOutcome::kOk);
  EXPECT_EQ(outcome_of_rate("BOOM", 0.35 + 1.1e-6), LimitOutcome::kClamped);
  EXPECT_EQ(outcome_of_rate("LF_WHEEL", -5.0), LimitOutcome::kClamped);
  EXPECT_EQ(outcome_of_rate("LF_WHEEL", std::nextafter(-5.0, -6.0)), LimitOutcome::kRejectedRange);
  HostLimitsSettings coarse;
  coarse.tolerance = 0.25;
  limits_ = HostLimits(m545(), coarse);
  EXPECT_EQ(outcome_of_rate("LF_WHEEL", 2.75), LimitOutcome::kOk);
  EXPECT_EQ(outcome_of_rate("LF_WHEEL", std::nextafter(2.75, 3.0)), LimitOutcome::kClamped);
}

TEST_F(HostLimitsTest, TargetsMayBeAQuarterBeyondTheirStops) {
  const int boom = joint("BOOM");
  const SlotLimits stops = limits_of(slot_of("BOOM"));
  const double beyond[] = {stops.lower - 0.25, stops.upper + 0.25};
  const double stop[] = {stops.lower, stops.upper};
  for (const int end : {0, 1}) {
    JointCommand command = command_of_zero();
    command.has_position_target[boom] = true;
    position_[boom] = stop[end];
    command.position_target[boom] = beyond[end];
    EXPECT_EQ(limits_.check(command, position_), LimitOutcome::kClamped);
    EXPECT_EQ(command.position_target[boom], stop[end]);
    command.position_target[boom] = std::nextafter(beyond[end], 100.0 * beyond[end]);
    EXPECT_EQ(limits_.check(command, position_), LimitOutcome::kRejectedRange);
  }
}

TEST_F(HostLimitsTest, JointsThatGoByRateHaveNoTarget) {
  for (const char* name : {"TURN", "LF_WHEEL"}) {
    JointCommand command = command_of_zero();
    command.has_position_target[joint(name)] = true;
    command.position_target[joint(name)] = 100.0;
    EXPECT_EQ(limits_.check(command, position_), LimitOutcome::kOk) << name;
    EXPECT_EQ(command.position_target[joint(name)], 100.0);
  }
}

TEST_F(HostLimitsTest, EveryOtherJointsTargetIsLimited) {
  const auto clamped_joints = [&](const MachineModel& machine) {
    const HostLimits limits(machine);
    int count = 0;
    for (int i = 0; i < machine.num_joints(); ++i) {
      JointCommand command = command_of_zero();
      const SlotLimits stops = limits_of(slot_of(machine.joints[i].name));
      command.has_position_target[i] = true;
      command.position_target[i] = std::isfinite(stops.upper) ? stops.upper + 0.1 : 0.6;
      if (limits.check(command, position_) == LimitOutcome::kClamped) ++count;
    }
    return count;
  };
  EXPECT_EQ(clamped_joints(m545()), m545().num_joints() - 5) << "four wheels and TURN";
  MachineModel other = m545();
  other.arm->coordinates.clear();
  EXPECT_EQ(clamped_joints(other), other.num_joints() - 4) << "nothing says which joint is TURN";
  other.arm.reset();
  EXPECT_EQ(clamped_joints(other), other.num_joints() - 4);
}

TEST_F(HostLimitsTest, BehindTheLastJointNothingCounts) {
  const int behind = m545().num_joints();
  ASSERT_LT(behind, kMaxJoints);
  JointCommand command = command_of_zero();
  command.rate[behind] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(limits_.check(command, position_), LimitOutcome::kOk);
  command.rate[behind] = 1e6;
  EXPECT_EQ(limits_.check(command, position_), LimitOutcome::kOk);
  std::array<double, kMaxJoints> rate{};
  rate[behind] = 1.0;
  EXPECT_FALSE(limits_.limit_rates(rate, position_));
}

TEST_F(HostLimitsTest, WhatIsNotANumberIsRefusedWhole) {
  for (const double poison :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity()}) {
    for (int i = 0; i < m545().num_joints(); ++i) {
      JointCommand command = command_of_zero();
      command.rate[i] = poison;
      EXPECT_EQ(limits_.check(command, position_), LimitOutcome::kRejectedNotFinite);
      command = command_of_zero();
      command.position_target[i] = poison;
      EXPECT_EQ(limits_.check(command, position_), LimitOutcome::kOk) << "no target: not used";
      command.has_position_target[i] = true;
      EXPECT_EQ(limits_.check(command, position_), LimitOutcome::kRejectedNotFinite);
    }
    JointCommand command = command_of_zero();
    command.valid_until_s = poison;
    EXPECT_EQ(limits_.check(command, position_), LimitOutcome::kRejectedNotFinite);
  }
  JointCommand command = command_of_zero();
  command.rate[0] = 1e300;
  EXPECT_EQ(limits_.check(command, position_), LimitOutcome::kRejectedRange);
}

TEST_F(HostLimitsTest, RatesGrowByTheAccelerationAndFallAtOnce) {
  const int boom = joint("BOOM");
  std::array<double, kMaxJoints> rate{};
  double before = 0.0;
  long times_limited = 0;
  for (int cycle = 0; cycle < 120; ++cycle) {
    rate = {};
    rate[boom] = 0.35;
    const bool limited = limits_.limit_rates(rate, position_);
    EXPECT_LE(rate[boom] - before, 1.1 * 0.3 * 0.01 + 1e-12);
    EXPECT_EQ(limited, rate[boom] < 0.35);
    if (limited) ++times_limited;
    before = rate[boom];
  }
  EXPECT_EQ(limits_.rates_limited(), times_limited);
  EXPECT_EQ(rate[boom], 0.35);
  rate[boom] = 0.0;
  EXPECT_FALSE(limits_.limit_rates(rate, position_));
  rate[boom] = -0.35;
  EXPECT_TRUE(limits_.limit_rates(rate, position_));
  EXPECT_NEAR(rate[boom], -1.1 * 0.3 * 0.01, 1e-12);
  rate[boom] = -0.35;
  EXPECT_TRUE(limits_.limit_rates(rate, position_));
  EXPECT_NEAR(rate[boom], -2.2 * 0.3 * 0.01, 1e-12);
}

TEST_F(HostLimitsTest, TheWindowIsAskedAsWell) {
  // A wheel may jump by 0.12 rad/s at once, but not again and again.
  const int wheel = joint("RF_WHEEL");
  std::array<double, kMaxJoints> rate{};
  for (int cycle = 0; cycle < 30; ++cycle) {
    rate = {};
    rate[wheel] = 2.5;
    limits_.limit_rates(rate, position_);
  }
  EXPECT_NEAR(rate[wheel], 0.8 * 0.3 + 0.12 + 1e-6, 1e-9);
}

TEST_F(HostLimitsTest, StandingStillForgetsTheRate) {
  const int boom = joint("BOOM");
  std::array<double, kMaxJoints> rate{};
  for (int cycle = 0; cycle < 50; ++cycle) {
    rate[boom] = 0.1;
    limits_.limit_rates(rate, position_);
  }
  limits_.stand_still();
  rate[boom] = 0.1;
  EXPECT_TRUE(limits_.limit_rates(rate, position_));
  EXPECT_LT(rate[boom], 0.004);
}

TEST_F(HostLimitsTest, TowardsAStopOnlyAsFastAsCanBeBraked) {
  const int boom = joint("BOOM");
  const SlotLimits stops = limits_of(slot_of("BOOM"));
  for (const double sign : {1.0, -1.0}) {
    position_[boom] = 0.5;
    std::array<double, kMaxJoints> rate{};
    for (int cycle = 0; cycle < 200; ++cycle) {
      rate[boom] = sign * 0.35;
      limits_.limit_rates(rate, position_);
    }
    for (const double distance : {0.1, 0.01, 0.0, -0.05}) {
      position_[boom] = sign > 0.0 ? stops.upper - distance : stops.lower + distance;
      rate[boom] = sign * 0.35;
      limits_.limit_rates(rate, position_);
      const double fastest = std::min(0.35, std::sqrt(2 * 0.3 * std::max(0.0, distance)));
      EXPECT_NEAR(rate[boom], sign * fastest, 1e-12);
    }
  }
}

TEST_F(HostLimitsTest, ARateThatIsNotFiniteBecomesZero) {
  std::array<double, kMaxJoints> rate{};
  rate[0] = std::numeric_limits<double>::quiet_NaN();
  rate[1] = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(limits_.limit_rates(rate, position_));
  EXPECT_EQ(rate[0], 0.0);
  EXPECT_EQ(rate[1], 0.0);
}

TEST(HostLimits, MachinesThatTheBusDoesNotKnowAndTimeThatStandsAreBugs) {
  MachineModel machine = m545();
  machine.joints[3].name = "TENTACLE";
  EXPECT_THROW(HostLimits{machine}, std::logic_error);
  HostLimitsSettings settings;
  settings.period_s = 0.0;
  EXPECT_THROW(HostLimits(m545(), settings), std::logic_error);
  machine = m545();
  while (machine.num_joints() < kMaxJoints) machine.joints.push_back(machine.joints.front());
  EXPECT_NO_THROW(HostLimits{machine});
  machine.joints.push_back(machine.joints.front());
  EXPECT_THROW(HostLimits{machine}, std::logic_error);
}

// T16: what passes the host is never refused by the electronics, whose limits were written apart.
TEST(HostLimitsAgainstElectronics, AgreeOn100000Vectors) {
  constexpr unsigned kSeed = 11;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const MachineModel& machine = m545();
  HostLimits host(machine);
  std::vector<MachineLimits> zones;
  for (int zone = 0; zone < kNumZones; ++zone) {
    MachineLimits::Limits limits{};
    std::array<bool, kMaxZoneJoints> is_wheel{};
    for (int i = 0; i < machine.num_joints(); ++i) {
      const JointSlot slot = slot_of(machine.joints[i].name);
      if (slot.zone != zone) continue;
      limits[slot.index] = limits_of(slot);
      is_wheel[slot.index] = machine.joints[i].role == JointRole::kWheel;
    }
    zones.emplace_back(limits, is_wheel);
    zones.back().reset(0);
  }
  constexpr int kCycles = 100'000 / kNumZones + 1;
  long vectors = 0, changed_by_host = 0, refused_raw = 0, refused_limited = 0;
  std::array<double, kMaxJoints> target{};
  for (int cycle = 1; cycle <= kCycles; ++cycle) {
    std::array<double, kMaxJoints> rate{}, position{};
    for (int i = 0; i < machine.num_joints(); ++i) {
      const SlotLimits limits = limits_of(slot_of(machine.joints[i].name));
      // Targets that are followed for a while, some beyond the limit, with jumps between them.
      if (uniform(random) > 0.96) target[i] = 1.3 * limits.max_rate * uniform(random);
      rate[i] = target[i];
      const double middle = 0.5 * (limits.lower + limits.upper);
      const double half = 0.5 * (limits.upper - limits.lower) * 1.05;
      position[i] = std::isfinite(middle) ? middle + half * uniform(random) : 0.0;
    }
    const auto raw = rate;
    host.limit_rates(rate, position);
    for (int zone = 0; zone < kNumZones; ++zone) {
      ZoneCommand limited, asked;
      limited.zone = asked.zone = zone;
      limited.echo_time_ms = asked.echo_time_ms = static_cast<std::uint32_t>(10 * cycle);
      std::array<double, kMaxZoneJoints> at{};
      bool changed = false;
      for (int i = 0; i < machine.num_joints(); ++i) {
        const JointSlot slot = slot_of(machine.joints[i].name);
        if (slot.zone != zone) continue;
        limited.active[slot.index] = asked.active[slot.index] = true;
        limited.rate[slot.index] = 1e-4 * std::round(1e4 * rate[i]);  // as on the bus
        asked.rate[slot.index] = raw[i];
        at[slot.index] = position[i];
        changed = changed || rate[i] != raw[i];
      }
      ++vectors;
      if (changed) ++changed_by_host;
      const bool raw_refused = zones[zone].judge(asked, at, 10 * cycle) != LimitVerdict::kOk;
      if (raw_refused) ++refused_raw;
      EXPECT_TRUE(!raw_refused || changed) << "the host must be the stricter one";
      if (zones[zone].judge(limited, at, 10 * cycle) != LimitVerdict::kOk) ++refused_limited;
      zones[zone].accept(limited, 10 * cycle);
    }
  }
  EXPECT_GE(vectors, 100'000);
  EXPECT_EQ(refused_limited, 0);
  EXPECT_GT(refused_raw, vectors / 20) << "the vectors must reach the limits";
  EXPECT_GE(changed_by_host, refused_raw);
  RecordProperty("vectors", std::to_string(vectors));
  RecordProperty("refused_raw", std::to_string(refused_raw));
}

}  // namespace
}  // namespace wex::can
