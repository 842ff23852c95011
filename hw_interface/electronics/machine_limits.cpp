#include "hw_interface/electronics/machine_limits.hpp"

#include <algorithm>
#include <cmath>

namespace wex::can {
namespace {

constexpr double kSecondsPerMs = 1e-3;

/// How fast a joint may go `distance` before its stop: it can be braked until there.
double braking_rate(double distance, double max_acceleration) noexcept {
  return std::sqrt(2.0 * max_acceleration * std::max(0.0, distance));
}

/// True if `rate` is within `change` of `from`, or nearer to zero than that.
bool reachable(double rate, double from, double change) noexcept {
  const double same_direction = std::max(0.0, rate > 0.0 ? from : -from);
  return std::abs(rate) <= same_direction + change;
}

}  // namespace

MachineLimits::MachineLimits(const Limits& limits, const std::array<bool, kMaxZoneJoints>& is_wheel,
                             const MachineLimitsSettings& settings) noexcept
    : limits_(limits), is_wheel_(is_wheel), settings_(settings) {}

LimitVerdict MachineLimits::judge_echo(std::uint32_t echo_time_ms,
                                       std::int64_t now_ms) const noexcept {
  // Both clocks wrap after 49 days; their difference does not.
  const auto age_ms = static_cast<std::int32_t>(static_cast<std::uint32_t>(now_ms) - echo_time_ms);
  return age_ms >= 0 && age_ms <= settings_.max_echo_age_ms ? LimitVerdict::kOk
                                                            : LimitVerdict::kStaleEcho;
}

bool MachineLimits::within_window(int joint, double rate, double change,
                                  std::int64_t now_ms) const noexcept {
  const std::int64_t too_old = (now_ms - settings_.window_ms) / kBucket_ms - 1;
  for (const Bucket& bucket : buckets_) {
    if (bucket.number <= too_old) continue;
    const double from = rate > 0.0 ? bucket.least[joint] : bucket.greatest[joint];
    if (!reachable(rate, from, change)) return false;
  }
  return true;
}

LimitVerdict MachineLimits::judge(const ZoneCommand& command,
                                  const std::array<double, kMaxZoneJoints>& position,
                                  std::int64_t now_ms) const noexcept {
  if (judge_echo(command.echo_time_ms, now_ms) != LimitVerdict::kOk) {
    return LimitVerdict::kStaleEcho;
  }
  const double dt_s =
      kSecondsPerMs * static_cast<double>(std::clamp<std::int64_t>(
                          now_ms - last_accepted_ms_, settings_.cycle_ms, settings_.max_change_ms));
  for (int i = 0; i < kMaxZoneJoints; ++i) {
    if (!command.active[i]) continue;
    const double rate = command.rate[i];
    const SlotLimits& limit = limits_[i];
    if (!(std::abs(rate) <= limit.max_rate + settings_.rate_tolerance)) return LimitVerdict::kRate;

    const double way = rate > 0.0 ? limit.upper - position[i] : position[i] - limit.lower;
    const double allowance = limit.max_rate * settings_.latency_allowance_s;
    if (std::abs(rate) >
        braking_rate(way + allowance, limit.max_acceleration) + settings_.rate_tolerance) {
      return LimitVerdict::kSoftStop;
    }

    const double acceleration = settings_.acceleration_factor * limit.max_acceleration;
    const double window_change =
        settings_.window_factor * limit.max_acceleration * kSecondsPerMs * settings_.window_ms;
    const double at_once =
        settings_.rate_tolerance + (is_wheel_[i] ? settings_.wheel_change_rad_s : 0.0);
    if (!reachable(rate, last_rate_[i], acceleration * dt_s + at_once)) {
      return LimitVerdict::kRateChange;
    }
    if (!within_window(i, rate, window_change + at_once, now_ms)) {
      return LimitVerdict::kWindow;
    }
  }
  return LimitVerdict::kOk;
}

void MachineLimits::accept(const ZoneCommand& command, std::int64_t now_ms) noexcept {
  for (int i = 0; i < kMaxZoneJoints; ++i)
    last_rate_[i] = command.active[i] ? command.rate[i] : 0.0;
  last_accepted_ms_ = now_ms;
  const std::int64_t number = now_ms / kBucket_ms;
  Bucket& bucket = buckets_[static_cast<std::size_t>(number % kNumBuckets)];
  if (bucket.number != number) bucket = Bucket{number, last_rate_, last_rate_};
  for (int i = 0; i < kMaxZoneJoints; ++i) {
    bucket.least[i] = std::min(bucket.least[i], last_rate_[i]);
    bucket.greatest[i] = std::max(bucket.greatest[i], last_rate_[i]);
  }
}

void MachineLimits::reset(std::int64_t now_ms) noexcept {
  buckets_.fill(Bucket{});
  accept(ZoneCommand{}, now_ms);
}

bool is_neutral(const ZoneCommand& command, double tolerance) noexcept {
  for (int i = 0; i < kMaxZoneJoints; ++i) {
    if (command.active[i] && !(std::abs(command.rate[i]) <= tolerance)) return false;
  }
  return true;
}

}  // namespace wex::can
