#pragma once

#include <array>
#include <cstdint>

#include "hw_interface/socketcan/generated/signal_table.hpp"
#include "hw_interface/socketcan/signal_row.hpp"

// One frame being written or read signal by signal. Private to the codec; noexcept, no allocation.

namespace wex::can {

/// Places of the signals that every message begins with.
inline constexpr int kCrcField = 0, kCounterField = 1, kFirstField = 2;

/// Collects a message's raw numbers; the first refusal is kept and returned by finish().
class FrameWriter {
 public:
  explicit FrameWriter(const MessageRow& row) noexcept : row_(&row) {}
  void integer(int field, std::int64_t value) noexcept;
  void physical(int field, double value) noexcept;
  /// The raw number that stands for "no value". The field is signed (caller's duty).
  void not_available(int field) noexcept;
  void refuse(CodecError error) noexcept;
  /// Counter, bytes, CRC. On error neither argument is touched.
  [[nodiscard]] Result<void, CodecError> finish(SendContext& context,
                                                CanFrame& frame) const noexcept;

 private:
  const MessageRow* row_;
  std::array<std::int64_t, generated::kMaxSignals> raw_{};
  CodecError error_{};  ///< if refused
  bool refused_ = false;
};

/// A frame whose format, length and CRC are right.
class FrameReader {
 public:
  [[nodiscard]] static Result<FrameReader, CodecError> open(const CanFrame& frame,
                                                            std::uint32_t session,
                                                            MessageKind kind) noexcept;
  [[nodiscard]] const MessageRow& row() const noexcept { return *row_; }
  [[nodiscard]] std::uint8_t counter() const noexcept {
    return static_cast<std::uint8_t>(raw_[kCounterField]);
  }
  /// Values out of their range are refused; see finish().
  [[nodiscard]] std::int64_t integer(int field) noexcept;
  [[nodiscard]] double physical(int field) noexcept;
  /// NaN where the sender has no value.
  [[nodiscard]] double physical_if_available(int field) noexcept;
  [[nodiscard]] Result<ReceivedMeta, CodecError> finish() const noexcept;

 private:
  explicit FrameReader(const MessageRow& row) noexcept : row_(&row) {}

  const MessageRow* row_;
  std::array<std::int64_t, generated::kMaxSignals> raw_{};
  CodecError error_{};  ///< if refused
  bool refused_ = false;
};

/// CRC of a frame's payload beyond the CRC itself, of the data id and, if bound, of the session.
[[nodiscard]] std::uint16_t protection_crc(const MessageRow& row, const std::uint8_t* payload,
                                           std::uint32_t session) noexcept;

}  // namespace wex::can
