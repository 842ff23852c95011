#include "initializer/paper/paper_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "tests/initializer/paper_worlds.hpp"

namespace wex {
namespace {

constexpr auto kArmIndex = static_cast<std::size_t>(Limb::kArm);

int wheels_down(const PaperStance& stance) {
  return static_cast<int>(
      std::count(stance.contacts.begin(), stance.contacts.begin() + kNumWheels, true));
}

/// A square pit, 3 m deep, around a point, so wide that no configuration of the leg reaches beyond.
HeightFunction pit_at(const Eigen::Vector2d& centre, double half_width_m) {
  return [=](double x, double y) {
    const bool inside =
        std::abs(x - centre.x()) < half_width_m && std::abs(y - centre.y()) < half_width_m;
    return inside ? -3.0 : 0.0;
  };
}

/// A ditch across, 3 m deep, in front of x: the front wheels find nothing.
HeightFunction ditch_from(double x_m, double width_m) {
  return [=](double x, double) { return x > x_m && x < x_m + width_m ? -3.0 : 0.0; };
}

std::vector<Pose2> random_poses(int count, double extent_m, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> place(-extent_m, extent_m), turn(-M_PI, M_PI);
  std::vector<Pose2> poses;
  for (int i = 0; i < count; ++i) {
    poses.push_back({place(generator), place(generator), turn(generator)});
  }
  return poses;
}

TEST(PaperCheck, StandsOnFourWheelsOnFlatGroundInDefaultPosture) {
  const TerrainMap flat = flat_map();
  const PaperCheck check = paper_check(flat);
  const PaperStance stance = check.stand(Pose2{1.0, -2.0, 0.7});
  ASSERT_TRUE(stance.ok()) << describe(stance.rejection);
  EXPECT_EQ(stance.contacts, kDrivingContacts);
  // The first vertex is the default posture, which was made to stand on level ground.
  EXPECT_THAT(stance.vertex, testing::Each(0));
  EXPECT_NEAR(stance.base[kBaseZ], test_machine().default_base_height_m, 1e-6);
  EXPECT_NEAR(stance.base[kBasePitch], 0.0, 1e-6);
  EXPECT_GT(stance.margin_m, 1.0);
}

TEST(PaperCheck, APitUnderOneWheelMeansThreeContactsAndACentredArm) {
  const TerrainMap map = make_map(40.0, 30.0, pit_at(default_wheel(Limb::kLF), 1.1));
  const PaperCheck check = paper_check(map);
  const BaseCoordinates base = level_base({0.0, 0.0, 0.0});
  const PaperStance stance = check.stand(base);
  ASSERT_TRUE(stance.ok()) << describe(stance.rejection);
  EXPECT_EQ(stance.contacts, (ContactFlags{false, true, true, true, false}));
  EXPECT_NE(stance.vertex[kArmIndex], 0);
  // Front left is missing: the arm goes towards the rear and the right.
  const LimbRoadmap& arm = test_roadmaps().limbs.back();
  const Eigen::Vector3d shift =
      arm.moment_base.col(stance.vertex[kArmIndex]) - arm.moment_base.col(0);
  EXPECT_LT(shift.x() + shift.y(), 0.0);
}

TEST(PaperCheck, NoOtherCounterweightOfTheRoadmapWouldBeMoreCentral) {
  const TerrainMap map = make_map(40.0, 30.0, pit_at(default_wheel(Limb::kLF), 1.1));
  const PaperCheck check = paper_check(map);
  const PaperStance stance = check.stand(level_base({0.0, 0.0, 0.0}));
  ASSERT_TRUE(stance.ok());
  // By the machine's own kinematics.
  const MachineModel& machine = test_machine();
  const Roadmaps& maps = test_roadmaps();
  Eigen::VectorXd q = Eigen::VectorXd::Zero(machine.num_coordinates());
  q.tail(machine.num_joints()) = machine.default_posture();
  q.head<kNumBaseCoordinates>() = stance.base;
  const auto write = [&](std::size_t limb, int vertex) {
    for (std::size_t k = 0; k < maps.limbs[limb].coordinates.size(); ++k) {
      q[maps.limbs[limb].coordinates[k]] = maps.limbs[limb].q(static_cast<Eigen::Index>(k), vertex);
    }
  };
  for (std::size_t i = 0; i < kNumWheels; ++i) write(i, stance.vertex[i]);
  KinematicTree::Workspace w = machine.tree.make_workspace();
  const auto margin_m = [&](int vertex) {
    write(kArmIndex, vertex);
    machine.tree.update(q, w);
    const Eigen::Vector2d com = machine.tree.com(w).head<2>();
    double margin = 1e9;
    constexpr std::array<std::size_t, 3> kCorners{1, 2, 3};  // RF, LH, RH: counter-clockwise
    for (std::size_t i = 0; i < 3; ++i) {
      const auto corner = [&](std::size_t k) {
        const WheeledLeg& leg = machine.legs[kCorners[k % 3]];
        return Eigen::Vector2d(
            machine.tree.position(w, leg.carrier_body, leg.p_carrier_wheel).head<2>());
      };
      const Eigen::Vector2d a = corner(i), along = (corner(i + 1) - a).normalized();
      margin = std::min(margin, along.x() * (com - a).y() - along.y() * (com - a).x());
    }
    return margin;
  };
  EXPECT_NEAR(margin_m(stance.vertex[kArmIndex]), stance.margin_m, 0.01);
  for (int v = 0; v < maps.limbs.back().num_vertices(); v += 7) {
    if (maps.limbs.back().p_base_contact(2, v) < 0.3) continue;  // bucket too low to swing
    EXPECT_LE(margin_m(v), stance.margin_m + 0.01) << "vertex " << v;
  }
}

/// Centre of mass of the default posture with the arm at a vertex, by the machine's own kinematics.
Eigen::Vector2d com_with_arm_at(const LimbRoadmap& arm, int vertex) {
  const MachineModel& machine = test_machine();
  Eigen::VectorXd q = Eigen::VectorXd::Zero(machine.num_coordinates());
  q.tail(machine.num_joints()) = machine.default_posture();
  for (std::size_t k = 0; k < arm.coordinates.size(); ++k) {
    q[arm.coordinates[k]] = arm.q(static_cast<Eigen::Index>(k), vertex);
  }
  KinematicTree::Workspace w = machine.tree.make_workspace();
  machine.tree.update(q, w);
  return machine.tree.com(w).head<2>();
}

/// So deep that neither legs nor arm find its floor, so wide that no leg reaches its edges.
TerrainMap with_ditch_under_the_front_axle() {
  const double front_m = default_wheel(Limb::kLF).x();
  return make_map(40.0, 30.0, [front_m](double x, double) {
    return x > front_m - 1.6 && x < front_m + 1.2 ? -20.0 : 0.0;
  });
}

// By hand: hind wheels at (-h, +-w), the bucket ahead at (b, 0). The triangle's half width at the
// centre of mass (x, y) is w (b - x) / (b + h), and its sides lean by atan(w / (b + h)). With the
// bucket at (4.0, 3.5) instead the side from the right wheel passes (0.7, 0.99), and the centre of
// mass, with a third of it in cabin and arm, is right of that: this tripod falls over.
TEST(PaperCheck, TwoWheelsAndTheBucketStandAsComputedByHand) {
  const TerrainMap map = with_ditch_under_the_front_axle();
  const BaseCoordinates base = level_base({0.0, 0.0, 0.0});
  const Eigen::Vector2d aside(4.0, 3.5), ahead(5.0, 0.0), farther(5.5, 0.0);
  const Roadmaps maps = with_bucket_at(only_default_arm(), {aside, ahead, farther});
  const PaperStance stance = paper_check(map, {}, maps).stand(base);
  ASSERT_TRUE(stance.ok()) << describe(stance.rejection);
  EXPECT_EQ(stance.contacts, (ContactFlags{false, false, true, true, true}));
  EXPECT_EQ(stance.vertex[kArmIndex], 2);  // the nearest to default of those that carry
  const double h = -default_wheel(Limb::kLH).x(), w = default_wheel(Limb::kLH).y();
  const Eigen::Vector2d com = com_with_arm_at(maps.limbs.back(), 2);
  const double half_width = w * (ahead.x() - com.x()) / (ahead.x() + h);
  const double margin_m = (half_width - std::abs(com.y())) * std::cos(std::atan2(w, ahead.x() + h));
  EXPECT_GT(margin_m, 0.4);
  EXPECT_NEAR(stance.margin_m, margin_m, 2e-3);
}

TEST(PaperCheck, TwoWheelsDoNotStandWithABucketThatCarriesNothingOrTouchesTooSeldom) {
  const TerrainMap map = with_ditch_under_the_front_axle();
  const BaseCoordinates base = level_base({0.0, 0.0, 0.0});
  const Roadmaps aside = with_bucket_at(only_default_arm(), {{4.0, 3.5}, {4.1, 3.6}, {4.0, -3.5}});
  EXPECT_EQ(paper_check(map, {}, aside).stand(base).rejection, PaperRejection::kUnstable);
  const Roadmaps twice = with_bucket_at(only_default_arm(), {{5.0, 0.0}, {5.5, 0.0}});
  EXPECT_EQ(paper_check(map, {}, twice).stand(base).rejection, PaperRejection::kNoArmContact);
  const Roadmaps over_the_ditch =
      with_bucket_at(only_default_arm(), {{3.0, 0.0}, {3.2, 0.0}, {3.4, 0.0}});
  EXPECT_EQ(paper_check(map, {}, over_the_ditch).stand(base).rejection,
            PaperRejection::kNoArmContact);
}

// Of 3000 vertices some twenty touch the ground at any one height of the base, all around the
// machine; those few ahead of it stand too far aside at most heights, default included. So the real
// roadmap is asked over a range of heights.
TEST(PaperCheck, ADitchUnderTheFrontAxleMeansTwoWheelsAndTheBucket) {
  const double front_m = default_wheel(Limb::kLF).x();
  const TerrainMap map = with_ditch_under_the_front_axle();
  const PaperCheck check = paper_check(map);
  int standing = 0;
  for (int i = 0; i < 20; ++i) {
    BaseCoordinates base = level_base({0.0, 0.0, 0.0});
    base[kBaseZ] += 0.02 * i - 0.1;
    const PaperStance stance = check.stand(base);
    if (!stance.ok()) continue;
    ++standing;
    EXPECT_EQ(stance.contacts, (ContactFlags{false, false, true, true, true}));
    // The bucket is on the ground, beyond the ditch or it could not balance the machine.
    const Eigen::Vector3d p_base =
        test_roadmaps().limbs.back().p_base_contact.col(stance.vertex[kArmIndex]);
    EXPECT_NEAR(p_base.z() + base[kBaseZ], 0.0, 0.05 + 1e-4);
    EXPECT_GT(p_base.x(), front_m + 1.2);
    EXPECT_GE(stance.margin_m, PlanSettings{}.min_stability_margin_m);
  }
  EXPECT_GE(standing, 3);
}

TEST(PaperCheck, ALegMayBeLiftedThoughItCouldStand) {
  const TerrainMap flat = flat_map();
  const PaperCheck check = paper_check(flat);
  const PaperStance stance = check.stand(level_base({0.0, 0.0, 0.0}), 1);
  ASSERT_TRUE(stance.ok()) << describe(stance.rejection);
  EXPECT_EQ(stance.contacts, (ContactFlags{true, false, true, true, false}));
  // What balances it best comes first; on level ground nothing is in its way.
  const std::vector<int> vertices = check.counterweights(stance);
  ASSERT_GT(vertices.size(), 100U);
  EXPECT_EQ(vertices.front(), stance.vertex[kArmIndex]);
  // By hand: front right is missing, so the mass must go back and to the left of where the default
  // posture, ahead, has it.
  const Eigen::Matrix3Xd& moment = test_roadmaps().limbs.back().moment_base;
  for (const int vertex : vertices) {
    const Eigen::Vector3d shift = moment.col(vertex) - moment.col(0);
    EXPECT_GT(shift.y() - shift.x(), 0.0) << "vertex " << vertex;
  }
}

TEST(PaperCheck, NothingToStandOnMeansNothing) {
  // Three-metre pits and poles in between: no cell is farther than 0.15 m from an edge.
  const TerrainMap map = make_map(40.0, 30.0, [](double x, double y) {
    return std::fmod(std::abs(std::floor(x / 0.2) + std::floor(y / 0.2)), 2.0) == 0.0 ? -3.0 : 0.0;
  });
  const PaperCheck check = paper_check(map);
  for (const Pose2& pose : random_poses(200, 8.0, 3)) {
    EXPECT_FALSE(check.stand(pose).ok());
  }
}

TEST(PaperCheck, RefusesForTheReasonThatIs) {
  const TerrainMap flat = flat_map();
  const PaperCheck check = paper_check(flat);
  BaseCoordinates base = level_base({0.0, 0.0, 0.0});
  base[kBaseRoll] = 0.36;  // 20 degrees are 0.349
  EXPECT_EQ(check.stand(base).rejection, PaperRejection::kTilt);
  base = level_base({0.0, 0.0, 0.0});
  base[kBaseZ] = 0.35;  // the chassis touches
  EXPECT_EQ(check.stand(base).rejection, PaperRejection::kBelly);
  base[kBaseZ] = 3.0;  // no leg reaches down
  EXPECT_EQ(check.stand(base).rejection, PaperRejection::kTooFewLegs);
  EXPECT_EQ(check.stand(Pose2{500.0, 0.0, 0.0}).rejection, PaperRejection::kOffMap);
}

TEST(PaperCheck, WithoutArmSupportTwoWheelsDoNot) {
  const TerrainMap map = make_map(40.0, 30.0, ditch_from(default_wheel(Limb::kLF).x() - 0.9, 2.0));
  PlanSettings settings;
  settings.ablation.arm_support = false;
  EXPECT_EQ(paper_check(map, settings).stand(level_base({0.0, 0.0, 0.0})).rejection,
            PaperRejection::kTooFewLegs);
}

TEST(PaperCheck, WithoutArmCentringTheArmStaysInDefaultPostureAndTheMarginIsSmaller) {
  const TerrainMap map = make_map(40.0, 30.0, pit_at(default_wheel(Limb::kLF), 1.1));
  PlanSettings settings;
  settings.min_stability_margin_m = -10.0;  // both are to be compared
  const BaseCoordinates base = level_base({0.0, 0.0, 0.0});
  const PaperStance centred = paper_check(map, settings).stand(base);
  settings.ablation.arm_centring = false;
  const PaperStance idle = paper_check(map, settings).stand(base);
  ASSERT_TRUE(centred.ok() && idle.ok());
  EXPECT_EQ(idle.vertex[kArmIndex], 0);
  EXPECT_GT(centred.margin_m, idle.margin_m + 0.1);
}

TEST(PaperCheck, WithoutFilteredHeightsTheBaseFollowsABumpUnderneath) {
  // A block between the wheels, lower than the chassis.
  const TerrainMap map = make_map(40.0, 30.0, [](double x, double y) {
    return std::abs(x) < 0.5 && std::abs(y) < 0.4 ? 0.45 : 0.0;
  });
  PlanSettings settings;
  const Pose2 over{0.0, 0.0, 0.0};
  const double filtered_m = paper_check(map, settings).base_at(over)[kBaseZ];
  settings.ablation.filtered_heights = false;
  settings.ablation.nearest_traversable = false;
  const double raw_m = paper_check(map, settings).base_at(over)[kBaseZ];
  EXPECT_NEAR(raw_m, 0.45 + test_machine().default_base_height_m, 1e-3);
  EXPECT_LT(filtered_m, raw_m - 0.2);
}

// A tyre of 0.6 m keeps its radius from either face: a gap of 1.1 m has no floor for a wheel, one
// of 3 m has a strip of 1.8 m. So over the narrow gap the nearest place a wheel may stand on is the
// rim, and over the wide one its own floor: how deep that is is not the map's to judge.
TEST(PaperCheck, OverAGapTheNearestTraversableGroundGivesTheHeight) {
  const auto gap = [](double half_m) {
    return make_map(40.0, 30.0,
                    [=](double x, double) { return std::abs(x) < half_m ? -20.0 : 0.0; });
  };
  const TerrainMap narrow = gap(0.55), wide = gap(1.5);
  const double above_m = test_machine().default_base_height_m;
  PlanSettings settings;
  const auto height_over = [&](const TerrainMap& map) {
    return paper_check(map, settings).base_at(Pose2{0.0, 0.0, 0.0})[kBaseZ];
  };
  EXPECT_FALSE(narrow.traversable_at({0.0, 0.0}));
  EXPECT_NEAR(height_over(narrow), above_m, 0.05);
  EXPECT_TRUE(wide.traversable_at({0.0, 0.0}));
  EXPECT_NEAR(height_over(wide), above_m - 20.0, 0.05);
  settings.ablation.nearest_traversable = false;
  EXPECT_NEAR(height_over(narrow), above_m - 20.0, 0.05);
}

TEST(PaperCheck, GroundsTheLegsThatAPlainLoopGrounds) {
  const TerrainMap map = make_map(40.0, 30.0, bumps);
  const PaperCheck check = paper_check(map);
  const PlanSettings settings;
  int grounded = 0, different = 0;
  for (const Pose2& pose : random_poses(300, 9.0, 5)) {
    const BaseCoordinates base = check.base_at(pose);
    const Eigen::Isometry3d T_world_base = T_world_base_from(base);
    const auto rows = check.ground_legs(base);
    for (std::size_t i = 0; i < kNumWheels; ++i) {
      const LimbRoadmap& leg = test_roadmaps().limbs[i];
      int touching = 0, nearest = -1;
      for (int v = 0; v < leg.num_vertices(); ++v) {
        const Eigen::Vector3d p = T_world_base * leg.p_base_contact.col(v);
        const double gap_m =
            p.z() - test_machine().legs[i].radius_m - map.dilated_height_m(p.head<2>());
        if (!(std::abs(gap_m) <= check.paper().touch_m)) continue;
        if (!(map.signed_distance_m(p.head<2>()) >= settings.min_signed_distance_m)) continue;
        if (nearest < 0) nearest = v;
        ++touching;
      }
      const int expected = touching >= check.paper().min_touching ? nearest : -1;
      grounded += expected >= 0;
      different += rows[i] != expected;
    }
  }
  EXPECT_GT(grounded, 600);
  EXPECT_LE(different, 3);  // a vertex that touches by a hair may tip
}

// The right legs' roadmaps mirrored onto the left ones, the arm's onto itself, so that the machine
// is as symmetric as its terrain: a vertex for every vertex.
Roadmaps mirrored(const Roadmaps& maps) {
  Roadmaps mirror = maps;
  constexpr std::array<std::size_t, kNumLimbs> kOther{1, 0, 3, 2, 4};
  for (std::size_t i = 0; i < kNumLimbs; ++i) {
    const LimbRoadmap& from = maps.limbs[kOther[i]];
    LimbRoadmap& to = mirror.limbs[i];
    to.p_base_contact = from.p_base_contact;
    to.moment_base = from.moment_base;
    to.p_base_contact.row(1) *= -1.0;
    to.moment_base.row(1) *= -1.0;
  }
  return mirror;
}

TEST(PaperCheck, MirroredTerrainGivesMirroredFeasibility) {
  const auto ground = [](double x, double y) {
    return bumps(x, y) + (std::abs(x - 1.0) < 1.0 ? -3.0 : 0.0);
  };
  const TerrainMap map = make_map(40.0, 30.0, ground);
  const TerrainMap mirror = make_map(40.0, 30.0, [&](double x, double y) { return ground(x, -y); });
  const Roadmaps mirror_roadmaps = mirrored(test_roadmaps());
  const PaperCheck check = paper_check(map);
  const PaperCheck mirror_check = paper_check(mirror, {}, mirror_roadmaps);
  constexpr std::array<std::size_t, kNumLimbs> kOther{1, 0, 3, 2, 4};
  std::array<int, 5> by_wheels{};
  int different = 0;
  constexpr int kPoses = 1500;
  for (const Pose2& pose : random_poses(kPoses, 9.0, 7)) {
    const PaperStance here = check.stand(pose);
    const PaperStance there = mirror_check.stand(Pose2{pose.x_m, -pose.y_m, -pose.yaw_rad});
    bool same = here.ok() == there.ok();
    for (std::size_t i = 0; same && here.ok() && i < kNumLimbs; ++i) {
      same = here.contacts[i] == there.contacts[kOther[i]];
    }
    different += !same;
    if (here.ok()) ++by_wheels[static_cast<std::size_t>(wheels_down(here))];
  }
  EXPECT_THAT(by_wheels[4], testing::Gt(50));
  EXPECT_THAT(by_wheels[3] + by_wheels[2], testing::Gt(20));
  EXPECT_LE(different, kPoses / 200);  // ties of Algorithm 1's cost, rounding at thresholds
}

TEST(PaperCheck, RaisingTheMarginNeverMakesAnInfeasiblePoseFeasible) {
  const TerrainMap map = make_map(40.0, 30.0, [](double x, double y) {
    return bumps(x, y) + (std::abs(x - 1.0) < 1.0 ? -3.0 : 0.0);
  });
  const std::vector<Pose2> poses = random_poses(1500, 9.0, 11);
  std::vector<bool> before(poses.size(), true);
  std::vector<int> feasible;
  for (const double margin_m : {0.0, 0.3, 0.6, 0.9, 1.2}) {
    PlanSettings settings;
    settings.min_stability_margin_m = margin_m;
    const PaperCheck check = paper_check(map, settings);
    int count = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const bool now = check.stand(poses[i]).ok();
      EXPECT_TRUE(before[i] || !now) << "pose " << i << ", margin " << margin_m;
      before[i] = now;
      count += now;
    }
    feasible.push_back(count);
  }
  EXPECT_GT(feasible.front(), feasible.back());  // the margin decides some of them
}

TEST(PaperCheck, ShiftingMapAndPoseTogetherChangesNothing) {
  const auto ground = [](double x, double y) {
    return bumps(x, y) + (std::abs(x - 1.0) < 1.0 ? -3.0 : 0.0);
  };
  const Eigen::Vector2d shift(64.0, -32.0);
  const TerrainMap map = make_map(40.0, 30.0, ground);
  const TerrainMap shifted = make_map(40.0, 30.0, ground, shift);
  const PaperCheck check = paper_check(map), shifted_check = paper_check(shifted);
  int feasible = 0, different = 0;
  for (const Pose2& pose : random_poses(1500, 9.0, 13)) {
    const PaperStance here = check.stand(pose);
    const PaperStance there =
        shifted_check.stand(Pose2{pose.x_m + shift.x(), pose.y_m + shift.y(), pose.yaw_rad});
    feasible += here.ok();
    different += here.rejection != there.rejection ||
                 (here.ok() && (here.vertex != there.vertex || here.contacts != there.contacts));
  }
  EXPECT_GT(feasible, 100);
  EXPECT_LE(different, 3);  // rounding at thresholds
}

TEST(PaperCheck, RefusesAnEmptyRoadmap) {
  const TerrainMap flat = flat_map(20.0, 20.0);
  Roadmaps maps = test_roadmaps();
  maps.limbs[2].q.resize(3, 0);
  const auto check = PaperCheck::build(flat, test_machine(), maps, {});
  ASSERT_FALSE(check);
  EXPECT_THAT(check.error().message, testing::HasSubstr("LH"));
}

}  // namespace
}  // namespace wex
