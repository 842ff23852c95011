#include <cmath>
#include <cstdio>
#include <string>

#include "hw_interface/socketcan/codec.hpp"
#include "hw_interface/socketcan/frame_fields.hpp"

namespace wex::can {
namespace {

constexpr int kRateField = 4;  // first joint rate of a ZoneCommand

std::string hex(const CanFrame& frame) {
  std::string text;
  char byte[4];
  for (int i = 0; i < frame.length && i < kMaxPayloadBytes; ++i) {
    std::snprintf(byte, sizeof byte, "%02X", frame.data[i]);
    text += byte;
  }
  return text;
}

std::string value_text(const SignalRow& signal, std::int64_t raw) {
  const auto num_choices = static_cast<std::int64_t>(signal.choices.size());
  if (raw >= 0 && raw < num_choices) return signal.choices[raw];
  if (signal.is_signed && raw == signal.not_available) return "n/a";
  if (signal.denominator == 1.0 && signal.numerator == 1.0) return std::to_string(raw);
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", physical(signal, raw));
  return text;
}

}  // namespace

const char* to_string(CodecError error) noexcept {
  switch (error) {
    case CodecError::kNotFinite:
      return "not finite";
    case CodecError::kOutOfRange:
      return "out of range";
    case CodecError::kUnknownId:
      return "unknown id";
    case CodecError::kWrongLength:
      return "wrong length";
    case CodecError::kWrongFormat:
      return "wrong format";
    case CodecError::kBadCrc:
      return "bad CRC";
    case CodecError::kBadEnumeration:
      return "value not in its table";
  }
  return "unknown error";
}

const char* to_string(MachineMode mode) noexcept {
  const MessageRow* row = row_of(MessageKind::kZoneStatus, 0);
  const auto choices = row->signals[kFirstField].choices;
  const auto index = static_cast<std::size_t>(mode);
  return index < choices.size() ? choices[index] : "unknown";
}

MessageKind kind_of(const CanFrame& frame) noexcept {
  if (frame.extended || frame.remote || frame.error) return MessageKind::kUnknown;
  const MessageRow* row = row_of(frame.id);
  return row == nullptr ? MessageKind::kUnknown : row->kind;
}

int zone_of(const CanFrame& frame) noexcept {
  if (kind_of(frame) == MessageKind::kUnknown) return -1;
  return row_of(frame.id)->zone;
}

const char* name_of(const CanFrame& frame) noexcept {
  return kind_of(frame) == MessageKind::kUnknown ? "unknown" : row_of(frame.id)->name;
}

MessageTiming timing_of(MessageKind kind) noexcept {
  for (const MessageRow& row : generated::kMessages) {
    if (row.kind == kind) return {row.cycle_ms * 1e-3, row.timeout_ms * 1e-3};
  }
  return {};
}

JointSlot slot_of(const std::string& joint_name) noexcept {
  for (int zone = 0; zone < kNumZones; ++zone) {
    const MessageRow* row = row_of(MessageKind::kZoneCommand, zone);
    for (int i = 0; i < row->num_joints; ++i) {
      if (joint_name == row->signals[kRateField + i].joint) return {zone, i};
    }
  }
  return {};
}

SlotLimits limits_of(JointSlot slot) noexcept {
  const MessageRow* command = row_of(MessageKind::kZoneCommand, slot.zone);
  const MessageRow* feedback = row_of(MessageKind::kZoneFeedback, slot.zone);
  if (command == nullptr || slot.index < 0 || slot.index >= command->num_joints) return {};
  const SignalRow& rate = command->signals[kRateField + slot.index];
  // Positions follow Crc, Counter, SampleTimeMs and the qualities.
  const SignalRow& position =
      feedback->signals[kFirstField + 1 + feedback->num_joints + slot.index];
  return {position.position_lower, position.position_upper, rate.rate_limit,
          rate.acceleration_limit};
}

std::string describe(const CanFrame& frame, std::uint32_t session) {
  char id[16];
  std::snprintf(id, sizeof id, frame.extended ? "0x%08X" : "0x%03X", frame.id);
  std::string text = id;
  if (frame.error) return text + " error frame " + hex(frame);
  if (frame.remote) return text + " remote frame";
  if (kind_of(frame) == MessageKind::kUnknown) return text + " unknown id " + hex(frame);
  const MessageRow& row = *row_of(frame.id);
  text += std::string(" ") + row.name;
  if (frame.fd != row.fd || frame.length != row.length) {
    return text + (frame.fd != row.fd ? " wrong format " : " wrong length ") + hex(frame);
  }
  std::array<std::int64_t, generated::kMaxSignals> raw{};
  row.unpack(frame.data.data(), raw.data());
  text += " #" + std::to_string(raw[kCounterField]);
  if (raw[kCrcField] != protection_crc(row, frame.data.data(), session)) {
    text += row.session_bound ? " [bad CRC or another session]" : " [bad CRC]";
  }
  for (std::size_t i = kFirstField; i < row.signals.size(); ++i) {
    const SignalRow& signal = row.signals[i];
    text += std::string(" ") + signal.name + "=" + value_text(signal, raw[i]);
    const bool absent = signal.is_signed && raw[i] == signal.not_available;
    if (*signal.unit != '\0' && !absent) text += std::string(" ") + signal.unit;
    if (!absent && (raw[i] < signal.raw_min || raw[i] > signal.raw_max)) text += " [out of range]";
  }
  return text;
}

}  // namespace wex::can
