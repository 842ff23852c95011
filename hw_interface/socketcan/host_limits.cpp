#include "hw_interface/socketcan/host_limits.hpp"

#include <algorithm>
#include <cmath>

namespace wex::can {

HostLimits::HostLimits(const MachineModel& machine, const HostLimitsSettings& settings)
    : settings_(settings), num_joints_(machine.num_joints()) {
  WEX_EXPECTS(num_joints_ <= kMaxJoints && settings.period_s > 0.0);
  for (int i = 0; i < num_joints_; ++i) {
    const JointSlot slot = slot_of(machine.joints[i].name);
    WEX_EXPECTS(slot.zone >= 0);
    const bool is_wheel = machine.joints[i].role == JointRole::kWheel;
    const bool is_turn = machine.arm && !machine.arm->coordinates.empty() &&
                         machine.arm->coordinates.front() == kNumBaseCoordinates + i;
    joints_[i] = {limits_of(slot), is_wheel, !is_wheel && !is_turn};
  }
}

LimitOutcome HostLimits::check(JointCommand& command,
                               const std::array<double, kMaxJoints>& position) const noexcept {
  if (!std::isfinite(command.valid_until_s)) return LimitOutcome::kRejectedNotFinite;
  for (int i = 0; i < num_joints_; ++i) {
    if (!std::isfinite(command.rate[i]) ||
        (command.has_position_target[i] && !std::isfinite(command.position_target[i]))) {
      return LimitOutcome::kRejectedNotFinite;
    }
  }
  LimitOutcome outcome = LimitOutcome::kOk;
  const auto bring_into = [&](double& value, double lower, double upper) {
    const double within = std::clamp(value, lower, upper);
    if (std::abs(within - value) > settings_.tolerance) outcome = LimitOutcome::kClamped;
    value = within;
  };
  for (int i = 0; i < num_joints_; ++i) {
    const SlotLimits& limits = joints_[i].limits;
    if (std::abs(command.rate[i]) > settings_.hard_rate_factor * limits.max_rate) {
      return LimitOutcome::kRejectedRange;
    }
    bring_into(command.rate[i], -limits.max_rate, limits.max_rate);
    if (!command.has_position_target[i] || !joints_[i].takes_target) continue;
    double& target = command.position_target[i];
    if (target < limits.lower - settings_.hard_position_margin ||
        target > limits.upper + settings_.hard_position_margin) {
      return LimitOutcome::kRejectedRange;
    }
    bring_into(target, limits.lower, limits.upper);
    bring_into(target, position[i] - settings_.max_target_error,
               position[i] + settings_.max_target_error);
  }
  return outcome;
}

double HostLimits::largest_rate(int joint, double rate, double position) const noexcept {
  const SlotLimits& limits = joints_[joint].limits;
  const double sign = rate > 0.0 ? 1.0 : -1.0;
  const double way = rate > 0.0 ? limits.upper - position : position - limits.lower;
  const double braking = std::sqrt(2.0 * limits.max_acceleration * std::max(0.0, way));
  const double at_once = joints_[joint].wheel ? settings_.wheel_change_rad_s : 0.0;
  const double per_period = limits.max_acceleration * settings_.period_s;
  const double same_way = std::max(0.0, sign * sent_[head_][joint]);
  double slowest = same_way;
  for (const auto& cycle : sent_) {
    slowest = std::min(slowest, std::max(0.0, sign * cycle[joint]));
  }
  const double per_cycle = same_way + settings_.cycle_acceleration_factor * per_period + at_once;
  const double per_window = slowest + kWindowCycles * per_period + at_once + settings_.tolerance;
  return std::min({limits.max_rate, braking, per_cycle, per_window});
}

void HostLimits::remember(const std::array<double, kMaxJoints>& rate) noexcept {
  head_ = (head_ + 1) % kWindowCycles;
  sent_[head_] = rate;
}

bool HostLimits::limit_rates(std::array<double, kMaxJoints>& rate,
                             const std::array<double, kMaxJoints>& position) noexcept {
  bool limited = false;
  for (int i = 0; i < num_joints_; ++i) {
    const double largest = largest_rate(i, rate[i], position[i]);
    // Written so that a rate that is not finite becomes zero.
    if (std::abs(rate[i]) <= largest) continue;
    rate[i] = std::isfinite(rate[i]) ? std::copysign(largest, rate[i]) : 0.0;
    limited = true;
  }
  if (limited) ++rates_limited_;
  remember(rate);
  return limited;
}

void HostLimits::stand_still() noexcept { remember({}); }

}  // namespace wex::can
