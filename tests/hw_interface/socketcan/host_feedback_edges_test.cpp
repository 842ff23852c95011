#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "tests/hw_interface/socketcan/host_feedback_fixture.hpp"

// Every joint, zone and message by itself, and every limit where it begins.

namespace wex::can {
namespace {

TEST_F(HostFeedbackTest, NewItHasHeardNothing) {
  EXPECT_FALSE(feedback_.take_operator_reset());
  EXPECT_FALSE(feedback_.take_restart());
  EXPECT_FALSE(feedback_.take_masquerade());
  EXPECT_FALSE(feedback_.take_crc_fault());
  EXPECT_FALSE(feedback_.operator_stopped());
  EXPECT_FALSE(feedback_.dbc_matches());
  EXPECT_FALSE(feedback_.all_zones_reach(0));
  EXPECT_EQ(feedback_.state(now_ns_).t_s, 0.0);
  EXPECT_EQ(feedback_.state(now_ns_).base[kBaseYaw], 0.0);
  EXPECT_EQ(feedback_.measurement().position[0], 0.0);
}

TEST_F(HostFeedbackTest, EveryJointIsReadFromItsPlace) {
  for (int i = 0; i < m545().num_joints(); ++i) {
    const auto [zone, index] = slot_of(m545().joints[i].name);
    const SlotLimits limits = limits_of({zone, index});
    zones_[zone].position[index] = std::clamp(1e-3 * (i + 1), limits.lower, limits.upper);
    zones_[zone].rate[index] = 2e-4 * (i + 1);
    pressures_[zone].pressure_a_pa[index] = 2e3 * (100 + i);
    pressures_[zone].pressure_b_pa[index] = 2e3 * 50;
  }
  pose_.pitch_rad = 0.125;
  pose_.roll_rad = -0.25;
  give_all();
  const MachineState state = feedback_.state(now_ns_);
  const JointMeasurement measured = feedback_.measurement();
  EXPECT_NEAR(measured.pitch_rad, 0.125, 1e-5);
  EXPECT_NEAR(measured.roll_rad, -0.25, 1e-5);
  for (int i = 0; i < m545().num_joints(); ++i) {
    const Joint& joint = m545().joints[i];
    const SlotLimits limits = limits_of(slot_of(joint.name));
    const double position = std::clamp(1e-3 * (i + 1), limits.lower, limits.upper);
    EXPECT_NEAR(state.position[i], position, 1e-6) << joint.name;
    EXPECT_NEAR(measured.position[i], position, 1e-6) << joint.name;
    EXPECT_NEAR(measured.rate[i], 2e-4 * (i + 1), 1e-9) << joint.name;
    EXPECT_NEAR(measured.effort[i], 2e3 * (50 + i) * joint.max_effort / m545().pump_pressure_pa,
                1e-6)
        << joint.name;
    EXPECT_EQ(state.joint_quality[i], SignalQuality::kOk);
    EXPECT_EQ(feedback_.slot(i).index, slot_of(joint.name).index);
  }
}

TEST_F(HostFeedbackTest, WithoutAnyOnePartItIsNotComplete) {
  struct Part {
    int zone;
    int kind;
  };
  std::vector<Part> parts{{-1, 0}, {-1, 1}, {-1, 2}};
  for (int zone = 0; zone < kNumZones; ++zone) {
    for (const int kind : {3, 4, 5}) parts.push_back({zone, kind});
  }
  const auto give_part = [&](const Part& part) {
    const int zone = part.zone;
    imu_.sample_time_ms = stamp_ms_;
    if (part.kind == 0) give_pose();
    if (part.kind == 1) give(imu_, imu_context_);
    if (part.kind == 2) give(estop_, estop_context_);
    if (part.kind == 3) give_zone(zone);
    if (part.kind == 4) give(pressures_[zone], pressure_context_[zone]);
    if (part.kind == 5) give(statuses_[zone], status_context_[zone]);
  };
  const auto give_all_but = [&](std::size_t missing) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (i != missing) give_part(parts[i]);
    }
  };
  for (std::size_t missing = 0; missing < parts.size(); ++missing) {
    SCOPED_TRACE(missing);
    // New, and the same after the machine was switched on anew.
    feedback_ = HostFeedback::create(m545(), {100.0, 200.0}).value();
    for (int life = 0; life < 2; ++life) {
      give_all_but(missing);
      EXPECT_FALSE(feedback_.complete());
      give_part(parts[missing]);
      EXPECT_TRUE(feedback_.complete());
      pass(10'000);
      stamp_ms_ -= 15'000;  // its clock jumps back
    }
    stamp_ms_ = 30'000;
  }
}

TEST_F(HostFeedbackTest, WithoutAGoodReadingOfEveryJointItIsNotComplete) {
  for (int i = 0; i < m545().num_joints(); ++i) {
    const auto [zone, index] = slot_of(m545().joints[i].name);
    for (int life = 0; life < 2; ++life) {
      zones_[zone].quality[index] = JointQuality::kStale;
      give_all();
      EXPECT_FALSE(feedback_.complete()) << m545().joints[i].name;
      zones_[zone].quality[index] = JointQuality::kOk;
      give_zone(zone);
      EXPECT_TRUE(feedback_.complete()) << m545().joints[i].name;
      stamp_ms_ -= 2000;
    }
    feedback_ = HostFeedback::create(m545(), {100.0, 200.0}).value();
    stamp_ms_ = 5000;
  }
}

TEST_F(HostFeedbackTest, TurnsFromBeforeAMachineWasSwitchedOnAnewDoNotCount) {
  const auto [zone, index] = slot_of("RH_WHEEL");
  for (const double angle : {3.0, -2.0, 0.0, 2.0, -3.0}) {
    zones_[zone].position[index] = angle;
    pose_.yaw_rad = angle;
    give_all();
    pass(10);
  }
  EXPECT_GT(feedback_.measurement().position[joint("RH_WHEEL")], 6.0);
  EXPECT_GT(feedback_.state(now_ns_).base[kBaseYaw], 3.2);
  stamp_ms_ -= 3000;
  zones_[zone].position[index] = pose_.yaw_rad = 0.5;
  give_all();
  EXPECT_NEAR(feedback_.measurement().position[joint("RH_WHEEL")], 0.5, 1e-6);
  EXPECT_NEAR(feedback_.state(now_ns_).base[kBaseYaw], 0.5, 1e-5);
}

TEST_F(HostFeedbackTest, APersonsFramesFromBeforeTheRestartAreNoEdge) {
  give_all();
  give(OperatorCommand{OperatorAction::kNone}, operator_context_);
  stamp_ms_ -= 2000;
  give_zone(0);
  give(OperatorCommand{OperatorAction::kReset}, operator_context_);
  EXPECT_FALSE(feedback_.take_operator_reset());
}

/// A counter that is not what follows.
void jumps(SendContext& context, int by = 50) {
  context.counter = static_cast<std::uint8_t>(context.counter + by);
}

TEST_F(HostFeedbackTest, AfterARestartCountersMayBeginAnywhere) {
  give_all();
  give(OperatorCommand{}, operator_context_);
  stamp_ms_ -= 2000;
  jumps(zone_context_[3]);
  give_zone(3);  // tells of the restart
  ASSERT_TRUE(feedback_.take_restart());
  for (SendContext* context :
       {&zone_context_[0], &pressure_context_[0], &status_context_[0], &imu_context_,
        &pose_context_, &estop_context_, &operator_context_}) {
    jumps(*context);
  }
  imu_.sample_time_ms = stamp_ms_;
  give_zone(0);
  give_pose();
  EXPECT_EQ(give(pressures_[0], pressure_context_[0]), FrameVerdict::kUsed);
  EXPECT_EQ(give(statuses_[0], status_context_[0]), FrameVerdict::kUsed);
  EXPECT_EQ(give(imu_, imu_context_), FrameVerdict::kUsed);
  EXPECT_EQ(give(estop_, estop_context_), FrameVerdict::kUsed);
  EXPECT_EQ(give(OperatorCommand{}, operator_context_), FrameVerdict::kUsed);
}

TEST_F(HostFeedbackTest, AJumpOfACounterIsALossAsFarAsTimeExplainsIt) {
  give_all();                                              // the e-stop's report: every 10 ms
  for (const int elapsed_ns : {99'500'200, 99'499'800}) {  // half a millisecond is rounding
    now_ns_ += elapsed_ns;
    jumps(estop_context_, 11);
    EXPECT_EQ(give(estop_, estop_context_) == FrameVerdict::kUsed, elapsed_ns > 99'500'000);
  }
  for (int i = 0; i < 10; ++i) {
    now_ns_ += 10 * kMs;
    give(estop_, estop_context_);
  }
  jumps(estop_context_, 9);
  EXPECT_EQ(give(estop_, estop_context_), FrameVerdict::kWrongSequence) << "no time has passed";
}

TEST_F(HostFeedbackTest, CountersFromBeforeTheFirstStampGoOn) {
  // Their age is not known, so they are taken as new: what follows must be in order.
  give(pressures_[3], pressure_context_[3]);
  give(statuses_[3], status_context_[3]);
  give(estop_, estop_context_);
  give(OperatorCommand{}, operator_context_);
  give_zone(0);
  jumps(pressure_context_[3]);
  jumps(status_context_[3]);
  jumps(estop_context_);
  jumps(operator_context_);
  EXPECT_EQ(give(pressures_[3], pressure_context_[3]), FrameVerdict::kWrongSequence);
  EXPECT_EQ(give(statuses_[3], status_context_[3]), FrameVerdict::kWrongSequence);
  EXPECT_EQ(give(estop_, estop_context_), FrameVerdict::kWrongSequence);
  EXPECT_EQ(give(OperatorCommand{}, operator_context_), FrameVerdict::kWrongSequence);
}

TEST_F(HostFeedbackTest, OfAnyTwoModesTheLessPermissiveCounts) {
  const MachineMode modes[] = {MachineMode::kEnabled, MachineMode::kEnabling, MachineMode::kReady,
                               MachineMode::kHold,    MachineMode::kInit,     MachineMode::kFault,
                               MachineMode::kEStop};
  for (std::size_t more = 0; more < std::size(modes); ++more) {
    for (std::size_t less = more + 1; less < std::size(modes); ++less) {
      for (const int zone : {0, 5}) {
        for (ZoneStatus& status : statuses_) status.mode = modes[more];
        statuses_[zone].mode = modes[less];
        give_status();
        EXPECT_EQ(feedback_.mode(), modes[less]) << more << " " << less << " " << zone;
      }
    }
  }
}

TEST_F(HostFeedbackTest, OneZoneThatWasNeverHeardIsInInit) {
  for (ZoneStatus& status : statuses_) status.mode = MachineMode::kEnabled;
  for (int zone = 0; zone < kNumZones; ++zone) {
    EXPECT_EQ(feedback_.mode(), MachineMode::kInit);
    EXPECT_FALSE(feedback_.dbc_matches());
    give(statuses_[zone], status_context_[zone]);
  }
  EXPECT_EQ(feedback_.mode(), MachineMode::kEnabled);
  EXPECT_TRUE(feedback_.dbc_matches());
}

TEST_F(HostFeedbackTest, AnOperatorsStopIsReportedByAnyZone) {
  for (ZoneStatus& status : statuses_) status.fault_bits = 0xFFBF;
  give_status();
  EXPECT_FALSE(feedback_.operator_stopped());
  statuses_[2].fault_bits = kReportsOperatorStop;
  give_status();
  EXPECT_TRUE(feedback_.operator_stopped());
}

TEST_F(HostFeedbackTest, ReportsAreAsOldAsTheOldestZones) {
  give_all();
  pass(30);
  for (int zone = 0; zone < kNumZones; ++zone) {
    EXPECT_NEAR(feedback_.status_age_s(now_ns_), 0.030, 1e-6);
    give(statuses_[zone], status_context_[zone]);
  }
  EXPECT_NEAR(feedback_.status_age_s(now_ns_), 0.0, 1e-6);
  EXPECT_NEAR(feedback_.estop_age_s(now_ns_), 0.030, 1e-6);
  give(estop_, estop_context_);
  EXPECT_NEAR(feedback_.estop_age_s(now_ns_), 0.0, 1e-6);
}

TEST_F(HostFeedbackTest, FeedbackIsAsOldAsItsOldestReading) {
  for (int i = 0; i < m545().num_joints(); ++i) {
    give_all();
    const auto [zone, index] = slot_of(m545().joints[i].name);
    zones_[zone].quality[index] = JointQuality::kStale;
    pass(20);
    give_all();
    EXPECT_NEAR(feedback_.feedback_age_s(now_ns_), 0.020, 1e-6) << m545().joints[i].name;
    zones_[zone].quality[index] = JointQuality::kOk;
    pass(10);
  }
}

TEST_F(HostFeedbackTest, ARepeatedFrameLeavesTheAgeAsItIs) {
  give_all();
  SendContext again = estop_context_;
  give(estop_, estop_context_);
  pass(40);
  EXPECT_EQ(feedback_.take(frame_of(estop_, again), now_ns_), FrameVerdict::kRepeated);
  EXPECT_NEAR(feedback_.estop_age_s(now_ns_), 0.040, 1e-6);
}

TEST_F(HostFeedbackTest, ReachingATimeNeedsThePoseAsWell) {
  give_all();
  EXPECT_TRUE(feedback_.all_zones_reach(stamp_ms_));
  pass(10);
  for (int zone = 0; zone < kNumZones; ++zone) {
    EXPECT_FALSE(feedback_.all_zones_reach(stamp_ms_));
    give_zone(zone);
  }
  EXPECT_FALSE(feedback_.all_zones_reach(stamp_ms_));
  give_pose();
  EXPECT_TRUE(feedback_.all_zones_reach(stamp_ms_));
}

TEST_F(HostFeedbackTest, LossesOfEveryKindAreCounted) {
  give_all();
  give(OperatorCommand{}, operator_context_);
  for (SendContext* context :
       {&zone_context_[0], &zone_context_[5], &pressure_context_[0], &status_context_[5],
        &imu_context_, &pose_context_, &estop_context_, &operator_context_}) {
    context->counter = static_cast<std::uint8_t>(context->counter + 2);
  }
  give_all();
  give(OperatorCommand{}, operator_context_);
  EXPECT_EQ(feedback_.lost_frames(MessageKind::kZoneFeedback), 4);
  for (const MessageKind kind :
       {MessageKind::kZonePressure, MessageKind::kZoneStatus, MessageKind::kImu,
        MessageKind::kBasePose, MessageKind::kEStopState, MessageKind::kOperatorCommand}) {
    EXPECT_EQ(feedback_.lost_frames(kind), 2);
  }
  EXPECT_EQ(feedback_.lost_frames(MessageKind::kLockStep), 0);
}

TEST_F(HostFeedbackTest, AReadingIsStaleFrom30MsOnButForAMicrosecond) {
  const int boom = joint("BOOM");
  give_all();
  EXPECT_EQ(feedback_.state(now_ns_ + 29'998'900).joint_quality[boom], SignalQuality::kOk);
  EXPECT_EQ(feedback_.state(now_ns_ + 29'999'100).joint_quality[boom], SignalQuality::kStale);
}

TEST_F(HostFeedbackTest, AReadingThatIsNoMoreAvailableIsInvalid) {
  const auto [zone, index] = slot_of("BOOM");
  give_all();
  zones_[zone].quality[index] = JointQuality::kNotAvailable;
  give_zone(zone);
  EXPECT_EQ(feedback_.state(now_ns_).joint_quality[joint("BOOM")], SignalQuality::kInvalid);
}

TEST_F(HostFeedbackTest, ASenderIsForgottenAfterMoreThanASecond) {
  for (const int silence_ms : {900, 1000, 1001}) {
    give_all();
    pass(silence_ms);
    give_zone(0);
    estop_context_.counter = static_cast<std::uint8_t>(estop_context_.counter + 200);
    const bool used = give(estop_, estop_context_) == FrameVerdict::kUsed;
    EXPECT_EQ(used, silence_ms > 1000) << silence_ms;
    for (int i = 0; i < 3; ++i) give(estop_, estop_context_);
  }
}

TEST_F(HostFeedbackTest, AnEdgeMayBeASecondLong) {
  for (const int pause_ms : {900, 1000, 1001}) {
    give(OperatorCommand{OperatorAction::kNone}, operator_context_);
    give_zone(0);
    give(OperatorCommand{OperatorAction::kNone}, operator_context_);
    pass(pause_ms);
    give_zone(0);
    give(OperatorCommand{OperatorAction::kReset}, operator_context_);
    EXPECT_EQ(feedback_.take_operator_reset(), pause_ms <= 1000) << pause_ms;
  }
}

TEST_F(HostFeedbackTest, NeitherTheFirstFrameNorALevelIsAnEdge) {
  stamp_ms_ = 100;  // the machine has just been switched on
  give_all();
  give(OperatorCommand{OperatorAction::kReset}, operator_context_);
  give(OperatorCommand{OperatorAction::kReset}, operator_context_);
  EXPECT_FALSE(feedback_.take_operator_reset());
}

TEST_F(HostFeedbackTest, WrongCrcsCountWithinASecond) {
  const auto corrupted = [&] {
    CanFrame frame = frame_of(zones_[0], zone_context_[0]);
    zone_context_[0].counter--;
    frame.data[20] ^= 0x10;
    return feedback_.take(frame, now_ns_);
  };
  for (int i = 0; i < 40; ++i) {  // three a second, for long
    for (int j = 0; j < 3; ++j) corrupted();
    EXPECT_FALSE(feedback_.take_crc_fault()) << i;
    pass(1001);
    give_all();
  }
  for (int j = 0; j < 3; ++j) corrupted();
  pass(900);
  corrupted();
  EXPECT_TRUE(feedback_.take_crc_fault());
}

TEST_F(HostFeedbackTest, TheFirstFourWrongCrcsCountAsWell) {
  for (const int last_ms : {999, 1000}) {
    feedback_ = HostFeedback::create(m545(), {0.0, 0.0}).value();
    stamp_ms_ = 5000;
    give_zone(0);
    CanFrame frame = frame_of(zones_[0], zone_context_[0]);
    frame.data[20] ^= 0x10;
    for (int i = 0; i < 3; ++i) feedback_.take(frame, now_ns_);
    pass(last_ms);
    feedback_.take(frame, now_ns_);
    EXPECT_EQ(feedback_.take_crc_fault(), last_ms < 1000);
  }
}

TEST_F(HostFeedbackTest, AsManyWrongCrcsAsCanBeAskedForAreToldApart) {
  FeedbackSettings settings;
  settings.max_crc_errors = 15;
  settings.crc_window_s = 1.0;
  feedback_ = HostFeedback::create(m545(), {0.0, 0.0}, settings).value();
  const auto corrupted = [&] {
    CanFrame frame = frame_of(zones_[0], zone_context_[0]);
    frame.data[20] ^= 0x10;
    feedback_.take(frame, now_ns_);
    return feedback_.take_crc_fault();
  };
  give_zone(0);
  for (int i = 0; i < 16; ++i) {
    EXPECT_FALSE(corrupted()) << i;
    pass(90);  // the sixteenth comes 1.35 s after the first
  }
  for (int i = 0; i < 14; ++i) corrupted();
  EXPECT_TRUE(corrupted());
}

TEST_F(HostFeedbackTest, AnOwnIdOfTheWrongFormatWasAlteredOnTheWay) {
  SendContext context;
  CanFrame frame = frame_of(HostStop{}, context);
  frame.fd = false;
  EXPECT_EQ(feedback_.take(frame, now_ns_), FrameVerdict::kMalformed);
  EXPECT_FALSE(feedback_.take_masquerade());
}

TEST_F(HostFeedbackTest, AnglesBetweenStopsAreNotUnwrapped) {
  const auto [zone, index] = slot_of("EE_PITCH");
  for (const double angle : {-2.5, 0.85, -2.5}) {  // more than half a turn apart
    zones_[zone].position[index] = angle;
    give_zone(zone);
    EXPECT_NEAR(feedback_.measurement().position[joint("EE_PITCH")], angle, 1e-6);
  }
}

TEST(HostFeedback, AJointThatTheMachineDoesNotHaveIsNotRead) {
  MachineModel machine = m545();
  const JointSlot missing = slot_of(machine.joints.back().name);
  ASSERT_NE(missing.zone, slot_of(machine.joints.front().name).zone);
  machine.joints.pop_back();
  HostFeedback feedback = HostFeedback::create(machine, {0.0, 0.0}).value();
  ZoneFeedback zone;
  zone.zone = missing.zone;
  zone.position[missing.index] = 0.1;
  zone.sample_time_ms = 1000;
  SendContext context;
  CanFrame frame;
  ASSERT_TRUE(encode(zone, context, frame));
  ASSERT_EQ(feedback.take(frame, 0), FrameVerdict::kUsed);
  EXPECT_EQ(feedback.measurement().position[0], 0.0);
}

TEST(HostFeedback, MoreThanItCanHoldIsABug) {
  MachineModel machine = m545();
  while (machine.num_joints() < kMaxJoints) machine.joints.push_back(machine.joints.front());
  FeedbackSettings settings;
  settings.max_crc_errors = 15;
  EXPECT_TRUE(HostFeedback::create(machine, {0.0, 0.0}, settings));
  settings.max_crc_errors = 16;
  EXPECT_THROW((void)HostFeedback::create(machine, {0.0, 0.0}, settings), std::logic_error);
  machine.joints.push_back(machine.joints.front());
  EXPECT_THROW((void)HostFeedback::create(machine, {0.0, 0.0}), std::logic_error);
}

}  // namespace
}  // namespace wex::can
