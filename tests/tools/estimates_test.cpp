// Wheel height bias and support margin, both from measured coordinates.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "initializer/make_plan.hpp"
#include "tools/wex/height_bias.hpp"
#include "tools/wex/support_margin.hpp"

namespace wex::app {
namespace {

class Estimates : public ::testing::Test {
 protected:
  Estimates() : terrain_(flat()), machine_(*load_machine()) {
    q_ = *standing_posture(terrain_, machine_, {15.0, 8.0, 0.3});
  }
  static TerrainMap flat() {
    Grid grid;
    grid.size_x = 300;
    grid.size_y = 160;
    grid.values.assign(300 * 160, 2.0f);
    return *TerrainMap::build(std::move(grid));
  }
  TerrainMap terrain_;
  MachineModel machine_;
  Eigen::VectorXd q_;
};

TEST_F(Estimates, AStandingPostureHasNoHeightBias) {
  HeightBias bias(terrain_, machine_);
  bias.update(0.0, q_);
  for (const double value : bias.value_m()) EXPECT_NEAR(value, 0.0, 2e-3);
}

TEST_F(Estimates, TheFirstHeightIsTakenAtOnceAndChangesAreLowPassed) {
  constexpr double kTimeConstant = 0.5, kRaise = 0.02;
  HeightBias bias(terrain_, machine_, kTimeConstant);
  Eigen::VectorXd raised = q_;
  raised[kBaseZ] += kRaise;
  bias.update(10.0, raised);
  const double first = bias.value_m()[0];
  EXPECT_NEAR(first, kRaise, 2e-3);
  bias.update(10.0 + kTimeConstant, q_);
  EXPECT_NEAR(bias.value_m()[0], first - kRaise * (1.0 - std::exp(-1.0)), 1e-6);
  EXPECT_THROW(bias.update(9.0, q_), std::logic_error);
}

// Where the hips were told to be is not where the ground is: a drive would follow its own error.
TEST_F(Estimates, HipsThatAreBentAgainstEachOtherAreNoGround) {
  constexpr double kBend = 0.03;
  constexpr std::array<double, kNumWheels> kWarp{1.0, -1.0, -1.0, 1.0};  // LF and RH, RF and LH
  Eigen::VectorXd bent = q_;
  for (int i = 0; i < kNumWheels; ++i) bent[machine_.legs[i].hfe] += kBend * kWarp[i];
  bent[kBaseZ] += 0.02;
  HeightBias bias(terrain_, machine_);
  bias.update(0.0, bent);
  for (const double value : bias.value_m()) EXPECT_NEAR(value, 0.02, 5e-3);
}

TEST_F(Estimates, ATiltedBaseIsTakenAsItIs) {
  constexpr double kRoll = 0.02;  // the left side goes up
  Eigen::VectorXd tilted = q_;
  tilted[kBaseRoll] += kRoll;
  HeightBias bias(terrain_, machine_);
  bias.update(0.0, tilted);
  EXPECT_GT(bias.value_m()[0], 0.01);
  EXPECT_NEAR(bias.value_m()[1], -bias.value_m()[0], 5e-3);
}

TEST_F(Estimates, FourWheelsSupportBetterThanThreeAndTwoNotAtAll) {
  const double four_m = support_margin_m(machine_, q_, kDrivingContacts);
  EXPECT_GT(four_m, 0.9);
  EXPECT_LT(four_m, 1.6);  // half the track bounds it
  ContactFlags three = kDrivingContacts;
  three[0] = false;
  EXPECT_LT(support_margin_m(machine_, q_, three), four_m);
  three[1] = false;
  EXPECT_EQ(support_margin_m(machine_, q_, three), -std::numeric_limits<double>::infinity());
}

TEST_F(Estimates, TheMarginDoesNotDependOnWhereTheMachineStandsAndHeads) {
  const double here_m = support_margin_m(machine_, q_, kDrivingContacts);
  Eigen::VectorXd elsewhere = q_;
  elsewhere[kBaseX] += 3.0;
  elsewhere[kBaseY] -= 2.0;
  elsewhere[kBaseYaw] += 2.1;
  EXPECT_NEAR(support_margin_m(machine_, elsewhere, kDrivingContacts), here_m, 1e-9);
}

TEST_F(Estimates, TheMarginIsNegativeWhenTheCentreOfMassIsOutside) {
  Eigen::VectorXd tilted = q_;
  tilted[kBaseRoll] = 1.2;
  EXPECT_LT(support_margin_m(machine_, tilted, kDrivingContacts), 0.0);
}

}  // namespace
}  // namespace wex::app
