#pragma once

#include <vector>

#include "models/types/pose.hpp"

namespace wex {

/// One arc or straight piece of a drivable path of the base origin, at constant gear and curvature.
struct PathSegment {
  Pose2 start;                 ///< world frame; yaw is continuous along a path
  double curvature_1_m = 0.0;  ///< as steered: positive turns left when driving forward
  double length_m = 0.0;       ///< signed, negative drives backwards
};
using DrivePath = std::vector<PathSegment>;

/// What a path costs beside its length, in metres of forward driving.
struct PathCostWeights {
  double cusp_m = 1.5;         ///< per change of direction: a stop, and rolling out of it
  double reverse_share = 0.2;  ///< extra share per metre driven backwards
};

/// Pose after `distance_m` (signed, as PathSegment::length_m) along a segment.
[[nodiscard]] Pose2 pose_along(const PathSegment& segment, double distance_m);

/// Appends `more`, which starts where `path` ends, its yaw shifted by whole turns to be continuous.
void append_path(DrivePath& path, const DrivePath& more);

/// The same way in the same gears, segments of no length aside.
[[nodiscard]] bool same_way(const DrivePath& a, const DrivePath& b);

[[nodiscard]] double path_length_m(const DrivePath& path);
/// Length plus the penalties of the weights; every change of gear between segments is a cusp.
[[nodiscard]] double path_cost_m(const DrivePath& path, const PathCostWeights& weights);

/// A sample of a path.
struct Station {
  double s_m = 0.0;  ///< distance driven so far, never decreasing
  Pose2 pose;
  double gear = 1.0;  ///< +1 or -1, of the piece that leads here (of the first piece at the start)
  bool stop = false;  ///< start, end, or a change of direction
};

/// Samples at most `max_spacing_m` apart, with every segment end among them, and at least two steps
/// between any two stops so that there is a place to move at speed. Segments shorter than a
/// micrometre are left out.
///   path  not empty (contract)
[[nodiscard]] std::vector<Station> path_stations(const DrivePath& path, double max_spacing_m);

/// Mean steered curvature over `window_m` around every station: Reeds-Shepp curvature jumps, a
/// steering cylinder cannot. Rises from zero over half a window at the start, where the wheels
/// stand straight.
[[nodiscard]] std::vector<double> steered_curvature_1_m(const DrivePath& path,
                                                        const std::vector<Station>& stations,
                                                        double window_m);

/// Mean of the piecewise linear function through (s, value) over a window around every sample.
/// Point symmetric beyond the ends, so that end values and straight lines are kept.
///   s  not decreasing, as long as values (contract)
[[nodiscard]] std::vector<double> moving_average(const std::vector<double>& s,
                                                 const std::vector<double>& values,
                                                 double window_m);

}  // namespace wex
