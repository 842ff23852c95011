#include "hw_interface/socketcan/codec.hpp"

#include <cmath>
#include <limits>

#include "hw_interface/socketcan/frame_fields.hpp"

// Which value stands in which signal. Places follow the payload: after Crc and Counter come the
// fields listed here; a zone's signals are grouped by kind, one per joint of the zone.

namespace wex::can {
namespace {

using Read = Result<ReceivedMeta, CodecError>;

constexpr JointQuality quality_of(std::int64_t raw) { return static_cast<JointQuality>(raw); }

/// A sender's value counts only with these qualities.
constexpr bool has_value(JointQuality quality) {
  return quality == JointQuality::kOk || quality == JointQuality::kStale;
}

/// Hands over what was read only if all of it was good.
template <typename Message>
Read deliver(const FrameReader& reader, const Message& read, Message& message) noexcept {
  const Read result = reader.finish();
  if (result) message = read;
  return result;
}

void write_vector(FrameWriter& writer, int field, const Eigen::Vector3d& vector) noexcept {
  for (int i = 0; i < 3; ++i) writer.physical(field + i, vector[i]);
}

Eigen::Vector3d read_vector(FrameReader& reader, int field) noexcept {
  Eigen::Vector3d vector;
  for (int i = 0; i < 3; ++i) vector[i] = reader.physical(field + i);
  return vector;
}

/// A value of quality kOk or kStale must be there; otherwise the wire carries "not available".
void write_rated(FrameWriter& writer, int field, double value, JointQuality quality) noexcept {
  if (has_value(quality)) {
    writer.physical(field, value);
  } else {
    writer.not_available(field);
  }
}

double read_rated(FrameReader& reader, int field, JointQuality quality) noexcept {
  if (has_value(quality)) return reader.physical(field);
  return std::numeric_limits<double>::quiet_NaN();
}

constexpr int kNoZone = -1;  // messages without a zone are always in the table

// ZoneCommand
constexpr int kValidForMs = kFirstField, kEchoTimeMs = kFirstField + 1;
constexpr int kCommandJoints = kFirstField + 2;  // rates, then active flags
// ZoneFeedback
constexpr int kFeedbackTime = kFirstField, kFeedbackJoints = kFirstField + 1;
// ZoneStatus
enum : int {
  kMode = kFirstField,
  kFaultBits,
  kLastAcceptedCounter,
  kRejectedFrames,
  kChallenge,
  kStatusSession,
  kStatusHash
};
// HostHeartbeat
enum : int { kRequest = kFirstField, kHeartbeatSession, kNonce, kChallengeEcho, kHeartbeatHash };
// HostStop and EStopState
constexpr int kSwitch = kFirstField, kCause = kFirstField + 1;
// Imu
constexpr int kImuTime = kFirstField, kAngularVelocity = kFirstField + 1;
constexpr int kAcceleration = kAngularVelocity + 3;
// BasePose
constexpr int kPoseQuality = kFirstField, kPoseTime = kFirstField + 1;
constexpr int kPoseValues = kFirstField + 2;  // position, yaw, pitch, roll, velocity

}  // namespace

std::uint32_t dbc_hash() noexcept { return generated::kDbcHash; }

Result<void, CodecError> encode(const ZoneCommand& message, SendContext& context,
                                CanFrame& frame) noexcept {
  const MessageRow* row = row_of(MessageKind::kZoneCommand, message.zone);
  if (row == nullptr) return tl::unexpected(CodecError::kUnknownId);
  const int joints = row->num_joints;
  FrameWriter writer(*row);
  writer.integer(kValidForMs, message.valid_for_ms);
  writer.integer(kEchoTimeMs, message.echo_time_ms);
  for (int i = 0; i < joints; ++i) {
    writer.physical(kCommandJoints + i, message.rate[i]);
    writer.integer(kCommandJoints + joints + i, message.active[i] ? 1 : 0);
  }
  // A command for a joint that the zone does not have is a mistake, not something to drop.
  for (int i = joints; i < kMaxZoneJoints; ++i) {
    if (!std::isfinite(message.rate[i])) writer.refuse(CodecError::kNotFinite);
    if (message.active[i] || message.rate[i] != 0.0) writer.refuse(CodecError::kOutOfRange);
  }
  return writer.finish(context, frame);
}

Read decode(const CanFrame& frame, std::uint32_t session, ZoneCommand& message) noexcept {
  auto reader = FrameReader::open(frame, session, MessageKind::kZoneCommand);
  if (!reader) return tl::unexpected(reader.error());
  const int joints = reader->row().num_joints;
  ZoneCommand read;
  read.zone = reader->row().zone;
  read.valid_for_ms = static_cast<std::uint8_t>(reader->integer(kValidForMs));
  read.echo_time_ms = static_cast<std::uint32_t>(reader->integer(kEchoTimeMs));
  for (int i = 0; i < joints; ++i) {
    read.rate[i] = reader->physical(kCommandJoints + i);
    read.active[i] = reader->integer(kCommandJoints + joints + i) != 0;
  }
  return deliver(*reader, read, message);
}

Result<void, CodecError> encode(const ZoneFeedback& message, SendContext& context,
                                CanFrame& frame) noexcept {
  const MessageRow* row = row_of(MessageKind::kZoneFeedback, message.zone);
  if (row == nullptr) return tl::unexpected(CodecError::kUnknownId);
  const int joints = row->num_joints;
  FrameWriter writer(*row);
  writer.integer(kFeedbackTime, message.sample_time_ms);
  for (int i = 0; i < joints; ++i) {
    const JointQuality quality = message.quality[i];
    const int field = kFeedbackJoints + i;
    writer.integer(field, static_cast<std::int64_t>(quality));
    write_rated(writer, field + joints, message.position[i], quality);
    write_rated(writer, field + 2 * joints, message.rate[i], quality);
    write_rated(writer, field + 3 * joints, message.spool[i], quality);
  }
  return writer.finish(context, frame);
}

Read decode(const CanFrame& frame, std::uint32_t session, ZoneFeedback& message) noexcept {
  auto reader = FrameReader::open(frame, session, MessageKind::kZoneFeedback);
  if (!reader) return tl::unexpected(reader.error());
  const int joints = reader->row().num_joints;
  ZoneFeedback read;
  read.quality.fill(JointQuality::kNotAvailable);
  read.zone = reader->row().zone;
  read.sample_time_ms = static_cast<std::uint32_t>(reader->integer(kFeedbackTime));
  for (int i = 0; i < joints; ++i) {
    const int field = kFeedbackJoints + i;
    read.quality[i] = quality_of(reader->integer(field));
    read.position[i] = read_rated(*reader, field + joints, read.quality[i]);
    read.rate[i] = read_rated(*reader, field + 2 * joints, read.quality[i]);
    read.spool[i] = read_rated(*reader, field + 3 * joints, read.quality[i]);
  }
  return deliver(*reader, read, message);
}

Result<void, CodecError> encode(const ZonePressure& message, SendContext& context,
                                CanFrame& frame) noexcept {
  const MessageRow* row = row_of(MessageKind::kZonePressure, message.zone);
  if (row == nullptr) return tl::unexpected(CodecError::kUnknownId);
  const int joints = row->num_joints;
  FrameWriter writer(*row);
  for (int i = 0; i < joints; ++i) {
    writer.physical(kFirstField + 2 * i, message.pressure_a_pa[i]);
    writer.physical(kFirstField + 2 * i + 1, message.pressure_b_pa[i]);
  }
  return writer.finish(context, frame);
}

Read decode(const CanFrame& frame, std::uint32_t session, ZonePressure& message) noexcept {
  auto reader = FrameReader::open(frame, session, MessageKind::kZonePressure);
  if (!reader) return tl::unexpected(reader.error());
  ZonePressure read;
  read.zone = reader->row().zone;
  for (int i = 0; i < reader->row().num_joints; ++i) {
    read.pressure_a_pa[i] = reader->physical_if_available(kFirstField + 2 * i);
    read.pressure_b_pa[i] = reader->physical_if_available(kFirstField + 2 * i + 1);
  }
  return deliver(*reader, read, message);
}

Result<void, CodecError> encode(const ZoneStatus& message, SendContext& context,
                                CanFrame& frame) noexcept {
  const MessageRow* row = row_of(MessageKind::kZoneStatus, message.zone);
  if (row == nullptr) return tl::unexpected(CodecError::kUnknownId);
  FrameWriter writer(*row);
  writer.integer(kMode, static_cast<std::int64_t>(message.mode));
  writer.integer(kFaultBits, message.fault_bits);
  writer.integer(kLastAcceptedCounter, message.last_accepted_counter);
  writer.integer(kRejectedFrames, message.rejected_frames);
  writer.integer(kChallenge, message.challenge);
  writer.integer(kStatusSession, message.session);
  writer.integer(kStatusHash, message.dbc_hash);
  return writer.finish(context, frame);
}

Read decode(const CanFrame& frame, std::uint32_t session, ZoneStatus& message) noexcept {
  auto reader = FrameReader::open(frame, session, MessageKind::kZoneStatus);
  if (!reader) return tl::unexpected(reader.error());
  ZoneStatus read;
  read.zone = reader->row().zone;
  read.mode = static_cast<MachineMode>(reader->integer(kMode));
  read.fault_bits = static_cast<std::uint16_t>(reader->integer(kFaultBits));
  read.last_accepted_counter = static_cast<std::uint8_t>(reader->integer(kLastAcceptedCounter));
  read.rejected_frames = static_cast<std::uint16_t>(reader->integer(kRejectedFrames));
  read.challenge = static_cast<std::uint32_t>(reader->integer(kChallenge));
  read.session = static_cast<std::uint32_t>(reader->integer(kStatusSession));
  read.dbc_hash = static_cast<std::uint32_t>(reader->integer(kStatusHash));
  return deliver(*reader, read, message);
}

Result<void, CodecError> encode(const HostHeartbeat& message, SendContext& context,
                                CanFrame& frame) noexcept {
  FrameWriter writer(*row_of(MessageKind::kHostHeartbeat, kNoZone));
  writer.integer(kRequest, static_cast<std::int64_t>(message.request));
  writer.integer(kHeartbeatSession, message.session);
  writer.integer(kNonce, message.nonce);
  writer.integer(kChallengeEcho, message.challenge_echo);
  writer.integer(kHeartbeatHash, message.dbc_hash);
  return writer.finish(context, frame);
}

Read decode(const CanFrame& frame, std::uint32_t session, HostHeartbeat& message) noexcept {
  auto reader = FrameReader::open(frame, session, MessageKind::kHostHeartbeat);
  if (!reader) return tl::unexpected(reader.error());
  HostHeartbeat read;
  read.request = static_cast<HostRequest>(reader->integer(kRequest));
  read.session = static_cast<std::uint32_t>(reader->integer(kHeartbeatSession));
  read.nonce = static_cast<std::uint16_t>(reader->integer(kNonce));
  read.challenge_echo = static_cast<std::uint32_t>(reader->integer(kChallengeEcho));
  read.dbc_hash = static_cast<std::uint32_t>(reader->integer(kHeartbeatHash));
  return deliver(*reader, read, message);
}

Result<void, CodecError> encode(const HostStop& message, SendContext& context,
                                CanFrame& frame) noexcept {
  FrameWriter writer(*row_of(MessageKind::kHostStop, kNoZone));
  writer.integer(kSwitch, message.active ? 1 : 0);
  writer.integer(kCause, message.cause);
  return writer.finish(context, frame);
}

Read decode(const CanFrame& frame, std::uint32_t session, HostStop& message) noexcept {
  auto reader = FrameReader::open(frame, session, MessageKind::kHostStop);
  if (!reader) return tl::unexpected(reader.error());
  HostStop read;
  read.active = reader->integer(kSwitch) != 0;
  read.cause = static_cast<std::uint8_t>(reader->integer(kCause));
  return deliver(*reader, read, message);
}

Result<void, CodecError> encode(const OperatorCommand& message, SendContext& context,
                                CanFrame& frame) noexcept {
  FrameWriter writer(*row_of(MessageKind::kOperatorCommand, kNoZone));
  writer.integer(kFirstField, static_cast<std::int64_t>(message.action));
  return writer.finish(context, frame);
}

Read decode(const CanFrame& frame, std::uint32_t session, OperatorCommand& message) noexcept {
  auto reader = FrameReader::open(frame, session, MessageKind::kOperatorCommand);
  if (!reader) return tl::unexpected(reader.error());
  OperatorCommand read;
  read.action = static_cast<OperatorAction>(reader->integer(kFirstField));
  return deliver(*reader, read, message);
}

Result<void, CodecError> encode(const EStopState& message, SendContext& context,
                                CanFrame& frame) noexcept {
  FrameWriter writer(*row_of(MessageKind::kEStopState, kNoZone));
  writer.integer(kSwitch, message.chain_open ? 1 : 0);
  writer.integer(kCause, message.cause);
  return writer.finish(context, frame);
}

Read decode(const CanFrame& frame, std::uint32_t session, EStopState& message) noexcept {
  auto reader = FrameReader::open(frame, session, MessageKind::kEStopState);
  if (!reader) return tl::unexpected(reader.error());
  EStopState read;
  read.chain_open = reader->integer(kSwitch) != 0;
  read.cause = static_cast<std::uint8_t>(reader->integer(kCause));
  return deliver(*reader, read, message);
}

Result<void, CodecError> encode(const Imu& message, SendContext& context,
                                CanFrame& frame) noexcept {
  FrameWriter writer(*row_of(MessageKind::kImu, kNoZone));
  writer.integer(kImuTime, message.sample_time_ms);
  write_vector(writer, kAngularVelocity, message.angular_velocity_rad_s);
  write_vector(writer, kAcceleration, message.acceleration_m_s2);
  return writer.finish(context, frame);
}

Read decode(const CanFrame& frame, std::uint32_t session, Imu& message) noexcept {
  auto reader = FrameReader::open(frame, session, MessageKind::kImu);
  if (!reader) return tl::unexpected(reader.error());
  Imu read;
  read.sample_time_ms = static_cast<std::uint32_t>(reader->integer(kImuTime));
  read.angular_velocity_rad_s = read_vector(*reader, kAngularVelocity);
  read.acceleration_m_s2 = read_vector(*reader, kAcceleration);
  return deliver(*reader, read, message);
}

Result<void, CodecError> encode(const BasePose& message, SendContext& context,
                                CanFrame& frame) noexcept {
  const Eigen::Vector3d& p = message.p_map_base_m;
  const Eigen::Vector3d& v = message.velocity_m_s;
  const std::array<double, 9> values{
      p.x(), p.y(), p.z(), message.yaw_rad, message.pitch_rad, message.roll_rad,
      v.x(), v.y(), v.z()};
  FrameWriter writer(*row_of(MessageKind::kBasePose, kNoZone));
  writer.integer(kPoseQuality, static_cast<std::int64_t>(message.quality));
  writer.integer(kPoseTime, message.sample_time_ms);
  for (int i = 0; i < 9; ++i) write_rated(writer, kPoseValues + i, values[i], message.quality);
  return writer.finish(context, frame);
}

Read decode(const CanFrame& frame, std::uint32_t session, BasePose& message) noexcept {
  auto reader = FrameReader::open(frame, session, MessageKind::kBasePose);
  if (!reader) return tl::unexpected(reader.error());
  BasePose read;
  read.quality = quality_of(reader->integer(kPoseQuality));
  read.sample_time_ms = static_cast<std::uint32_t>(reader->integer(kPoseTime));
  std::array<double, 9> values{};
  for (int i = 0; i < 9; ++i) values[i] = read_rated(*reader, kPoseValues + i, read.quality);
  read.p_map_base_m = {values[0], values[1], values[2]};
  read.yaw_rad = values[3];
  read.pitch_rad = values[4];
  read.roll_rad = values[5];
  read.velocity_m_s = {values[6], values[7], values[8]};
  return deliver(*reader, read, message);
}

Result<void, CodecError> encode(const LockStep& message, SendContext& context,
                                CanFrame& frame) noexcept {
  FrameWriter writer(*row_of(MessageKind::kLockStep, kNoZone));
  writer.integer(kFirstField, message.run_until_ms);
  return writer.finish(context, frame);
}

Read decode(const CanFrame& frame, std::uint32_t session, LockStep& message) noexcept {
  auto reader = FrameReader::open(frame, session, MessageKind::kLockStep);
  if (!reader) return tl::unexpected(reader.error());
  LockStep read;
  read.run_until_ms = static_cast<std::uint32_t>(reader->integer(kFirstField));
  return deliver(*reader, read, message);
}

}  // namespace wex::can
