#include "initializer/stepping/arm_kinematics.hpp"

#include <cmath>
#include <utility>

namespace wex {
namespace {

constexpr double kStraightElbowM = 0.02;  // kept from it: joints would race

}  // namespace

Result<ArmKinematics> ArmKinematics::build(const MachineModel& machine) {
  auto plane = ArmPlane::of(machine);
  if (!plane) {
    return fail(ErrorCode::kBadInput,
                "machine " + machine.name +
                    ": stepping needs an arm of turn, boom, dipper, telescope and bucket pitch "
                    "that moves in one plane");
  }
  ArmKinematics arm(*std::move(plane));
  for (std::size_t k = 0; k < kNumJoints; ++k) {
    const int coordinate = machine.arm->coordinates[k];
    const Joint& joint = machine.joints[static_cast<std::size_t>(coordinate - kNumBaseCoordinates)];
    arm.coordinates_[k] = coordinate;
    arm.lower_[k] = joint.lower;
    arm.upper_[k] = joint.upper;
    arm.max_rate_[k] = joint.max_rate;
  }
  Eigen::VectorXd q = Eigen::VectorXd::Zero(machine.num_coordinates());
  q.tail(machine.num_joints()) = machine.transport_posture();
  arm.transport_ = arm.posture_of(q);
  return arm;
}

ArmKinematics::Joints ArmKinematics::joints_of(const ArmPosture& posture) noexcept {
  return {posture.turn_rad, posture.boom_rad, posture.dipper_rad, posture.tele_m,
          posture.ee_pitch_rad};
}

ArmPosture ArmKinematics::posture_of(const Joints& joints) noexcept {
  return {joints[0], joints[1], joints[2], joints[3], joints[4]};
}

ArmPosture ArmKinematics::posture_of(const Eigen::VectorXd& q) const {
  Joints joints;
  for (std::size_t k = 0; k < kNumJoints; ++k) joints[k] = q[coordinates_[k]];
  return posture_of(joints);
}

void ArmKinematics::write(const ArmPosture& posture, Eigen::VectorXd& q) const {
  const Joints joints = joints_of(posture);
  for (std::size_t k = 0; k < kNumJoints; ++k) q[coordinates_[k]] = joints[k];
}

ArmKinematics::Shape ArmKinematics::shape(const ArmPosture& posture) const noexcept {
  const ArmPlane::Points p = plane_.points(posture);
  const double c = std::cos(posture.turn_rad), s = std::sin(posture.turn_rad);
  return {plane_.p_base(p.elbow, c, s), plane_.p_base(p.wrist, c, s),
          plane_.p_base(p.contact, c, s)};
}

Eigen::Vector3d ArmKinematics::moment_base(const ArmPosture& posture) const noexcept {
  return plane_.moment_base(plane_.points(posture).moment, std::cos(posture.turn_rad),
                            std::sin(posture.turn_rad));
}

double ArmKinematics::attitude_rad(const ArmPosture& posture) const noexcept {
  const ArmPlane::Points p = plane_.points(posture);
  const std::complex<double> edge = p.contact - p.wrist;
  return std::atan2(edge.real(), -edge.imag());
}

std::optional<ArmPosture> ArmKinematics::reach(const Eigen::Vector3d& p_base_contact, double tele_m,
                                               double attitude_rad, double margin) const noexcept {
  const auto place = plane_.in_plane(p_base_contact);
  if (!place) return std::nullopt;
  auto posture = plane_.reach(place->contact, tele_m, attitude_rad, margin, kStraightElbowM);
  if (posture) posture->turn_rad = wrap_angle(place->turn_rad);
  return posture;
}

bool ArmKinematics::within_limits(const ArmPosture& posture) const noexcept {
  const Joints joints = joints_of(posture);
  for (std::size_t k = 0; k < kNumJoints; ++k) {
    if (joints[k] < lower_[k] || joints[k] > upper_[k]) return false;
  }
  return true;
}

}  // namespace wex
