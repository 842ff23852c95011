#pragma once

#include <cstdint>
#include <span>

#include "hw_interface/socketcan/codec.hpp"

// What the generated table says of messages and signals. Private to the codec.

namespace wex::can {

enum class E2eProfile : std::uint8_t { kCrc16Counter8, kCrc8Counter4 };

struct SignalRow {
  const char* name;
  const char* unit;
  const char* joint;              ///< empty if it belongs to none
  double numerator, denominator;  ///< value = raw * numerator / denominator
  double minimum, maximum;        ///< physical range
  std::int64_t raw_min, raw_max;  ///< the same in raw numbers
  bool is_signed;                 ///< then one raw value, outside the range, means "not available"
  std::int64_t not_available;     ///< the most negative raw value
  std::span<const char* const> choices;  ///< names of the raw values 0, 1 ... of an enumeration
  double rate_limit, acceleration_limit, position_lower, position_upper;
};

struct MessageRow {
  std::uint32_t id;
  MessageKind kind;
  int zone;  ///< -1 if it has none
  const char* name;
  const char* sender;
  std::uint8_t length;
  bool fd;
  E2eProfile profile;
  std::uint16_t data_id;
  bool session_bound;
  int cycle_ms, timeout_ms;
  int num_joints;                      ///< of its zone
  std::span<const SignalRow> signals;  ///< by position in the payload: Crc, Counter, content
  /// Raw numbers, one per signal and in its range, to the whole payload and back. No checks.
  void (*pack)(const std::int64_t* raw, std::uint8_t* bytes) noexcept;
  void (*unpack)(const std::uint8_t* bytes, std::int64_t* raw) noexcept;
};

/// Nearest raw number of a physical value. errors: kNotFinite, kOutOfRange
[[nodiscard]] Result<std::int64_t, CodecError> quantize(const SignalRow& signal,
                                                        double value) noexcept;
/// Rounded once, so that the ends of a range come back exactly as the DBC states them.
[[nodiscard]] double physical(const SignalRow& signal, std::int64_t raw) noexcept;

/// Row of an id; nullptr if there is none.
[[nodiscard]] const MessageRow* row_of(std::uint32_t id) noexcept;
/// Row of a message of a zone (-1: of none); nullptr if there is none.
[[nodiscard]] const MessageRow* row_of(MessageKind kind, int zone) noexcept;

}  // namespace wex::can
