#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "models/types/limbs.hpp"
#include "models/types/result.hpp"

namespace wex {

/// The side-car file as it stands, joints still by name. Format: machines/m545/m545.toml.
struct Sidecar {
  struct Leg {
    std::string haa, hfe, steer;  ///< empty where the leg has no such joint
    std::string wheel;
  };
  struct Arm {
    std::vector<std::string> joints;
    std::string contact_link;
    Eigen::Vector3d contact_point_m = Eigen::Vector3d::Zero();
  };
  struct ActuationClass {
    std::string name;
    std::vector<std::string> joints;
    double dead_time_s = 0.0, lag_s = 0.0, hold_stiffness = 0.0, max_acceleration = 0.0;
  };

  double default_base_height_m = 0.0, belly_below_base_m = 0.0, min_turning_radius_m = 0.0;
  Eigen::Vector2d belly_min_m = Eigen::Vector2d::Zero(), belly_max_m = Eigen::Vector2d::Zero();
  double pump_flow_m3_s = 0.0, pump_pressure_pa = 0.0, dead_band = 0.0;
  double tyre_radius_m = 0.0, tyre_half_width_m = 0.0;
  double tyre_stiffness_n_m = 0.0, tyre_damping_ns_m = 0.0;
  std::array<Leg, kNumWheels> legs;  ///< indexed by Limb
  std::optional<Arm> arm;
  std::vector<ActuationClass> actuation;
  std::map<std::string, double> default_posture, transport_posture;
};

/// Reads and checks one side-car file; unknown and missing keys are errors. Never throws.
///   errors  kBadInput naming file, line and field
[[nodiscard]] Result<Sidecar> load_sidecar(const std::filesystem::path& path);

}  // namespace wex
