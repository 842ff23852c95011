#include "hw_interface/electronics/zone_controller.hpp"

#include <algorithm>
#include <cmath>

#include "models/types/pose.hpp"

namespace wex::can {
namespace {

double towards_zero(double value, double step) noexcept {
  constexpr double kRounding = 1e-12;
  const double left = std::abs(value) - step;
  return left > kRounding ? std::copysign(left, value) : 0.0;
}

}  // namespace

ZoneController::ZoneController(const Roles& roles, const Limits& limits,
                               const ZoneControllerSettings& settings) noexcept
    : roles_(roles), limits_(limits), settings_(settings) {}

void ZoneController::update_spool(int i, bool active, double asked, double measured_rate) noexcept {
  double& spool = output_.spool[i];
  const double opening = active ? asked / limits_[i].max_rate : 0.0;
  const bool rest = std::abs(opening) < settings_.rest_rate_fraction;
  if (active) {
    const double travel =
        settings_.dead_band + (1.0 - settings_.dead_band) * std::min(1.0, std::abs(opening));
    spool = rest ? 0.0 : std::copysign(travel, opening);
  } else {
    spool = towards_zero(spool, settings_.period_s / settings_.spool_ramp_s);
  }
  if (roles_[i] != SlotRole::kSwing) return;
  const bool stands = std::abs(measured_rate) < settings_.swing_standstill_rad_s;
  output_.brake[i] = rest && spool == 0.0 && (output_.brake[i] || stands);
}

void ZoneController::update_wheel(int i, bool active, double asked, double position,
                                  double rate) noexcept {
  const double max_change = settings_.wheel_stop_rad_s2 * settings_.period_s;
  double& drive = drive_rate_[i];
  drive = active ? asked : towards_zero(drive, max_change);
  const bool rest = std::abs(drive) < settings_.wheel_rest_rad_s;
  const bool slow = std::abs(rate) < settings_.brake_below_rad_s;
  if (!output_.brake[i]) latched_angle_[i] = position;
  output_.brake[i] = rest && (output_.brake[i] || slow);
  const double hold =
      output_.brake[i] ? settings_.brake_gain_1_s * wrap_angle(latched_angle_[i] - position) : 0.0;
  output_.wheel_rate[i] = std::clamp(drive + hold, -limits_[i].max_rate, limits_[i].max_rate);
}

const ZoneOutput& ZoneController::update(const ZoneCommand* command,
                                         const std::array<double, kMaxZoneJoints>& position,
                                         const std::array<double, kMaxZoneJoints>& rate,
                                         double wheel_share, double swing_share) noexcept {
  for (int i = 0; i < kMaxZoneJoints; ++i) {
    const bool active = command != nullptr && command->active[i];
    const double asked = active ? command->rate[i] : 0.0;
    if (roles_[i] == SlotRole::kWheel) {
      update_wheel(i, active, wheel_share * asked, position[i], rate[i]);
    } else if (roles_[i] != SlotRole::kUnused) {
      const double share = roles_[i] == SlotRole::kSwing ? swing_share : 1.0;
      update_spool(i, active, share * asked, rate[i]);
    }
  }
  return output_;
}

bool ZoneController::brakes_closed() const noexcept {
  for (int i = 0; i < kMaxZoneJoints; ++i) {
    const bool has_brake = roles_[i] == SlotRole::kWheel || roles_[i] == SlotRole::kSwing;
    if (has_brake && !output_.brake[i]) return false;
  }
  return true;
}

bool ZoneController::neutral() const noexcept {
  return std::all_of(output_.spool.begin(), output_.spool.end(),
                     [](double spool) { return spool == 0.0; });
}

}  // namespace wex::can
