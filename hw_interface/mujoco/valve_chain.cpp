#include "hw_interface/mujoco/valve_chain.hpp"

#include <algorithm>
#include <cmath>

namespace wex {
namespace {

constexpr double kShutTime_s = 0.05;  ///< from full flow, by the valve's spring

}  // namespace

ValveChain::ValveChain(const MachineModel& machine, double period_s, double dead_band)
    : num_joints_(machine.num_joints()), period_s_(period_s), dead_band_(dead_band) {
  WEX_EXPECTS(num_joints_ <= kMaxJoints && period_s > 0.0 && dead_band >= 0.0 && dead_band < 1.0);
  for (int i = 0; i < num_joints_; ++i) {
    const Joint& joint = machine.joints[i];
    Valve& valve = valves_[i];
    valve.max_rate = joint.max_rate;
    valve.wheel = joint.role == JointRole::kWheel;
    valve.dead_time_periods = static_cast<int>(std::lround(joint.dead_time_s / period_s));
    WEX_EXPECTS(valve.dead_time_periods >= 0 && valve.dead_time_periods <= kMaxDeadTimePeriods);
    if (joint.lag_s > 0.0) valve.blend = 1.0 - std::exp(-period_s / joint.lag_s);
  }
}

std::array<double, kMaxJoints> ValveChain::update(
    const std::array<double, kMaxJoints>& spool, const std::array<double, kMaxJoints>& wheel_rate,
    bool released, const std::array<bool, kMaxJoints>& braked) noexcept {
  std::array<double, kMaxJoints> rate{};
  constexpr int kRing = kMaxDeadTimePeriods + 1;
  for (int i = 0; i < num_joints_; ++i) {
    Valve& valve = valves_[i];
    if (!released || (valve.wheel && braked[i])) {
      const double slower = std::abs(valve.rate) - valve.max_rate * period_s_ / kShutTime_s;
      valve.rate = valve.wheel ? wheel_rate[i] : std::copysign(std::max(0.0, slower), valve.rate);
      history_[i].fill(valve.wheel ? wheel_rate[i] : 0.0);
      rate[i] = valve.rate;
      continue;
    }
    history_[i][head_] = valve.wheel ? wheel_rate[i] : spool[i];
    const double input = history_[i][(head_ - valve.dead_time_periods + kRing) % kRing];
    double flow_rate = input;
    if (!valve.wheel) {
      const double open = std::max(0.0, std::abs(input) - dead_band_) / (1.0 - dead_band_);
      flow_rate = std::copysign(open * valve.max_rate, input);
    }
    valve.rate += valve.blend * (flow_rate - valve.rate);
    rate[i] = valve.rate;
  }
  head_ = (head_ + 1) % kRing;
  return rate;
}

}  // namespace wex
