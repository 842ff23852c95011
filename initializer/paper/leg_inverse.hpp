#pragma once

#include <optional>

#include "models/excavator/machine_model.hpp"
#include "models/terrain/terrain_map.hpp"
#include "models/types/pose.hpp"
#include "models/types/result.hpp"

namespace wex {

/// Joints of a leg that rests on the ground.
struct LegJoints {
  double haa_rad = 0.0, hfe_rad = 0.0, steer_rad = 0.0;
};

/// Inverse kinematics of standing wheels with a given hip abduction, by the whole machine's
/// kinematics: hip flexion that rests the disc on the ground, steering that rolls along the base's
/// path or is left as it is. For the few wheels that stand with their hip spread; one per thread.
class LegInverse {
 public:
  LegInverse(const TerrainMap& terrain, const MachineModel& machine, double min_signed_distance_m);

  ///   curvature_1_m  of the path to roll along; if not given, the guess's steering is kept
  ///   guess          to begin with; its hip abduction is kept
  ///   errors         why the wheel cannot stand so
  [[nodiscard]] Result<LegJoints, const char*> rest(const BaseCoordinates& base, std::size_t leg,
                                                    std::optional<double> curvature_1_m,
                                                    const LegJoints& guess);
  /// Height of a wheel above the tyre-dilated ground; NaN off the map or over unknown ground.
  [[nodiscard]] double clearance_m(const BaseCoordinates& base, std::size_t leg,
                                   const LegJoints& joints);
  /// Of the wheel's disc above where it would rest; NaN likewise.
  [[nodiscard]] double gap_m(const BaseCoordinates& base, std::size_t leg, const LegJoints& joints);

 private:
  void update(std::size_t leg, const LegJoints& joints);
  [[nodiscard]] double gap_m(std::size_t leg) const;
  [[nodiscard]] bool on_good_ground(std::size_t leg) const;
  [[nodiscard]] double heading_error_rad(std::size_t leg, double curvature_1_m) const;

  const TerrainMap& terrain_;
  const MachineModel& machine_;
  double min_distance_m_;
  KinematicTree::Workspace workspace_;
  Eigen::VectorXd q_;
};

}  // namespace wex
