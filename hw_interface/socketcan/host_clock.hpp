#pragma once

#include <cstdint>

namespace wex::can {

/// The machine's time as the host sees it, from the millisecond stamps of its frames (which wrap
/// after 49 days) and the host's own monotonic clock. Realtime clocks play no part, so they may
/// jump. Pure: time comes in. Allocation-free.
///   free running  now = monotonic - the smallest offset seen: the fastest frame tells it best. The
///                 offset may grow by drift, else a slower clock of the machine were never followed
///   lock step     now = the newest stamp: the machine's clock stands while nothing is heard
class HostClock {
 public:
  enum class Mode : std::uint8_t { kFreeRunning, kLockStep };
  enum class Verdict : std::uint8_t { kOk, kRestarted };

  /// A stamp heard at now_ns. kRestarted: the machine's clock has jumped (it was switched on anew):
  /// everything known of it is void. The host's time goes on from where it was all the same.
  Verdict observe(std::uint32_t stamp_ms, std::int64_t now_ns) noexcept;
  void set_mode(Mode mode, std::int64_t now_ns) noexcept;

  [[nodiscard]] Mode mode() const noexcept { return mode_; }
  [[nodiscard]] bool valid() const noexcept { return valid_; }
  /// 0 before the first stamp.
  [[nodiscard]] double now_s(std::int64_t now_ns) const noexcept;
  /// A recent stamp without its wrap.
  [[nodiscard]] double seconds_of(std::uint32_t stamp_ms) const noexcept;
  [[nodiscard]] std::uint32_t newest_stamp_ms() const noexcept;

 private:
  static constexpr double kMaxDrift = 1e-4;                     ///< of the machine's clock
  static constexpr std::int64_t kMaxBack_ms = 1000;             ///< reordered, not restarted
  static constexpr std::int64_t kMaxAhead_ns = 10'000'000'000;  ///< of what the clock should say

  [[nodiscard]] std::int64_t unwrapped_ms(std::uint32_t stamp_ms) const noexcept;
  void restart(std::uint32_t stamp_ms, std::int64_t now_ns) noexcept;

  Mode mode_ = Mode::kFreeRunning;
  bool valid_ = false;
  std::int64_t newest_ms_ = 0;    ///< host's time of the newest stamp
  std::int64_t shift_ms_ = 0;     ///< host's time minus stamp, without wraps; changes at restarts
  std::int64_t offset_ns_ = 0;    ///< monotonic minus machine time
  std::int64_t observed_ns_ = 0;  ///< monotonic time of the newest stamp
};

}  // namespace wex::can
