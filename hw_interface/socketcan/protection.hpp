#pragma once

#include <cstdint>
#include <span>

namespace wex::can {

/// CRC-16 0x1021 (init 0xFFFF) over payload, data id and session: FD frames. Check value of
/// "123456789" without id and session: 0x29B1.
[[nodiscard]] std::uint16_t crc16(std::span<const std::uint8_t> bytes,
                                  std::uint16_t start = 0xFFFF) noexcept;
/// CRC-8 0x2F (init 0xFF, xorout 0xFF), classic frames. Check value of "123456789": 0xDF.
[[nodiscard]] std::uint8_t crc8(std::span<const std::uint8_t> bytes) noexcept;

enum class SequenceVerdict : std::uint8_t { kFirst, kOk, kRepeated, kLostSome, kWrongSequence };

/// Receiver's side of the counter: delta 0 is a repetition (discarded, does not refresh age),
/// 1..max_delta is good, more is a wrong sequence that needs good_to_recover good frames in a row;
/// the last of them is trusted. Feed it frames with a good CRC only.
/// Frames that were due and did not come widen what is good by one each (as AUTOSAR's profiles 1
/// and 2 do): a jump that time explains is a loss, which ages judge; one that it does not is wrong.
class SequenceCheck {
 public:
  struct Settings {
    int modulus = 256;
    int max_delta = 3;
    int good_to_recover = 3;
  };
  explicit SequenceCheck(const Settings& settings) noexcept : settings_(settings) {}
  /// missing: frames that were due since the one before and did not come.
  SequenceVerdict update(std::uint8_t counter, int missing = 0) noexcept;
  /// True when the content of the frame just checked may be used.
  [[nodiscard]] bool trusted() const noexcept {
    return seen_ && good_needed_ == 0 && last_verdict_ != SequenceVerdict::kRepeated;
  }
  [[nodiscard]] long lost_frames() const noexcept { return lost_; }
  /// Frames of this period that were due in `elapsed_ms` since the last one and did not come.
  [[nodiscard]] static int missing_after(double elapsed_ms, double period_ms) noexcept;
  /// As new, for a new session or after a time-out; the count of lost frames goes on.
  void reset() noexcept;

 private:
  SequenceVerdict judge(std::uint8_t counter, int missing) noexcept;

  Settings settings_;
  bool seen_ = false;
  std::uint8_t last_ = 0;
  SequenceVerdict last_verdict_ = SequenceVerdict::kFirst;
  int good_needed_ = 0;
  long lost_ = 0;
};

}  // namespace wex::can
