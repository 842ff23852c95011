#pragma once

#include <array>
#include <cstdint>

#include "hw_interface/socketcan/codec.hpp"
#include "models/excavator/machine_model.hpp"
#include "models/types/machine_io_types.hpp"

namespace wex::can {

struct HostLimitsSettings {
  double period_s = 0.01;
  double tolerance = 1e-6;             ///< rad/s, rad (m/s, m): rounding of a planner
  double hard_rate_factor = 2.0;       ///< of the joint's largest rate: beyond it is no slip
  double hard_position_margin = 0.25;  ///< rad or m beyond an end stop, likewise
  double max_target_error = 0.5;       ///< rad or m from measured to target; more is brought nearer
  double cycle_acceleration_factor = 1.1;  ///< of the joint's own acceleration, within one cycle
  double wheel_change_rad_s = 0.12;  ///< brake latch and droop corrections of the drives, at once
};

enum class LimitOutcome : std::uint8_t { kOk, kClamped, kRejectedNotFinite, kRejectedRange };

/// The host's limits, from the DBC's attributes, written apart from the electronics' and stricter
/// in every number, so that what passes here is never refused there. Noexcept, allocation-free.
///   a program's command   finite, then range: slightly beyond is clamped and reported, far beyond
///                         is refused whole
///   what goes on the bus  |v| <= max_rate; v <= sqrt(2 a d) towards a stop at distance d; |v|
///   grows
///                         by no more than a dt per cycle and a 250 ms over the last 250 ms;
///                         towards zero everything is allowed
class HostLimits {
 public:
  /// Every joint has a place on the bus (contract).
  HostLimits(const MachineModel& machine, const HostLimitsSettings& settings = {});

  /// Brings `command` into the limits. Position targets count where they are used.
  LimitOutcome check(JointCommand& command,
                     const std::array<double, kMaxJoints>& position) const noexcept;

  /// One cycle: brings rates into the limits and remembers them. True if one was changed.
  bool limit_rates(std::array<double, kMaxJoints>& rate,
                   const std::array<double, kMaxJoints>& position) noexcept;
  /// Nothing was commanded in this cycle.
  void stand_still() noexcept;

  [[nodiscard]] long rates_limited() const noexcept { return rates_limited_; }

 private:
  /// 300 ms: the electronics ask for 250, and the two sides' cycles are not in step.
  static constexpr int kWindowCycles = 30;
  struct JointData {
    SlotLimits limits;
    bool wheel = false;
    bool takes_target = false;  ///< wheels and TURN go by rate only
  };
  [[nodiscard]] double largest_rate(int joint, double rate, double position) const noexcept;
  void remember(const std::array<double, kMaxJoints>& rate) noexcept;

  HostLimitsSettings settings_;
  int num_joints_ = 0;
  std::array<JointData, kMaxJoints> joints_{};
  std::array<std::array<double, kMaxJoints>, kWindowCycles> sent_{};  ///< ring of rates
  int head_ = 0;                                                      ///< newest of it
  long rates_limited_ = 0;
};

}  // namespace wex::can
