#include "initializer/leg_table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace wex {
namespace {

constexpr int kNumSamples = 129;
constexpr double kThirdTurn = 2.0 * std::numbers::pi / 3.0;

// Coefficients of a + b cos + c sin through values at 0, +120 and -120 degrees.
Eigen::Matrix3d harmonic(const std::array<Eigen::Vector3d, 3>& value) {
  Eigen::Matrix3d columns;
  columns.col(0) = (value[0] + value[1] + value[2]) / 3.0;
  columns.col(1) = (2.0 * value[0] - value[1] - value[2]) / 3.0;
  columns.col(2) = (value[1] - value[2]) / std::numbers::sqrt3;
  return columns;
}

}  // namespace

Result<LegTable> LegTable::build(const MachineModel& machine, Limb limb) {
  const WheeledLeg& leg = machine.legs[static_cast<std::size_t>(limb)];
  if (leg.hfe < kNumBaseCoordinates) {
    return fail(ErrorCode::kBadInput, "machine " + machine.name + ": leg " +
                                          std::string(kLimbNames[static_cast<std::size_t>(limb)]) +
                                          " needs a hip flexion joint to be put on the ground");
  }
  const Joint& hip = machine.joints[static_cast<std::size_t>(leg.hfe - kNumBaseCoordinates)];

  LegTable table;
  table.hfe_lower_rad_ = hip.lower;
  table.hfe_upper_rad_ = hip.upper;
  table.samples_per_rad_ = (kNumSamples - 1) / (hip.upper - hip.lower);
  table.hfe_default_rad_ = hip.default_position;
  if (leg.steer >= 0) {
    const Joint& steer = machine.joints[static_cast<std::size_t>(leg.steer - kNumBaseCoordinates)];
    table.steer_lower_rad_ = steer.lower;
    table.steer_upper_rad_ = steer.upper;
  }

  KinematicTree::Workspace w = machine.tree.make_workspace();
  Eigen::VectorXd q = Eigen::VectorXd::Zero(machine.num_coordinates());
  q.tail(machine.num_joints()) = machine.transport_posture();
  q[leg.hfe] = 0.0;
  if (leg.steer >= 0) q[leg.steer] = 0.0;
  machine.tree.update(q, w);
  const double mass_kg = machine.tree.total_mass_kg();
  const Eigen::Vector3d moment_zero = mass_kg * machine.tree.com(w);

  table.samples_.reserve(kNumSamples);
  for (int i = 0; i < kNumSamples; ++i) {
    q[leg.hfe] = hip.lower + i / table.samples_per_rad_;
    std::array<Eigen::Vector3d, 3> wheel, axle, moment;
    for (std::size_t k = 0; k < 3; ++k) {
      if (leg.steer >= 0) q[leg.steer] = k == 0 ? 0.0 : (k == 1 ? kThirdTurn : -kThirdTurn);
      machine.tree.update(q, w);
      wheel[k] = machine.tree.position(w, leg.carrier_body, leg.p_carrier_wheel);
      axle[k] = machine.tree.direction(w, leg.carrier_body, leg.axle_carrier);
      moment[k] = mass_kg * machine.tree.com(w) - moment_zero;
    }
    table.samples_.push_back({harmonic(wheel), harmonic(axle), harmonic(moment)});
  }
  return table;
}

LegTable::Cell LegTable::cell(double hfe_rad) const noexcept {
  const double at = std::clamp((hfe_rad - hfe_lower_rad_) * samples_per_rad_, 0.0,
                               static_cast<double>(kNumSamples - 1));
  const int index = std::min(static_cast<int>(at), kNumSamples - 2);
  return {static_cast<std::size_t>(index), at - index};
}

Eigen::Vector3d LegTable::value(Eigen::Matrix3d Sample::* field, double hfe_rad,
                                const Steer& steer) const noexcept {
  const auto [index, share] = cell(hfe_rad);
  const Eigen::Matrix3d& below = samples_[index].*field;
  const Eigen::Matrix3d& above = samples_[index + 1].*field;
  return (1.0 - share) * (below * steer.weights()) + share * (above * steer.weights());
}

Eigen::Vector3d LegTable::p_base_wheel(double hfe_rad, const Steer& steer) const noexcept {
  return value(&Sample::wheel, hfe_rad, steer);
}

Eigen::Vector3d LegTable::dp_base_wheel(double hfe_rad, const Steer& steer) const noexcept {
  const std::size_t index = cell(hfe_rad).index;
  return samples_per_rad_ * ((samples_[index + 1].wheel - samples_[index].wheel) * steer.weights());
}

Eigen::Vector3d LegTable::axle_base(double hfe_rad, const Steer& steer) const noexcept {
  return value(&Sample::axle, hfe_rad, steer).normalized();
}

Eigen::Vector3d LegTable::moment_base(double hfe_rad, const Steer& steer) const noexcept {
  return value(&Sample::moment, hfe_rad, steer);
}

double LegTable::steering_rad(double hfe_rad, double curvature_1_m) const noexcept {
  constexpr int kMaxSteps = 12;
  constexpr double kStepSize = 1e-4;  // rad, for how the axle turns with steering
  double steer = 0.0;
  for (int i = 0; i < kMaxSteps; ++i) {
    // Rolling direction wanted at the wheel, and the one the axle gives, both from base x.
    const auto error = [&](double angle) {
      const Eigen::Vector3d p = p_base_wheel(hfe_rad, Steer(angle));
      const Eigen::Vector3d axle = axle_base(hfe_rad, Steer(angle));
      const double wanted = std::atan2(curvature_1_m * p.x(), 1.0 - curvature_1_m * p.y());
      return wanted - std::atan2(-axle.x(), axle.y());
    };
    const double e = error(steer);
    const double slope = (error(steer + kStepSize) - e) / kStepSize;
    if (std::abs(slope) < 1e-6) break;  // a wheel that cannot be steered
    const double step = std::clamp(-e / slope, -0.5, 0.5);
    steer += step;
    if (std::abs(step) < 1e-9) break;
  }
  return steer;
}

Result<std::array<LegTable, kNumWheels>> build_leg_tables(const MachineModel& machine) {
  auto lf = LegTable::build(machine, Limb::kLF);
  auto rf = LegTable::build(machine, Limb::kRF);
  auto lh = LegTable::build(machine, Limb::kLH);
  auto rh = LegTable::build(machine, Limb::kRH);
  for (const auto* table : {&lf, &rf, &lh, &rh}) {
    if (!*table) return tl::unexpected<Error>(table->error());
  }
  return std::array<LegTable, kNumWheels>{*std::move(lf), *std::move(rf), *std::move(lh),
                                          *std::move(rh)};
}

}  // namespace wex
