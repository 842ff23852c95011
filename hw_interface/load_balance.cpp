#include "hw_interface/load_balance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace wex {
namespace {

/// LF and RH against RF and LH, by Limb.
constexpr std::array<double, kNumWheels> kWarpSign{1.0, -1.0, -1.0, 1.0};
constexpr double kSmallestLever_m = 0.1;

}  // namespace

LoadBalance::LoadBalance(const MachineModel& machine, double period_s,
                         const LoadBalanceSettings& settings)
    : settings_(settings),
      period_s_(period_s),
      blend_(1.0 - std::exp(-2.0 * std::numbers::pi * settings.cutoff_hz * period_s)),
      usable_(true),
      tree_(machine.tree),
      workspace_(tree_.make_workspace()),
      q_(Eigen::VectorXd::Zero(machine.num_coordinates())),
      jacobian_(3, machine.num_coordinates()) {
  WEX_EXPECTS(period_s > 0.0 && settings.cutoff_hz > 0.0);
  for (int i = 0; i < kNumWheels; ++i) {
    const WheeledLeg& source = machine.legs[i];
    usable_ = usable_ && source.hfe >= 0;
    legs_[i] = {source.hfe - kNumBaseCoordinates,
                source.wheel - kNumBaseCoordinates,
                source.carrier_body,
                source.p_carrier_wheel,
                source.axle_carrier,
                source.wheel_sign,
                source.radius_m};
  }
}

double LoadBalance::load_n(int index, const std::array<double, kMaxJoints>& effort) noexcept {
  const Leg& leg = legs_[index];
  const Eigen::Matrix3d& R_base_carrier = workspace_.T_world_body[leg.carrier_body].linear();
  const Eigen::Vector3d p_carrier_contact =
      leg.p_carrier_wheel - R_base_carrier.transpose() * (leg.radius_m * Eigen::Vector3d::UnitZ());
  tree_.position_jacobian(workspace_, leg.carrier_body, p_carrier_contact, jacobian_);
  const Eigen::Vector3d per_flexion = jacobian_.col(kNumBaseCoordinates + leg.hfe);
  lever_m_[index] = per_flexion.z();
  const Eigen::Vector3d forward =
      (R_base_carrier * leg.axle_carrier).cross(Eigen::Vector3d::UnitZ()).normalized();
  const double traction_n = leg.wheel_sign * effort[leg.wheel] / leg.radius_m;
  return -(effort[leg.hfe] + traction_n * per_flexion.dot(forward)) / lever_m_[index];
}

void LoadBalance::update(const std::array<double, kMaxJoints>& position,
                         const std::array<double, kMaxJoints>& effort, bool active) noexcept {
  offset_rate_rad_s_.fill(0.0);
  if (!usable_) return;
  for (Eigen::Index i = kNumBaseCoordinates; i < q_.size(); ++i) {
    q_[i] = position[static_cast<std::size_t>(i - kNumBaseCoordinates)];
  }
  tree_.update(q_, workspace_);
  double sum_n = 0.0, warp_n = 0.0;
  for (int leg = 0; leg < kNumWheels; ++leg) {
    const double load = load_n(leg, effort);
    if (std::abs(lever_m_[leg]) < kSmallestLever_m) return;
    load_n_[leg] = primed_ ? load_n_[leg] + blend_ * (load - load_n_[leg]) : load;
    sum_n += load_n_[leg];
    warp_n += kWarpSign[leg] * load_n_[leg];
  }
  primed_ = true;
  const double smallest_n = *std::min_element(load_n_.begin(), load_n_.end());
  const bool all_stand =
      sum_n > 0.0 && smallest_n > settings_.min_load_fraction * sum_n / kNumWheels;
  warp_ = all_stand ? warp_n / sum_n : 0.0;
  if (!active || std::abs(warp_) < settings_.dead_zone) return;

  const double raise_m = std::clamp(raise_m_ + settings_.gain_m_s * warp_ * period_s_,
                                    -settings_.max_raise_m, settings_.max_raise_m);
  for (int leg = 0; leg < kNumWheels; ++leg) {
    const double step_rad = kWarpSign[leg] * (raise_m - raise_m_) / lever_m_[leg];
    offset_rate_rad_s_[leg] = step_rad / period_s_;
    offset_rad_[leg] += step_rad;
  }
  raise_m_ = raise_m;
}

}  // namespace wex
