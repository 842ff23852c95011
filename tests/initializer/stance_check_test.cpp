#include "initializer/stepping/stance_check.hpp"

#include <gmock/gmock.h>

#include "initializer/stepping/stance_polygon.hpp"
#include "models/terrain/wheel_rest.hpp"
#include "test_worlds.hpp"

namespace wex {
namespace {

const StanceTables& tables() {
  static const StanceTables made = *StanceTables::build(test_machine());
  return made;
}

BaseCoordinates base_at(double x, double z, double pitch_rad = 0.0, double yaw_rad = 0.0,
                        double y = 0.0, double roll_rad = 0.0) {
  BaseCoordinates base;
  base << x, y, z, yaw_rad, pitch_rad, roll_rad;
  return base;
}

constexpr std::uint8_t kFrontWheels = 0b0011, kRearWheels = 0b1100, kAllWheels = 0b1111;

struct World {
  explicit World(const HeightFunction& height, double size_x_m = 24.0, double size_y_m = 14.0)
      : map(make_map(size_x_m, size_y_m, height)), ground(map), check(ground, tables()) {}
  [[nodiscard]] Stance stance(const BaseCoordinates& base, int steering = kSteeredStraight) const {
    return check.stance(BaseFrame::from(base), steering, StanceClearances{});
  }
  TerrainMap map;
  StanceGround ground;
  StanceCheck check;
};

double flat(double, double) { return 0.0; }
/// Pit 2 m deep over 0 < x < 2.
double pit(double x, double) { return x > 0.0 && x < 2.0 ? -2.0 : 0.0; }

TEST(StanceTables, AgreeWithTheKinematicTree) {
  const MachineModel& machine = test_machine();
  KinematicTree::Workspace w = machine.tree.make_workspace();
  Eigen::VectorXd q = Eigen::VectorXd::Zero(machine.num_coordinates());
  q.tail(machine.num_joints()) = machine.transport_posture();
  Eigen::Vector3d moment = tables().moment_chassis_base + tables().moment_folded_base.front();
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    const LegSample& sample = tables().legs[i][kSteeredStraight].samples[7 + i];
    q[machine.legs[i].hfe] = sample.hfe_rad;
    moment += sample.moment_base;
  }
  machine.tree.update(q, w);
  constexpr double kTolerance = 1e-9;
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    const WheeledLeg& leg = machine.legs[i];
    EXPECT_LT((tables().legs[i][kSteeredStraight].samples[7 + i].p_base_wheel -
               machine.tree.position(w, leg.carrier_body, leg.p_carrier_wheel))
                  .norm(),
              kTolerance);
  }
  EXPECT_LT((moment / tables().mass_kg - machine.tree.com(w)).norm(), kTolerance);
}

TEST(StanceTables, LegsAreSweptFromHighToLow) {
  for (const auto& leg : tables().legs) {
    for (const LegSweep& sweep : leg) {
      EXPECT_GT(sweep.samples.front().p_base_wheel.z(),
                sweep.samples.back().p_base_wheel.z() + 1.0);
    }
  }
}

TEST(ArmTable, PosturesReachTheirPlaceWithinHalfACell) {
  const ArmPlane& plane = tables().arm.plane();
  int num_postures = 0;
  for (const double forward : {3.0, 4.52, 6.0, 7.0}) {
    for (const double up : {-2.4, -0.98, 0.3}) {
      const auto span = tables().arm.postures({forward, up});
      for (const auto* posture = span.begin; posture != span.end; ++posture, ++num_postures) {
        const auto exact = plane.reach({forward, up}, posture->tele_m, posture->attitude_rad);
        ASSERT_TRUE(exact);
        const ArmPlane::Points points = plane.points(*exact);
        EXPECT_LT(std::abs(points.contact - std::complex<double>(forward, up)), 1e-9);
        EXPECT_NEAR(points.moment.real(), posture->moment_forward, 0.1 * 2700.0);
      }
    }
  }
  EXPECT_GT(num_postures, 30);
}

TEST(ArmTable, ReachGrowsWithTheAttitudeOutwards) {
  // limits.md: 7.05 m at 0, 8.1 m at 45 degrees, base 0.95 m above the contact.
  const ArmPlane& plane = tables().arm.plane();
  const auto reach_m = [&](double attitude_rad) {
    double farthest = 0.0;
    for (double forward = 5.0; forward < 9.0; forward += 0.01) {
      for (double tele = plane.tele().lower; tele <= plane.tele().upper; tele += 0.02) {
        if (plane.reach({forward, -0.95}, tele, attitude_rad)) farthest = forward;
      }
    }
    return std::hypot(farthest, plane.lateral_m());
  };
  EXPECT_NEAR(reach_m(0.0), 7.05, 0.15);
  EXPECT_NEAR(reach_m(0.785), 8.1, 0.15);
}

TEST(StanceGround, StandsBesideARimButNotOnIt) {
  const World world(pit);
  EXPECT_GT(world.ground.clear_m(-0.35, 0.0), 0.15);
  EXPECT_LT(world.ground.clear_m(-0.05, 0.0), 0.15);
  EXPECT_LT(world.ground.clear_m(0.3, 0.0), 0.0) << "beside the wall of the pit";
  EXPECT_GT(world.ground.clear_m(1.0, 0.0), 0.15) << "the floor itself is good ground";
}

TEST(StanceGround, OffTheMapEverythingIsRefused) {
  const World world(flat);
  EXPECT_GT(world.ground.dilated_m(12.2, 0.0), 100.0);
  EXPECT_GT(world.ground.highest_m(0.0, -9.0), 100.0);
  EXPECT_LT(world.ground.clear_m(-40.0, 0.0), 0.0);
}

TEST(StanceGround, AtACliffTheTopSideCountsForTyresThatMustStayClear) {
  // 1 m up from the cell at x = 3; a tyre touches that from 0.6 m before.
  const World world([](double x, double) { return x > 2.95 ? 1.0 : 0.0; });
  const StanceGround& ground = world.ground;
  EXPECT_NEAR(ground.dilated_m(2.35, 0.0), 0.5 * (0.0 + 0.4), 1e-3);
  EXPECT_NEAR(ground.dilated_top_side_m(2.35, 0.0), 0.4, 1e-3) << "0.4 m between two cells";
  EXPECT_NEAR(ground.dilated_top_side_m(2.31, 0.0), 0.4, 1e-3);
  EXPECT_NEAR(ground.dilated_top_side_m(2.25, 0.0), 0.0, 1e-3) << "before it";
  EXPECT_EQ(ground.dilated_top_side_m(2.75, 0.0), ground.dilated_m(2.75, 0.0))
      << "0.1 m from cell to cell is no cliff";
}

TEST(StanceGround, OnSlopesAndBumpsTheTopSideIsTheGround) {
  const World world([](double x, double y) { return 0.5 * x + 0.5 * bumps(x, y); });
  for (double x = -4.0; x < 4.0; x += 0.23) {
    for (double y = -3.0; y < 3.0; y += 0.31) {
      EXPECT_EQ(world.ground.dilated_top_side_m(x, y), world.ground.dilated_m(x, y));
    }
  }
}

TEST(StanceCheck, StandsOnFlatGroundAtTheDefaultHeight) {
  const World world(flat);
  const Stance stance = world.stance(base_at(0.0, 0.95));
  EXPECT_TRUE(stance.allows(0));
  EXPECT_TRUE(stance.allows(0b0011));
  EXPECT_TRUE(stance.allows(0b1100));
  for (const Eigen::Vector3d& p : stance.p_world_wheel) EXPECT_NEAR(p.z(), 0.6, 1e-3);
  EXPECT_GT(world.check.margin_on_wheels(BaseFrame::from(base_at(0.0, 0.95)), stance), 0.8);
}

TEST(StanceCheck, ChassisTooLowOrLegsTooShort) {
  const World world(flat);
  EXPECT_FALSE(world.stance(base_at(0.0, 0.38)).belly_clear);
  EXPECT_EQ(world.stance(base_at(0.0, 1.8)).grounded, 0);
  EXPECT_EQ(world.stance(base_at(0.0, 1.8)).fault[0], LegFault::kTooLow);
}

TEST(StanceCheck, WheelOffTheMapIsARefusalAndNotALiftedWheel) {
  const World world(flat);
  const Stance stance = world.stance(base_at(10.0, 0.95));
  EXPECT_EQ(stance.grounded, 0b1100);
  EXPECT_EQ(stance.swing_clear, 0b1100);
  EXPECT_FALSE(stance.allows(0b0011));
}

TEST(StanceCheck, WheelsOverAPitCanOnlyBeLifted) {
  const World world(pit);
  const Stance stance = world.stance(base_at(-1.4, 0.95));
  EXPECT_EQ(stance.grounded, 0b1100);
  EXPECT_TRUE(stance.allows(0b0011));
  EXPECT_FALSE(stance.allows(0));
}

TEST(StanceCheck, ClawsAreKeptOffAWallBehind) {
  // Claws reach from behind the hind wheels, at x = -2.3, to -3.2, a metre above the ground.
  const auto stance_before = [](double wall_x_m, double height_m) {
    const World world([&](double x, double) { return x < wall_x_m + 0.05 ? height_m : 0.0; });
    return world.stance(base_at(0.0, 0.95));
  };
  ASSERT_TRUE(tables().legs[2][kSteeredStraight].has_claw);
  const Stance near = stance_before(-3.2, 1.5);
  EXPECT_EQ(near.grounded, kFrontWheels);
  EXPECT_EQ(near.fault[2], LegFault::kBeam);
  EXPECT_EQ(near.fault[3], LegFault::kBeam);
  EXPECT_EQ(stance_before(-3.6, 1.5).grounded, kAllWheels);
  EXPECT_EQ(stance_before(-3.2, 0.4).grounded, kAllWheels) << "they stand out over it";
}

TEST(StanceCheck, AClawThatWouldMeetAWallOnItsWayUpMayNotBeLifted) {
  // The base is high: claws hang down, and stand out 0.2 m farther while they pass the level.
  const auto stance_before = [](double wall_x_m) {
    const World world([&](double x, double) { return x < wall_x_m + 0.05 ? 1.6 : 0.0; });
    return world.stance(base_at(0.0, 1.55));
  };
  const Stance near = stance_before(-3.3), far = stance_before(-3.7);
  for (const Stance& stance : {near, far}) EXPECT_EQ(stance.grounded & kRearWheels, kRearWheels);
  EXPECT_EQ(near.swing_clear & kRearWheels, kRearWheels) << "up there it is clear again";
  EXPECT_EQ(near.sweep_clear & kRearWheels, 0);
  EXPECT_FALSE(near.may_lift(kRearWheels));
  EXPECT_EQ(far.sweep_clear & kRearWheels, kRearWheels);
}

TEST(StanceCheck, AWheelThatWouldTouchABlockBesideItsFootholdMayNotBeLifted) {
  // The base is high: front wheels stand at x = 2.2 and pass 2.54 on their way up.
  const auto stance_before = [](double block_x_m) {
    const World world([&](double x, double) { return x > block_x_m ? 1.3 : 0.0; });
    return world.stance(base_at(0.0, 1.33));
  };
  const Stance near = stance_before(3.15), far = stance_before(3.6);
  for (const Stance& stance : {near, far}) {
    EXPECT_EQ(stance.grounded, kAllWheels);
    EXPECT_EQ(stance.swing_clear & kFrontWheels, kFrontWheels);
    EXPECT_TRUE(stance.allows(kFrontWheels));
  }
  EXPECT_EQ(near.sweep_clear & kFrontWheels, 0);
  EXPECT_FALSE(near.may_lift(kFrontWheels));
  EXPECT_TRUE(far.may_lift(kFrontWheels));
}

TEST(StanceCheck, StandingWheelsAreDiscsOnSlopedGround) {
  const double gradient = std::tan(0.2);
  const World world([&](double, double y) { return gradient * y; });
  const Stance stance = world.stance(base_at(0.0, 0.95));
  ASSERT_TRUE(stance.allows(0));
  constexpr double kWithin_m = 0.005;
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    const Eigen::Vector3d& p = stance.p_world_wheel[i];
    const WheelRest rest = wheel_rest(world.map, p.head<2>(), Eigen::Vector3d::UnitY(), 0.6, 0.2);
    EXPECT_NEAR(p.z(), rest.height_m, kWithin_m) << i;
  }
}

TEST(StanceCheck, MirroredTerrainGivesMirroredStances) {
  const auto gentle = [](double x, double y) { return 0.4 * bumps(x, y); };
  const auto mirrored = [](double x, double y) { return 0.4 * bumps(x, -y); };
  const World left(gentle), right(mirrored);
  int num_allowed = 0;
  for (int k = 0; k < 60; ++k) {
    const double x = -5.0 + 0.17 * k, y = 1.5 * std::sin(k), yaw = 0.7 * std::cos(3.0 * k);
    const Stance a = left.stance(base_at(x, 1.0, 0.05, yaw, y, 0.1), kNumSteerings - 1);
    const Stance b = right.stance(base_at(x, 1.0, 0.05, -yaw, -y, -0.1), 0);
    const auto swapped = [](std::uint8_t mask) {
      return (mask & 0b0101) << 1 | (mask & 0b1010) >> 1;
    };
    EXPECT_EQ(a.belly_clear, b.belly_clear);
    EXPECT_EQ(a.grounded, swapped(b.grounded)) << "pose " << k;
    EXPECT_EQ(a.swing_clear, swapped(b.swing_clear)) << "pose " << k;
    EXPECT_EQ(a.sweep_clear, swapped(b.sweep_clear)) << "pose " << k;
    num_allowed += a.allows(0) ? 1 : 0;
  }
  EXPECT_GT(num_allowed, 20);
}

TEST(StanceCheck, MoreClearanceNeverAllowsMore) {
  const World world(bumps);
  for (int k = 0; k < 200; ++k) {
    const BaseFrame base = BaseFrame::from(base_at(-6.0 + 0.06 * k, 0.9 + 0.004 * k));
    const Stance plain = world.check.stance(base, kSteeredStraight, StanceClearances{});
    const Stance strict =
        world.check.stance(base, kSteeredStraight, StanceClearances{}.inflated(0.05));
    EXPECT_LE(strict.belly_clear, plain.belly_clear);
    EXPECT_EQ(strict.grounded & ~plain.grounded, 0);
    EXPECT_EQ(strict.swing_clear & ~plain.swing_clear, 0);
    EXPECT_EQ(strict.sweep_clear & ~plain.sweep_clear, 0);
  }
}

TEST(StanceCheck, ShiftingMapAndPoseTogetherChangesNothing) {
  const auto shifted = [](double x, double y) { return bumps(x - 3.0, y) + 10.0; };
  const World here(bumps), there(shifted);
  for (int k = 0; k < 60; ++k) {
    const double x = -4.0 + 0.1 * k;
    const Stance a = here.stance(base_at(x, 1.2, 0.0, 0.02 * k));
    const Stance b = there.stance(base_at(x + 3.0, 11.2, 0.0, 0.02 * k));
    EXPECT_EQ(a.grounded, b.grounded);
    EXPECT_EQ(a.swing_clear, b.swing_clear);
    EXPECT_EQ(a.sweep_clear, b.sweep_clear);
    EXPECT_EQ(a.belly_clear, b.belly_clear);
  }
}

TEST(StanceCheck, CounterWeightBalancesThreeWheelsOnTheSideAwayFromTheLiftedOne) {
  const World world(flat);
  const BaseFrame base = BaseFrame::from(base_at(0.0, 0.95));
  const Stance stance = world.stance(base_at(0.0, 0.95));
  for (int leg = 0; leg < kNumWheels; ++leg) {
    const auto lifted = static_cast<std::uint8_t>(1 << leg);
    const auto balanced = world.check.margin_with_counter_weight(base, stance, lifted);
    EXPECT_GT(balanced.margin_m, 0.5) << leg;
    const Eigen::Vector3d& arm =
        tables().counter_weights[static_cast<std::size_t>(balanced.counter_weight)].moment_base;
    EXPECT_LT(arm.head<2>().dot(stance.p_world_wheel[static_cast<std::size_t>(leg)].head<2>()),
              0.0);
  }
}

TEST(StanceCheck, BucketAheadCarriesTheFrontWithinReach) {
  const World world(flat);
  const BaseFrame base = BaseFrame::from(base_at(0.0, 0.95));
  const Stance stance = world.stance(base_at(0.0, 0.95));
  const auto margin_m = [&](double x) {
    return world.check.margin_on_bucket(base, stance, 0b0011, {x, 0.0, 0.0}, 1e9, -2.0).margin_m;
  };
  EXPECT_GT(margin_m(4.0), 0.3);
  EXPECT_GT(margin_m(6.5), 0.3);
  EXPECT_LT(margin_m(9.0), -1.0) << "out of reach";
}

TEST(StanceCheck, MarginOnThreePointsIsThatOfTheTriangle) {
  const World world(flat);
  const BaseFrame base = BaseFrame::from(base_at(0.0, 0.95));
  const Stance stance = world.stance(base_at(0.0, 0.95));
  const StancePolygon polygon(stance.p_world_patch, 0b0011, Eigen::Vector3d(5.0, 0.0, 0.0), base);
  // Rear wheels at x = -2.27, y = +-1.255: 1 m ahead of their line is 1 m inside.
  const Eigen::Vector3d& rear = stance.p_world_wheel[2];
  const Eigen::Vector3d com(rear.x() + 1.0, 0.0, 0.0);
  EXPECT_NEAR(polygon.in_base(base, Eigen::Vector3d::Zero(), 1.0)
                  .margin_m(com - Eigen::Vector3d(0.0, 0.0, 0.0)),
              std::min(1.0, (5.0 - com.x()) * rear.y() / std::hypot(5.0 - rear.x(), rear.y())),
              1e-6);
}

}  // namespace
}  // namespace wex
