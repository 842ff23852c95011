#pragma once

#include <array>
#include <cstdint>

#include "hw_interface/joint_loop.hpp"
#include "hw_interface/socketcan/codec.hpp"
#include "hw_interface/socketcan/host_clock.hpp"
#include "hw_interface/socketcan/protection.hpp"
#include "models/excavator/machine_model.hpp"

namespace wex::can {

struct FeedbackSettings {
  double stale_after_s = 0.03;  ///< a joint's reading: the planner is told
  int max_crc_errors = 3;       ///< within crc_window_s; more is a fault
  double crc_window_s = 1.0;
  double operator_memory_s = 1.0;      ///< a reset edge needs the frame before it to be this young
  double forget_sender_after_s = 1.0;  ///< silence after which a counter may start anywhere
};

/// Set in ZoneStatus::fault_bits after a person's stop over the bus, until the reset.
inline constexpr std::uint16_t kReportsOperatorStop = 1 << 6;

/// What became of a received frame.
enum class FrameVerdict : std::uint8_t {
  kUsed,
  kRepeated,       ///< counter as before: refreshes nothing
  kWrongSequence,  ///< too much was lost, or it is old
  kBadCrc,         ///< altered on the way, or somebody else's
  kMalformed,      ///< length, format or a value that the DBC does not know
  kUnknown,        ///< an id that nobody has
  kOwnId,          ///< one of the host's ids, formed like one of its frames: a second sender
  kError           ///< error frame of the controller (or forged by a local process)
};

/// Everything the host knows of the machine, with its age: latest value per message, never a queue.
/// Used by the bus interface and by the replay. Time comes in. Noexcept, allocation-free after
/// construction.
class HostFeedback {
 public:
  /// The zones and places of the machine's joints, by joint; fails if the bus does not know one.
  [[nodiscard]] static Result<HostFeedback> create(const MachineModel& machine,
                                                   const Eigen::Vector2d& map_origin_m,
                                                   const FeedbackSettings& settings = {});

  FrameVerdict take(const CanFrame& frame, std::int64_t now_ns) noexcept;

  /// What the planners get: age and quality by joint, wheels and yaw unwrapped.
  [[nodiscard]] MachineState state(std::int64_t now_ns) const noexcept;
  [[nodiscard]] JointMeasurement measurement() const noexcept;

  [[nodiscard]] HostClock& clock() noexcept { return clock_; }
  [[nodiscard]] const HostClock& clock() const noexcept { return clock_; }
  [[nodiscard]] double now_s(std::int64_t now_ns) const noexcept { return clock_.now_s(now_ns); }

  /// Oldest of all joints and of the base pose, by the machine's own stamps; infinite if one of
  /// them was never heard.
  [[nodiscard]] double feedback_age_s(std::int64_t now_ns) const noexcept;
  [[nodiscard]] double status_age_s(std::int64_t now_ns) const noexcept;  ///< oldest zone's
  [[nodiscard]] double estop_age_s(std::int64_t now_ns) const noexcept;
  /// All zones, base pose, e-stop report heard at least once since the machine was switched on.
  [[nodiscard]] bool complete() const noexcept;
  /// Stamp of the zone's newest feedback; 0 if there is none.
  [[nodiscard]] std::uint32_t zone_stamp_ms(int zone) const noexcept {
    return feedback_[zone].value.sample_time_ms;
  }
  /// Feedback of all zones and the base pose are of `stamp_ms` or later.
  [[nodiscard]] bool all_zones_reach(std::uint32_t stamp_ms) const noexcept;

  /// The least permissive mode any zone reports.
  [[nodiscard]] MachineMode mode() const noexcept;
  /// The session, challenge that all zones report; 0 if they do not agree.
  [[nodiscard]] std::uint32_t session() const noexcept;
  [[nodiscard]] std::uint32_t challenge() const noexcept;
  [[nodiscard]] const ZoneStatus& status(int zone) const noexcept { return status_[zone].value; }
  [[nodiscard]] bool dbc_matches() const noexcept;
  [[nodiscard]] bool estop_open() const noexcept { return estop_.value.chain_open; }
  /// Any zone reports that a person stopped the machine over the bus.
  [[nodiscard]] bool operator_stopped() const noexcept;
  [[nodiscard]] JointSlot slot(int joint) const noexcept { return slots_[joint]; }

  // Events since the last call of the same function.
  [[nodiscard]] bool take_operator_reset() noexcept;
  [[nodiscard]] bool take_restart() noexcept;
  [[nodiscard]] bool take_masquerade() noexcept;
  [[nodiscard]] bool take_crc_fault() noexcept;

  /// Frames that counters show to be missing, by kind.
  [[nodiscard]] long lost_frames(MessageKind kind) const noexcept;

 private:
  /// Receiver of one id.
  struct Receiver {
    SequenceCheck sequence{SequenceCheck::Settings{}};
    bool heard = false;
    double heard_s = 0.0;    ///< machine time of the last frame in order
    double checked_s = 0.0;  ///< likewise of the last one whose counter was looked at
  };
  template <typename Message>
  struct Latest : Receiver {
    Message value{};
    double sample_s = 0.0;  ///< machine time, of messages with a stamp
  };

  HostFeedback(const MachineModel& machine, const Eigen::Vector2d& map_origin_m,
               const FeedbackSettings& settings) noexcept;
  template <typename Message>
  FrameVerdict receive(const CanFrame& frame, std::int64_t now_ns,
                       Latest<Message>& latest) noexcept;
  template <typename Message>
  FrameVerdict judge_own(const CanFrame& frame) noexcept;
  FrameVerdict refuse(CodecError error, std::int64_t now_ns) noexcept;
  template <typename Message>
  void apply(const Message& message, std::int64_t now_ns, Latest<Message>& latest) noexcept;
  void observe_stamp(std::uint32_t stamp_ms, std::int64_t now_ns) noexcept;
  void unwrap_zone(const Latest<ZoneFeedback>& latest) noexcept;
  void forget() noexcept;
  template <typename Action>
  void for_each_receiver(Action action) noexcept;

  struct JointData {
    bool continuous = false;
    double effort_per_pressure = 0.0;  ///< N m or N per Pa
    double unwrapped = 0.0;
    double ok_sample_s = 0.0;  ///< machine time of the last good reading
    bool ok_once = false;
  };

  FeedbackSettings settings_;
  Eigen::Vector3d map_origin_m_;
  int num_joints_ = 0;
  std::array<JointSlot, kMaxJoints> slots_{};
  std::array<JointData, kMaxJoints> joints_{};
  std::array<std::array<int, kMaxZoneJoints>, kNumZones> joint_of_{};  ///< -1: no such place

  HostClock clock_;
  std::array<Latest<ZoneFeedback>, kNumZones> feedback_{};
  std::array<Latest<ZonePressure>, kNumZones> pressure_{};
  std::array<Latest<ZoneStatus>, kNumZones> status_{};
  Latest<Imu> imu_;
  Latest<BasePose> pose_;
  Latest<EStopState> estop_;
  Latest<OperatorCommand> operator_;
  double yaw_rad_ = 0.0;  ///< unwrapped
  bool operator_reset_ = false, restarted_ = false, masquerade_ = false, crc_fault_ = false;
  static constexpr int kMaxCrcErrors = 15;
  std::array<double, kMaxCrcErrors> crc_error_s_{};  ///< times of the last ones, a ring
  long crc_errors_ = 0;
};

}  // namespace wex::can
