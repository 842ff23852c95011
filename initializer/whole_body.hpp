#pragma once

#include <vector>

#include "initializer/drive_path.hpp"
#include "initializer/pose_check.hpp"
#include "models/types/plan.hpp"
#include "models/types/result.hpp"

namespace wex {

/// Distances over which a path is smoothed into whole-body nodes.
struct SmoothingSettings {
  double steering_window_m = 2.0;  ///< curvature is averaged over this
  double base_window_m = 1.5;      ///< base height, pitch and roll, twice in a row
};

/// Why a path cannot be followed: the station, and what is wrong there.
struct PathFailure {
  std::size_t station = 0;
  StandingPose pose;
};

/// Full coordinates of a standing pose: everything not in `pose` in transport posture.
[[nodiscard]] Eigen::VectorXd coordinates_of(const MachineModel& machine, const StandingPose& pose);

/// Whole-body nodes at the stations of a path, untimed. Base height, roll and pitch by Algorithm 1
/// at every station, then smoothed along the path as far as every node passes the pose check
/// (Algorithm 1 has no memory and so may jump between neighbours); steering for the smoothed
/// curvature; wheels turned by the way they roll.
///   errors  the first station at which the machine cannot stand, steering included
[[nodiscard]] Result<std::vector<WholeBodyNode>, PathFailure> whole_body_nodes(
    const PoseCheck& check, const MachineModel& machine, const DrivePath& path,
    const std::vector<Station>& stations, const SmoothingSettings& smoothing = {});

}  // namespace wex
