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

  /// Is the brake of `joint` closed after a period at this measured rate?
  bool closes_at(int joint, double rate) {
    ZoneController fresh = make();
    rate_[joint] = rate;
    return fresh.update(nullptr, position_, rate_).brake[joint];
  }

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

TEST_F(ZoneControllerTest, TheSlowestRateOpensTheSpool) {
  ZoneControllerSettings settings;
  settings.rest_rate_fraction = 0.25;
  ZoneController::Roles roles{};
  roles.fill(SlotRole::kCylinder);
  ZoneController::Limits limits{};
  limits.fill({-1.0, 1.0, 0.5, 0.5});
  controller_ = ZoneController(roles, limits, settings);
  for (int joint = 0; joint < kMaxZoneJoints; ++joint) {
    EXPECT_NE(ask(joint, 0.125).spool[joint], 0.0);
    EXPECT_EQ(ask(joint, std::nextafter(0.125, 0.0)).spool[joint], 0.0);
  }
}

TEST_F(ZoneControllerTest, PlacesThatTheZoneDoesNotHaveStayShut) {
  const ZoneOutput& output = ask(3, 1.0);
  EXPECT_EQ(output.spool[3], 0.0);
  EXPECT_EQ(output.wheel_rate[3], 0.0);
  EXPECT_FALSE(output.brake[3]);
}

TEST_F(ZoneControllerTest, HoldingRampsTheSpoolToNeutralWithin50Ms) {
  for (const double sign : {1.0, -1.0}) {
    ask(kCylinder, sign * 0.5);
    for (const double expected : {0.8, 0.6, 0.4, 0.2, 0.0}) {
      EXPECT_NEAR(hold().spool[kCylinder], sign * expected, 1e-12);
    }
    EXPECT_EQ(hold().spool[kCylinder], 0.0);
    EXPECT_TRUE(controller_.neutral());
    EXPECT_FALSE(controller_.output().brake[kCylinder]) << "it has none";
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

TEST_F(ZoneControllerTest, TheSwingBrakeStaysOpenWhileItsSpoolIs) {
  ask(kSwing, 0.8);
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(hold().brake[kSwing]) << "it stands, but may yet swing";
  EXPECT_TRUE(hold().brake[kSwing]);
}

TEST_F(ZoneControllerTest, BrakesCloseBelowTheirRates) {
  EXPECT_FALSE(closes_at(kSwing, 0.01));
  EXPECT_TRUE(closes_at(kSwing, std::nextafter(0.01, 0.0)));
  EXPECT_FALSE(closes_at(kWheel, -0.06));
  EXPECT_TRUE(closes_at(kWheel, std::nextafter(-0.06, 0.0)));
}

TEST_F(ZoneControllerTest, WheelsAndCabinGetTheirShareOfWhatIsAsked) {
  ZoneCommand command;
  command.active = {true, true, true};
  command.rate = {0.25, 0.4, 2.0};
  const ZoneOutput& output = controller_.update(&command, position_, rate_, 0.25, 0.5);
  EXPECT_NEAR(output.spool[kCylinder], 0.05 + 0.95 * 0.5, 1e-12) << "all of it";
  EXPECT_NEAR(output.spool[kSwing], 0.05 + 0.95 * 0.25, 1e-12);
  EXPECT_NEAR(output.wheel_rate[kWheel], 0.5, 1e-12);
  controller_.update(&command, position_, rate_);
  EXPECT_NEAR(output.spool[kSwing], 0.05 + 0.95 * 0.5, 1e-12);
  EXPECT_NEAR(output.wheel_rate[kWheel], 2.0, 1e-12);
}

TEST_F(ZoneControllerTest, AWheelIsLeftToItsBrakeBelowAMillirad) {
  EXPECT_FALSE(ask(kWheel, 1e-3).brake[kWheel]);
  EXPECT_TRUE(ask(kWheel, std::nextafter(1e-3, 0.0)).brake[kWheel]);
}

TEST_F(ZoneControllerTest, AHoldingWheelRampsDownThenLatches) {
  ask(kWheel, 1.0);
  rate_[kWheel] = 1.0;
  for (const double expected : {0.7, 0.4, 0.1, 0.0}) {
    EXPECT_NEAR(hold().wheel_rate[kWheel], expected, 1e-9);
    EXPECT_FALSE(controller_.output().brake[kWheel]);
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
  for (const int joint : {kSwing, kWheel}) {
    ask(joint, 0.5);
    EXPECT_FALSE(controller_.brakes_closed()) << joint;
    for (int i = 0; i < 10; ++i) hold();
    EXPECT_TRUE(controller_.brakes_closed());
  }
}

TEST_F(ZoneControllerTest, TheBrakeOfAnyPlaceCounts) {
  for (int joint = 0; joint < kMaxZoneJoints; ++joint) {
    ZoneController::Roles roles{};
    roles[joint] = SlotRole::kWheel;
    ZoneController::Limits limits{};
    limits[joint] = {-kInfinity, kInfinity, 2.5, 0.8};
    controller_ = ZoneController(roles, limits);
    EXPECT_FALSE(controller_.brakes_closed()) << joint;
    hold();
    EXPECT_TRUE(controller_.brakes_closed()) << joint;
  }
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
