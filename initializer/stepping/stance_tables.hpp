#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "initializer/stepping/arm_table.hpp"
#include "models/excavator/machine_model.hpp"
#include "models/types/result.hpp"

namespace wex {

/// Steering of all wheels by the curvature of the base's path, from the tightest arc to the right
/// to that to the left: the kingpin offset moves the wheels by up to a quarter of a metre between
/// straight and tightest, so by 3 cm from one to the next.
inline constexpr int kNumSteerings = 17;
inline constexpr int kSteeredStraight = kNumSteerings / 2;
/// The nearest of them.
[[nodiscard]] int steering_for(double curvature_1_m, double min_turning_radius_m) noexcept;

/// One leg at one hip flexion, base frame.
struct LegSample {
  static constexpr int kMaxBeamPoints = 5;
  double hfe_rad = 0.0;
  Eigen::Vector3d p_base_wheel;  ///< centre, tyre at static sag [m]
  Eigen::Vector3d axle_base;
  Eigen::Vector3d moment_base;  ///< mass times centre of mass of the whole leg [kg m]
  std::array<Eigen::Vector3d, kMaxBeamPoints> p_base_beam;  ///< hinges, hip to wheel carrier [m]
  std::array<Eigen::Vector3d, 2> p_base_claw;  ///< ends of what the carrier carries [m]
};

/// One leg from the highest wheel position to the lowest, close enough for linear interpolation
/// (error under half a millimetre).
struct LegSweep {
  static constexpr int kSamples = 25;
  std::array<LegSample, kSamples> samples;
  int num_beam_points = 0;
  bool has_claw = false;
};

/// What a stance of the machine is computed from: legs over hip flexion and steering, the folded
/// arm at all cabin yaws, counterweight postures, bucket contacts. Everything else is in transport
/// posture. Plain data, made from the machine's kinematic tree.
struct StanceTables {
  std::array<std::array<LegSweep, kNumSteerings>, kNumWheels> legs;  ///< by Limb and steering
  std::array<double, kNumWheels> radius_m{}, half_width_m{}, sag_m{}, claw_radius_m{};
  double mass_kg = 0.0;
  Eigen::Vector3d moment_chassis_base;                 ///< all but legs, cabin and arm [kg m]
  std::vector<Eigen::Vector3d> moment_folded_base;     ///< cabin and folded arm, over cabin yaw
  std::vector<Eigen::Vector3d> moment_transport_base;  ///< the same without slewing: one entry
  std::vector<CounterWeight> counter_weights;
  ArmTable arm;  ///< empty if there is no such arm

  Eigen::Vector2d belly_min_m, belly_max_m;
  double belly_below_base_m = 0.0;
  double default_base_height_m = 0.0;
  double min_turning_radius_m = 0.0;

  /// errors  kBadInput: a leg that cannot be put on the ground by hip flexion
  [[nodiscard]] static Result<StanceTables> build(const MachineModel& machine);
};

}  // namespace wex
