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
      usable_(true) {
  WEX_EXPECTS(period_s > 0.0 && settings.cutoff_hz > 0.0);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(machine.num_coordinates());
  q.tail(machine.num_joints()) = machine.default_posture();
  KinematicTree::Workspace workspace = machine.tree.make_workspace();
  machine.tree.update(q, workspace);
  Eigen::Matrix3Xd jacobian(3, machine.num_coordinates());
  for (int leg = 0; leg < kNumWheels; ++leg) {
    const WheeledLeg& wheeled_leg = machine.legs[leg];
    if (wheeled_leg.hfe < 0) {
      usable_ = false;
      continue;
    }
    machine.tree.position_jacobian(workspace, wheeled_leg.carrier_body, wheeled_leg.p_carrier_wheel,
                                   jacobian);
    hfe_joint_[leg] = wheeled_leg.hfe - kNumBaseCoordinates;
    lever_m_[leg] = jacobian(2, wheeled_leg.hfe);
    usable_ = usable_ && std::abs(lever_m_[leg]) > kSmallestLever_m;
  }
}

void LoadBalance::update(const std::array<double, kMaxJoints>& effort, bool active) noexcept {
  offset_rate_rad_s_.fill(0.0);
  if (!usable_) return;
  double sum_n = 0.0, warp_n = 0.0;
  for (int leg = 0; leg < kNumWheels; ++leg) {
    const double load_n = -effort[hfe_joint_[leg]] / lever_m_[leg];
    load_n_[leg] = primed_ ? load_n_[leg] + blend_ * (load_n - load_n_[leg]) : load_n;
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
    offset_rate_rad_s_[leg] = kWarpSign[leg] * (raise_m - raise_m_) / (lever_m_[leg] * period_s_);
    offset_rad_[leg] = kWarpSign[leg] * raise_m / lever_m_[leg];
  }
  raise_m_ = raise_m;
}

}  // namespace wex
