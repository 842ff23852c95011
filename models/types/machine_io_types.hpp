#pragma once

#include <Eigen/Core>
#include <array>
#include <bitset>
#include <cstdint>

#include "models/types/limbs.hpp"
#include "models/types/pose.hpp"

namespace wex {

/// Upper bound of actuated joints, so that control-rate values live on the stack.
inline constexpr int kMaxJoints = 32;

/// What a joint's reading is worth.
enum class SignalQuality : std::uint8_t {
  kOk,
  kStale,        ///< older than the planner may take for the present; the last value is kept
  kInvalid,      ///< the sensor reports a fault
  kNotAvailable  ///< never heard of
};

/// What is sent to the machine at control rate. Plain value, no allocation. Joint order as in
/// MachineModel::joints; entries beyond num_joints are ignored.
struct JointCommand {
  int num_joints = 0;
  std::array<double, kMaxJoints> rate{};             ///< feed-forward, rad/s or m/s
  std::array<double, kMaxJoints> position_target{};  ///< rad or m, used where has_position_target
  std::bitset<kMaxJoints> has_position_target{};     ///< never for wheels and TURN
  double valid_until_s = 0.0;  ///< machine time; afterwards all motion stops and holds
};

/// What is known of the machine at `t_s` (machine time). Plain value, no allocation.
struct MachineState {
  double t_s = 0.0;                                ///< time the values are of
  double age_s = 0.0;                              ///< how old they were when read
  BaseCoordinates base = BaseCoordinates::Zero();  ///< in the local world frame; yaw unwrapped
  /// Linear, angular; world frame, m/s and rad/s.
  Eigen::Matrix<double, 6, 1> base_velocity = Eigen::Matrix<double, 6, 1>::Zero();
  int num_joints = 0;
  std::array<double, kMaxJoints> position{};     ///< rad or m; wheels unwrapped
  std::array<double, kMaxJoints> rate{};         ///< rad/s or m/s
  std::array<double, kMaxJoints> effort{};       ///< N m or N, from cylinder pressures
  std::array<double, kMaxJoints> joint_age_s{};  ///< of each position and rate when read
  std::array<SignalQuality, kMaxJoints> joint_quality{};
};

}  // namespace wex
