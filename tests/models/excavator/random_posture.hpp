#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <numbers>
#include <random>

#include "models/excavator/machine_model.hpp"

namespace wex::test {

/// Joints anywhere within their limits, continuous ones over a full turn, base within a few metres
/// and 0.5 rad of level.
inline Eigen::VectorXd random_posture(const MachineModel& machine, std::mt19937& generator) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Eigen::VectorXd q(machine.num_coordinates());
  for (int i = kBaseX; i <= kBaseZ; ++i) q[i] = 3.0 * unit(generator);
  q[kBaseYaw] = std::numbers::pi * unit(generator);
  q[kBasePitch] = 0.5 * unit(generator);
  q[kBaseRoll] = 0.5 * unit(generator);
  for (int i = 0; i < machine.num_joints(); ++i) {
    const Joint& joint = machine.joints[i];
    const double lower = std::max(joint.lower, -std::numbers::pi);
    const double upper = std::min(joint.upper, std::numbers::pi);
    q[kNumBaseCoordinates + i] = lower + 0.5 * (unit(generator) + 1.0) * (upper - lower);
  }
  return q;
}

}  // namespace wex::test
