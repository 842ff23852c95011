#include "initializer/paper/body_poser.hpp"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "initializer/stepping/tyre_patch.hpp"

namespace wex {
namespace {

constexpr double kRollingErrorM = 0.05;  // of a standing wheel between two stations

}  // namespace

Result<BodyPoser> BodyPoser::build(const TerrainMap& terrain, const MachineModel& machine,
                                   const Roadmaps& roadmaps, const PaperCheck& check,
                                   const PlanSettings& settings) {
  auto placer = WheelPlacer::build(terrain, machine, settings);
  if (!placer) return tl::unexpected<Error>(placer.error());
  auto arm = ArmKinematics::build(machine);
  if (!arm) return tl::unexpected<Error>(arm.error());
  return BodyPoser(terrain, machine, roadmaps, check, *std::move(placer), *std::move(arm),
                   settings.min_signed_distance_m);
}

BodyPoser::BodyPoser(const TerrainMap& terrain, const MachineModel& machine,
                     const Roadmaps& roadmaps, const PaperCheck& check, WheelPlacer placer,
                     ArmKinematics arm, double min_signed_distance_m)
    : terrain_(&terrain),
      machine_(&machine),
      roadmaps_(&roadmaps),
      check_(&check),
      placer_(std::move(placer)),
      arm_(std::move(arm)),
      inverse_(terrain, machine, min_signed_distance_m),
      workspace_(machine.tree.make_workspace()) {}

LegJoints BodyPoser::read_leg(const Eigen::VectorXd& q, std::size_t leg) const {
  const WheeledLeg& wheel = machine_->legs[leg];
  return {wheel.haa < 0 ? 0.0 : q[wheel.haa], q[wheel.hfe], wheel.steer < 0 ? 0.0 : q[wheel.steer]};
}

void BodyPoser::write_leg(const LegJoints& joints, std::size_t leg, Eigen::VectorXd& q) const {
  const WheeledLeg& wheel = machine_->legs[leg];
  if (wheel.haa >= 0) q[wheel.haa] = joints.haa_rad;
  q[wheel.hfe] = joints.hfe_rad;
  if (wheel.steer >= 0) q[wheel.steer] = joints.steer_rad;
}

LegJoints BodyPoser::vertex_joints(std::size_t leg, int vertex) const {
  const LimbRoadmap& map = roadmaps_->limbs[leg];
  Eigen::VectorXd q = Eigen::VectorXd::Zero(machine_->num_coordinates());
  for (std::size_t k = 0; k < map.coordinates.size(); ++k) {
    q[map.coordinates[k]] = map.q(static_cast<Eigen::Index>(k), vertex);
  }
  return read_leg(q, leg);
}

ArmPosture BodyPoser::vertex_posture(int vertex) const {
  const LimbRoadmap& map = roadmaps_->limbs.back();
  Eigen::VectorXd q = Eigen::VectorXd::Zero(machine_->num_coordinates());
  for (std::size_t k = 0; k < map.coordinates.size(); ++k) {
    q[map.coordinates[k]] = map.q(static_cast<Eigen::Index>(k), vertex);
  }
  return arm_.posture_of(q);
}

// In between everything moves evenly, as it does in the plan.
bool BodyPoser::stays_on_ground(const StandingLeg& from, const StandingLeg& to, std::size_t leg) {
  const auto near_ground = [&](double share) {
    BaseCoordinates base = from.base + share * (to.base - from.base);
    base[kBaseYaw] =
        from.base[kBaseYaw] + share * wrap_angle(to.base[kBaseYaw] - from.base[kBaseYaw]);
    const auto between = [share](double a, double b) { return a + share * (b - a); };
    const LegJoints joints{between(from.joints.haa_rad, to.joints.haa_rad),
                           between(from.joints.hfe_rad, to.joints.hfe_rad),
                           between(from.joints.steer_rad, to.joints.steer_rad)};
    return std::abs(inverse_.gap_m(base, leg, joints)) <= kRollingErrorM;
  };
  return near_ground(0.25) && near_ground(0.5) && near_ground(0.75);
}

Result<LegJoints, const char*> BodyPoser::standing(
    const BaseCoordinates& base, double curvature_1_m, std::size_t leg,
    const std::function<bool(const LegJoints&)>& clear, const std::optional<StandingLeg>& before) {
  const char* why = "has no configuration on the ground";
  const auto gets_here = [&](const LegJoints& joints) {
    if (!clear(joints)) {
      why = "would touch another limb";
      return false;
    }
    if (!before || stays_on_ground(*before, {base, joints}, leg)) return true;
    why = "would have to be lifted from where it stands to where it can stand next";
    return false;
  };
  const auto others = static_cast<std::uint8_t>(0xF & ~(1U << leg));
  const auto hips = placer_.default_hfe_rad();
  if (const auto placed = placer_.place(base, curvature_1_m, others, hips, hips)) {
    const WheeledLeg& wheel = machine_->legs[leg];
    const double haa_rad =
        wheel.haa < 0 ? 0.0 : machine_->transport_posture()[wheel.haa - kNumBaseCoordinates];
    const LegJoints joints{haa_rad, placed->hfe_rad[leg], placed->steer_rad[leg]};
    if (gets_here(joints)) return joints;
  }
  std::vector<LegJoints> guesses;
  if (before) guesses.push_back(before->joints);
  for (const int vertex : check_->touching_vertices(base, leg)) {
    guesses.push_back(vertex_joints(leg, vertex));
  }
  for (const std::optional<double> rolling :
       {std::optional(curvature_1_m), std::optional<double>()}) {
    for (const LegJoints& guess : guesses) {
      const auto joints = inverse_.rest(base, leg, rolling, guess);
      if (joints && gets_here(*joints)) return joints;
      if (!joints) why = joints.error();
    }
  }
  return tl::unexpected<const char*>(why);
}

Footing BodyPoser::footing(const Eigen::VectorXd& q, const ContactFlags& contacts) {
  machine_->tree.update(q, workspace_);
  Footing footing;
  footing.base = q.head<kNumBaseCoordinates>();
  footing.T_world_base = T_world_base_from(footing.base);
  footing.mass_kg = machine_->tree.total_mass_kg();
  footing.moment_base =
      footing.mass_kg * (footing.T_world_base.inverse() * machine_->tree.com(workspace_)) -
      arm_.moment_base(arm_.posture_of(q));
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    if (!contacts[i]) continue;
    const WheeledLeg& leg = machine_->legs[i];
    const Eigen::Vector3d p =
        machine_->tree.position(workspace_, leg.carrier_body, leg.p_carrier_wheel);
    const Eigen::Vector3d axle =
        machine_->tree.direction(workspace_, leg.carrier_body, leg.axle_carrier);
    footing.contacts[footing.num_contacts++] =
        tyre_patch(*terrain_, p, axle, leg.radius_m, leg.half_width_m).head<2>();
  }
  if (contacts[static_cast<std::size_t>(Limb::kArm)]) {
    footing.contacts[footing.num_contacts++] =
        machine_->tree
            .position(workspace_, machine_->arm->contact_body, machine_->arm->p_body_contact)
            .head<2>();
  }
  return footing;
}

}  // namespace wex
