#include "hw_interface/electronics/zone_controller.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace wex::can {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kCylinder = 0, kSwing = 1, kWheel = 2;

class ZoneControllerTest : public ::testing::Test {
 protected:
  static ZoneController make() {
    ZoneController::Roles roles{};
    roles[kCylinder] = SlotRole::kCylinder;
    roles[kSwing] = SlotRole::kSwing;
    roles[kWheel] = SlotRole::kWheel;
    ZoneController::Limits limits{};
    limits[kCylinder] = {-1.0, 1.0, 0.5, 0.5};
    limits[kSwing] = {-kInfinity, kInfinity, 0.8, 0.3};
    limits[kWheel] = {-kInfinity, kInfinity, 2.5, 0.8};
    return {roles, limits};
  }
  const ZoneOutput& ask(int joint, double rate) {
    ZoneCommand command;
    command.active[joint] = true;
    command.rate[joint] = rate;
    return controller_.update(&command, position_, rate_);
  }
  const ZoneOutput& hold() { return controller_.update(nullptr, position_, rate_); }

  ZoneController controller_ = make();
  std::array<double, kMaxZoneJoints> position_{}, rate_{};
};

TEST_F(ZoneControllerTest, SpoolsUndoTheirDeadBand) {
  EXPECT_DOUBLE_EQ(ask(kCylinder, 0.5).spool[kCylinder], 1.0);
  EXPECT_DOUBLE_EQ(ask(kCylinder, -0.5).spool[kCylinder], -1.0);
  EXPECT_DOUBLE_EQ(ask(kCylinder, 0.25).spool[kCylinder], 0.05 + 0.95 * 0.5);
  EXPECT_DOUBLE_EQ(ask(kCylinder, 0.6).spool[kCylinder], 1.0) << "no further than open";
}

TEST_F(ZoneControllerTest, NextToNothingKeepsTheSpoolClosed) {
  EXPECT_EQ(ask(kCylinder, 0.0009).spool[kCylinder], 0.0);
  EXPECT_TRUE(controller_.neutral());
  EXPECT_NE(ask(kCylinder, 0.0011).spool[kCylinder], 0.0);
  EXPECT_FALSE(controller_.neutral());
}

TEST_F(ZoneControllerTest, HoldingRampsTheSpoolToNeutralWithin50Ms) {
  for (const double sign : {1.0, -1.0}) {
    ask(kCylinder, sign * 0.5);
    for (const double expected : {0.8, 0.6, 0.4, 0.2, 0.0}) {
      EXPECT_NEAR(hold().spool[kCylinder], sign * expected, 1e-12);
    }
    EXPECT_EQ(hold().spool[kCylinder], 0.0);
    EXPECT_TRUE(controller_.neutral());
  }
}

TEST_F(ZoneControllerTest, AnInactiveJointHoldsWhileOthersMove) {
  ask(kCylinder, 0.5);
  for (int i = 0; i < 6; ++i) ask(kSwing, 0.8);
  EXPECT_EQ(controller_.output().spool[kCylinder], 0.0);
  EXPECT_EQ(controller_.output().spool[kSwing], 1.0);
}

TEST_F(ZoneControllerTest, TheSwingBrakeClosesAfterStandstill) {
  ask(kSwing, 0.4);
  rate_[kSwing] = 0.4;
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(hold().brake[kSwing]) << "it still swings";
  rate_[kSwing] = 0.009;
  EXPECT_TRUE(hold().brake[kSwing]);
  rate_[kSwing] = 0.02;
  EXPECT_TRUE(hold().brake[kSwing]) << "closed is closed";
  EXPECT_FALSE(ask(kSwing, 0.1).brake[kSwing]);
}

TEST_F(ZoneControllerTest, AHoldingWheelRampsDownThenLatches) {
  ask(kWheel, 1.0);
  rate_[kWheel] = 1.0;
  double before = 1.0;
  int periods = 0;
  while (hold().wheel_rate[kWheel] > 0.0) {
    EXPECT_NEAR(before - controller_.output().wheel_rate[kWheel], std::min(0.3, before), 1e-9);
    EXPECT_FALSE(controller_.output().brake[kWheel]);
    before = controller_.output().wheel_rate[kWheel];
    ASSERT_LE(++periods, 10);
  }
  EXPECT_FALSE(hold().brake[kWheel]) << "1 rad/s is too fast to brake";
  rate_[kWheel] = 0.05;
  position_[kWheel] = 2.0;
  EXPECT_TRUE(hold().brake[kWheel]);
  position_[kWheel] = 2.01;
  EXPECT_NEAR(hold().wheel_rate[kWheel], -0.2, 1e-12) << "back to the angle it stood at";
  EXPECT_FALSE(ask(kWheel, 0.5).brake[kWheel]);
  EXPECT_EQ(controller_.output().wheel_rate[kWheel], 0.5);
}

TEST_F(ZoneControllerTest, ALatchedWheelDoesNotMindTheWrapOfItsAngle) {
  position_[kWheel] = std::numbers::pi - 0.001;
  hold();
  hold();
  ASSERT_TRUE(controller_.output().brake[kWheel]);
  position_[kWheel] = -std::numbers::pi + 0.001;
  EXPECT_NEAR(hold().wheel_rate[kWheel], -0.04, 1e-9);
}

TEST_F(ZoneControllerTest, AWheelOfWhichNothingIsAskedIsLatchedToo) {
  for (int i = 0; i < 3; ++i) ask(kWheel, 0.0);
  EXPECT_TRUE(controller_.output().brake[kWheel]);
}

TEST_F(ZoneControllerTest, AllBrakesAreClosedWhenSwingAndWheelsAre) {
  hold();
  hold();
  EXPECT_TRUE(controller_.brakes_closed());
  ask(kWheel, 0.5);
  EXPECT_FALSE(controller_.brakes_closed());
}

TEST_F(ZoneControllerTest, WheelsNeverExceedTheirLimit) {
  ask(kWheel, 2.5);
  EXPECT_EQ(controller_.output().wheel_rate[kWheel], 2.5);
  hold();
  for (int i = 0; i < 200; ++i) hold();
  position_[kWheel] = 3.0;
  EXPECT_EQ(hold().wheel_rate[kWheel], -2.5);
}

}  // namespace
}  // namespace wex::can
