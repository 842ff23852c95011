#pragma once

#include <Eigen/Core>
#include <complex>
#include <optional>
#include <vector>

#include "initializer/stepping/certificate.hpp"
#include "models/excavator/machine_model.hpp"

namespace wex {

/// Cabin and arm at one cabin yaw and posture, as a counterweight.
struct CounterWeight {
  ArmPosture posture;
  Eigen::Vector3d moment_base;  ///< mass times centre of mass of cabin and arm [kg m]
  Eigen::Vector3d p_base_elbow, p_base_wrist, p_base_bucket;  ///< what must clear the ground [m]
};

/// The arm in its own plane: a boom and a dipper with a telescope, and a bucket, all hinged about
/// parallel axes, on a cabin that turns about base z. Complex numbers stand for (forward, up), from
/// the cabin's axis and the base origin's height.
class ArmPlane {
 public:
  /// nullopt if the machine has no arm of this kind (checked against its kinematic tree).
  [[nodiscard]] static std::optional<ArmPlane> of(const MachineModel& machine);

  struct Points {
    std::complex<double> elbow, wrist, contact;  ///< dipper hinge, bucket hinge, bucket contact [m]
    std::complex<double> moment;                 ///< of the arm [kg m]
  };
  [[nodiscard]] Points points(const ArmPosture& posture) const noexcept;

  /// Posture (turn left at zero) that puts the contact at a place with a given telescope length and
  /// attitude (angle of hinge-to-edge from straight down, outwards positive), elbow up; all joints
  /// at least `limit_margin` inside their limits and `reach_margin_m` from a straight elbow.
  [[nodiscard]] std::optional<ArmPosture> reach(std::complex<double> contact, double tele_m,
                                                double attitude_rad, double limit_margin_rad = 0.0,
                                                double reach_margin_m = 0.0) const noexcept;

  /// The same with the attitude as a unit vector from hinge to edge, the telescope not checked.
  [[nodiscard]] std::optional<ArmPosture> reach(std::complex<double> contact, double tele_m,
                                                std::complex<double> edge_direction,
                                                double limit_margin_rad,
                                                double reach_margin_m) const noexcept;

  /// Cabin yaw at which a point of the base frame lies in the arm's plane, ahead of the cabin, and
  /// its place in that plane; nullopt too close to the cabin's axis.
  struct InPlane {
    double turn_rad = 0.0;
    std::complex<double> contact;
  };
  [[nodiscard]] std::optional<InPlane> in_plane(const Eigen::Vector3d& p_base) const noexcept;

  /// A point of the plane in the base frame, and cabin plus arm's moment there.
  [[nodiscard]] Eigen::Vector3d p_base(std::complex<double> p, double cos_turn,
                                       double sin_turn) const noexcept {
    return {cos_turn * p.real() - sin_turn * lateral_m_,
            sin_turn * p.real() + cos_turn * lateral_m_, p.imag()};
  }
  [[nodiscard]] Eigen::Vector3d moment_base(std::complex<double> arm_moment, double cos_turn,
                                            double sin_turn) const noexcept {
    const double forward = moment_cabin_.x() + arm_moment.real();
    const double left = moment_cabin_.y();  // the arm's own share does not change with posture
    return {cos_turn * forward - sin_turn * left, sin_turn * forward + cos_turn * left,
            moment_cabin_.z() + arm_moment.imag()};
  }
  [[nodiscard]] double lateral_m() const noexcept { return lateral_m_; }

  struct Limits {
    double lower = 0.0, upper = 0.0;
  };
  [[nodiscard]] const Limits& boom() const noexcept { return boom_; }
  [[nodiscard]] const Limits& dipper() const noexcept { return dipper_; }
  [[nodiscard]] const Limits& tele() const noexcept { return tele_; }
  [[nodiscard]] const Limits& ee_pitch() const noexcept { return ee_pitch_; }

 private:
  ArmPlane() = default;
  double lateral_m_ = 0.0;  // of the arm's plane, left of the cabin's axis
  // At zero joints: hinge of the boom; from hinge to hinge; telescope direction; hinge to contact.
  std::complex<double> boom_hinge_, boom_link_, dipper_link_, tele_axis_, bucket_link_;
  // Mass times lever of what each joint carries, without what the next one carries.
  std::complex<double> boom_moment_, dipper_moment_, bucket_moment_;
  double boom_length_m_ = 0.0, bucket_length_m_ = 0.0;
  double boom_sign_ = 1.0, dipper_sign_ = 1.0, bucket_sign_ = 1.0;
  double arm_mass_kg_ = 0.0, tele_mass_kg_ = 0.0;
  Eigen::Vector3d moment_cabin_ = Eigen::Vector3d::Zero();  // with the arm's constant lateral share
  Limits boom_, dipper_, tele_, ee_pitch_;
};

/// Postures that put the bucket on a contact point, by the point's place in the arm's plane.
class ArmTable {
 public:
  static constexpr int kMaxPostures = 6;
  struct Posture {
    float moment_forward = 0.0F, moment_up = 0.0F;  ///< of the arm [kg m]
    float elbow_forward = 0.0F, elbow_up = 0.0F;    ///< [m]
    float wrist_forward = 0.0F, wrist_up = 0.0F;    ///< [m]
    float tele_m = 0.0F, attitude_rad = 0.0F;       ///< what it was made from
  };
  struct Span {
    const Posture* begin = nullptr;
    const Posture* end = nullptr;
    [[nodiscard]] bool empty() const noexcept { return begin == end; }
  };

  ArmTable() = default;
  explicit ArmTable(const ArmPlane& plane);

  [[nodiscard]] bool empty() const noexcept { return !plane_; }
  [[nodiscard]] const ArmPlane& plane() const noexcept { return *plane_; }
  /// Postures for the nearest place of the table, by centre of mass from near to far.
  [[nodiscard]] Span postures(std::complex<double> contact) const noexcept;
  [[nodiscard]] double max_reach_m() const noexcept { return max_reach_m_; }

 private:
  std::optional<ArmPlane> plane_;
  std::vector<std::int32_t> first_;  // postures of cell c: [first[c], first[c + 1])
  std::vector<Posture> postures_;
  double max_reach_m_ = 0.0;
};

/// Counterweight postures, over cabin yaw and reach, all of them clear of level ground.
[[nodiscard]] std::vector<CounterWeight> make_counter_weights(const MachineModel& machine,
                                                              const ArmPlane& plane);

}  // namespace wex
