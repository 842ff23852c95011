#pragma once

#include <array>
#include <cstdint>

#include "hw_interface/socketcan/codec.hpp"
#include "hw_interface/socketcan/messages.hpp"

namespace wex::can {

/// Why the electronics refuse a command whose bytes are in order.
enum class LimitVerdict : std::uint8_t {
  kOk,
  kStaleEcho,   ///< computed from feedback older than max_echo_age_ms, or from the future
  kRate,        ///< faster than the joint may
  kSoftStop,    ///< towards a stop faster than can be braked
  kRateChange,  ///< away from zero faster than the acceleration allows since the last command
  kWindow       ///< the same over the last window_ms
};

struct MachineLimitsSettings {
  int max_echo_age_ms = 60;
  int cycle_ms = 10;       ///< a command may always change as much as in one cycle
  int max_change_ms = 50;  ///< and at most as much as in the time-out
  double acceleration_factor =
      1.2;                       ///< of the joint's own, per command: the sender's cycle jitters
  double window_factor = 1.2;    ///< likewise over window_ms
  int window_ms = 250;           ///< at most MachineLimits::kMaxWindow_ms
  double rate_tolerance = 2e-3;  ///< rad/s or m/s: rounding on the bus
  double wheel_change_rad_s = 0.15;   ///< brake latch and droop corrections of the drives, at once
  double latency_allowance_s = 0.03;  ///< the host's positions are older than ours
};

/// The electronics' limits of one zone, from the DBC's attributes (limits_of), written apart from
/// the host's. Per active joint with commanded rate v, position p, limit a of acceleration:
///   |v| <= max_rate + tolerance
///   v <= sqrt(2 a d) + tolerance,  d = max(0, upper - p + max_rate * latency_allowance); likewise
///        below (a continuous joint has no stops)
///   |v| <= reach(v_last, factor a dt) and the same with every command of the last window_ms in
///   place
///        of v_last and window_ms for dt, where reach(u, c) = c + tolerance + (u of v's sign ? |u|
///        : 0)
/// so going towards zero is always allowed. dt is the time since the last accepted command, within
/// [cycle, max_change]. An inactive joint counts as v = 0. Wheels: wheel_change is added to c.
/// A frame is judged as a whole: nothing is clamped. Pure, noexcept, allocation-free.
class MachineLimits {
 public:
  static constexpr int kMaxWindow_ms = 500;
  using Limits = std::array<SlotLimits, kMaxZoneJoints>;

  MachineLimits(const Limits& limits, const std::array<bool, kMaxZoneJoints>& is_wheel,
                const MachineLimitsSettings& settings = {}) noexcept;

  [[nodiscard]] LimitVerdict judge(const ZoneCommand& command,
                                   const std::array<double, kMaxZoneJoints>& position,
                                   std::int64_t now_ms) const noexcept;
  /// Only the age of the echoed feedback: all that is asked of a command that moves nothing.
  [[nodiscard]] LimitVerdict judge_echo(std::uint32_t echo_time_ms,
                                        std::int64_t now_ms) const noexcept;
  /// The command is in force from now on.
  void accept(const ZoneCommand& command, std::int64_t now_ms) noexcept;
  /// Everything stands: changes count from zero.
  void reset(std::int64_t now_ms) noexcept;

 private:
  static constexpr int kBucket_ms = 10;
  static constexpr int kNumBuckets = kMaxWindow_ms / kBucket_ms + 1;
  /// Least and greatest rate accepted within 10 ms.
  struct Bucket {
    std::int64_t number = -1;  ///< time / kBucket_ms; -1: never used
    std::array<double, kMaxZoneJoints> least{}, greatest{};
  };
  [[nodiscard]] bool within_window(int joint, double rate, double change,
                                   std::int64_t now_ms) const noexcept;

  Limits limits_;
  std::array<bool, kMaxZoneJoints> is_wheel_;
  MachineLimitsSettings settings_;
  std::array<double, kMaxZoneJoints> last_rate_{};
  std::int64_t last_accepted_ms_ = 0;
  std::array<Bucket, kNumBuckets> buckets_{};
};

/// True when no active joint is asked for more than `tolerance` (rad/s or m/s): bumpless.
[[nodiscard]] bool is_neutral(const ZoneCommand& command, double tolerance) noexcept;

}  // namespace wex::can
