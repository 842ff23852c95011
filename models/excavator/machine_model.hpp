#pragma once

#include <Eigen/Geometry>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "models/excavator/kinematic_tree.hpp"
#include "models/types/limbs.hpp"
#include "models/types/result.hpp"

namespace wex {

/// What an actuated joint does for the machine; decides limits handling and the command's form.
enum class JointRole { kHipAbduction, kHipFlexion, kSteering, kWheel, kArm, kAuxiliary };

/// One actuated joint, limits as in the URDF, actuation as in the side-car. SI units.
struct Joint {
  std::string name;
  int body = -1;  ///< tree body it carries
  JointRole role = JointRole::kAuxiliary;
  bool prismatic = false;
  bool continuous = false;                ///< no position limits; lower/upper are then -/+infinity
  double lower = 0.0, upper = 0.0;        ///< rad or m
  double max_rate = 0.0;                  ///< rad/s or m/s
  double max_effort = 0.0;                ///< N m or N
  double max_acceleration = 0.0;          ///< rad/s^2 or m/s^2
  double dead_time_s = 0.0, lag_s = 0.0;  ///< hydraulics
  double hold_stiffness = 0.0;            ///< oil column stiffness, N m/rad or N/m
  double default_position = 0.0, transport_position = 0.0;
};

/// A wheeled leg. Coordinates are indices into q (base 6 first), -1 where the leg has no such
/// joint.
struct WheeledLeg {
  Limb limb{};
  int haa = -1, hfe = -1, steer = -1, wheel = -1;  ///< coordinates
  int carrier_body = -1;  ///< tree body that carries the axle and does not spin with the wheel
  Eigen::Vector3d p_carrier_wheel;  ///< wheel centre at static tyre sag, carrier frame [m]
  Eigen::Vector3d axle_carrier;     ///< unit axle, pointing to the machine's left at q = 0
  int wheel_body = -1;  ///< tree body of the wheel; its tyre stands locked at static sag
  Eigen::Vector3d tyre_axis_carrier;  ///< unit axis of the tyre's slide: base z in default posture
  Eigen::Vector3d p_carrier_wheel_unloaded;  ///< wheel centre at zero deflection [m];
                                             ///< p_carrier_wheel = this + static_sag_m * tyre axis
  double wheel_sign = 1.0;  ///< +1 if positive wheel rate rolls the machine forward
  double radius_m = 0.6, half_width_m = 0.2;
  double static_sag_m = 0.0;  ///< tyre deflection standing on flat ground in default posture
};

struct ArmLimb {
  std::vector<int> coordinates;  ///< TURN first, then outwards
  int contact_body = -1;
  Eigen::Vector3d p_body_contact;  ///< ARM_contact [m]
};

/// A passive joint that follows an actuated one: position = multiplier * q[coordinate].
struct PassiveJoint {
  std::string name;
  int body = -1;  ///< tree body it carries
  int coordinate = -1;
  double multiplier = 0.0;
};

/// Everything the planners know of a machine; plain data once loaded (immutable, thread-safe
/// reads). Built by load_machine from machines/NAME/{NAME.urdf, NAME.toml}.
struct MachineModel {
  std::string name;
  std::filesystem::path urdf_path, sidecar_path;
  double total_mass_kg = 0.0;
  std::vector<Joint> joints;  ///< actuated, in q order (coordinate = 6 + index)
  std::vector<PassiveJoint> passive_joints;
  std::array<WheeledLeg, kNumWheels> legs;  ///< indexed by Limb
  std::optional<ArmLimb> arm;
  KinematicTree tree;

  double belly_below_base_m = 0.35;          ///< underside of the chassis below the base origin
  Eigen::Vector2d belly_min_m, belly_max_m;  ///< chassis rectangle in base x, y [m]
  double default_base_height_m = 0.95;       ///< base origin above the standing wheels' ground
  double min_turning_radius_m = 4.5;         ///< all-wheel steering
  double pump_flow_limit_w_over_pa = 0.004;  ///< m^3/s shared by all moving joints but wheels
  double pump_pressure_pa = 35e6;
  double valve_dead_band = 0.05;  ///< of full command
  double tyre_stiffness_n_m = 6e5, tyre_damping_ns_m = 1.5e4;

  [[nodiscard]] int num_joints() const { return static_cast<int>(joints.size()); }
  [[nodiscard]] int num_coordinates() const { return kNumBaseCoordinates + num_joints(); }
  /// Coordinate of a joint by name; nullopt if there is none.
  [[nodiscard]] std::optional<int> coordinate(const std::string& joint_name) const;
  /// Joint values only (size num_joints).
  [[nodiscard]] Eigen::VectorXd default_posture() const;
  [[nodiscard]] Eigen::VectorXd transport_posture() const;  ///< driving: arm folded, bucket clear
};

/// Reads NAME.urdf and NAME.toml from the directory NAME under $WEX_MACHINES_DIR (default:
/// machines/ of the source tree), or from a directory given by its path. Never throws.
///   errors  kBadInput naming file and line or field
[[nodiscard]] Result<MachineModel> load_machine(const std::string& name_or_directory = "m545");

}  // namespace wex
