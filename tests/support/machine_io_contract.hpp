#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <ostream>
#include <string>

#include "hw_interface/machine_io.hpp"
#include "models/excavator/machine_model.hpp"

// The contract every MachineIo keeps, whatever is behind it. A backend's test defines its subjects:
//   INSTANTIATE_TEST_SUITE_P(Simulated, MachineIoContract, ::testing::Values(subject));
// and, if commands move the machine (they do not move a replay):
//   INSTANTIATE_TEST_SUITE_P(Simulated, MachineIoMotionContract, ::testing::Values(subject));

namespace wex {

struct MachineIoSubject {
  std::string name;
  std::function<std::unique_ptr<MachineIo>()> make;  ///< standing on flat ground, active, holding
  std::shared_ptr<const MachineModel> machine;
};

inline void PrintTo(const MachineIoSubject& subject, std::ostream* stream) {
  *stream << subject.name;
}

class MachineIoContract : public ::testing::TestWithParam<MachineIoSubject> {
 protected:
  static constexpr double kTick_s = 0.01;

  const MachineModel& machine() const { return *GetParam().machine; }
  int joint(const std::string& name) const {
    return machine().coordinate(name).value() - kNumBaseCoordinates;
  }
  /// A joint with a position target and a slow one at that: the left front hip.
  int hip() const { return machine().legs[0].hfe - kNumBaseCoordinates; }
  int wheel(int leg) const { return machine().legs[leg].wheel - kNumBaseCoordinates; }

  JointCommand command_for(double duration_s) {
    JointCommand command;
    command.num_joints = machine().num_joints();
    command.valid_until_s = io_->read().t_s + duration_s;
    return command;
  }
  JointCommand drive_command(double wheel_rate_rad_s, double duration_s) {
    JointCommand command = command_for(duration_s);
    for (int leg = 0; leg < kNumWheels; ++leg) {
      command.rate[wheel(leg)] = machine().legs[leg].wheel_sign * wheel_rate_rad_s;
    }
    return command;
  }
  void wait(double duration_s) { io_->wait_until(io_->read().t_s + duration_s); }
  double fastest_rate() {
    const MachineState state = io_->read();
    double fastest = 0.0;
    for (int i = 0; i < state.num_joints; ++i) fastest = std::max(fastest, std::abs(state.rate[i]));
    return fastest;
  }

  std::unique_ptr<MachineIo> io_ = GetParam().make();
};

/// Where commands move the machine.
class MachineIoMotionContract : public MachineIoContract {};

TEST_P(MachineIoContract, ReadsBackEveryJointWithTimeAndAge) {
  const MachineState before = io_->read();
  wait(5 * kTick_s);
  const MachineState after = io_->read();
  EXPECT_EQ(after.num_joints, machine().num_joints());
  EXPECT_GE(after.t_s - before.t_s, 4 * kTick_s);
  EXPECT_GE(after.age_s, 0.0);
  EXPECT_LE(after.age_s, 5 * kTick_s);
  for (int i = 0; i < after.num_joints; ++i) {
    EXPECT_TRUE(std::isfinite(after.position[i] + after.rate[i] + after.effort[i]))
        << machine().joints[i].name;
  }
  EXPECT_TRUE(after.base.allFinite() && after.base_velocity.allFinite());
}

TEST_P(MachineIoContract, WaitingForATimeThatIsPastReturnsAtOnce) {
  wait(10 * kTick_s);
  const double now_s = io_->read().t_s;
  io_->wait_until(now_s - 5 * kTick_s);
  EXPECT_LE(io_->read().t_s, now_s + kTick_s);
}

TEST_P(MachineIoMotionContract, AJointGoesWhereItsTargetIsAndIsReadBackThere) {
  constexpr double kStep_rad = 0.05, kTolerance_rad = 2e-3;
  const double target_rad = io_->read().position[hip()] - kStep_rad;
  JointCommand command = command_for(5.0);
  command.position_target[hip()] = target_rad;
  command.has_position_target[hip()] = true;
  ASSERT_EQ(io_->write(command), WriteOutcome::kAccepted);
  EXPECT_EQ(io_->health().level, HealthLevel::kOk);
  wait(4.0);
  EXPECT_NEAR(io_->read().position[hip()], target_rad, kTolerance_rad);
}

TEST_P(MachineIoMotionContract, RatesStayWithinTheJointsLimit) {
  const Joint& limits = machine().joints[hip()];
  JointCommand command = command_for(3.0);
  command.rate[hip()] = -1.5 * limits.max_rate;
  ASSERT_EQ(io_->write(command), WriteOutcome::kClamped);
  EXPECT_EQ(io_->health().commands_clamped, 1);
  const double start_s = io_->read().t_s;
  double fastest_rad_s = 0.0;
  while (io_->read().t_s < start_s + 1.0) {
    wait(kTick_s);
    fastest_rad_s = std::max(fastest_rad_s, std::abs(io_->read().rate[hip()]));
  }
  EXPECT_LE(fastest_rad_s, 1.1 * limits.max_rate);
  EXPECT_GE(fastest_rad_s, 0.5 * limits.max_rate);
}

TEST_P(MachineIoMotionContract, PositionsStayWithinTheJointsLimits) {
  constexpr double kOverrun_rad = 0.02;
  const Joint& limits = machine().joints[joint("DIPPER")];
  JointCommand command = command_for(20.0);
  command.rate[joint("DIPPER")] = -limits.max_rate;
  ASSERT_EQ(io_->write(command), WriteOutcome::kAccepted);
  wait(6.0);
  const double position_rad = io_->read().position[joint("DIPPER")];
  EXPECT_GE(position_rad, limits.lower - kOverrun_rad);
  EXPECT_LE(position_rad, limits.lower + 2.0 * kOverrun_rad);
}

TEST_P(MachineIoMotionContract, AnExpiredCommandEndsAllMotionAndIsCounted) {
  ASSERT_EQ(io_->write(drive_command(0.8, 2.0)), WriteOutcome::kAccepted);
  wait(1.9);
  ASSERT_GT(std::abs(io_->read().rate[wheel(0)]), 0.5) << "it must move before it can stop";
  wait(0.2 + 1.0);
  EXPECT_EQ(io_->health().level, HealthLevel::kHolding);
  EXPECT_EQ(io_->health().expiries, 1);
  EXPECT_LT(fastest_rate(), 0.03);
  const MachineState held = io_->read();
  wait(2.0);
  const MachineState later = io_->read();
  EXPECT_LT((later.base - held.base).norm(), 0.01);
}

TEST_P(MachineIoContract, ACommandThatIsExpiredAlreadyIsRejected) {
  wait(10 * kTick_s);
  JointCommand command = drive_command(0.8, 0.0);
  command.valid_until_s -= 5 * kTick_s;
  EXPECT_EQ(io_->write(command), WriteOutcome::kRejectedExpired);
  wait(1.0);
  EXPECT_LT(fastest_rate(), 0.01);
  EXPECT_EQ(io_->health().commands_rejected, 1);
}

TEST_P(MachineIoMotionContract, ACommandThatIsNotFiniteIsRejectedAndEndsTheMotion) {
  for (const double poison :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    ASSERT_EQ(io_->write(drive_command(0.8, 10.0)), WriteOutcome::kAccepted);
    wait(1.5);
    ASSERT_GT(std::abs(io_->read().rate[wheel(0)]), 0.5);
    JointCommand command = drive_command(0.8, 10.0);
    command.rate[hip()] = poison;
    EXPECT_EQ(io_->write(command), WriteOutcome::kRejectedNotFinite);
    wait(1.2);
    EXPECT_LT(fastest_rate(), 0.03);
  }
  JointCommand command = command_for(10.0);
  command.has_position_target[hip()] = true;
  command.position_target[hip()] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(io_->write(command), WriteOutcome::kRejectedNotFinite);
  command = command_for(10.0);
  command.valid_until_s = std::numeric_limits<double>::infinity();
  EXPECT_EQ(io_->write(command), WriteOutcome::kRejectedNotFinite) << "would never expire";
}

TEST_P(MachineIoContract, ACommandOfTheWrongSizeIsRejected) {
  JointCommand command = drive_command(0.8, 10.0);
  command.num_joints = machine().num_joints() - 1;
  EXPECT_EQ(io_->write(command), WriteOutcome::kRejectedWrongSize);
  command.num_joints = kMaxJoints + 1;
  EXPECT_EQ(io_->write(command), WriteOutcome::kRejectedWrongSize);
  wait(1.0);
  EXPECT_LT(fastest_rate(), 0.01);
}

TEST_P(MachineIoMotionContract, StopEndsTheMotionUntilReleased) {
  ASSERT_EQ(io_->write(drive_command(0.8, 20.0)), WriteOutcome::kAccepted);
  wait(1.5);
  io_->stop();
  EXPECT_EQ(io_->write(drive_command(0.8, 20.0)), WriteOutcome::kRejectedStopped);
  EXPECT_EQ(io_->health().level, HealthLevel::kHolding);
  wait(1.2);
  EXPECT_LT(fastest_rate(), 0.03);
  io_->release();
  wait(0.5);
  EXPECT_LT(fastest_rate(), 0.03) << "the command from before the stop must not come back";
  EXPECT_EQ(io_->write(drive_command(0.8, 20.0)), WriteOutcome::kAccepted);
  wait(1.5);
  EXPECT_GT(std::abs(io_->read().rate[wheel(0)]), 0.5);
}

TEST_P(MachineIoMotionContract, WheelsAndTurnIgnorePositionTargets) {
  JointCommand command = command_for(2.0);
  for (const int index : {wheel(0), joint("TURN")}) {
    command.has_position_target[index] = true;
    command.position_target[index] = io_->read().position[index] + 1.0;
  }
  ASSERT_EQ(io_->write(command), WriteOutcome::kAccepted);
  wait(1.5);
  EXPECT_LT(fastest_rate(), 0.01);
}

TEST_P(MachineIoContract, EveryJointHasAnAgeAndAQuality) {
  wait(5 * kTick_s);
  const MachineState state = io_->read();
  for (int i = 0; i < state.num_joints; ++i) {
    EXPECT_EQ(state.joint_quality[i], SignalQuality::kOk) << machine().joints[i].name;
    EXPECT_GE(state.joint_age_s[i], 0.0);
    EXPECT_LT(state.joint_age_s[i], 0.03);
  }
}

TEST_P(MachineIoContract, IsActiveAndHoldsWhileNothingIsWritten) {
  EXPECT_EQ(io_->lifecycle(), Lifecycle::kActive);
  EXPECT_EQ(io_->health().level, HealthLevel::kHolding);
  EXPECT_TRUE(io_->activate()) << "does nothing";
  EXPECT_EQ(io_->lifecycle(), Lifecycle::kActive);
}

TEST_P(MachineIoContract, WritesAreRejectedWhileInactive) {
  io_->deactivate();
  EXPECT_EQ(io_->lifecycle(), Lifecycle::kInactive);
  EXPECT_EQ(io_->write(drive_command(0.8, 1.0)), WriteOutcome::kRejectedNotActive);
  EXPECT_EQ(io_->health().level, HealthLevel::kHolding);
  wait(5 * kTick_s);
  EXPECT_LT(fastest_rate(), 0.03) << "reads go on";
  io_->deactivate();
  EXPECT_EQ(io_->lifecycle(), Lifecycle::kInactive) << "does nothing";
  const auto activated = io_->activate();
  ASSERT_TRUE(activated) << activated.error().message;
  EXPECT_EQ(io_->lifecycle(), Lifecycle::kActive);
  EXPECT_EQ(io_->write(drive_command(0.8, 1.0)), WriteOutcome::kAccepted);
}

TEST_P(MachineIoContract, StopRejectsWritesUntilReleased) {
  io_->stop();
  EXPECT_EQ(io_->write(drive_command(0.8, 1.0)), WriteOutcome::kRejectedStopped);
  wait(5 * kTick_s);
  io_->release();
  wait(50 * kTick_s);
  EXPECT_EQ(io_->write(drive_command(0.8, 1.0)), WriteOutcome::kAccepted);
}

TEST_P(MachineIoContract, WhatIsFarBeyondTheLimitsIsRejected) {
  JointCommand command = drive_command(0.8, 10.0);
  command.rate[hip()] = 3.0 * machine().joints[hip()].max_rate;
  EXPECT_EQ(io_->write(command), WriteOutcome::kRejectedRange);
  command = command_for(10.0);
  command.has_position_target[hip()] = true;
  command.position_target[hip()] = machine().joints[hip()].upper + 1.0;
  EXPECT_EQ(io_->write(command), WriteOutcome::kRejectedRange);
  wait(1.0);
  EXPECT_LT(fastest_rate(), 0.03);
}

TEST_P(MachineIoContract, RejectedCommandsAreCounted) {
  JointCommand command = drive_command(0.8, 10.0);
  command.rate[hip()] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(io_->write(command), WriteOutcome::kRejectedNotFinite);
  EXPECT_EQ(io_->health().commands_rejected, 1);
  EXPECT_EQ(io_->write(drive_command(0.8, 1.0)), WriteOutcome::kAccepted);
  EXPECT_EQ(io_->health().commands_accepted, 1);
}

TEST_P(MachineIoMotionContract, WhatIsFarBeyondTheLimitsEndsTheMotion) {
  ASSERT_EQ(io_->write(drive_command(0.8, 20.0)), WriteOutcome::kAccepted);
  wait(1.5);
  JointCommand command = drive_command(0.8, 20.0);
  command.rate[wheel(0)] = 3.0 * machine().joints[wheel(0)].max_rate;
  EXPECT_EQ(io_->write(command), WriteOutcome::kRejectedRange);
  wait(1.2);
  EXPECT_LT(fastest_rate(), 0.03);
}

TEST_P(MachineIoMotionContract, DeactivationStopsFirstAndNothingComesBack) {
  ASSERT_EQ(io_->write(drive_command(0.8, 20.0)), WriteOutcome::kAccepted);
  wait(1.5);
  ASSERT_GT(std::abs(io_->read().rate[wheel(0)]), 0.5);
  io_->deactivate();
  EXPECT_LT(fastest_rate(), 0.05);
  ASSERT_TRUE(io_->activate());
  wait(1.0);
  EXPECT_LT(fastest_rate(), 0.03) << "the command of before must not come back";
}

inline std::string subject_name(const ::testing::TestParamInfo<MachineIoSubject>& info) {
  return info.param.name;
}

}  // namespace wex
