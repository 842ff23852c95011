#include "hw_interface/mujoco/simulated_plant.hpp"

#include <gtest/gtest.h>

#include "tests/hw_interface/test_ground.hpp"

namespace wex {
namespace {

const MachineModel& m545() {
  static const MachineModel machine = load_machine().value();
  return machine;
}

// In free fall, so that nothing but the actuator itself is in the way.
TEST(SimulatedPlant, EveryJointReachesItsRateLimitOnceDeadTimeAndLagAreOver) {
  constexpr double kFall_m = 60.0, kLags = 4.0;
  for (int i = 0; i < m545().num_joints(); ++i) {
    const Joint& joint = m545().joints[i];
    Eigen::VectorXd q = standing_on_plane(m545());
    q[kBaseZ] += kFall_m;
    const auto plant = SimulatedPlant::create(m545(), flat_ground(), q).value();
    const double start = q[kNumBaseCoordinates + i];
    const double sign = joint.continuous || joint.upper - start > start - joint.lower ? 1.0 : -1.0;
    can::PlantInput input;
    input.motion_released = true;
    input.spool[i] = sign;
    if (joint.role == JointRole::kWheel) input.wheel_rate[i] = sign * joint.max_rate;
    while (plant->time_s() < joint.dead_time_s + kLags * joint.lag_s) plant->act(input);
    const double rate = sign * plant->measure().rate[i];
    EXPECT_NEAR(rate, joint.max_rate, 0.05 * joint.max_rate) << joint.name;
  }
}

// On its wheels, the cabin with its arm: it gets to its rate, and its motor never beyond its
// torque.
TEST(SimulatedPlant, TheCabinReachesItsRateWithinItsTorque) {
  const int turn = m545().arm->coordinates.front() - kNumBaseCoordinates;
  const Joint& joint = m545().joints[turn];
  const auto plant =
      SimulatedPlant::create(m545(), flat_ground(), standing_on_plane(m545())).value();
  ASSERT_TRUE(plant->settle());
  can::PlantInput input;
  input.motion_released = true;
  input.spool[turn] = 1.0;
  double hardest = 0.0, fastest = 0.0;
  while (plant->time_s() < 2.0) {
    plant->act(input);
    hardest = std::max(hardest, std::abs(plant->measure().effort[turn]));
    fastest = std::max(fastest, plant->measure().rate[turn]);
  }
  EXPECT_LE(hardest, joint.max_effort);
  EXPECT_GT(hardest, 0.1 * joint.max_effort);
  EXPECT_NEAR(fastest, joint.max_rate, 0.05 * joint.max_rate);
}

TEST(SimulatedPlant, ValuesThatWereNeverSetAreZero) {
  const GroundTruth truth;
  EXPECT_EQ(truth.base.norm(), 0.0);
  const MachineState state;
  EXPECT_EQ(state.base.norm(), 0.0);
  EXPECT_EQ(state.base_velocity.norm(), 0.0);
}

}  // namespace
}  // namespace wex
