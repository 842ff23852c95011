#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "initializer/paper/bucket_point.hpp"
#include "initializer/paper/contact_schedule.hpp"
#include "initializer/paper/leg_inverse.hpp"
#include "models/terrain/wheel_rest.hpp"
#include "tests/initializer/test_worlds.hpp"

namespace wex {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr ContactFlags kFour = kDrivingContacts;
constexpr ContactFlags kFull{true, true, true, true, true};
constexpr ContactFlags kRearAndBucket{false, false, true, true, true};

TEST(ContactChanges, NothingChangesNothing) {
  EXPECT_THAT(contact_changes(kFour, kFour), IsEmpty());
}

TEST(ContactChanges, OneChangeNeedsNoNodeInBetween) {
  const ContactFlags three{true, true, true, false, false};
  EXPECT_THAT(contact_changes(kFour, three), ElementsAre(three));
  EXPECT_THAT(contact_changes(three, kFour), ElementsAre(kFour));
}

TEST(ContactChanges, FromWheelsToBucketByWayOfFullContact) {
  const ContactFlags without_lf{false, true, true, true, true};
  EXPECT_THAT(contact_changes(kFour, kRearAndBucket),
              ElementsAre(kFull, without_lf, kRearAndBucket));
}

TEST(ContactChanges, BackToWheelsTheBucketLeavesLast) {
  const auto changes = contact_changes(kRearAndBucket, kFour);
  ASSERT_EQ(changes.size(), 3U);
  EXPECT_EQ(changes[1], kFull);
  EXPECT_EQ(changes[2], kFour);
}

TEST(ContactChanges, NeverFewerContactsThanTheSmallerEnd) {
  const ContactFlags left_front_up{false, true, true, true, false};
  const ContactFlags right_front_up{true, false, true, true, false};
  EXPECT_THAT(contact_changes(left_front_up, right_front_up), ElementsAre(kFour, right_front_up));
}

TEST(ClosestPair, IsTheClosestOfAll) {
  const std::vector<Eigen::Vector3d> first{{0, 0, 0}, {5, 0, 0}, {9, 9, 9}};
  const std::vector<Eigen::Vector3d> second{{-2, 0, 0}, {5.5, 0.1, 0}, {1, 1, 1}};
  EXPECT_EQ(closest_pair(first, second), (std::pair<std::size_t, std::size_t>{1, 1}));
}

TEST(LegInverse, RestsASpreadLegAndRollsAlongThePath) {
  const TerrainMap map =
      make_map(30.0, 30.0, [](double x, double y) { return 0.1 * x + 0.05 * y; });
  const MachineModel& machine = test_machine();
  LegInverse inverse(map, machine, 0.15);
  BaseCoordinates base;
  base << 1.0, -1.0, 1.0, 0.4, 0.0, 0.0;
  const double curvature = 0.1;
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    const WheeledLeg& leg = machine.legs[i];
    const double outwards = machine.joints[leg.haa - kNumBaseCoordinates].upper > 0.6 ? 0.2 : -0.2;
    const auto joints = inverse.rest(base, i, curvature, {outwards, -0.2, 0.0});
    ASSERT_TRUE(joints) << kLimbNames[i] << " " << joints.error();
    EXPECT_EQ(joints->haa_rad, outwards);
    Eigen::VectorXd q = Eigen::VectorXd::Zero(machine.num_coordinates());
    q.tail(machine.num_joints()) = machine.transport_posture();
    q.head<kNumBaseCoordinates>() = base;
    q[leg.haa] = joints->haa_rad;
    q[leg.hfe] = joints->hfe_rad;
    q[leg.steer] = joints->steer_rad;
    KinematicTree::Workspace w = machine.tree.make_workspace();
    machine.tree.update(q, w);
    const Eigen::Vector3d p = machine.tree.position(w, leg.carrier_body, leg.p_carrier_wheel);
    const Eigen::Vector3d axle = machine.tree.direction(w, leg.carrier_body, leg.axle_carrier);
    EXPECT_NEAR(p.z(), wheel_rest(map, p.head<2>(), axle, leg.radius_m, leg.half_width_m).height_m,
                1e-5);
    // The axle points to the centre of the curve, on the base's lateral axis.
    const Eigen::Isometry3d T_base_world = T_world_base_from(base).inverse();
    const Eigen::Vector3d p_base = T_base_world * p, axle_base = T_base_world.linear() * axle;
    const Eigen::Vector2d to_centre = Eigen::Vector2d(0.0, 1.0 / curvature) - p_base.head<2>();
    EXPECT_NEAR(axle_base.x() * to_centre.y() - axle_base.y() * to_centre.x(), 0.0,
                1e-4 * to_centre.norm());
  }
}

TEST(LegInverse, KeepsTheSteeringIfNotAskedToRoll) {
  const TerrainMap map = flat_map(20.0, 20.0);
  LegInverse inverse(map, test_machine(), 0.15);
  BaseCoordinates base;
  base << 0.0, 0.0, 1.0, 0.0, 0.0, 0.0;
  const auto joints = inverse.rest(base, 0, std::nullopt, {0.3, -0.2, 0.4});
  ASSERT_TRUE(joints) << joints.error();
  EXPECT_EQ(joints->steer_rad, 0.4);
  EXPECT_EQ(joints->haa_rad, 0.3);
  const auto rolling = inverse.rest(base, 0, 0.0, {0.3, -0.2, 0.4});
  ASSERT_TRUE(rolling) << rolling.error();
  EXPECT_NEAR(rolling->steer_rad, -0.3, 0.02);  // straight ahead
}

TEST(LegInverse, SaysWhyAWheelCannotStand) {
  const TerrainMap map = flat_map(10.0, 10.0);
  LegInverse inverse(map, test_machine(), 0.15);
  BaseCoordinates base;
  base << 0.0, 0.0, 4.0, 0.0, 0.0, 0.0;  // far above any reach
  EXPECT_FALSE(inverse.rest(base, 0, 0.0, {}));
  base << 40.0, 0.0, 0.95, 0.0, 0.0, 0.0;
  const auto off_map = inverse.rest(base, 0, 0.0, {});
  ASSERT_FALSE(off_map);
  EXPECT_THAT(std::string(off_map.error()), testing::HasSubstr("off the map"));
}

}  // namespace
}  // namespace wex
