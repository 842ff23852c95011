#include <gtest/gtest.h>

#include <cmath>

#include "hw_interface/electronics/electronics.hpp"
#include "hw_interface/socketcan/socketcan_machine.hpp"
#include "tests/hw_interface/socketcan/host_feedback_fixture.hpp"

namespace wex::can {
namespace {

TEST_F(HostFeedbackTest, IsCompleteOnlyWithEveryPart) {
  EXPECT_FALSE(feedback_.complete());
  EXPECT_EQ(feedback_.mode(), MachineMode::kInit);
  EXPECT_TRUE(std::isinf(feedback_.feedback_age_s(now_ns_)));
  EXPECT_TRUE(std::isinf(feedback_.status_age_s(now_ns_)));
  EXPECT_TRUE(std::isinf(feedback_.estop_age_s(now_ns_)));
  for (const SignalQuality quality : {feedback_.state(now_ns_).joint_quality[0]}) {
    EXPECT_EQ(quality, SignalQuality::kNotAvailable);
  }
  for (int zone = 0; zone < kNumZones; ++zone) {
    give_zone(zone);
    give(pressures_[zone], pressure_context_[zone]);
    EXPECT_FALSE(feedback_.complete());
  }
  imu_.sample_time_ms = stamp_ms_;
  give(imu_, imu_context_);
  give_status();
  give(estop_, estop_context_);
  EXPECT_FALSE(feedback_.complete()) << "without a base pose there is no machine to drive";
  give_pose();
  EXPECT_TRUE(feedback_.complete());
  EXPECT_TRUE(feedback_.dbc_matches());
  EXPECT_EQ(feedback_.mode(), MachineMode::kReady);
}

TEST_F(HostFeedbackTest, ReadsBackWhatTheMachineSays) {
  const JointSlot slot = slot_of("BOOM");
  zones_[slot.zone].position[slot.index] = 0.5;
  zones_[slot.zone].rate[slot.index] = -0.1;
  pressures_[slot.zone].pressure_a_pa[slot.index] = 10e6;
  pressures_[slot.zone].pressure_b_pa[slot.index] = 3e6;
  pose_.p_map_base_m << 101.5, 198.0, 3.0;
  pose_.yaw_rad = 0.3;
  pose_.pitch_rad = -0.1;
  pose_.velocity_m_s << 0.5, 0.0, 0.1;
  imu_.angular_velocity_rad_s << 0.0, 0.0, 0.2;
  give_all();
  const MachineState state = feedback_.state(now_ns_ + 7 * kMs);
  EXPECT_EQ(state.num_joints, m545().num_joints());
  EXPECT_NEAR(state.t_s, 5.0, 1e-9);
  EXPECT_NEAR(state.age_s, 0.007, 1e-9);
  EXPECT_NEAR(state.position[joint("BOOM")], 0.5, 1e-6);
  EXPECT_NEAR(state.rate[joint("BOOM")], -0.1, 1e-4);
  EXPECT_NEAR(state.effort[joint("BOOM")], 7e6 * 300'000 / 35e6, 100.0);
  EXPECT_NEAR(state.joint_age_s[joint("BOOM")], 0.007, 1e-9);
  EXPECT_EQ(state.joint_quality[joint("BOOM")], SignalQuality::kOk);
  BaseCoordinates base;
  base << 1.5, -2.0, 3.0, 0.3, -0.1, 0.0;
  EXPECT_LT((state.base - base).norm(), 1e-4);
  EXPECT_NEAR(state.base_velocity[0], 0.5, 1e-5);
  EXPECT_NEAR(state.base_velocity[5], 0.2, 1e-5);
}

TEST_F(HostFeedbackTest, WheelsTurnAndYawAreUnwrapped) {
  for (const char* name : {"LF_WHEEL", "TURN", "EE_YAW"}) {
    const JointSlot slot = slot_of(name);
    double angle = 3.0;
    for (int i = 0; i < 10; ++i) {
      zones_[slot.zone].position[slot.index] = wrap_angle(angle);
      give_zone(slot.zone);
      pass(10);
      if (i < 9) angle += 1.0;
    }
    EXPECT_NEAR(feedback_.measurement().position[joint(name)], angle, 1e-5) << name;
  }
  double yaw = -3.0;
  for (int i = 0; i < 10; ++i) {
    pose_.yaw_rad = wrap_angle(yaw);
    give_pose();
    pass(10);
    if (i < 9) yaw -= 1.0;
  }
  EXPECT_NEAR(feedback_.state(now_ns_).base[kBaseYaw], yaw, 1e-5);
}

TEST_F(HostFeedbackTest, AgesRunBySampleTimeNotByArrival) {
  give_all();
  pass(10);
  const std::uint32_t sampled_ms = stamp_ms_;
  pass(30);  // the same sample arrives 30 ms late
  for (int zone = 0; zone < kNumZones; ++zone) {
    zones_[zone].sample_time_ms = sampled_ms;
    give(zones_[zone], zone_context_[zone]);
  }
  pose_.sample_time_ms = sampled_ms;
  give(pose_, pose_context_);
  EXPECT_NEAR(feedback_.feedback_age_s(now_ns_), 0.030, 1e-4);
}

TEST_F(HostFeedbackTest, FeedbackIsAsOldAsItsOldestJoint) {
  give_all();
  for (int i = 0; i < 6; ++i) {
    pass(10);
    for (int zone = 0; zone < kNumZones; ++zone) {
      if (zone != 4) give_zone(zone);
    }
    give_pose();
  }
  EXPECT_NEAR(feedback_.feedback_age_s(now_ns_), 0.060, 1e-6);
  EXPECT_FALSE(feedback_.all_zones_reach(stamp_ms_));
  give_zone(4);
  EXPECT_NEAR(feedback_.feedback_age_s(now_ns_), 0.0, 1e-6);
  EXPECT_TRUE(feedback_.all_zones_reach(stamp_ms_));
  EXPECT_FALSE(feedback_.all_zones_reach(stamp_ms_ + 1));
}

// T17: one joint of a zone whose frames still come.
TEST_F(HostFeedbackTest, AJointWhoseSensorSaysNoMoreIsStaleAfter30Ms) {
  const JointSlot slot = slot_of("DIPPER");
  zones_[slot.zone].position[slot.index] = -0.5;
  give_all();
  zones_[slot.zone].quality[slot.index] = JointQuality::kStale;
  zones_[slot.zone].position[slot.index] = 0.0;
  for (int age_ms = 10; age_ms <= 60; age_ms += 10) {
    pass(10);
    for (int zone = 0; zone < kNumZones; ++zone) give_zone(zone);
    give_pose();
    const MachineState state = feedback_.state(now_ns_);
    EXPECT_EQ(state.joint_quality[joint("DIPPER")],
              age_ms >= 30 ? SignalQuality::kStale : SignalQuality::kOk)
        << age_ms;
    EXPECT_EQ(state.joint_quality[joint("BOOM")], SignalQuality::kOk);
    EXPECT_NEAR(state.joint_age_s[joint("DIPPER")], 1e-3 * age_ms, 1e-6);
    EXPECT_NEAR(state.position[joint("DIPPER")], -0.5, 1e-6) << "the last good value";
    EXPECT_NEAR(feedback_.feedback_age_s(now_ns_), 1e-3 * age_ms, 1e-6);
  }
  zones_[slot.zone].quality[slot.index] = JointQuality::kInvalid;
  pass(10);
  give_zone(slot.zone);
  EXPECT_EQ(feedback_.state(now_ns_).joint_quality[joint("DIPPER")], SignalQuality::kInvalid);
}

TEST_F(HostFeedbackTest, APoseWithoutQualityIsNoPose) {
  give_all();
  pose_.quality = JointQuality::kInvalid;
  pass(10);
  give_pose();
  EXPECT_TRUE(std::isinf(feedback_.feedback_age_s(now_ns_)));
}

TEST_F(HostFeedbackTest, TheLeastPermissiveZoneCounts) {
  give_all();
  for (ZoneStatus& status : statuses_) status.mode = MachineMode::kEnabled;
  give_status();
  EXPECT_EQ(feedback_.mode(), MachineMode::kEnabled);
  for (const MachineMode mode : {MachineMode::kEnabling, MachineMode::kReady, MachineMode::kHold,
                                 MachineMode::kInit, MachineMode::kFault, MachineMode::kEStop}) {
    statuses_[3].mode = mode;
    give_status();
    EXPECT_EQ(feedback_.mode(), mode);
  }
}

TEST_F(HostFeedbackTest, SessionAndChallengeCountWhenAllZonesAgree) {
  give_all();
  for (ZoneStatus& status : statuses_) {
    status.session = 7;
    status.challenge = 8;
  }
  give_status();
  EXPECT_EQ(feedback_.session(), 7U);
  EXPECT_EQ(feedback_.challenge(), 8U);
  statuses_[5].session = statuses_[5].challenge = 9;
  give_status();
  EXPECT_EQ(feedback_.session(), 0U);
  EXPECT_EQ(feedback_.challenge(), 0U);
  statuses_[5].dbc_hash ^= 1U;
  give_status();
  EXPECT_FALSE(feedback_.dbc_matches());
}

TEST_F(HostFeedbackTest, ARepeatedCounterRefreshesNothing) {
  give_all();
  pass(40);
  zones_[0].sample_time_ms = stamp_ms_;
  SendContext again = zone_context_[0];
  EXPECT_EQ(give(zones_[0], zone_context_[0]), FrameVerdict::kUsed);
  pass(40);
  EXPECT_EQ(feedback_.take(frame_of(zones_[0], again), now_ns_), FrameVerdict::kRepeated);
}

TEST_F(HostFeedbackTest, AWrongSequenceNeedsThreeGoodOnes) {
  give_all();
  zone_context_[0].counter = static_cast<std::uint8_t>(zone_context_[0].counter + 10);
  EXPECT_EQ(give(zones_[0], zone_context_[0]), FrameVerdict::kWrongSequence);
  EXPECT_EQ(give(zones_[0], zone_context_[0]), FrameVerdict::kWrongSequence);
  EXPECT_EQ(give(zones_[0], zone_context_[0]), FrameVerdict::kWrongSequence);
  EXPECT_EQ(give(zones_[0], zone_context_[0]), FrameVerdict::kUsed);
}

TEST_F(HostFeedbackTest, LostFramesAreCountedByKind) {
  give_all();
  zone_context_[2].counter = static_cast<std::uint8_t>(zone_context_[2].counter + 2);
  give_zone(2);
  imu_context_.counter = static_cast<std::uint8_t>(imu_context_.counter + 1);
  give(imu_, imu_context_);
  EXPECT_EQ(feedback_.lost_frames(MessageKind::kZoneFeedback), 2);
  EXPECT_EQ(feedback_.lost_frames(MessageKind::kImu), 1);
  for (const MessageKind kind :
       {MessageKind::kZoneStatus, MessageKind::kZonePressure, MessageKind::kBasePose,
        MessageKind::kEStopState, MessageKind::kOperatorCommand, MessageKind::kLockStep}) {
    EXPECT_EQ(feedback_.lost_frames(kind), 0);
  }
}

TEST_F(HostFeedbackTest, ASenderMayStartAnewAfterASecondOfSilence) {
  give_all();
  pass(1100);
  estop_context_.counter = static_cast<std::uint8_t>(estop_context_.counter + 100);
  EXPECT_EQ(give(estop_, estop_context_), FrameVerdict::kUsed);
}

TEST_F(HostFeedbackTest, FourWrongCrcsWithinASecondAreAFault) {
  give_all();
  const auto corrupted = [&] {
    CanFrame frame = frame_of(zones_[0], zone_context_[0]);
    zone_context_[0].counter--;
    frame.data[20] ^= 0x10;
    return feedback_.take(frame, now_ns_);
  };
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(corrupted(), FrameVerdict::kBadCrc);
    pass(100);
    give_zone(0);
  }
  EXPECT_FALSE(feedback_.take_crc_fault());
  pass(750);
  give_zone(0);
  corrupted();
  EXPECT_FALSE(feedback_.take_crc_fault()) << "the first is more than a second ago";
  corrupted();
  EXPECT_TRUE(feedback_.take_crc_fault());
  EXPECT_FALSE(feedback_.take_crc_fault()) << "an event";
}

TEST_F(HostFeedbackTest, OneOfTheHostsOwnIdsIsASecondSender) {
  SendContext context{123, 0};
  const CanFrame frames[] = {frame_of(ZoneCommand{}, context), frame_of(HostHeartbeat{}, context),
                             frame_of(HostStop{}, context), frame_of(LockStep{}, context)};
  for (CanFrame frame : frames) {
    EXPECT_EQ(feedback_.take(frame, now_ns_), FrameVerdict::kOwnId);
    EXPECT_TRUE(feedback_.take_masquerade());
    frame.data[frame.length - 1] ^= 0xFF;
    EXPECT_EQ(feedback_.take(frame, now_ns_), FrameVerdict::kOwnId) << "whatever its CRC";
    EXPECT_TRUE(feedback_.take_masquerade());
    frame.length = 48;
    EXPECT_EQ(feedback_.take(frame, now_ns_), FrameVerdict::kMalformed);
    EXPECT_FALSE(feedback_.take_masquerade()) << "an id altered on the way";
  }
}

TEST_F(HostFeedbackTest, MalformedFramesAreDroppedAndNamed) {
  CanFrame good = frame_of(zones_[0], zone_context_[0]);
  CanFrame frame = good;
  frame.length = 32;
  EXPECT_EQ(feedback_.take(frame, now_ns_), FrameVerdict::kMalformed);
  frame = good;
  frame.fd = false;
  frame.length = 8;
  EXPECT_EQ(feedback_.take(frame, now_ns_), FrameVerdict::kMalformed);
  frame = good;
  frame.extended = true;
  EXPECT_EQ(feedback_.take(frame, now_ns_), FrameVerdict::kMalformed);
  frame = good;
  frame.remote = true;
  EXPECT_EQ(feedback_.take(frame, now_ns_), FrameVerdict::kMalformed);
  frame = good;
  frame.id = 0x555;
  EXPECT_EQ(feedback_.take(frame, now_ns_), FrameVerdict::kUnknown);
  frame = good;
  frame.error = true;
  EXPECT_EQ(feedback_.take(frame, now_ns_), FrameVerdict::kError);
  EXPECT_FALSE(feedback_.clock().valid()) << "none of them may have had an effect";
}

TEST_F(HostFeedbackTest, AnOpenChainCountsWhateverItsCounter) {
  give_all();
  EXPECT_FALSE(feedback_.estop_open());
  estop_.chain_open = true;
  estop_context_.counter = static_cast<std::uint8_t>(estop_context_.counter + 50);
  EXPECT_EQ(give(estop_, estop_context_), FrameVerdict::kWrongSequence);
  EXPECT_TRUE(feedback_.estop_open());
  estop_.chain_open = false;
  give(estop_, estop_context_);
  give(estop_, estop_context_);
  EXPECT_TRUE(feedback_.estop_open()) << "good news must be in order";
  give(estop_, estop_context_);
  EXPECT_FALSE(feedback_.estop_open());
}

TEST_F(HostFeedbackTest, AResetIsAnEdgeOfAPersonsFrames) {
  give_all();
  const auto operator_says = [&](OperatorAction action) {
    give(OperatorCommand{action}, operator_context_);
  };
  operator_says(OperatorAction::kReset);
  EXPECT_FALSE(feedback_.take_operator_reset()) << "a level is no edge";
  operator_says(OperatorAction::kNone);
  operator_says(OperatorAction::kReset);
  EXPECT_TRUE(feedback_.take_operator_reset());
  EXPECT_FALSE(feedback_.take_operator_reset());
  operator_says(OperatorAction::kNone);
  pass(1100);
  for (int zone = 0; zone < kNumZones; ++zone) give_zone(zone);
  operator_says(OperatorAction::kReset);
  EXPECT_FALSE(feedback_.take_operator_reset()) << "the frame before is too old";
}

TEST_F(HostFeedbackTest, AMachineSwitchedOnAnewIsUnknownAgain) {
  give_all();
  pass(5000);
  stamp_ms_ = 20;
  for (auto* contexts : {&zone_context_, &status_context_, &pressure_context_}) contexts->fill({});
  give_zone(0);
  EXPECT_TRUE(feedback_.take_restart());
  EXPECT_FALSE(feedback_.take_restart());
  EXPECT_FALSE(feedback_.complete());
  EXPECT_EQ(feedback_.mode(), MachineMode::kInit);
}

TEST_F(HostFeedbackTest, WhatCameBeforeTheFirstStampIsAsOldAsThat) {
  give(estop_, estop_context_);
  give_status();
  pass(10);
  give_zone(0);
  EXPECT_LT(feedback_.estop_age_s(now_ns_), 0.011);
  EXPECT_LT(feedback_.status_age_s(now_ns_), 0.011);
  pass(50);
  EXPECT_NEAR(feedback_.estop_age_s(now_ns_), 0.050, 1e-6);
}

TEST(HostFeedback, AMachineWithAJointThatTheBusDoesNotKnowIsRefused) {
  MachineModel machine = m545();
  machine.joints[3].name = "TAIL";
  const auto feedback = HostFeedback::create(machine, {0.0, 0.0});
  ASSERT_FALSE(feedback);
  EXPECT_EQ(feedback.error().code, ErrorCode::kBadInput);
  EXPECT_NE(feedback.error().message.find("'TAIL'"), std::string::npos);
}

TEST(HostFeedback, BothSidesMeanTheSameByLockStep) { EXPECT_EQ(kAnnouncesLockStep, kInfoLockStep); }

}  // namespace
}  // namespace wex::can
