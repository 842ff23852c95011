#include "initializer/internal/direct_paths.hpp"

#include <ompl/base/spaces/DubinsStateSpace.h>

#include <algorithm>

#include "initializer/internal/se2_search.hpp"

namespace wex {
namespace {

namespace ob = ompl::base;

DrivePath dubins_path(const Pose2& from, const Pose2& to, double turning_radius_m) {
  const ob::DubinsStateSpace space(turning_radius_m);
  const auto state_of = [&](const Pose2& pose) {
    auto* state = space.allocState()->as<ob::SE2StateSpace::StateType>();
    state->setXY(pose.x_m, pose.y_m);
    state->setYaw(wrap_angle(pose.yaw_rad));
    return state;
  };
  auto* a = state_of(from);
  auto* b = state_of(to);
  const ob::DubinsStateSpace::DubinsPath curve = space.dubins(a, b);
  space.freeState(a);
  space.freeState(b);

  DrivePath path;
  Pose2 pose = from;
  for (int i = 0; i < 3; ++i) {
    const double turn = curve.type_[i] == ob::DubinsStateSpace::DUBINS_LEFT    ? 1.0
                        : curve.type_[i] == ob::DubinsStateSpace::DUBINS_RIGHT ? -1.0
                                                                               : 0.0;
    path.push_back({pose, turn / turning_radius_m, curve.length_[i] * turning_radius_m});
    pose = pose_along(path.back(), path.back().length_m);
  }
  return path;
}

// The same ground track driven from its end to its start, tail first.
DrivePath in_reverse(const DrivePath& path, double first_yaw_rad) {
  DrivePath reversed;
  for (auto segment = path.rbegin(); segment != path.rend(); ++segment) {
    reversed.push_back(
        {pose_along(*segment, segment->length_m), segment->curvature_1_m, -segment->length_m});
  }
  const double shift_rad = first_yaw_rad - reversed.front().start.yaw_rad;
  for (PathSegment& segment : reversed) segment.start.yaw_rad += shift_rad;
  return reversed;
}

}  // namespace

std::vector<DrivePath> direct_paths(const Pose2& from, const Pose2& to, double turning_radius_m,
                                    const PathCostWeights& weights) {
  std::vector<DrivePath> paths{reeds_shepp_path(from, to, turning_radius_m),
                               dubins_path(from, to, turning_radius_m),
                               in_reverse(dubins_path(to, from, turning_radius_m), from.yaw_rad)};
  std::stable_sort(paths.begin(), paths.end(), [&](const DrivePath& a, const DrivePath& b) {
    return path_cost_m(a, weights) < path_cost_m(b, weights);
  });
  paths.erase(std::unique(paths.begin(), paths.end(), same_way), paths.end());
  return paths;
}

}  // namespace wex
