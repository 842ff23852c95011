#include "hw_interface/mujoco/valve_chain.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace wex {
namespace {

constexpr double kPeriod_s = 0.01, kDeadBand = 0.05;

const MachineModel& m545() {
  static const MachineModel machine = load_machine().value();
  return machine;
}
int joint(const char* name) { return m545().coordinate(name).value() - kNumBaseCoordinates; }

/// Rate of a joint t_s after its spool was opened.
double rate_after(const char* name, double spool, double t_s) {
  ValveChain valves(m545(), kPeriod_s, kDeadBand);
  std::array<double, kMaxJoints> opening{}, rate{}, wheels{};
  opening[joint(name)] = wheels[joint(name)] = spool;
  for (int i = 0; i < std::lround(t_s / kPeriod_s); ++i) rate = valves.update(opening, wheels);
  return rate[joint(name)];
}

TEST(ValveChain, DoesNothingWithinTheDeadBand) {
  EXPECT_EQ(rate_after("BOOM", 0.049, 5.0), 0.0);
  EXPECT_EQ(rate_after("BOOM", -0.049, 5.0), 0.0);
  EXPECT_GT(rate_after("BOOM", 0.051, 5.0), 0.0);
}

TEST(ValveChain, GivesTheFullRateAtFullOpening) {
  const double max_rad_s = m545().joints[joint("BOOM")].max_rate;
  EXPECT_NEAR(rate_after("BOOM", 1.0, 5.0), max_rad_s, 1e-6);
  EXPECT_NEAR(rate_after("BOOM", -1.0, 5.0), -max_rad_s, 1e-6);
  EXPECT_NEAR(rate_after("BOOM", 0.05 + 0.95 * 0.5, 5.0), 0.5 * max_rad_s, 1e-6);
}

TEST(ValveChain, WaitsForTheDeadTimeThenFollowsTheLag) {
  for (const char* name : {"BOOM", "LF_HFE"}) {
    const Joint& limits = m545().joints[joint(name)];
    EXPECT_EQ(rate_after(name, 1.0, limits.dead_time_s), 0.0) << name;
    EXPECT_GT(rate_after(name, 1.0, limits.dead_time_s + kPeriod_s), 0.0) << name;
    EXPECT_NEAR(rate_after(name, 1.0, limits.dead_time_s + limits.lag_s),
                (1.0 - std::exp(-1.0)) * limits.max_rate, 1e-9)
        << name;
  }
}

TEST(ValveChain, PassesWheelRatesThroughWithoutASpool) {
  EXPECT_NEAR(rate_after("LF_WHEEL", 0.02, 5.0), 0.02, 1e-6);
}

TEST(ValveChain, ShutsWithin50MsWhateverIsOnItsWay) {
  ValveChain valves(m545(), kPeriod_s, kDeadBand);
  std::array<double, kMaxJoints> opening{}, rate{};
  opening[joint("BOOM")] = 1.0;
  for (int i = 0; i < 300; ++i) rate = valves.update(opening, {});
  ASSERT_GT(rate[joint("BOOM")], 0.34);
  double before = rate[joint("BOOM")];
  for (int i = 0; i < 5; ++i) {
    rate = valves.update(opening, {}, false);
    EXPECT_LT(rate[joint("BOOM")], before);
    before = rate[joint("BOOM")];
  }
  EXPECT_EQ(before, 0.0);
  // Released again: what was in the pilot lines before does not come back.
  const Joint& boom = m545().joints[joint("BOOM")];
  for (int i = 0; i < std::lround(boom.dead_time_s / kPeriod_s); ++i) {
    EXPECT_EQ(valves.update(opening, {})[joint("BOOM")], 0.0);
  }
  EXPECT_GT(valves.update(opening, {})[joint("BOOM")], 0.0);
}

TEST(ValveChain, WhileShutWheelsFollowTheirBrakeValvesWithoutDelay) {
  ValveChain valves(m545(), kPeriod_s, kDeadBand);
  std::array<double, kMaxJoints> wheels{};
  const int wheel = joint("LF_WHEEL");
  wheels[wheel] = 0.8;
  for (int i = 0; i < 300; ++i) valves.update({}, wheels);
  wheels[wheel] = 0.3;
  EXPECT_EQ(valves.update({}, wheels, false)[wheel], 0.3);
  EXPECT_NEAR(valves.update({}, wheels)[wheel], 0.3, 1e-12) << "0.8 is forgotten";
}

}  // namespace
}  // namespace wex
