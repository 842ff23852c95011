#include "hw_interface/joint_loop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace wex {
namespace {

constexpr double kPeriod_s = 0.01;

/// The loop against joints that do at once what they are told.
class JointLoopTest : public ::testing::Test {
 protected:
  static const MachineModel& machine() {
    static const MachineModel model = load_machine().value();
    return model;
  }
  static int joint(const char* name) {
    return machine().coordinate(name).value() - kNumBaseCoordinates;
  }
  static int wheel(int leg) { return machine().legs[leg].wheel - kNumBaseCoordinates; }

  JointLoopTest() {
    command_.num_joints = machine().num_joints();
    for (int i = 0; i < command_.num_joints; ++i) {
      measured_.position[i] = machine().joints[i].transport_position;
    }
  }

  ActuatorCommand tick(const JointCommand* command, bool blocked_wheels = false) {
    const ActuatorCommand out = loop_.update(command, measured_);
    for (int i = 0; i < machine().num_joints(); ++i) {
      const bool blocked = blocked_wheels && machine().joints[i].role == JointRole::kWheel;
      measured_.rate[i] = blocked ? 0.0 : out.rate[i];
      measured_.position[i] += measured_.rate[i] * kPeriod_s;
    }
    return out;
  }
  ActuatorCommand run(const JointCommand* command, double duration_s, bool blocked_wheels = false) {
    ActuatorCommand out;
    for (double t_s = 0.0; t_s < duration_s - 1e-9; t_s += kPeriod_s) {
      out = tick(command, blocked_wheels);
    }
    return out;
  }

  JointLoop loop_{machine()};
  JointCommand command_;
  JointMeasurement measured_;
};

TEST_F(JointLoopTest, ReachesAPositionTargetWithoutOvershoot) {
  const int boom = joint("BOOM");
  const double start_rad = measured_.position[boom];
  command_.has_position_target[boom] = true;
  command_.position_target[boom] = start_rad - 0.3;
  double lowest_rad = start_rad;
  for (int i = 0; i < 600; ++i) {
    tick(&command_);
    lowest_rad = std::min(lowest_rad, measured_.position[boom]);
  }
  EXPECT_NEAR(measured_.position[boom], start_rad - 0.3, 2e-3);
  EXPECT_GT(lowest_rad, start_rad - 0.3 - 5e-3);
}

TEST_F(JointLoopTest, KeepsRateAndAccelerationLimits) {
  const int hip = joint("LF_HFE");
  const Joint& limits = machine().joints[hip];
  command_.rate[hip] = 100.0;
  double previous_rad_s = 0.0;
  for (int i = 0; i < 200; ++i) {
    const double rate_rad_s = tick(&command_).rate[hip];
    EXPECT_LE(rate_rad_s - previous_rad_s, limits.max_acceleration * kPeriod_s + 1e-12);
    EXPECT_LE(rate_rad_s, limits.max_rate);
    previous_rad_s = rate_rad_s;
  }
  EXPECT_LE(measured_.position[hip], limits.upper);
}

TEST_F(JointLoopTest, SlewsNoFasterThanCanBeStoppedWithTheArmWhereItIs) {
  const int turn = joint("TURN"), dipper = joint("DIPPER");
  const StoppingSlew slew;
  const auto limit = [&] {
    return 0.97 *
           slew.at(ArmReach::of({measured_.position[joint("BOOM")], measured_.position[dipper],
                                 measured_.position[joint("TELE")],
                                 measured_.position[joint("EE_PITCH")]}),
                   tilt_of(measured_.pitch_rad, measured_.roll_rad));
  };
  for (const double asked : {0.8, -0.8}) {
    command_.rate[turn] = asked;
    const double rate = run(&command_, 3.0).rate[turn];
    EXPECT_NEAR(rate, std::copysign(limit(), asked), 1e-9);
  }
  command_.rate[turn] = 0.8;
  run(&command_, 3.0);
  const double before = limit();
  measured_.roll_rad = 0.2;
  EXPECT_NEAR(tick(&command_).rate[turn], limit(), 1e-9) << "at once, not by the ramp";
  command_.rate[dipper] = 0.3;
  run(&command_, 1.5);
  EXPECT_LT(measured_.rate[turn], limit() - 0.01) << "the arm goes out";
  command_.rate[dipper] = 0.0;
  const double further_out = run(&command_, 3.0).rate[turn];
  EXPECT_NEAR(further_out, limit(), 1e-9);
  EXPECT_LT(further_out, 0.7 * before);
  command_.rate[turn] = 0.05;
  EXPECT_NEAR(run(&command_, 1.0).rate[turn], 0.05, 1e-9) << "slower is left alone";
}

TEST_F(JointLoopTest, ReachesFullRateAndFeedForwardNeedsNoError) {
  const int steer = joint("LF_STEER");
  command_.rate[steer] = 0.1;
  command_.has_position_target[steer] = true;
  for (int i = 0; i < 300; ++i) {
    command_.position_target[steer] = 0.1 * kPeriod_s * i;
    tick(&command_);
  }
  EXPECT_NEAR(measured_.rate[steer], 0.1, 1e-3);
  EXPECT_NEAR(measured_.position[steer], command_.position_target[steer], 2e-3);
}

TEST_F(JointLoopTest, SharesThePumpByScalingEveryHydraulicRate) {
  for (int i = 0; i < machine().num_joints(); ++i) command_.rate[i] = machine().joints[i].max_rate;
  for (const char* name : {"BOOM", "DIPPER", "EE_PITCH", "TELE"}) {  // in mid range, to move freely
    const Joint& limits = machine().joints[joint(name)];
    measured_.position[joint(name)] = 0.5 * (limits.lower + limits.upper);
  }
  const ActuatorCommand out = run(&command_, 2.0);
  double flow_m3_s = 0.0;
  for (int i = 0; i < machine().num_joints(); ++i) {
    const Joint& limits = machine().joints[i];
    if (limits.role == JointRole::kWheel) {
      EXPECT_GT(out.rate[i], 0.9) << "wheels have their own pump";
    } else {
      flow_m3_s += std::abs(out.rate[i]) * limits.max_effort / machine().pump_pressure_pa;
    }
  }
  EXPECT_LE(flow_m3_s, machine().pump_flow_limit_w_over_pa * (1.0 + 1e-9));
  EXPECT_GE(flow_m3_s, 0.7 * machine().pump_flow_limit_w_over_pa);
}

TEST_F(JointLoopTest, OpensTheValveBeyondItsDeadBandForTheSmallestMotion) {
  const int boom = joint("BOOM");
  command_.rate[boom] = 0.01 * machine().joints[boom].max_rate;
  const ActuatorCommand out = run(&command_, 0.5);
  EXPECT_NEAR(out.spool[boom], 0.05 + 0.95 * 0.01, 1e-9);
  command_.rate[boom] = 0.0;
  EXPECT_EQ(run(&command_, 0.5).spool[boom], 0.0);
}

TEST_F(JointLoopTest, HoldingClosesEveryValveAtOnce) {
  command_.rate[joint("BOOM")] = -0.2;
  run(&command_, 1.0);
  const ActuatorCommand out = tick(nullptr);
  EXPECT_EQ(*std::max_element(out.spool.begin(), out.spool.end()), 0.0);
  EXPECT_EQ(*std::min_element(out.spool.begin(), out.spool.end()), 0.0);
}

TEST_F(JointLoopTest, ALatchedWheelComesBackToItsAngleAfterADisturbance) {
  run(nullptr, 0.1);
  measured_.position[wheel(2)] += 0.02;
  run(nullptr, 3.0);
  EXPECT_NEAR(measured_.position[wheel(2)], 0.0, 1e-3);
}

TEST_F(JointLoopTest, WheelsFollowARampAndStopWithinASecond) {
  for (int leg = 0; leg < kNumWheels; ++leg) command_.rate[wheel(leg)] = 0.8;
  const double first_rad_s = tick(&command_).rate[wheel(0)];
  EXPECT_LT(first_rad_s, 0.05);
  EXPECT_NEAR(run(&command_, 3.0).rate[wheel(0)], 0.8, 0.02);
  EXPECT_NEAR(run(nullptr, 1.0).rate[wheel(0)], 0.0, 1e-3);
}

TEST_F(JointLoopTest, AStalledWheelStopsAllUntilTheCommandEndsOrReverses) {
  for (int leg = 0; leg < kNumWheels; ++leg) command_.rate[wheel(leg)] = 0.5;
  measured_.effort[wheel(1)] = machine().joints[wheel(1)].max_effort;
  run(&command_, 2.0, true);
  EXPECT_EQ(loop_.stall_stops(), 1);
  EXPECT_TRUE(loop_.stalled());
  measured_.effort[wheel(1)] = 0.0;
  EXPECT_LT(std::abs(run(&command_, 1.0).rate[wheel(0)]), 0.07) << "not tried again by itself";
  for (int leg = 0; leg < kNumWheels; ++leg) command_.rate[wheel(leg)] = -0.5;
  EXPECT_LT(run(&command_, 2.0).rate[wheel(0)], -0.4) << "backing off is allowed";
  EXPECT_EQ(loop_.stall_stops(), 1);
}

TEST_F(JointLoopTest, HighTorqueAloneIsNoStall) {
  for (int leg = 0; leg < kNumWheels; ++leg) command_.rate[wheel(leg)] = 0.5;
  for (int leg = 0; leg < kNumWheels; ++leg) {
    measured_.effort[wheel(leg)] = machine().joints[wheel(leg)].max_effort;
  }
  run(&command_, 4.0);
  EXPECT_EQ(loop_.stall_stops(), 0);
}

TEST_F(JointLoopTest, TargetsAreReachedBesideTheLoadBalancesOffset) {
  // Unequal hip efforts make the balance raise a diagonal; the target stays what the caller means.
  const int hip = joint("LF_HFE");
  for (const char* name : {"LF_HFE", "RF_HFE", "LH_HFE", "RH_HFE"}) {
    measured_.effort[joint(name)] = -25e3;
    command_.has_position_target[joint(name)] = true;
    command_.position_target[joint(name)] = measured_.position[joint(name)];
  }
  measured_.effort[joint("LF_HFE")] = measured_.effort[joint("RH_HFE")] = -40e3;
  run(&command_, 6.0);
  const double offset_rad = loop_.offset_of_joint_rad(hip);
  EXPECT_GT(offset_rad, 5e-3) << "the loaded wheel is raised";
  EXPECT_EQ(loop_.offset_of_joint_rad(joint("BOOM")), 0.0);
  EXPECT_NEAR(measured_.position[hip] - offset_rad, command_.position_target[hip], 2e-3);
  run(nullptr, 3.0);
  EXPECT_EQ(loop_.offset_of_joint_rad(hip), offset_rad) << "frozen while holding";
}

TEST_F(JointLoopTest, TravelsNoFasterThanCanBeStoppedInTimeOnThisSlope) {
  const StoppingSpeed allowed;
  const double margin = JointLoopSettings{}.travel_margin;
  for (const double pitch_rad : {0.0, 0.1, 0.3, -0.3}) {
    for (const double sign : {1.0, -1.0}) {
      loop_ = JointLoop(machine());
      measured_.pitch_rad = pitch_rad;
      for (int leg = 0; leg < kNumWheels; ++leg) command_.rate[wheel(leg)] = sign * 2.0;
      const double rate = run(&command_, 4.0).rate[wheel(0)];
      const double expected_m_s = margin * allowed.at(sign * pitch_rad);
      EXPECT_NEAR(sign * rate * machine().legs[0].radius_m, expected_m_s, 1e-3)
          << pitch_rad << " " << sign;
    }
  }
  measured_.pitch_rad = 0.0;
  measured_.roll_rad = -0.35;
  EXPECT_NEAR(-run(&command_, 4.0).rate[wheel(0)] * machine().legs[0].radius_m,
              margin * allowed.at(0.0, 0.35), 1e-3);
}

TEST_F(JointLoopTest, SlowingDownOnASlopeKeepsTheCurve) {
  measured_.pitch_rad = 0.3;
  const std::array<double, kNumWheels> asked{0.9, 1.1, 0.9, 1.1};
  for (int leg = 0; leg < kNumWheels; ++leg) command_.rate[wheel(leg)] = asked[leg];
  const ActuatorCommand out = run(&command_, 4.0);
  EXPECT_LT(out.rate[wheel(1)], 0.6);
  EXPECT_NEAR(out.rate[wheel(0)] / out.rate[wheel(1)], asked[0] / asked[1], 1e-3);
}

}  // namespace
}  // namespace wex
