#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "initializer/stepping/arm_table.hpp"
#include "models/excavator/machine_model.hpp"
#include "models/types/result.hpp"

namespace wex {

/// The plane arm of the tables as coordinates of the machine: exact kinematics of whole-body nodes,
/// turn included. Bucket roll and yaw stay in transport posture. Immutable, no allocation in
/// queries, safe for concurrent use.
class ArmKinematics {
 public:
  /// errors  kBadInput: no arm, or one that is not turn, boom, dipper, telescope, pitch in a plane
  [[nodiscard]] static Result<ArmKinematics> build(const MachineModel& machine);

  static constexpr std::size_t kNumJoints = 5;
  using Joints = std::array<double, kNumJoints>;  ///< in the order of ArmPosture

  [[nodiscard]] static Joints joints_of(const ArmPosture& posture) noexcept;
  [[nodiscard]] static ArmPosture posture_of(const Joints& joints) noexcept;
  [[nodiscard]] ArmPosture posture_of(const Eigen::VectorXd& q) const;
  void write(const ArmPosture& posture, Eigen::VectorXd& q) const;

  /// Points of the arm, base frame [m]: dipper hinge, bucket hinge, bucket contact.
  struct Shape {
    Eigen::Vector3d p_base_elbow, p_base_wrist, p_base_contact;
  };
  [[nodiscard]] Shape shape(const ArmPosture& posture) const noexcept;
  /// Mass times centre of mass of the cabin and all it carries, base frame [kg m].
  [[nodiscard]] Eigen::Vector3d moment_base(const ArmPosture& posture) const noexcept;
  /// Angle of the line from bucket hinge to contact from straight down, base frame; positive: the
  /// contact is farther out.
  [[nodiscard]] double attitude_rad(const ArmPosture& posture) const noexcept;

  /// The posture, elbow up, that puts the contact somewhere; turn in (-pi, pi]. Nothing if out of
  /// reach or closer than `margin` (rad, m) to an end stop.
  [[nodiscard]] std::optional<ArmPosture> reach(const Eigen::Vector3d& p_base_contact,
                                                double tele_m, double attitude_rad,
                                                double margin = 0.02) const noexcept;

  [[nodiscard]] bool within_limits(const ArmPosture& posture) const noexcept;
  [[nodiscard]] const ArmPosture& transport() const noexcept { return transport_; }
  [[nodiscard]] const Joints& lower() const noexcept { return lower_; }
  [[nodiscard]] const Joints& upper() const noexcept { return upper_; }
  [[nodiscard]] const Joints& max_rate() const noexcept { return max_rate_; }

 private:
  explicit ArmKinematics(ArmPlane plane) : plane_(std::move(plane)) {}

  ArmPlane plane_;
  std::array<int, kNumJoints> coordinates_{};
  Joints lower_{}, upper_{}, max_rate_{};
  ArmPosture transport_;
};

}  // namespace wex
