#pragma once

#include <array>

#include "models/excavator/machine_model.hpp"
#include "models/types/machine_io_types.hpp"

namespace wex {

struct LoadBalanceSettings {
  double cutoff_hz = 0.3;     ///< low pass of the estimated wheel loads
  double gain_m_s = 0.04;     ///< rate of the wheels' raise per unit of warp: closed loop 0.15 Hz
  double max_raise_m = 0.10;  ///< at the wheel
  double dead_zone = 0.03;    ///< warp below this is left alone
  double min_load_fraction = 0.1;  ///< of the mean: a leg below it is not standing
};

/// Slow correction of the warp mode: four stiff legs on rough ground share the weight by chance,
/// so the wheels of the diagonal that carries more are raised and the others lowered as much,
///   warp = (f_LF - f_RF - f_LH + f_RH) / (f_LF + f_RF + f_LH + f_RH),
///   d(raise)/dt = gain * lowpass(warp), offset = +-raise / lever,
/// where f is each wheel's load from the hip's virtual work, dp/dq being that of the contact point
/// at a locked wheel and the drive's traction taken out:
///   -(hip effort) = f (dp/dq . up) + (wheel effort / radius) (dp/dq . forward).
/// Control-rate code: no allocation, nothing thrown after construction.
class LoadBalance {
 public:
  LoadBalance(const MachineModel& machine, double period_s,
              const LoadBalanceSettings& settings = {});

  /// One period with the joint positions and efforts (joint order). Not active: the offset stays.
  void update(const std::array<double, kMaxJoints>& position,
              const std::array<double, kMaxJoints>& effort, bool active) noexcept;

  [[nodiscard]] double warp() const noexcept { return warp_; }  ///< low-passed, in [-1, 1]
  /// By Limb, added to the hip flexion angle; positive raises the wheel where lever > 0.
  [[nodiscard]] const std::array<double, kNumWheels>& offset_rad() const noexcept {
    return offset_rad_;
  }
  [[nodiscard]] const std::array<double, kNumWheels>& offset_rate_rad_s() const noexcept {
    return offset_rate_rad_s_;
  }

 private:
  struct Leg {
    int hfe = -1, wheel = -1;  ///< joints
    int carrier_body = -1;
    Eigen::Vector3d p_carrier_wheel, axle_carrier;
    double wheel_sign = 1.0, radius_m = 0.0;
  };

  /// Load of one wheel, base frame; also sets its lever.
  double load_n(int leg, const std::array<double, kMaxJoints>& effort) noexcept;

  LoadBalanceSettings settings_;
  double period_s_ = 0.0, blend_ = 0.0;
  bool usable_ = false;  ///< every leg has a hip flexion joint that lifts its wheel
  KinematicTree tree_;
  KinematicTree::Workspace workspace_;
  Eigen::VectorXd q_;  ///< base at the origin, level: the base's tilt is small
  Eigen::Matrix3Xd jacobian_;
  std::array<Leg, kNumWheels> legs_{};
  std::array<double, kNumWheels> lever_m_{};  ///< d(wheel height) / d(hip flexion)
  std::array<double, kNumWheels> load_n_{};   ///< low-passed
  bool primed_ = false;
  double warp_ = 0.0, raise_m_ = 0.0;  ///< raise of LF and RH at the wheel
  std::array<double, kNumWheels> offset_rad_{}, offset_rate_rad_s_{};
};

}  // namespace wex
