#pragma once

#include "models/terrain/terrain_map.hpp"
#include "mpc/nlp/trajectory_problem.hpp"

namespace wex {

/// What the refinement and the receding horizon share.
struct DrivingConstraintSettings {
  double min_stability_margin_m = 0.25;
  double min_signed_distance_m = 0.15;
  double rate_fraction = 0.9;
  std::array<double, kNumWheels> height_bias_m{};
  Softness height{}, stability{}, traversability{};  ///< all hard by default
};

/// Adds every constraint of driving on four wheels to a setup whose machine, layout and dt are set.
void add_driving_constraints(TrajectorySetup& setup, const TerrainMap& terrain,
                             const DrivingConstraintSettings& settings);

}  // namespace wex
