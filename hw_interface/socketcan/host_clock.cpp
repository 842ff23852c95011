#include "hw_interface/socketcan/host_clock.hpp"

#include <algorithm>
#include <cmath>

namespace wex::can {
namespace {

constexpr std::int64_t kNanosecondsPerMs = 1'000'000;

}  // namespace

std::int64_t HostClock::unwrapped_ms(std::uint32_t stamp_ms) const noexcept {
  const auto newest_stamp = static_cast<std::uint32_t>(newest_ms_ - shift_ms_);
  return newest_ms_ + static_cast<std::int32_t>(stamp_ms - newest_stamp);
}

void HostClock::restart(std::uint32_t stamp_ms, std::int64_t now_ns) noexcept {
  newest_ms_ = valid_ ? std::llround(1e3 * now_s(now_ns)) : std::int64_t{stamp_ms};
  shift_ms_ = newest_ms_ - std::int64_t{stamp_ms};
  offset_ns_ = now_ns - newest_ms_ * kNanosecondsPerMs;
  observed_ns_ = now_ns;
  valid_ = true;
}

HostClock::Verdict HostClock::observe(std::uint32_t stamp_ms, std::int64_t now_ns) noexcept {
  if (!valid_) {
    restart(stamp_ms, now_ns);
    return Verdict::kOk;
  }
  const std::int64_t heard_ms = unwrapped_ms(stamp_ms);
  const std::int64_t offset_ns = now_ns - heard_ms * kNanosecondsPerMs;
  const bool back = heard_ms < newest_ms_ - kMaxBack_ms;
  const bool ahead = mode_ == Mode::kFreeRunning && offset_ns < offset_ns_ - kMaxAhead_ns;
  if (back || ahead) {
    restart(stamp_ms, now_ns);
    return Verdict::kRestarted;
  }
  if (heard_ms > newest_ms_) {
    const auto drift_ns =
        static_cast<std::int64_t>(kMaxDrift * static_cast<double>(now_ns - observed_ns_));
    offset_ns_ = std::min(offset_ns_ + std::max<std::int64_t>(drift_ns, 0), offset_ns);
    newest_ms_ = heard_ms;
    observed_ns_ = now_ns;
  }
  return Verdict::kOk;
}

void HostClock::set_mode(Mode mode, std::int64_t now_ns) noexcept {
  // From lock step on, offsets mean nothing: free running starts where the clock stands now.
  if (mode == Mode::kFreeRunning && mode_ == Mode::kLockStep) {
    offset_ns_ = now_ns - newest_ms_ * kNanosecondsPerMs;
    observed_ns_ = now_ns;
  }
  mode_ = mode;
}

double HostClock::now_s(std::int64_t now_ns) const noexcept {
  if (!valid_) return 0.0;
  const double newest_s = 1e-3 * static_cast<double>(newest_ms_);
  if (mode_ == Mode::kLockStep) return newest_s;
  return std::max(newest_s, 1e-9 * static_cast<double>(now_ns - offset_ns_));
}

double HostClock::seconds_of(std::uint32_t stamp_ms) const noexcept {
  return 1e-3 * static_cast<double>(unwrapped_ms(stamp_ms));
}

std::uint32_t HostClock::newest_stamp_ms() const noexcept {
  return static_cast<std::uint32_t>(newest_ms_ - shift_ms_);
}

}  // namespace wex::can
