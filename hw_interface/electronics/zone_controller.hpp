#pragma once

#include <array>

#include "hw_interface/socketcan/codec.hpp"
#include "hw_interface/socketcan/messages.hpp"

namespace wex::can {

struct ZoneControllerSettings {
  double period_s = 0.01;
  double dead_band = 0.05;           ///< of full spool travel, undone by its inverse
  double rest_rate_fraction = 2e-3;  ///< of the rate limit: slower than that is "closed"
  double spool_ramp_s = 0.05;        ///< from full to neutral, when a joint must hold
  double wheel_stop_rad_s2 = 30.0;  ///< when it must hold: more than the motors' relief valves give
  double brake_below_rad_s = 0.06;  ///< a parking brake closes below this (3.6 cm/s at the tyre)
  double wheel_rest_rad_s = 1e-3;   ///< less than this is asked of a wheel: it may be latched
  double brake_gain_1_s = 20.0;     ///< how a latched wheel is kept at its angle
  double swing_standstill_rad_s = 0.01;
};

/// What a slot of the zone is, beside its limits.
enum class SlotRole : std::uint8_t { kUnused, kCylinder, kSwing, kWheel };

struct ZoneOutput {
  std::array<double, kMaxZoneJoints> spool{};       ///< [-1, 1]; 0 for wheels
  std::array<double, kMaxZoneJoints> wheel_rate{};  ///< rad/s, drive and brake; 0 for others
  std::array<bool, kMaxZoneJoints> brake{};         ///< closed: parking brake, swing brake
};

/// From the rates of a ZoneCommand to the outputs of one zone, once per period:
///   cylinders  spool by the inverse of the dead band; holding: a ramp to neutral, within 50 ms
///   swing      as cylinders, and a brake once it stands with nothing asked of it
///   wheels     the rate goes to the drive; holding: a ramp down, then the parking brake below
///              brake_below_rad_s keeps the angle
/// Load-holding valves stay shut at neutral: holding never takes pressure from a leg.
class ZoneController {
 public:
  using Roles = std::array<SlotRole, kMaxZoneJoints>;
  using Limits = std::array<SlotLimits, kMaxZoneJoints>;
  ZoneController(const Roles& roles, const Limits& limits,
                 const ZoneControllerSettings& settings = {}) noexcept;

  /// command == nullptr: every joint holds. Inactive joints hold. Positions and rates as measured.
  /// wheel_share, swing_share: of what is asked of the wheels and of the cabin, so much is given.
  const ZoneOutput& update(const ZoneCommand* command,
                           const std::array<double, kMaxZoneJoints>& position,
                           const std::array<double, kMaxZoneJoints>& rate, double wheel_share = 1.0,
                           double swing_share = 1.0) noexcept;
  /// The spools are neutral (as of the last update).
  [[nodiscard]] bool neutral() const noexcept;
  /// Parking brakes and swing brake, of those that the zone has.
  [[nodiscard]] bool brakes_closed() const noexcept;
  [[nodiscard]] const ZoneOutput& output() const noexcept { return output_; }

 private:
  void update_spool(int i, bool active, double asked, double measured_rate) noexcept;
  void update_wheel(int i, bool active, double asked, double position, double rate) noexcept;

  Roles roles_;
  Limits limits_;
  ZoneControllerSettings settings_;
  ZoneOutput output_;
  std::array<double, kMaxZoneJoints> drive_rate_{};     ///< wheels: what the ramp has come to
  std::array<double, kMaxZoneJoints> latched_angle_{};  ///< wheels with a closed brake
};

}  // namespace wex::can
