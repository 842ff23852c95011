#include "initializer/paper/leg_inverse.hpp"

#include <algorithm>
#include <cmath>

#include "models/terrain/wheel_rest.hpp"

namespace wex {
namespace {

constexpr int kMaxSteps = 25;
constexpr double kHeightToleranceM = 1e-6, kHeadingToleranceRad = 1e-6;
constexpr double kDifferenceRad = 1e-4;
constexpr double kMaxStepRad = 0.3;
constexpr double kEndStopRad = 0.01;

}  // namespace

LegInverse::LegInverse(const TerrainMap& terrain, const MachineModel& machine,
                       double min_signed_distance_m)
    : terrain_(terrain),
      machine_(machine),
      min_distance_m_(min_signed_distance_m),
      workspace_(machine.tree.make_workspace()),
      q_(Eigen::VectorXd::Zero(machine.num_coordinates())) {
  q_.tail(machine.num_joints()) = machine.transport_posture();
}

void LegInverse::update(std::size_t leg, const LegJoints& joints) {
  const WheeledLeg& wheel = machine_.legs[leg];
  if (wheel.haa >= 0) q_[wheel.haa] = joints.haa_rad;
  q_[wheel.hfe] = joints.hfe_rad;
  if (wheel.steer >= 0) q_[wheel.steer] = joints.steer_rad;
  machine_.tree.update(q_, workspace_);
}

double LegInverse::gap_m(std::size_t leg) const {
  const WheeledLeg& wheel = machine_.legs[leg];
  const Eigen::Vector3d p =
      machine_.tree.position(workspace_, wheel.carrier_body, wheel.p_carrier_wheel);
  if (!terrain_.known(p.head<2>())) return std::nan("");
  const Eigen::Vector3d axle =
      machine_.tree.direction(workspace_, wheel.carrier_body, wheel.axle_carrier);
  return p.z() -
         wheel_rest(terrain_, p.head<2>(), axle, wheel.radius_m, wheel.half_width_m).height_m;
}

bool LegInverse::on_good_ground(std::size_t leg) const {
  const WheeledLeg& wheel = machine_.legs[leg];
  const Eigen::Vector2d p =
      machine_.tree.position(workspace_, wheel.carrier_body, wheel.p_carrier_wheel).head<2>();
  return terrain_.traversable_at(p) && terrain_.signed_distance_m(p) >= min_distance_m_;
}

double LegInverse::gap_m(const BaseCoordinates& base, std::size_t leg, const LegJoints& joints) {
  q_.head<kNumBaseCoordinates>() = base;
  update(leg, joints);
  return gap_m(leg);
}

double LegInverse::clearance_m(const BaseCoordinates& base, std::size_t leg,
                               const LegJoints& joints) {
  q_.head<kNumBaseCoordinates>() = base;
  update(leg, joints);
  const WheeledLeg& wheel = machine_.legs[leg];
  const Eigen::Vector3d p =
      machine_.tree.position(workspace_, wheel.carrier_body, wheel.p_carrier_wheel);
  return p.z() - wheel.radius_m - terrain_.dilated_height_m(p.head<2>());
}

// Between the way the wheel's place moves in the base's plane and the way it rolls.
double LegInverse::heading_error_rad(std::size_t leg, double curvature_1_m) const {
  const WheeledLeg& wheel = machine_.legs[leg];
  const Eigen::Isometry3d T_base_world = workspace_.T_world_body[0].inverse();
  const Eigen::Vector3d p =
      T_base_world * machine_.tree.position(workspace_, wheel.carrier_body, wheel.p_carrier_wheel);
  const Eigen::Vector3d axle =
      T_base_world.linear() *
      machine_.tree.direction(workspace_, wheel.carrier_body, wheel.axle_carrier);
  return std::atan2(curvature_1_m * p.x(), 1.0 - curvature_1_m * p.y()) -
         std::atan2(-axle.x(), axle.y());
}

Result<LegJoints, const char*> LegInverse::rest(const BaseCoordinates& base, std::size_t leg,
                                                std::optional<double> curvature_1_m,
                                                const LegJoints& guess) {
  const WheeledLeg& wheel = machine_.legs[leg];
  const auto joint = [&](int coordinate) -> const Joint& {
    return machine_.joints[static_cast<std::size_t>(coordinate - kNumBaseCoordinates)];
  };
  q_.head<kNumBaseCoordinates>() = base;
  LegJoints joints = guess;
  const bool rolls = curvature_1_m && wheel.steer >= 0;
  for (int i = 0; i < kMaxSteps; ++i) {
    update(leg, joints);
    const double gap = gap_m(leg);
    if (std::isnan(gap)) return tl::unexpected<const char*>("is off the map or unknown ground");
    const double turn = rolls ? heading_error_rad(leg, *curvature_1_m) : 0.0;
    if (std::abs(gap) < kHeightToleranceM && std::abs(turn) < kHeadingToleranceRad) {
      if (on_good_ground(leg)) return joints;
      return tl::unexpected<const char*>("would rest too close to ground no wheel may stand on");
    }
    // One after the other: steering hardly moves the wheel up or down.
    LegJoints beside = joints;
    beside.hfe_rad += kDifferenceRad;
    update(leg, beside);
    const double rise = (gap_m(leg) - gap) / kDifferenceRad;
    if (!(rise > kDifferenceRad)) break;
    double steer_step = 0.0;
    if (rolls) {
      beside = joints;
      beside.steer_rad += kDifferenceRad;
      update(leg, beside);
      const double by_steer = (heading_error_rad(leg, *curvature_1_m) - turn) / kDifferenceRad;
      if (std::abs(by_steer) > kDifferenceRad) steer_step = -turn / by_steer;
    }
    const Joint& hip = joint(wheel.hfe);
    joints.hfe_rad = std::clamp(joints.hfe_rad - std::clamp(gap / rise, -kMaxStepRad, kMaxStepRad),
                                hip.lower + kEndStopRad, hip.upper - kEndStopRad);
    joints.steer_rad += std::clamp(steer_step, -kMaxStepRad, kMaxStepRad);
    if (rolls) {
      const Joint& steer = joint(wheel.steer);
      joints.steer_rad = std::clamp(joints.steer_rad, steer.lower, steer.upper);
    }
  }
  return tl::unexpected<const char*>("finds no ground to rest on");
}

}  // namespace wex
