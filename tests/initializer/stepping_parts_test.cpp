// What a stepping motion is made of: arm kinematics, wheels on the ground, patches, hulls.
#include <gtest/gtest.h>

#include <random>

#include "initializer/stepping/arm_kinematics.hpp"
#include "initializer/stepping/base_motion.hpp"
#include "initializer/stepping/counterweight.hpp"
#include "initializer/stepping/footing.hpp"
#include "models/terrain/wheel_rest.hpp"
#include "stepping_worlds.hpp"

namespace wex {
namespace {

constexpr double kTableErrorM = 1e-4;

ArmKinematics test_arm() {
  auto arm = ArmKinematics::build(test_machine());
  if (!arm) throw std::runtime_error(arm.error().message);
  return *std::move(arm);
}

WheelPlacer placer_on(const TerrainMap& map) {
  auto placer = WheelPlacer::build(map, test_machine(), {});
  if (!placer) throw std::runtime_error(placer.error().message);
  return *std::move(placer);
}

BaseCoordinates base_at(double x_m, double y_m, double z_m, double yaw_rad = 0.0,
                        double pitch_rad = 0.0, double roll_rad = 0.0) {
  BaseCoordinates base;
  base << x_m, y_m, z_m, yaw_rad, pitch_rad, roll_rad;
  return base;
}

TEST(ArmKinematics, AgreesWithTheTreeInPointsAndMoment) {
  const ArmKinematics arm = test_arm();
  const MachineModel& machine = test_machine();
  KinematicTree::Workspace w = machine.tree.make_workspace();
  Eigen::VectorXd q = Eigen::VectorXd::Zero(machine.num_coordinates());
  q.tail(machine.num_joints()) = machine.transport_posture();
  machine.tree.update(q, w);
  const double mass_kg = machine.tree.total_mass_kg();
  const Eigen::Vector3d rest = mass_kg * machine.tree.com(w) - arm.moment_base(arm.transport());
  std::mt19937 random(1);
  for (int n = 0; n < 200; ++n) {
    ArmKinematics::Joints joints{};
    for (std::size_t k = 0; k < joints.size(); ++k) {
      const double lower = std::max(-3.0, arm.lower()[k]), upper = std::min(3.0, arm.upper()[k]);
      joints[k] = std::uniform_real_distribution(lower, upper)(random);
    }
    const ArmPosture posture = ArmKinematics::posture_of(joints);
    arm.write(posture, q);
    machine.tree.update(q, w);
    const Eigen::Vector3d contact =
        machine.tree.position(w, machine.arm->contact_body, machine.arm->p_body_contact);
    EXPECT_LT((arm.shape(posture).p_base_contact - contact).norm(), 1e-9);
    EXPECT_LT((rest + arm.moment_base(posture) - mass_kg * machine.tree.com(w)).norm(), 1e-3);
  }
}

TEST(ArmKinematics, ReachesWhatItSaysItReaches) {
  const ArmKinematics arm = test_arm();
  int reached = 0;
  for (const double x : {3.4, 5.0, 7.0}) {
    for (const double y : {-0.5, 0.0, 0.5}) {
      for (const double z : {-2.0, -1.0, 0.5}) {
        const Eigen::Vector3d p(x, y, z);
        const auto posture = arm.reach(p, 0.6, 0.2);
        if (!posture) continue;
        ++reached;
        EXPECT_LT((arm.shape(*posture).p_base_contact - p).norm(), 1e-9);
        EXPECT_NEAR(arm.attitude_rad(*posture), 0.2, 1e-9);
        EXPECT_TRUE(arm.within_limits(*posture));
      }
    }
  }
  EXPECT_GE(reached, 12);
}

TEST(ArmKinematics, AMachineWithoutAnArmIsRefused) {
  MachineModel machine = test_machine();
  machine.arm.reset();
  const auto arm = ArmKinematics::build(machine);
  ASSERT_FALSE(arm);
  EXPECT_EQ(arm.error().code, ErrorCode::kBadInput);
}

TEST(WheelPlacer, PutsDiscsOnRoughGroundExactly) {
  const TerrainMap map = make_map(20.0, 20.0, [](double x, double y) { return 0.6 * bumps(x, y); });
  const WheelPlacer placer = placer_on(map);
  const MachineModel& machine = test_machine();
  KinematicTree::Workspace w = machine.tree.make_workspace();
  int placed = 0;
  for (const double yaw : {0.0, 1.0, 2.5}) {
    for (const double curvature : {0.0, 0.15, -0.2}) {
      const BaseCoordinates base = base_at(0.5, -0.7, 1.15, yaw, 0.03, -0.05);
      const auto placement = placer.place(base, curvature, 0, {}, placer.default_hfe_rad());
      if (!placement) continue;
      ++placed;
      Eigen::VectorXd q = Eigen::VectorXd::Zero(machine.num_coordinates());
      q.tail(machine.num_joints()) = machine.transport_posture();
      q.head<kNumBaseCoordinates>() = base;
      for (std::size_t i = 0; i < kNumWheels; ++i) {
        q[machine.legs[i].hfe] = placement->hfe_rad[i];
        q[machine.legs[i].steer] = placement->steer_rad[i];
      }
      machine.tree.update(q, w);
      for (const WheeledLeg& leg : machine.legs) {
        const Eigen::Vector3d p = machine.tree.position(w, leg.carrier_body, leg.p_carrier_wheel);
        const Eigen::Vector3d axle = machine.tree.direction(w, leg.carrier_body, leg.axle_carrier);
        const double height_m =
            wheel_rest(map, p.head<2>(), axle, leg.radius_m, leg.half_width_m).height_m;
        EXPECT_NEAR(p.z(), height_m, kTableErrorM);
      }
      const ArmKinematics arm = test_arm();
      const Eigen::Vector3d com =
          T_world_base_from(base) *
          ((placement->moment_base + arm.moment_base(arm.transport())) / placer.mass_kg());
      EXPECT_LT((com - machine.tree.com(w)).norm(), kTableErrorM);
    }
  }
  EXPECT_GE(placed, 5);
}

TEST(WheelPlacer, SaysWhichWheelHasNoGroundAndWhy) {
  const TerrainMap map =
      make_map(30.0, 12.0, [](double x, double) { return x > 2.0 ? -2.0 : 0.0; });
  const WheelPlacer placer = placer_on(map);
  const auto over_the_edge =
      placer.place(base_at(0.0, 0.0, 1.0), 0.0, 0, {}, placer.default_hfe_rad());
  ASSERT_FALSE(over_the_edge);
  EXPECT_LT(over_the_edge.error().wheel, 2) << "one of the front wheels";
  const auto off_the_map =
      placer.place(base_at(-14.5, 0.0, 1.0), 0.0, 0, {}, placer.default_hfe_rad());
  ASSERT_FALSE(off_the_map);
  EXPECT_GE(off_the_map.error().wheel, 2);
}

TEST(WheelPlacer, LowestClearHeightIsThatOfTheTyre) {
  const TerrainMap map = flat_map();
  const WheelPlacer placer = placer_on(map);
  const BaseCoordinates base = base_at(0.0, 0.0, 1.0);
  const auto clear = placer.lowest_clear_rad(base, 0.0, 0, 0.10);
  ASSERT_TRUE(clear);
  const auto placement = placer.place(base, 0.0, 0, {}, placer.default_hfe_rad());
  ASSERT_TRUE(placement);
  // A front leg is 1.2 m long between hip and wheel.
  EXPECT_NEAR(1.2 * (std::sin(*clear) - std::sin(placement->hfe_rad[0])), 0.10, 0.003);
  EXPECT_FALSE(placer.lowest_clear_rad(base, 0.0, 0, 3.0));
}

TEST(TyrePatch, LiesBelowOnFlatGroundAndUphillOnASlope) {
  const double slope = 0.3;
  const TerrainMap flat = flat_map(),
                   hill = make_map(20.0, 20.0, [&](double x, double) { return slope * x; });
  const Eigen::Vector3d centre(1.0, 1.0, 0.6), axle = Eigen::Vector3d::UnitY();
  EXPECT_LT((tyre_patch(flat, centre, axle, 0.6, 0.2) - Eigen::Vector3d(1.0, 1.0, 0.0)).norm(),
            1e-6);
  const double angle = std::atan(slope);
  const Eigen::Vector3d along = tyre_patch(hill, centre, axle, 0.6, 0.2);
  EXPECT_NEAR(along.x(), 1.0 + 0.6 * std::sin(angle), 1e-3);
  EXPECT_NEAR(along.y(), 1.0, 1e-6);
  const Eigen::Vector3d across = tyre_patch(hill, centre, Eigen::Vector3d::UnitX(), 0.6, 0.2);
  EXPECT_GT(across.x(), 1.05) << "on its uphill edge";
  EXPECT_LT(across.x(), 1.21);
}

TEST(HullMargin, IsTheDistanceToTheNearestEdge) {
  const std::vector<Eigen::Vector2d> square{{0, 0}, {2, 2}, {2, 0}, {0, 2}};
  EXPECT_NEAR(hull_margin_m({1.0, 0.3}, square), 0.3, 1e-12);
  EXPECT_NEAR(hull_margin_m({1.0, -0.3}, square), -0.3, 1e-12);
  const std::vector<Eigen::Vector2d> with_inner{{0, 0}, {2, 2}, {2, 0}, {0, 2}, {1, 1}};
  EXPECT_NEAR(hull_margin_m({1.0, 0.3}, with_inner), 0.3, 1e-12);
  const std::vector<Eigen::Vector2d> line{{0, 0}, {1, 1}, {2, 2}};
  EXPECT_LE(hull_margin_m({1.0, 1.0}, line), 0.0);
}

TEST(BaseRuns, SplitWhereSupportChangesAndShareThePoseThere) {
  const CertifiedSequence sequence = gap_sequence(2.0);
  const std::vector<BaseRun> runs = base_runs(sequence, 2.0);
  ASSERT_EQ(runs.size(), 5U);
  for (std::size_t i = 1; i < runs.size(); ++i) {
    EXPECT_EQ(runs[i - 1].knots.back().base, runs[i].knots.front().base);
    EXPECT_NE(runs[i - 1].support, runs[i].support);
  }
}

TEST(BaseRuns, SmoothingKeepsEndsAndGivesWayWhereAPoseIsRefused) {
  HandMadeSequence hand(-3.0, 3.0, 1.0);
  hand.drive_to(0.0).rise_to(1.3).drive_to(3.0);
  BaseRun run = base_runs(hand.get(), 2.0).front();
  const BaseRun decided = run;
  ASSERT_TRUE(smooth_base(run, 1.5, [](const BaseKnot&) { return std::nullopt; }));
  EXPECT_EQ(run.knots.front().base, decided.knots.front().base);
  EXPECT_EQ(run.knots.back().base, decided.knots.back().base);
  double steepest = 0.0;
  for (std::size_t i = 1; i < run.knots.size(); ++i) {
    const double step_m = run.knots[i].sigma_m - run.knots[i - 1].sigma_m;
    steepest =
        std::max(steepest, (run.knots[i].base[kBaseZ] - run.knots[i - 1].base[kBaseZ]) / step_m);
  }
  EXPECT_LT(steepest, 0.5) << "the decided one rises on the spot";

  BaseRun strict = decided;
  ASSERT_TRUE(smooth_base(strict, 1.5, [&](const BaseKnot& knot) -> std::optional<std::string> {
    const double z = decided.knots[knot.state].base[kBaseZ];
    if (std::abs(knot.base[kBaseZ] - z) > 0.02) return "too far from the decided height";
    return std::nullopt;
  }));
  BaseRun refused = decided;
  const auto failure = smooth_base(
      refused, 1.5, [](const BaseKnot&) -> std::optional<std::string> { return "never"; });
  ASSERT_FALSE(failure);
  EXPECT_EQ(failure.error().why, "never");
}

TEST(Counterweights, HoldOnePostureAsLongAsItLastsAndChangeWhereBothHold) {
  const ArmKinematics arm = test_arm();
  HandMadeSequence hand(0.0, 2.0, 1.0);
  hand.drive_to(2.0);
  const BaseRun run = base_runs(hand.get(), 2.0).front();
  const TerrainMap map = flat_map();
  const WheelPlacer placer = placer_on(map);
  std::vector<BucketStance> stances(run.knots.size());
  for (std::size_t i = 0; i < stances.size(); ++i) {
    const auto placement = placer.place(run.knots[i].base, 0.0, 0, {}, placer.default_hfe_rad());
    ASSERT_TRUE(placement);
    stances[i].footing = footing_on(run.knots[i].base, *placement, 0, nullptr, placer.mass_kg());
  }
  ArmPosture first = arm.transport(), second = arm.transport();
  second.turn_rad = 1.0;
  const auto judge = [&](std::size_t knot, const ArmPosture& posture) {
    return posture.turn_rad == first.turn_rad ? knot <= 6 : knot >= 3;
  };
  const auto held = counterweights(arm, run, stances, {first, second}, 0.3, judge);
  ASSERT_TRUE(held);
  ASSERT_EQ(held->size(), 2U);
  EXPECT_EQ((*held)[0].first_knot, 0U);
  EXPECT_EQ((*held)[1].first_knot, 6U);
  const auto none = counterweights(arm, run, stances, {first}, 0.3, judge);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().state, run.knots[6].state);
}

}  // namespace
}  // namespace wex
