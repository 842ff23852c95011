#include "initializer/stepping/wheel_placer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "initializer/stepping/arm_kinematics.hpp"
#include "initializer/stepping/tyre_patch.hpp"
#include "models/terrain/wheel_rest.hpp"

namespace wex {
namespace {

constexpr double kEndStopRad = 0.01;  // kept free of hip flexion's end stops
constexpr double kToleranceM = 1e-6;
constexpr double kDistanceErrorM = 0.02;  // poses between decided ones; a map's cell is 0.1 m
constexpr int kMaxNewtonSteps = 12;
constexpr double kScanRad = 0.02;  // hip flexion between samples where a search has to look
constexpr double kBellySpacingM = 0.2;
constexpr double kStraight_1_m = 1e-4;  // curvature below which steering does not move a wheel
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace

Result<WheelPlacer> WheelPlacer::build(const TerrainMap& terrain, const MachineModel& machine,
                                       const PlanSettings& settings) {
  auto legs = build_leg_tables(machine);
  if (!legs) return tl::unexpected<Error>(legs.error());
  return WheelPlacer(terrain, machine, settings, *std::move(legs));
}

WheelPlacer::WheelPlacer(const TerrainMap& terrain, const MachineModel& machine,
                         const PlanSettings& settings, std::array<LegTable, kNumWheels> legs)
    : terrain_(&terrain),
      machine_(&machine),
      ground_(terrain),
      settings_(settings),
      legs_(std::move(legs)) {
  KinematicTree::Workspace w = machine.tree.make_workspace();
  Eigen::VectorXd q = Eigen::VectorXd::Zero(machine.num_coordinates());
  q.tail(machine.num_joints()) = machine.transport_posture();
  for (const WheeledLeg& leg : machine.legs) {
    q[leg.hfe] = 0.0;
    if (leg.steer >= 0) q[leg.steer] = 0.0;
  }
  machine.tree.update(q, w);
  mass_kg_ = machine.tree.total_mass_kg();
  moment_base_ = mass_kg_ * machine.tree.com(w);
  if (const auto arm = ArmKinematics::build(machine)) {
    moment_base_ -= arm->moment_base(arm->transport());
  }
  const Eigen::Vector2d size = machine.belly_max_m - machine.belly_min_m;
  const Eigen::Array2i steps = (size.array() / kBellySpacingM).ceil().max(1.0).cast<int>();
  for (int i = 0; i <= steps.x(); ++i) {
    for (int j = 0; j <= steps.y(); ++j) {
      p_base_belly_.emplace_back(machine.belly_min_m.x() + size.x() * i / steps.x(),
                                 machine.belly_min_m.y() + size.y() * j / steps.y(),
                                 -machine.belly_below_base_m);
    }
  }
}

std::array<double, kNumWheels> WheelPlacer::default_hfe_rad() const {
  std::array<double, kNumWheels> hfe{};
  for (std::size_t i = 0; i < kNumWheels; ++i) hfe[i] = legs_[i].hfe_default_rad();
  return hfe;
}

double WheelPlacer::upper_rad(int wheel) const {
  return legs_[static_cast<std::size_t>(wheel)].hfe_upper_rad() - kEndStopRad;
}

double WheelPlacer::gap_m(const Eigen::Isometry3d& T_world_base, std::size_t wheel,
                          const LegTable::Steer& steer, double hfe_rad, double* slope) const {
  const LegTable& table = legs_[wheel];
  const WheeledLeg& leg = machine_->legs[wheel];
  const Eigen::Vector3d p = T_world_base * table.p_base_wheel(hfe_rad, steer);
  if (!terrain_->known(p.head<2>())) return kUnknown;
  const Eigen::Vector3d axle = T_world_base.linear() * table.axle_base(hfe_rad, steer);
  const WheelRest rest = wheel_rest(*terrain_, p.head<2>(), axle, leg.radius_m, leg.half_width_m);
  const Eigen::Vector3d by_hfe = T_world_base.linear() * table.dp_base_wheel(hfe_rad, steer);
  *slope = by_hfe.z() - rest.by_xy.dot(by_hfe.head<2>());
  return p.z() - rest.height_m;
}

const char* WheelPlacer::ground_under(const Eigen::Vector2d& p_world_xy) const {
  if (!terrain_->contains(p_world_xy)) return "is off the map";
  if (!terrain_->known(p_world_xy)) return "is over unknown ground";
  if (!(ground_.clear_m(p_world_xy.x(), p_world_xy.y()) >=
        settings_.min_signed_distance_m - kDistanceErrorM)) {
    return "is too close to ground no wheel may stand on";
  }
  return nullptr;
}

// Newton from the guess; where the ground is too rough for it, the first contact met from above.
const char* WheelPlacer::rest(const Eigen::Isometry3d& T_world_base, std::size_t wheel,
                              const LegTable::Steer& steer, double& hfe_rad) const {
  const double lower = legs_[wheel].hfe_lower_rad() + kEndStopRad;
  const double upper = legs_[wheel].hfe_upper_rad() - kEndStopRad;
  double hfe = std::clamp(hfe_rad, lower, upper);
  double slope = 0.0;
  for (int i = 0; i < kMaxNewtonSteps; ++i) {
    const double gap = gap_m(T_world_base, wheel, steer, hfe, &slope);
    if (std::isnan(gap)) break;
    if (std::abs(gap) < kToleranceM) {
      hfe_rad = hfe;
      const Eigen::Vector3d p = T_world_base * legs_[wheel].p_base_wheel(hfe, steer);
      return ground_under(p.head<2>());
    }
    const double next = std::clamp(hfe - gap / std::max(slope, 0.3), lower, upper);
    if (next == hfe) break;
    hfe = next;
  }
  double above = upper;
  double gap = gap_m(T_world_base, wheel, steer, above, &slope);
  if (std::isnan(gap)) return "is off the map or over unknown ground";
  if (gap < 0.0) return "cannot be lifted high enough for the ground there";
  for (double below = upper - kScanRad; gap > 0.0; below -= kScanRad) {
    if (below < lower - kScanRad) return "does not reach the ground";
    gap = gap_m(T_world_base, wheel, steer, std::max(below, lower), &slope);
    if (std::isnan(gap)) return "is off the map or over unknown ground";
    if (gap > 0.0) above = std::max(below, lower);
  }
  double under = std::max(above - kScanRad, lower);
  while (above - under > 1e-9) {
    const double middle = 0.5 * (above + under);
    (gap_m(T_world_base, wheel, steer, middle, &slope) > 0.0 ? above : under) = middle;
  }
  hfe_rad = above;
  const Eigen::Vector3d p = T_world_base * legs_[wheel].p_base_wheel(above, steer);
  return ground_under(p.head<2>());
}

Result<WheelPlacement, PlacementFailure> WheelPlacer::place(
    const BaseCoordinates& base, double curvature_1_m, std::uint8_t lifted,
    const std::array<double, kNumWheels>& lifted_hfe_rad,
    const std::array<double, kNumWheels>& guess_rad) const {
  const Eigen::Isometry3d T_world_base = T_world_base_from(base);
  WheelPlacement placement;
  placement.moment_base = moment_base_;
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    const LegTable& table = legs_[i];
    const bool up = (lifted >> i & 1) != 0;
    double hfe = up ? lifted_hfe_rad[i] : guess_rad[i];
    LegTable::Steer steer;
    // Steering moves the wheel, the wheel's place its hip flexion, and that the hind kingpin.
    const int rounds = up || std::abs(curvature_1_m) < kStraight_1_m ? 1 : 3;
    for (int round = 0; round < rounds; ++round) {
      steer = LegTable::Steer(table.steering_rad(hfe, curvature_1_m));
      if (up) continue;
      if (const char* why = rest(T_world_base, i, steer, hfe)) {
        return tl::unexpected<PlacementFailure>({static_cast<int>(i), why});
      }
    }
    if (steer.angle_rad() < table.steer_lower_rad() ||
        steer.angle_rad() > table.steer_upper_rad()) {
      return tl::unexpected<PlacementFailure>(
          {static_cast<int>(i), "is beyond its steering limit"});
    }
    placement.hfe_rad[i] = hfe;
    placement.steer_rad[i] = steer.angle_rad();
    if (!up) {
      const WheeledLeg& leg = machine_->legs[i];
      placement.p_world_patch[i] = tyre_patch(
          *terrain_, T_world_base * table.p_base_wheel(hfe, steer),
          T_world_base.linear() * table.axle_base(hfe, steer), leg.radius_m, leg.half_width_m);
    }
    placement.moment_base += table.moment_base(hfe, steer);
  }
  return placement;
}

std::optional<double> WheelPlacer::lowest_clear_rad(const BaseCoordinates& base,
                                                    double curvature_1_m, int wheel,
                                                    double clearance_m) const {
  const Eigen::Isometry3d T_world_base = T_world_base_from(base);
  const auto i = static_cast<std::size_t>(wheel);
  const LegTable& table = legs_[i];
  const double lower = table.hfe_lower_rad() + kEndStopRad;
  const LegTable::Steer steer(table.steering_rad(upper_rad(wheel), curvature_1_m));
  const auto clearance = [&](double hfe) {
    const Eigen::Vector3d p = T_world_base * table.p_base_wheel(hfe, steer);
    return p.z() - machine_->legs[i].radius_m - ground_.dilated_top_side_m(p.x(), p.y());
  };
  double above = upper_rad(wheel);
  double last = clearance(above);
  if (!(last >= clearance_m)) return std::nullopt;
  while (above > lower) {
    const double below = std::max(above - kScanRad, lower);
    const double here = clearance(below);
    if (!(here >= clearance_m)) {
      const double share = std::isnan(here) ? 0.0 : (last - clearance_m) / (last - here);
      return above - share * (above - below);
    }
    above = below;
    last = here;
  }
  return lower;
}

bool WheelPlacer::belly_clear(const BaseCoordinates& base) const {
  const Eigen::Isometry3d T_world_base = T_world_base_from(base);
  return std::all_of(p_base_belly_.begin(), p_base_belly_.end(),
                     [&](const Eigen::Vector3d& p_base) {
                       const Eigen::Vector3d p = T_world_base * p_base;
                       return p.z() - ground_.height_m(p.x(), p.y()) >= settings_.belly_clearance_m;
                     });
}

}  // namespace wex
