#include "hw_interface/socketcan/host_feedback.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

namespace wex::can {
namespace {

constexpr double kAgeTolerance_s = 1e-6;  ///< stamps are whole milliseconds
constexpr double kNever_s = std::numeric_limits<double>::infinity();

template <typename Message>
constexpr bool kHasStamp = std::is_same_v<Message, ZoneFeedback> || std::is_same_v<Message, Imu> ||
                           std::is_same_v<Message, BasePose>;

/// How little a mode permits: the least permissive of several zones is the machine's.
int restriction(MachineMode mode) noexcept {
  switch (mode) {
    case MachineMode::kEnabled:
      return 0;
    case MachineMode::kEnabling:
      return 1;
    case MachineMode::kReady:
      return 2;
    case MachineMode::kHold:
      return 3;
    case MachineMode::kInit:
      return 4;
    case MachineMode::kFault:
      return 5;
    case MachineMode::kEStop:
      break;
  }
  return 6;
}

double nearest_turn(double angle_rad, double reference_rad) noexcept {
  return reference_rad + wrap_angle(angle_rad - reference_rad);
}

}  // namespace

Result<HostFeedback> HostFeedback::create(const MachineModel& machine,
                                          const Eigen::Vector2d& map_origin_m,
                                          const FeedbackSettings& settings) {
  WEX_EXPECTS(machine.num_joints() <= kMaxJoints && settings.max_crc_errors <= kMaxCrcErrors);
  for (const Joint& joint : machine.joints) {
    const JointSlot slot = slot_of(joint.name);
    if (slot.zone < 0) {
      return fail(ErrorCode::kBadInput, "the joint '" + joint.name + "' of the machine '" +
                                            machine.name +
                                            "' has no place on the bus: no signal of wex.dbc has "
                                            "it as its JointName");
    }
  }
  return HostFeedback(machine, map_origin_m, settings);
}

HostFeedback::HostFeedback(const MachineModel& machine, const Eigen::Vector2d& map_origin_m,
                           const FeedbackSettings& settings) noexcept
    : settings_(settings),
      map_origin_m_(map_origin_m.x(), map_origin_m.y(), 0.0),
      num_joints_(machine.num_joints()) {
  for (auto& zone : joint_of_) zone.fill(-1);
  for (int i = 0; i < num_joints_; ++i) {
    const Joint& joint = machine.joints[i];
    slots_[i] = slot_of(joint.name);
    joint_of_[slots_[i].zone][slots_[i].index] = i;
    joints_[i].continuous = joint.continuous;
    // Displacement of the cylinder or motor: it reaches its largest effort at pump pressure.
    joints_[i].effort_per_pressure = joint.max_effort / machine.pump_pressure_pa;
  }
}

template <typename Action>
void HostFeedback::for_each_receiver(Action action) noexcept {
  for (int zone = 0; zone < kNumZones; ++zone) {
    action(feedback_[zone]);
    action(pressure_[zone]);
    action(status_[zone]);
  }
  action(imu_);
  action(pose_);
  action(estop_);
  action(operator_);
}

void HostFeedback::forget() noexcept {
  for_each_receiver([](auto& latest) { latest = std::decay_t<decltype(latest)>{}; });
  for (JointData& joint : joints_) joint.ok_once = false;
}

void HostFeedback::observe_stamp(std::uint32_t stamp_ms, std::int64_t now_ns) noexcept {
  const bool first = !clock_.valid();
  if (clock_.observe(stamp_ms, now_ns) == HostClock::Verdict::kRestarted) {
    forget();
    restarted_ = true;
  } else if (first) {
    // What came before the first stamp was dated by a clock that did not know the machine's time.
    const double now = clock_.now_s(now_ns);
    for_each_receiver([now](Receiver& receiver) { receiver.heard_s = receiver.checked_s = now; });
  }
}

FrameVerdict HostFeedback::refuse(CodecError error, std::int64_t now_ns) noexcept {
  if (error != CodecError::kBadCrc) return FrameVerdict::kMalformed;
  const double now = clock_.now_s(now_ns);
  const long before_window = crc_errors_ - settings_.max_crc_errors;
  if (before_window >= 0 &&
      now - crc_error_s_[before_window % crc_error_s_.size()] < settings_.crc_window_s) {
    crc_fault_ = true;
  }
  crc_error_s_[crc_errors_ % crc_error_s_.size()] = now;
  ++crc_errors_;
  return FrameVerdict::kBadCrc;
}

void HostFeedback::unwrap_zone(const Latest<ZoneFeedback>& latest) noexcept {
  const ZoneFeedback& value = latest.value;
  for (int i = 0; i < kMaxZoneJoints; ++i) {
    const int index = joint_of_[value.zone][i];
    if (index < 0 || value.quality[i] != JointQuality::kOk) continue;
    JointData& joint = joints_[index];
    joint.unwrapped = joint.continuous && joint.ok_once
                          ? nearest_turn(value.position[i], joint.unwrapped)
                          : value.position[i];
    joint.ok_once = true;
    joint.ok_sample_s = latest.sample_s;
  }
}

template <typename Message>
void HostFeedback::apply(const Message& message, std::int64_t now_ns,
                         Latest<Message>& latest) noexcept {
  const double now = clock_.now_s(now_ns);
  if constexpr (std::is_same_v<Message, OperatorCommand>) {
    const bool after_idle = latest.heard && latest.value.action == OperatorAction::kNone &&
                            now - latest.heard_s <= settings_.operator_memory_s;
    operator_reset_ = operator_reset_ || (message.action == OperatorAction::kReset && after_idle);
  }
  if constexpr (std::is_same_v<Message, BasePose>) {
    yaw_rad_ = latest.heard ? nearest_turn(message.yaw_rad, yaw_rad_) : message.yaw_rad;
  }
  latest.value = message;
  latest.heard = true;
  latest.heard_s = now;
  if constexpr (kHasStamp<Message>) latest.sample_s = clock_.seconds_of(message.sample_time_ms);
  if constexpr (std::is_same_v<Message, ZoneFeedback>) unwrap_zone(latest);
}

template <typename Message>
FrameVerdict HostFeedback::receive(const CanFrame& frame, std::int64_t now_ns,
                                   Latest<Message>& latest) noexcept {
  Message message;
  const auto meta = decode(frame, 0, message);
  if (!meta) return refuse(meta.error(), now_ns);
  if constexpr (kHasStamp<Message>) observe_stamp(message.sample_time_ms, now_ns);
  if constexpr (std::is_same_v<Message, EStopState>) {
    // Bad news counts whatever its counter says.
    if (message.chain_open) latest.value.chain_open = true;
  }
  if (latest.heard && clock_.now_s(now_ns) - latest.heard_s > settings_.forget_sender_after_s) {
    latest.sequence.reset();
  }
  constexpr double kMsPerS = 1e3;
  const double now = clock_.now_s(now_ns);
  const int missing = SequenceCheck::missing_after(kMsPerS * (now - latest.checked_s),
                                                   kMsPerS * timing_of(kind_of(frame)).period_s);
  latest.checked_s = now;
  const SequenceVerdict verdict = latest.sequence.update(meta->counter, missing);
  if (verdict == SequenceVerdict::kRepeated) return FrameVerdict::kRepeated;
  if (!latest.sequence.trusted()) return FrameVerdict::kWrongSequence;
  apply(message, now_ns, latest);
  return FrameVerdict::kUsed;
}

template <typename Message>
FrameVerdict HostFeedback::judge_own(const CanFrame& frame) noexcept {
  Message message;
  const auto meta = decode(frame, 0, message);
  // Another length or format is an id that was altered on the way, not a second sender.
  if (!meta &&
      (meta.error() == CodecError::kWrongLength || meta.error() == CodecError::kWrongFormat)) {
    return FrameVerdict::kMalformed;
  }
  masquerade_ = true;
  return FrameVerdict::kOwnId;
}

FrameVerdict HostFeedback::take(const CanFrame& frame, std::int64_t now_ns) noexcept {
  if (frame.error) return FrameVerdict::kError;
  const int zone = std::max(0, zone_of(frame));
  switch (kind_of(frame)) {
    case MessageKind::kZoneFeedback:
      return receive(frame, now_ns, feedback_[zone]);
    case MessageKind::kZonePressure:
      return receive(frame, now_ns, pressure_[zone]);
    case MessageKind::kZoneStatus:
      return receive(frame, now_ns, status_[zone]);
    case MessageKind::kImu:
      return receive(frame, now_ns, imu_);
    case MessageKind::kBasePose:
      return receive(frame, now_ns, pose_);
    case MessageKind::kEStopState:
      return receive(frame, now_ns, estop_);
    case MessageKind::kOperatorCommand:
      return receive(frame, now_ns, operator_);
    case MessageKind::kHostStop:
      return judge_own<HostStop>(frame);
    case MessageKind::kHostHeartbeat:
      return judge_own<HostHeartbeat>(frame);
    case MessageKind::kZoneCommand:
      return judge_own<ZoneCommand>(frame);
    case MessageKind::kLockStep:
      return judge_own<LockStep>(frame);
    case MessageKind::kUnknown:
      break;
  }
  return frame.extended || frame.remote ? FrameVerdict::kMalformed : FrameVerdict::kUnknown;
}

JointMeasurement HostFeedback::measurement() const noexcept {
  JointMeasurement measured;
  measured.pitch_rad = pose_.value.pitch_rad;
  measured.roll_rad = pose_.value.roll_rad;
  for (int i = 0; i < num_joints_; ++i) {
    const auto [zone, index] = slots_[i];
    const ZonePressure& pressure = pressure_[zone].value;
    measured.position[i] = joints_[i].unwrapped;
    measured.rate[i] = feedback_[zone].value.rate[index];
    measured.effort[i] = joints_[i].effort_per_pressure *
                         (pressure.pressure_a_pa[index] - pressure.pressure_b_pa[index]);
  }
  return measured;
}

MachineState HostFeedback::state(std::int64_t now_ns) const noexcept {
  const double now = clock_.now_s(now_ns);
  MachineState state;
  state.t_s = pose_.sample_s;
  state.age_s = std::max(0.0, now - pose_.sample_s);
  const BasePose& pose = pose_.value;
  state.base << pose.p_map_base_m - map_origin_m_, yaw_rad_, pose.pitch_rad, pose.roll_rad;
  state.base_velocity << pose.velocity_m_s, imu_.value.angular_velocity_rad_s;
  state.num_joints = num_joints_;
  const JointMeasurement measured = measurement();
  state.position = measured.position;
  state.rate = measured.rate;
  state.effort = measured.effort;
  for (int i = 0; i < num_joints_; ++i) {
    const JointQuality reported = feedback_[slots_[i].zone].value.quality[slots_[i].index];
    state.joint_age_s[i] =
        joints_[i].ok_once ? std::max(0.0, now - joints_[i].ok_sample_s) : kNever_s;
    SignalQuality& quality = state.joint_quality[i];
    if (!joints_[i].ok_once) {
      quality = SignalQuality::kNotAvailable;
    } else if (reported == JointQuality::kInvalid || reported == JointQuality::kNotAvailable) {
      quality = SignalQuality::kInvalid;
    } else {
      quality = state.joint_age_s[i] >= settings_.stale_after_s - kAgeTolerance_s
                    ? SignalQuality::kStale
                    : SignalQuality::kOk;
    }
  }
  return state;
}

double HostFeedback::feedback_age_s(std::int64_t now_ns) const noexcept {
  const bool posed = pose_.heard && pose_.value.quality == JointQuality::kOk;
  double oldest_s = posed ? pose_.sample_s : -kNever_s;
  for (int i = 0; i < num_joints_; ++i) {
    oldest_s = std::min(oldest_s, joints_[i].ok_once ? joints_[i].ok_sample_s : -kNever_s);
  }
  return std::max(0.0, clock_.now_s(now_ns) - oldest_s);
}

double HostFeedback::status_age_s(std::int64_t now_ns) const noexcept {
  double oldest_s = kNever_s;
  for (const auto& status : status_) {
    oldest_s = std::min(oldest_s, status.heard ? status.heard_s : -kNever_s);
  }
  return std::max(0.0, clock_.now_s(now_ns) - oldest_s);
}

double HostFeedback::estop_age_s(std::int64_t now_ns) const noexcept {
  return estop_.heard ? std::max(0.0, clock_.now_s(now_ns) - estop_.heard_s) : kNever_s;
}

bool HostFeedback::complete() const noexcept {
  bool all = pose_.heard && imu_.heard && estop_.heard;
  for (int zone = 0; zone < kNumZones; ++zone) {
    all = all && feedback_[zone].heard && pressure_[zone].heard && status_[zone].heard;
  }
  for (int i = 0; i < num_joints_; ++i) all = all && joints_[i].ok_once;
  return all;
}

bool HostFeedback::all_zones_reach(std::uint32_t stamp_ms) const noexcept {
  const double t_s = clock_.seconds_of(stamp_ms);
  return std::all_of(feedback_.begin(), feedback_.end(),
                     [t_s](const auto& zone) { return zone.heard && zone.sample_s >= t_s; }) &&
         pose_.heard && pose_.sample_s >= t_s;
}

MachineMode HostFeedback::mode() const noexcept {
  MachineMode strictest = MachineMode::kEnabled;
  for (const auto& status : status_) {
    const MachineMode mode = status.heard ? status.value.mode : MachineMode::kInit;
    if (restriction(mode) > restriction(strictest)) strictest = mode;
  }
  return strictest;
}

std::uint32_t HostFeedback::session() const noexcept {
  const std::uint32_t session = status_[0].value.session;
  const bool agreed = std::all_of(status_.begin(), status_.end(), [session](const auto& status) {
    return status.value.session == session;
  });
  return agreed ? session : 0;
}

std::uint32_t HostFeedback::challenge() const noexcept {
  const std::uint32_t challenge = status_[0].value.challenge;
  const bool agreed = std::all_of(status_.begin(), status_.end(), [challenge](const auto& status) {
    return status.value.challenge == challenge;
  });
  return agreed ? challenge : 0;
}

bool HostFeedback::dbc_matches() const noexcept {
  return std::all_of(status_.begin(), status_.end(), [](const auto& status) {
    return status.heard && status.value.dbc_hash == dbc_hash();
  });
}

bool HostFeedback::operator_stopped() const noexcept {
  return std::any_of(status_.begin(), status_.end(), [](const auto& status) {
    return (status.value.fault_bits & kReportsOperatorStop) != 0;
  });
}

bool HostFeedback::take_operator_reset() noexcept { return std::exchange(operator_reset_, false); }
bool HostFeedback::take_restart() noexcept { return std::exchange(restarted_, false); }
bool HostFeedback::take_masquerade() noexcept { return std::exchange(masquerade_, false); }
bool HostFeedback::take_crc_fault() noexcept { return std::exchange(crc_fault_, false); }

long HostFeedback::lost_frames(MessageKind kind) const noexcept {
  const auto sum = [](const auto& zones) {
    long lost = 0;
    for (const auto& zone : zones) lost += zone.sequence.lost_frames();
    return lost;
  };
  switch (kind) {
    case MessageKind::kZoneFeedback:
      return sum(feedback_);
    case MessageKind::kZonePressure:
      return sum(pressure_);
    case MessageKind::kZoneStatus:
      return sum(status_);
    case MessageKind::kImu:
      return imu_.sequence.lost_frames();
    case MessageKind::kBasePose:
      return pose_.sequence.lost_frames();
    case MessageKind::kEStopState:
      return estop_.sequence.lost_frames();
    case MessageKind::kOperatorCommand:
      return operator_.sequence.lost_frames();
    default:
      return 0;
  }
}

}  // namespace wex::can
