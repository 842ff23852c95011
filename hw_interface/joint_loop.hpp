#pragma once

#include <array>

#include "hw_interface/load_balance.hpp"
#include "hw_interface/stopping_speed.hpp"
#include "models/excavator/machine_model.hpp"
#include "models/types/machine_io_types.hpp"

namespace wex {

struct JointLoopSettings {
  double period_s = 0.01;            ///< 100 Hz
  double position_gain_1_s = 2.0;    ///< upper bound; see gain_delay_product
  double gain_delay_product = 0.6;   ///< gain <= this / (dead time + lag): phase margin 40 degrees
  double dead_band = 0.05;           ///< of full spool travel, undone by its inverse
  double rest_rate_fraction = 2e-3;  ///< slower than this share of the rate limit is "closed"
  double wheel_stop_acceleration_factor = 3.0;  ///< of the joint's own: to end motion, and apart
  double wheel_hold_gain_1_s = 2.0;             ///< brake latch and drive droop
  double max_drive_lag_rad = 0.03;              ///< bound of the droop correction, at the wheel
  double stall_time_s = 0.5;
  double stall_rate_fraction = 0.2;    ///< of the commanded rate
  double stall_effort_fraction = 0.7;  ///< of the joint's largest effort
  StoppingSpeed travel;
  StoppingSlew slew;
  double travel_margin = 0.97;  ///< of both: what passes here is not cut by the electronics
  bool load_balance = true;
  LoadBalanceSettings balance;
};

/// What the sensors say in one control period. Joint order as in MachineModel::joints.
struct JointMeasurement {
  std::array<double, kMaxJoints> position{}, rate{}, effort{};
  double pitch_rad = 0.0, roll_rad = 0.0;  ///< of the base, nose down > 0
};

/// What goes to the actuators in one control period.
struct ActuatorCommand {
  std::array<double, kMaxJoints> rate{};   ///< rad/s or m/s after every limit
  std::array<double, kMaxJoints> spool{};  ///< valve opening in [-1, 1]; unused for wheels
};

/// The 100 Hz joint loop on the host, the same for every backend. Per joint:
///   rate = feed-forward + gain (target - measured), limited in rate, acceleration and end stops;
///   all hydraulic rates share the pump's flow; wheels follow a ramp, together no faster than can
///   be stopped in time on this slope, stop on stall and are latched at their angle while nothing
///   is asked of them. The cabin slews no faster than can be stopped with the arm where it is.
/// Control-rate code: no allocation, nothing thrown after construction.
class JointLoop {
 public:
  /// At most kMaxJoints joints, period > 0 (contract).
  explicit JointLoop(const MachineModel& machine, const JointLoopSettings& settings = {});

  /// One control period. command == nullptr: all motion ends and the machine holds.
  ActuatorCommand update(const JointCommand* command, const JointMeasurement& measured) noexcept;

  /// For the periods in which somebody else holds the machine (its electronics, a brake): the ramps
  /// end at once, so that the next motion begins at rest. update() follows as ever.
  void stand_still() noexcept;

  /// Times all wheel drives were stopped because one of them stalled.
  [[nodiscard]] long stall_stops() const noexcept { return stall_stops_; }
  [[nodiscard]] bool stalled() const noexcept { return stalled_wheel_ >= 0; }
  /// What the load balance has added to each leg's hip flexion, by Limb [rad].
  [[nodiscard]] const std::array<double, kNumWheels>& load_balance_offset_rad() const noexcept {
    return balance_.offset_rad();
  }
  /// The same by joint: zero but for the hip flexions.
  [[nodiscard]] double offset_of_joint_rad(int joint) const noexcept;

 private:
  struct JointData {
    double lower = 0.0, upper = 0.0, max_rate = 0.0, max_acceleration = 0.0, max_effort = 0.0;
    double gain_1_s = 0.0;
    double response_blend = 1.0;  ///< share of the way to a commanded rate gone in one period
    double flow_per_rate = 0.0;   ///< m^3 per rad or m: displacement of the cylinder
    bool wheel = false, takes_target = false;
    int leg = -1;  ///< leg whose hip flexion this is
  };

  double hydraulic_rate(int joint, const JointCommand* command, double position) const noexcept;
  void share_pump(ActuatorCommand& out) const noexcept;
  void update_stall(const JointCommand* command, const JointMeasurement& measured) noexcept;
  void limit_travel(std::array<double, kNumWheels>& asked,
                    const JointMeasurement& measured) const noexcept;
  double largest_slew_rate(const JointMeasurement& measured) const noexcept;
  void update_ramps(const std::array<double, kNumWheels>& asked, bool end_motion) noexcept;
  void update_wheels(const JointCommand* command, const JointMeasurement& measured,
                     ActuatorCommand& out) noexcept;

  JointLoopSettings settings_;
  int num_joints_ = 0;
  double pump_flow_m3_s_ = 0.0;
  std::array<JointData, kMaxJoints> joints_{};
  std::array<double, kMaxJoints> previous_rate_{};
  int turn_joint_ = -1;
  std::array<int, 4> reaching_joints_{-1, -1, -1, -1};  ///< BOOM, DIPPER, TELE, EE_PITCH

  std::array<int, kNumWheels> wheel_joint_{};  ///< by Limb
  std::array<double, kNumWheels> wheel_sign_{}, wheel_radius_m_{}, latched_angle_rad_{},
      stall_clock_s_{};
  std::array<bool, kNumWheels> latched_{};
  std::array<double, kNumWheels> expected_rate_{};  ///< the ramp after dead time and lag
  double drive_lag_rad_ = 0.0;  ///< how far the wheels, taken together, are behind that
  int stalled_wheel_ = -1;
  double stalled_direction_ = 0.0;
  long stall_stops_ = 0;

  LoadBalance balance_;
};

}  // namespace wex
