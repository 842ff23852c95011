#include <cmath>
#include <cstdio>
#include <random>

#include "hw_interface/electronics/machine_limits.hpp"
#include "hw_interface/socketcan/host_limits.hpp"
#include "tests/hw_interface/electronics/electronics_bench.hpp"

// T16: host and electronics judge by the same DBC, with code written twice. With the same numbers
// they must say the same of every command; with their own, what the host lets pass must pass.

namespace wex::can {
namespace {

constexpr double kTolerance = 1e-9;  ///< rad/s: sums of rates in another order
constexpr int kCycles = 4000;        // of 25 joints each: 100,000 vectors

struct JointLimits {
  MachineLimits limits;
  JointSlot slot;
  SlotLimits of;
};

std::vector<JointLimits> electronics_limits(const MachineLimitsSettings& settings) {
  std::vector<JointLimits> all;
  for (const Joint& joint : m545().joints) {
    const JointSlot slot = slot_of(joint.name);
    MachineLimits::Limits limits{};
    std::array<bool, kMaxZoneJoints> is_wheel{};
    limits[slot.index] = limits_of(slot);
    is_wheel[slot.index] = joint.role == JointRole::kWheel;
    all.push_back({MachineLimits(limits, is_wheel, settings), slot, limits_of(slot)});
    all.back().limits.reset(0);
  }
  return all;
}

/// A rate that may or may not be within the limits, most often near one of them.
double candidate(std::mt19937_64& random, const SlotLimits& limits, double last) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const double cycle = limits.max_acceleration * 0.01;
  switch (std::uniform_int_distribution<int>(0, 5)(random)) {
    case 0:
      return last + 1.3 * cycle * unit(random);
    case 1:
      return last + cycle * (unit(random) > 0.0 ? 1.0 : -1.0);
    case 2:
      return 1.1 * limits.max_rate * unit(random);
    case 3:
      return last * (1.0 - std::abs(unit(random)));
    case 4:
      return last + std::copysign(cycle, last);
    default:
      return last;
  }
}

class BothLimitsTest : public ::testing::Test {
 protected:
  struct Count {
    long agree = 0, differ = 0, passed = 0, refused = 0;
    long passed_here_refused_there = 0;
  };

  /// Random walk of all joints; the host's rates are sent and accepted.
  Count compare(const HostLimitsSettings& host_settings, const MachineLimitsSettings& settings) {
    HostLimits host(m545(), host_settings);
    std::vector<JointLimits> electronics = electronics_limits(settings);
    for (int i = 0; i < 100; ++i) host.stand_still();
    std::mt19937_64 random(16);
    std::array<double, kMaxJoints> last{}, position{};
    Count count;
    for (int cycle = 1; cycle <= kCycles; ++cycle) {
      const std::int64_t now_ms = 10 * cycle;
      std::array<double, kMaxJoints> asked{};
      for (int i = 0; i < m545().num_joints(); ++i) {
        const SlotLimits& of = electronics[static_cast<std::size_t>(i)].of;
        asked[i] = candidate(random, of, last[i]);
        const double lower = std::isinf(of.lower) ? -3.0 : of.lower - 0.05;
        const double upper = std::isinf(of.upper) ? 3.0 : of.upper + 0.05;
        // Stays for a while, then jumps: rates must be able to build up.
        if (cycle % 50 == 1) position[i] = std::uniform_real_distribution(lower, upper)(random);
      }
      std::array<double, kMaxJoints> allowed = asked;
      host.limit_rates(allowed, position);
      for (int i = 0; i < m545().num_joints(); ++i) {
        JointLimits& joint = electronics[static_cast<std::size_t>(i)];
        const auto command = [&](double rate) {
          ZoneCommand zone;
          zone.zone = joint.slot.zone;
          zone.active[joint.slot.index] = true;
          zone.rate[joint.slot.index] = rate;
          zone.echo_time_ms = static_cast<std::uint32_t>(now_ms);
          return zone;
        };
        std::array<double, kMaxZoneJoints> positions{};
        positions[joint.slot.index] = position[i];
        const bool host_passes = allowed[i] == asked[i];
        const bool electronics_pass =
            joint.limits.judge(command(asked[i]), positions, now_ms) == LimitVerdict::kOk;
        ++(host_passes == electronics_pass ? count.agree : count.differ);
        ++(host_passes ? count.passed : count.refused);
        if (joint.limits.judge(command(allowed[i]), positions, now_ms) != LimitVerdict::kOk) {
          ++count.passed_here_refused_there;
        }
        joint.limits.accept(command(allowed[i]), now_ms);
      }
      last = allowed;
    }
    return count;
  }
};

TEST_F(BothLimitsTest, WithTheSameNumbersBothSidesSayTheSame) {
  HostLimitsSettings host;
  host.tolerance = kTolerance;
  MachineLimitsSettings settings;
  settings.acceleration_factor = host.cycle_acceleration_factor;
  settings.window_factor = 1.0;
  settings.window_ms = 300;
  settings.wheel_change_rad_s = host.wheel_change_rad_s;
  settings.latency_allowance_s = 0.0;
  settings.rate_tolerance = 2.0 * kTolerance;  // what the host allows exactly is allowed
  const Count count = compare(host, settings);
  std::printf("T16: %ld vectors, verdicts equal %ld, different %ld (passed %ld, refused %ld)\n",
              count.agree + count.differ, count.agree, count.differ, count.passed, count.refused);
  EXPECT_EQ(count.agree, kCycles * m545().num_joints());
  EXPECT_EQ(count.differ, 0);
  EXPECT_GT(count.passed, 10'000) << "both verdicts must be there";
  EXPECT_GT(count.refused, 10'000);
}

TEST_F(BothLimitsTest, WhatTheHostLetsPassTheElectronicsNeverRefuse) {
  const Count count = compare({}, {});
  EXPECT_EQ(count.passed_here_refused_there, 0);
  EXPECT_GT(count.differ, 0) << "the electronics' numbers are the wider ones";
}

}  // namespace
}  // namespace wex::can
