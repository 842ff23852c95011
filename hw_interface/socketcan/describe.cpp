#include <cstdio>
#include <string>

#include "hw_interface/socketcan/codec.hpp"
#include "hw_interface/socketcan/frame_fields.hpp"

namespace wex::can {
namespace {

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
