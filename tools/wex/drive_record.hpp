#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hw_interface/machine_io.hpp"
#include "models/types/plan.hpp"
#include "models/types/result.hpp"

namespace wex::app {

/// Load from which on an executed contact counts as one [N].
inline constexpr double kContactLoadN = 1000.0;

/// One line of the executed motion, for files, plots and judging. Local world frame; t = 0 when
/// control began.
struct DriveSample {
  double t_s = 0.0;
  BaseCoordinates base{};
  Eigen::VectorXd scalar_joints;  ///< joints of model.xml in its order
  ContactFlags contacts{};  ///< measured load over kContactLoadN; scheduled where none is measured
  std::array<Eigen::Vector2d, kNumWheels> wheel_m{};  ///< wheel centres, xy
  double scheduled_margin_m = 0.0;  ///< centre of mass to the edge of the scheduled wheels
  double loaded_margin_m = 0.0;     ///< the same of the wheels that carry load
  double reference_time_s = 0.0, reference_error_m = 0.0;
  double goal_distance_m = 0.0;
};

/// One call of the receding-horizon optimizer.
struct SolveSample {
  double t_s = 0.0;         ///< when it began, time of the drive
  double applied_s = 0.0;   ///< when its result took effect
  double cpu_time_s = 0.0;  ///< thread CPU time
  int iterations = 0;
  bool feasible = false, usable = false;
  bool late = false;  ///< there only after the moment it was computed for
};

/// Integrals and extremes over the drive. What only a simulation's ground truth knows is NaN on a
/// machine without one.
struct DriveExtremes {
  double max_roll_rad = 0.0, max_pitch_rad = 0.0;
  double min_scheduled_margin_m = 0.0, min_loaded_margin_m = 0.0;
  double max_wheel_penetration_m = 0.0;
  double max_tyre_deflection_m = 0.0;
  double max_reference_error_m = 0.0;
  double hold_vertical_rate_m_s = 0.0;  ///< largest while holding still at the end
  std::array<double, kNumWheels> side_slip_m{}, travel_m{}, airborne_s{};
};

/// What happened between the first command and the end of the final hold.
struct DriveRecord {
  std::vector<DriveSample> samples;
  std::vector<SolveSample> solves;
  std::map<std::string, double> worst_residual;  ///< per constraint, over all usable solves
  DriveExtremes extremes;
  std::optional<Error> failure;  ///< kStoppedSafely or kOutOfLimits; nothing: the goal is reached
  double duration_s = 0.0;       ///< machine time without the final hold
  double simulated_s = 0.0;      ///< machine time with it
  double goal_error_m = 0.0, goal_error_rad = 0.0;
  MachineHealth health;
};

}  // namespace wex::app
