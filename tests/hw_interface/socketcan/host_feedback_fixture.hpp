#pragma once

#include <gtest/gtest.h>

#include <string>

#include "hw_interface/socketcan/host_feedback.hpp"

namespace wex::can {

inline constexpr std::int64_t kMs = 1'000'000;

inline const MachineModel& m545() {
  static const MachineModel machine = load_machine().value();
  return machine;
}
inline int joint(const std::string& name) {
  return m545().coordinate(name).value() - kNumBaseCoordinates;
}

/// A machine that says what a test wants, with every counter as it should be.
class HostFeedbackTest : public ::testing::Test {
 protected:
  HostFeedbackTest() {
    for (int zone = 0; zone < kNumZones; ++zone) {
      zones_[zone].zone = pressures_[zone].zone = statuses_[zone].zone = zone;
      statuses_[zone].dbc_hash = dbc_hash();
      statuses_[zone].mode = MachineMode::kReady;
    }
    pose_.quality = JointQuality::kOk;
  }

  template <typename Message>
  CanFrame frame_of(const Message& message, SendContext& context) {
    CanFrame frame;
    EXPECT_TRUE(encode(message, context, frame).has_value());
    return frame;
  }
  template <typename Message>
  FrameVerdict give(const Message& message, SendContext& context) {
    return feedback_.take(frame_of(message, context), now_ns_);
  }
  void give_zone(int zone) {
    zones_[zone].sample_time_ms = stamp_ms_;
    EXPECT_EQ(give(zones_[zone], zone_context_[zone]), FrameVerdict::kUsed);
  }
  void give_pose() {
    pose_.sample_time_ms = stamp_ms_;
    EXPECT_EQ(give(pose_, pose_context_), FrameVerdict::kUsed);
  }
  void give_status() {
    for (int zone = 0; zone < kNumZones; ++zone) {
      EXPECT_EQ(give(statuses_[zone], status_context_[zone]), FrameVerdict::kUsed);
    }
  }
  void pass(int duration_ms) {
    now_ns_ += duration_ms * kMs;
    stamp_ms_ += static_cast<std::uint32_t>(duration_ms);
  }
  /// Everything there is.
  void give_all() {
    for (int zone = 0; zone < kNumZones; ++zone) {
      give_zone(zone);
      give(pressures_[zone], pressure_context_[zone]);
    }
    imu_.sample_time_ms = stamp_ms_;
    give(imu_, imu_context_);
    give_pose();
    give_status();
    give(estop_, estop_context_);
  }

  std::array<ZoneFeedback, kNumZones> zones_{};
  std::array<ZonePressure, kNumZones> pressures_{};
  std::array<ZoneStatus, kNumZones> statuses_{};
  Imu imu_;
  BasePose pose_;
  EStopState estop_;
  std::array<SendContext, kNumZones> zone_context_{}, pressure_context_{}, status_context_{};
  SendContext imu_context_, pose_context_, estop_context_, operator_context_;
  HostFeedback feedback_ = HostFeedback::create(m545(), {100.0, 200.0}).value();
  std::int64_t now_ns_ = 77'000 * kMs;
  std::uint32_t stamp_ms_ = 5000;
};

}  // namespace wex::can
