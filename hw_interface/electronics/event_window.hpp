#pragma once

#include <array>
#include <cstdint>

namespace wex::can {

/// Counts events within a sliding time window. Allocation-free; at most kMaxCount can be told
/// apart.
class EventWindow {
 public:
  static constexpr int kMaxCount = 16;
  /// `full` (1 .. kMaxCount) events within window_ms make it full.
  EventWindow(int full, std::int64_t window_ms) noexcept : full_(full), window_ms_(window_ms) {}

  /// An event now. True if it makes the window full.
  bool add(std::int64_t now_ms) noexcept {
    times_ms_[next_] = now_ms;
    next_ = (next_ + 1) % full_;  // now the oldest of the last `full` events
    if (seen_ < full_) ++seen_;
    return seen_ == full_ && now_ms - times_ms_[next_] <= window_ms_;
  }
  void clear() noexcept { seen_ = 0; }

 private:
  int full_;
  std::int64_t window_ms_;
  std::array<std::int64_t, kMaxCount> times_ms_{};
  int next_ = 0;
  int seen_ = 0;
};

}  // namespace wex::can
