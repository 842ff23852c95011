#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "hw_interface/electronics/plant.hpp"
#include "hw_interface/socketcan/codec.hpp"
#include "hw_interface/socketcan/frame_port.hpp"
#include "models/excavator/machine_model.hpp"

namespace wex::can {

/// Joint index of every slot, -1 where a zone has fewer joints.
using SlotMap = std::array<std::array<int, kMaxZoneJoints>, kNumZones>;

/// What changes seldom: sent at 20 Hz and at once when it changes.
struct StatusReport {
  MachineMode mode = MachineMode::kInit;
  std::uint16_t bits = 0;
  std::uint32_t challenge = 0, session = 0;
  bool operator==(const StatusReport&) const = default;
};

/// What only one zone knows of itself.
struct ZoneReport {
  std::uint8_t last_accepted_counter = 0;
  std::uint16_t rejected_frames = 0;
};

/// The electronics' own frames: ZoneFeedback, BasePose, Imu and EStopState every period (100 Hz),
/// ZonePressure every 2nd, ZoneStatus every 5th and on change. A frame the bus does not take is
/// not kept: the next one is newer. Noexcept, allocation-free.
class FeedbackPublisher {
 public:
  FeedbackPublisher(const MachineModel& machine, const SlotMap& slots,
                    const Eigen::Vector2d& map_origin_m, double period_s);

  struct Sample {
    const PlantState* plant = nullptr;
    const PlantInput* input = nullptr;
    const StatusReport* status = nullptr;
    const std::array<ZoneReport, kNumZones>* zones = nullptr;
    bool chain_open = false;
    std::uint8_t estop_cause = 0;
    std::uint32_t sample_time_ms = 0;
  };
  void publish(FramePort& port, const Sample& sample) noexcept;

  [[nodiscard]] long frames_sent() const noexcept { return sent_; }
  [[nodiscard]] long frames_not_taken() const noexcept { return not_taken_; }
  /// What the port answered to the last frame.
  [[nodiscard]] SocketStatus port_status() const noexcept { return port_status_; }

 private:
  template <typename Message>
  void send(FramePort& port, const Message& message, SendContext& context) noexcept;
  void send_zone_feedback(FramePort& port, const Sample& sample, int zone) noexcept;
  void send_zone_pressure(FramePort& port, const Sample& sample, int zone) noexcept;
  void send_zone_status(FramePort& port, const Sample& sample, int zone) noexcept;
  void send_base_pose(FramePort& port, const Sample& sample) noexcept;
  void send_imu(FramePort& port, const Sample& sample) noexcept;

  struct JointData {
    SlotLimits limits;
    bool continuous = false, wheel = false;
    double pressure_per_effort = 0.0;  ///< Pa per N m or N
  };
  std::array<JointData, kMaxJoints> joints_{};
  SlotMap slots_;
  Eigen::Vector2d map_origin_m_;
  double period_s_;
  Eigen::Vector3d last_velocity_ = Eigen::Vector3d::Zero();
  bool has_last_velocity_ = false;

  std::array<SendContext, kNumZones> feedback_{}, pressure_{}, status_context_{};
  SendContext estop_, imu_, base_pose_;
  StatusReport last_status_;
  long period_ = 0;
  long sent_ = 0, not_taken_ = 0;
  SocketStatus port_status_ = SocketStatus::kOk;
};

}  // namespace wex::can
