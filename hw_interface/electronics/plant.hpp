#pragma once

#include <Eigen/Core>
#include <array>

#include "models/types/machine_io_types.hpp"
#include "models/types/pose.hpp"

namespace wex::can {

/// What the sensors and the localisation unit say at one moment. Joint order as in
/// MachineModel::joints, SI units; base in the local world frame.
struct PlantState {
  std::array<double, kMaxJoints> position{}, rate{}, effort{};
  BaseCoordinates base = BaseCoordinates::Zero();
  Eigen::Matrix<double, 6, 1> base_velocity = Eigen::Matrix<double, 6, 1>::Zero();
  bool sensors_valid = false, base_pose_valid = false;
};

/// What the electronics' outputs do for one control period.
struct PlantInput {
  std::array<double, kMaxJoints> spool{};       ///< valve opening in [-1, 1]; unused for wheels
  std::array<double, kMaxJoints> wheel_rate{};  ///< drives and their brakes, rad/s; wheels only
  std::array<bool, kMaxJoints> braked{};  ///< wheels: the brake is closed, no valve delays its rate
  /// False: the load-holding valves shut whatever the spools do (springs, within 50 ms): no flow.
  /// The machine stands on its legs, so nothing here ever lets pressure out of one.
  bool motion_released = false;
};

/// The hydraulics and mechanics behind the electronics: simulated, or a test's.
class Plant {
 public:
  virtual ~Plant() = default;
  [[nodiscard]] virtual PlantState sense() noexcept = 0;
  /// Takes effect for the next control period; a simulated plant lives through that period here.
  virtual void act(const PlantInput& input) noexcept = 0;
};

}  // namespace wex::can
