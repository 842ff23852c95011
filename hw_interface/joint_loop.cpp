#include "hw_interface/joint_loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wex {
namespace {

constexpr double kBrakingShare = 0.8;           ///< of the acceleration limit, when closing in
constexpr double kWheelRestRate_rad_s = 1e-3;   ///< 0.6 mm/s: nothing is asked of the wheel
constexpr double kWheelLatchRate_rad_s = 0.06;  ///< above what a drive yields to on 30 degrees

double slewed(double from, double to, double max_change) noexcept {
  return from + std::clamp(to - from, -max_change, max_change);
}

}  // namespace

JointLoop::JointLoop(const MachineModel& machine, const JointLoopSettings& settings)
    : settings_(settings),
      num_joints_(machine.num_joints()),
      pump_flow_m3_s_(machine.pump_flow_limit_w_over_pa),
      balance_(machine, settings.period_s, settings.balance) {
  WEX_EXPECTS(num_joints_ <= kMaxJoints && settings.period_s > 0.0);
  for (int i = 0; i < num_joints_; ++i) {
    const Joint& joint = machine.joints[i];
    JointData& data = joints_[i];
    data.lower = joint.lower;
    data.upper = joint.upper;
    data.max_rate = joint.max_rate;
    data.max_acceleration = joint.max_acceleration;
    data.max_effort = joint.max_effort;
    const double delay_s = joint.dead_time_s + joint.lag_s;
    data.gain_1_s =
        delay_s > 0.0 ? std::min(settings.position_gain_1_s, settings.gain_delay_product / delay_s)
                      : settings.position_gain_1_s;
    if (delay_s > 0.0) data.response_blend = 1.0 - std::exp(-settings.period_s / delay_s);
    data.flow_per_rate = joint.max_effort / machine.pump_pressure_pa;
    data.wheel = joint.role == JointRole::kWheel;
    const bool is_turn = machine.arm && !machine.arm->coordinates.empty() &&
                         machine.arm->coordinates.front() == kNumBaseCoordinates + i;
    data.takes_target = !data.wheel && !is_turn;
    if (is_turn) turn_joint_ = i;
  }
  constexpr std::array<const char*, 4> kReachingJoints{"BOOM", "DIPPER", "TELE", "EE_PITCH"};
  for (std::size_t i = 0; i < kReachingJoints.size(); ++i) {
    if (const auto coordinate = machine.coordinate(kReachingJoints[i])) {
      reaching_joints_[i] = *coordinate - kNumBaseCoordinates;
    }
  }
  for (int leg = 0; leg < kNumWheels; ++leg) {
    const WheeledLeg& wheeled_leg = machine.legs[leg];
    wheel_joint_[leg] = wheeled_leg.wheel - kNumBaseCoordinates;
    wheel_sign_[leg] = wheeled_leg.wheel_sign;
    wheel_radius_m_[leg] = wheeled_leg.radius_m;
    if (wheeled_leg.hfe >= 0) joints_[wheeled_leg.hfe - kNumBaseCoordinates].leg = leg;
  }
}

double JointLoop::offset_of_joint_rad(int joint) const noexcept {
  const int leg = joints_[joint].leg;
  return leg < 0 ? 0.0 : balance_.offset_rad()[leg];
}

double JointLoop::hydraulic_rate(int joint, const JointCommand* command,
                                 double position) const noexcept {
  if (command == nullptr) return 0.0;
  const JointData& data = joints_[joint];
  double rate = command->rate[joint];
  if (data.takes_target && command->has_position_target[joint]) {
    // Proportional near the target; further away no faster than can be braked in time.
    const double error = command->position_target[joint] - (position - offset_of_joint_rad(joint));
    const double braking = std::sqrt(2.0 * kBrakingShare * data.max_acceleration * std::abs(error));
    rate += std::copysign(std::min(data.gain_1_s * std::abs(error), braking), error);
  }
  if (data.leg >= 0) rate += balance_.offset_rate_rad_s()[data.leg];
  // Towards an end stop, only as fast as the loop would close the rest of the way.
  rate = std::min(rate, data.gain_1_s * std::max(0.0, data.upper - position));
  rate = std::max(rate, -data.gain_1_s * std::max(0.0, position - data.lower));
  rate = std::clamp(rate, -data.max_rate, data.max_rate);
  return slewed(previous_rate_[joint], rate, data.max_acceleration * settings_.period_s);
}

void JointLoop::share_pump(ActuatorCommand& out) const noexcept {
  double flow_m3_s = 0.0;
  for (int i = 0; i < num_joints_; ++i) {
    if (!joints_[i].wheel) flow_m3_s += std::abs(out.rate[i]) * joints_[i].flow_per_rate;
  }
  const double scale = flow_m3_s > pump_flow_m3_s_ ? pump_flow_m3_s_ / flow_m3_s : 1.0;
  for (int i = 0; i < num_joints_; ++i) {
    if (joints_[i].wheel) continue;
    out.rate[i] *= scale;
    const double opening = out.rate[i] / joints_[i].max_rate;
    out.spool[i] =
        std::abs(opening) < settings_.rest_rate_fraction
            ? 0.0
            : std::copysign(settings_.dead_band + (1.0 - settings_.dead_band) * std::abs(opening),
                            opening);
  }
}

void JointLoop::update_stall(const JointCommand* command,
                             const JointMeasurement& measured) noexcept {
  if (stalled_wheel_ >= 0) {
    // Over when nothing more is asked of the wheel, or the other way round.
    const double asked =
        command == nullptr ? 0.0 : command->rate[wheel_joint_[stalled_wheel_]] * stalled_direction_;
    if (asked < kWheelRestRate_rad_s) stalled_wheel_ = -1;
    return;
  }
  for (int leg = 0; leg < kNumWheels; ++leg) {
    const int joint = wheel_joint_[leg];
    const double ramp = previous_rate_[joint];
    const bool blocked =
        std::abs(ramp) > kWheelRestRate_rad_s &&
        measured.rate[joint] * ramp < settings_.stall_rate_fraction * ramp * ramp &&
        std::abs(measured.effort[joint]) >
            settings_.stall_effort_fraction * joints_[joint].max_effort;
    stall_clock_s_[leg] = blocked ? stall_clock_s_[leg] + settings_.period_s : 0.0;
    if (stall_clock_s_[leg] <= settings_.stall_time_s) continue;
    stalled_wheel_ = leg;
    stalled_direction_ = std::copysign(1.0, ramp);
    ++stall_stops_;
    stall_clock_s_.fill(0.0);
    for (const int wheel : wheel_joint_) previous_rate_[wheel] = 0.0;
    return;
  }
}

double JointLoop::largest_slew_rate(const JointMeasurement& measured) const noexcept {
  // An arm of other joints has an unknown reach: not a number, hence the least.
  const auto pick = [this](const std::array<double, kMaxJoints>& of) {
    const auto value = [&of](int joint) {
      return joint < 0 ? std::numeric_limits<double>::quiet_NaN() : of[joint];
    };
    const auto [boom, dipper, tele, ee_pitch] = reaching_joints_;
    return ReachingJoints{value(boom), value(dipper), value(tele), value(ee_pitch)};
  };
  return settings_.travel_margin *
         settings_.slew.at(pick(measured.position), pick(measured.rate),
                           tilt_of(measured.pitch_rad, measured.roll_rad));
}

void JointLoop::limit_travel(std::array<double, kNumWheels>& asked,
                             const JointMeasurement& measured) const noexcept {
  double travel_m_s = 0.0;
  for (int leg = 0; leg < kNumWheels; ++leg) {
    travel_m_s += wheel_sign_[leg] * wheel_radius_m_[leg] * asked[leg] / kNumWheels;
  }
  const double share = settings_.travel.share_of(travel_m_s / settings_.travel_margin,
                                                 measured.pitch_rad, measured.roll_rad);
  for (double& rate : asked) rate *= share;
}

void JointLoop::update_ramps(const std::array<double, kNumWheels>& asked,
                             bool end_motion) noexcept {
  // The wheels together speed up gently; what one does against another is geometry (curves,
  // steering about an offset kingpin) and follows at once, or the wheels would work against each
  // other.
  std::array<double, kNumWheels> ramp{};
  double asked_mean = 0.0, mean = 0.0;
  for (int leg = 0; leg < kNumWheels; ++leg) {
    ramp[leg] = wheel_sign_[leg] * previous_rate_[wheel_joint_[leg]];
    asked_mean += wheel_sign_[leg] * asked[leg] / kNumWheels;
    mean += ramp[leg] / kNumWheels;
  }
  for (int leg = 0; leg < kNumWheels; ++leg) {
    const JointData& data = joints_[wheel_joint_[leg]];
    const double gentle = data.max_acceleration * settings_.period_s;
    const double quick = gentle * settings_.wheel_stop_acceleration_factor;
    const double apart =
        slewed(ramp[leg] - mean, wheel_sign_[leg] * asked[leg] - asked_mean, quick);
    const double together = slewed(mean, asked_mean, end_motion ? quick : gentle);
    const double rate = wheel_sign_[leg] * (together + apart);
    previous_rate_[wheel_joint_[leg]] = std::clamp(rate, -data.max_rate, data.max_rate);
    expected_rate_[leg] +=
        data.response_blend * (previous_rate_[wheel_joint_[leg]] - expected_rate_[leg]);
  }
}

void JointLoop::update_wheels(const JointCommand* command, const JointMeasurement& measured,
                              ActuatorCommand& out) noexcept {
  update_stall(command, measured);
  const bool end_motion = command == nullptr || stalled();
  std::array<double, kNumWheels> asked{};
  for (int leg = 0; leg < kNumWheels && !end_motion; ++leg) {
    const double max_rate = joints_[wheel_joint_[leg]].max_rate;
    asked[leg] = std::clamp(command->rate[wheel_joint_[leg]], -max_rate, max_rate);
  }
  limit_travel(asked, measured);
  update_ramps(asked, end_motion);
  double droop_rad_s = 0.0, latch_error_rad = 0.0;
  int driven = 0;
  bool were_all_latched = true;
  for (int leg = 0; leg < kNumWheels; ++leg) {
    const int joint = wheel_joint_[leg];
    const bool rest = std::abs(asked[leg]) < kWheelRestRate_rad_s &&
                      std::abs(previous_rate_[joint]) < kWheelRestRate_rad_s;
    were_all_latched = were_all_latched && latched_[leg];
    if (latched_[leg]) {
      latch_error_rad += wheel_sign_[leg] * (latched_angle_rad_[leg] - measured.position[joint]);
    } else {
      latched_angle_rad_[leg] = measured.position[joint];
    }
    // The wheel runs on for a moment after the ramp: latched earlier, it would be pulled back.
    const bool still = std::abs(measured.rate[joint]) < kWheelLatchRate_rad_s;
    latched_[leg] = rest && (latched_[leg] || still);
    if (latched_[leg]) continue;
    droop_rad_s += wheel_sign_[leg] * (expected_rate_[leg] - measured.rate[joint]);
    ++driven;
  }

  // The drives yield under load. Taken together they are brought back to their ramp (a pump feeds
  // a volume); one against another they may differ, as they must on uneven ground.
  if (driven == 0) {
    drive_lag_rad_ = 0.0;
  } else {
    if (were_all_latched) drive_lag_rad_ = latch_error_rad / kNumWheels;
    drive_lag_rad_ = std::clamp(drive_lag_rad_ + droop_rad_s / driven * settings_.period_s,
                                -settings_.max_drive_lag_rad, settings_.max_drive_lag_rad);
  }
  for (int leg = 0; leg < kNumWheels; ++leg) {
    const int joint = wheel_joint_[leg];
    const double error_rad = latched_[leg] ? latched_angle_rad_[leg] - measured.position[joint]
                                           : wheel_sign_[leg] * drive_lag_rad_;
    const double ramp = latched_[leg] ? 0.0 : previous_rate_[joint];
    out.rate[joint] = std::clamp(ramp + settings_.wheel_hold_gain_1_s * error_rad,
                                 -joints_[joint].max_rate, joints_[joint].max_rate);
  }
}

void JointLoop::stand_still() noexcept {
  previous_rate_.fill(0.0);
  expected_rate_.fill(0.0);
  drive_lag_rad_ = 0.0;
}

ActuatorCommand JointLoop::update(const JointCommand* command,
                                  const JointMeasurement& measured) noexcept {
  balance_.update(measured.position, measured.effort, settings_.load_balance && command != nullptr);
  ActuatorCommand out;
  for (int i = 0; i < num_joints_; ++i) {
    if (!joints_[i].wheel) out.rate[i] = hydraulic_rate(i, command, measured.position[i]);
  }
  if (turn_joint_ >= 0) {
    const double largest = largest_slew_rate(measured);
    out.rate[turn_joint_] = std::clamp(out.rate[turn_joint_], -largest, largest);
  }
  share_pump(out);
  for (int i = 0; i < num_joints_; ++i) {
    if (!joints_[i].wheel) previous_rate_[i] = out.rate[i];
  }
  update_wheels(command, measured, out);
  return out;
}

}  // namespace wex
