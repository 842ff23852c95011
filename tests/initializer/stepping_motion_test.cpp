#include "initializer/stepping/stepping_motion.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <set>

#include "stepping_worlds.hpp"

namespace wex {
namespace {

constexpr double kMarginM = 0.30;

TerrainMap gap_map(double width_m) {
  return make_map(40.0, 12.0,
                  [&](double x, double) { return x > 0.0 && x < width_m ? -2.0 : 0.0; });
}

std::vector<WholeBodyNode> motion_of(const TerrainMap& map, const CertifiedSequence& sequence) {
  const auto nodes = stepping_motion(map, test_machine(), {}, sequence);
  if (!nodes) {
    ADD_FAILURE() << "state " << nodes.error().state << ": " << nodes.error().why;
    return {};
  }
  return *nodes;
}

// What a coarse plan has to keep to, looked at in steps of a centimetre.
void expect_sound(const PlanFacts& facts) {
  EXPECT_LE(facts.contact_error_at_nodes_m, 0.02);
  EXPECT_LE(facts.contact_error_between_m, 0.05);
  EXPECT_LE(facts.bucket_slip_m, 0.01);
  EXPECT_LE(facts.bucket_height_error_m, 0.02);
  EXPECT_GE(facts.swing_clearance_m, 0.10);
  EXPECT_GE(facts.margin_m, kMarginM) << "at " << facts.margin_at_s << " s";
  EXPECT_LE(facts.joint_step, 0.1 + 1e-6);
  EXPECT_LE(facts.base_step_m, 0.2 + 1e-5);
  EXPECT_LE(facts.rate_share, 0.8 + 1e-6);
  EXPECT_LE(facts.flow_share, 1.0 + 1e-6);
  EXPECT_LE(facts.limit_excess, 0.0);
  EXPECT_LE(facts.most_changes_at_once, 1);
  EXPECT_TRUE(facts.time_increases);
}

TEST(SteppingMotion, CrossesGapsOnTheBucketWithinEveryLimit) {
  for (const double width_m : {1.0, 2.0, 3.4}) {
    SCOPED_TRACE(width_m);
    const TerrainMap map = gap_map(width_m);
    const auto nodes = motion_of(map, gap_sequence(width_m));
    ASSERT_FALSE(nodes.empty());
    const PlanFacts facts = look_at(map, test_machine(), nodes);
    expect_sound(facts);
    EXPECT_EQ(facts.contact_changes, 12) << "bucket, two wheels, down and up, front and rear";
  }
}

TEST(SteppingMotion, LiftsAndLandsInOrderWithFullContactBetween) {
  const TerrainMap map = gap_map(2.0);
  const auto nodes = motion_of(map, gap_sequence(2.0));
  ASSERT_FALSE(nodes.empty());
  std::vector<std::string> schedule;
  for (const WholeBodyNode& node : nodes) {
    std::string contacts;
    for (const bool contact : node.contacts) contacts += contact ? '1' : '0';
    if (schedule.empty() || schedule.back() != contacts) schedule.push_back(contacts);
  }
  const std::vector<std::string> expected{"11110", "11111", "01111", "00111", "10111",
                                          "11111", "11110", "11111", "11011", "11001",
                                          "11101", "11111", "11110"};
  EXPECT_EQ(schedule, expected);
}

TEST(SteppingMotion, StartsAndEndsInTransportPostureWhereTheSequenceSays) {
  const TerrainMap map = gap_map(2.0);
  const CertifiedSequence sequence = gap_sequence(2.0);
  const auto nodes = motion_of(map, sequence);
  ASSERT_FALSE(nodes.empty());
  const Eigen::VectorXd transport = test_machine().transport_posture();
  for (const auto& [node, state] : {std::pair(nodes.front(), sequence.states.front()),
                                    std::pair(nodes.back(), sequence.states.back())}) {
    EXPECT_LT((node.q.head<kNumBaseCoordinates>() - state.base).norm(), 1e-9);
    for (const int coordinate : test_machine().arm->coordinates) {
      EXPECT_NEAR(node.q[coordinate], transport[coordinate - kNumBaseCoordinates], 1e-9);
    }
  }
  EXPECT_EQ(nodes.front().t_s, 0.0);
}

TEST(SteppingMotion, RestsAtEveryContactChange) {
  const TerrainMap map = gap_map(2.0);
  const auto nodes = motion_of(map, gap_sequence(2.0));
  ASSERT_FALSE(nodes.empty());
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    for (std::size_t limb = 0; limb < kNumLimbs; ++limb) {
      if (!nodes[i - 1].contacts[limb] || nodes[i].contacts[limb]) continue;
      EXPECT_EQ(nodes[i - 1].q, nodes[i].q) << "lifted at " << nodes[i].t_s << " s while moving";
      EXPECT_GE(nodes[i].t_s - nodes[i - 1].t_s, 1.0 - 1e-9) << "load is confirmed first";
    }
  }
}

TEST(SteppingMotion, LowersTheBucketSlowlyAndStraightDown) {
  const TerrainMap map = gap_map(2.0);
  const auto nodes = motion_of(map, gap_sequence(2.0));
  KinematicTree::Workspace w = test_machine().tree.make_workspace();
  const auto bucket = [&](const WholeBodyNode& node) {
    test_machine().tree.update(node.q, w);
    return test_machine().tree.position(w, test_machine().arm->contact_body,
                                        test_machine().arm->p_body_contact);
  };
  int touches = 0;
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    if (nodes[i - 1].contacts[4] || !nodes[i].contacts[4]) continue;
    ++touches;
    const Eigen::Vector3d touch = bucket(nodes[i]);
    for (std::size_t k = i; k > i - 3; --k) {
      const Eigen::Vector3d above = bucket(nodes[k - 1]), below = bucket(nodes[k]);
      EXPECT_LE((above.z() - below.z()) / (nodes[k].t_s - nodes[k - 1].t_s), 0.05 + 1e-6);
      EXPECT_LT((above - touch).head<2>().norm(), 0.01);
    }
  }
  EXPECT_EQ(touches, 2);
}

TEST(SteppingMotion, StandingWheelsDoNotTurnAndLiftedOnesTurnWithTheGround) {
  const TerrainMap map = gap_map(2.0);
  const auto nodes = motion_of(map, gap_sequence(2.0));
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    const Eigen::VectorXd step = nodes[i].q - nodes[i - 1].q;
    for (const WheeledLeg& leg : test_machine().legs) {
      // Beside the gap the spline of level ground is off by tenths of a millimetre.
      EXPECT_NEAR(leg.wheel_sign * step[leg.wheel], step[kBaseX] / leg.radius_m, 2e-4);
    }
  }
}

TEST(SteppingMotion, ChangesHeightAndPitchOnItsWayWithoutLosingContact) {
  const TerrainMap map = flat_map();
  HandMadeSequence hand(-4.0, 4.0, 0.9);
  hand.drive_to(-2.0).rise_to(1.2, 0.0).drive_to(0.0).rise_to(1.1, 0.0873).drive_to(4.0);
  const auto nodes = motion_of(map, hand.get());
  ASSERT_FALSE(nodes.empty());
  expect_sound(look_at(map, test_machine(), nodes));
  // Smoothed: between the steps of the grid the base passes heights that the sequence jumps over.
  std::set<double> heights;
  for (const WholeBodyNode& node : nodes) heights.insert(node.q[kBaseZ]);
  EXPECT_GT(heights.size(), 15U);
}

TEST(SteppingMotion, DrivesOnThreeWheelsWithTheArmAsCounterweight) {
  const TerrainMap map = flat_map();
  HandMadeSequence hand(-4.0, 4.0, 1.0);
  // Arm far out over the right hind corner; machine.md 1.5 has LF stable at cabin yaws there.
  hand.hold_arm({-2.4, 0.9, 0.2, 1.0, -0.8});
  hand.drive_to(-1.0).drive_to(1.0, {0b0001, -1}).drive_to(4.0);
  const auto nodes = motion_of(map, hand.get());
  ASSERT_FALSE(nodes.empty());
  const PlanFacts facts = look_at(map, test_machine(), nodes);
  expect_sound(facts);
  EXPECT_EQ(facts.contact_changes, 2);
}

TEST(SteppingMotion, FindsACounterweightOfItsOwnWhereTheGivenOneIsImpossible) {
  const TerrainMap map = flat_map();
  for (int wheel = 0; wheel < kNumWheels; ++wheel) {
    SCOPED_TRACE(wheel);
    HandMadeSequence hand(-3.0, 3.0, 1.0);
    hand.drive_to(-1.0).drive_to(1.0, {static_cast<std::uint8_t>(1 << wheel), -1}).drive_to(3.0);
    const auto nodes = motion_of(map, hand.get());
    ASSERT_FALSE(nodes.empty());
    expect_sound(look_at(map, test_machine(), nodes));
  }
}

TEST(SteppingMotion, SaysWhichStateCannotBeReached) {
  const TerrainMap map = gap_map(2.0);
  CertifiedSequence sequence = gap_sequence(2.0);
  sequence.bucket_points[0].x() += 3.0;
  const auto nodes = stepping_motion(map, test_machine(), {}, sequence);
  ASSERT_FALSE(nodes);
  EXPECT_EQ(sequence.states[nodes.error().state].support, (Support{kFrontPair, 0}));
  EXPECT_NE(nodes.error().why.find("bucket"), std::string::npos) << nodes.error().why;
}

TEST(SteppingMotion, SaysWhichWheelHasNoGround) {
  const TerrainMap map = gap_map(2.0);
  HandMadeSequence hand(-7.0, 7.0, 1.0);
  hand.drive_to(7.0);
  const auto nodes = stepping_motion(map, test_machine(), {}, hand.get());
  ASSERT_FALSE(nodes);
  EXPECT_NE(nodes.error().why.find("wheel"), std::string::npos) << nodes.error().why;
  EXPECT_LT(hand.get().states[nodes.error().state].base[kBaseX], -2.0);
}

TEST(SteppingMotion, IsTheSameTwice) {
  const TerrainMap map = gap_map(2.0);
  const auto steps = SteppingMotion::build(map, test_machine(), {});
  ASSERT_TRUE(steps);
  const auto once = steps->nodes(gap_sequence(2.0)), again = steps->nodes(gap_sequence(2.0));
  ASSERT_TRUE(once && again);
  ASSERT_EQ(once->size(), again->size());
  for (std::size_t i = 0; i < once->size(); ++i) {
    EXPECT_EQ((*once)[i].q, (*again)[i].q);
    EXPECT_EQ((*once)[i].t_s, (*again)[i].t_s);
  }
}

TEST(SteppingMotion, MovesWithMapAndSequence) {
  const Eigen::Vector2d shift(12.3, -4.5);
  const double width_m = 2.0;
  const TerrainMap here = gap_map(width_m);
  const TerrainMap there = make_map(
      40.0, 12.0, [&](double x, double) { return x > 0.0 && x < width_m ? -2.0 : 0.0; }, shift);
  CertifiedSequence sequence = gap_sequence(width_m);
  const auto nodes = motion_of(here, sequence);
  for (PathSegment& segment : sequence.path) {
    segment.start.x_m += shift.x();
    segment.start.y_m += shift.y();
  }
  for (Station& station : sequence.stations) {
    station.pose.x_m += shift.x();
    station.pose.y_m += shift.y();
  }
  for (SteppingState& state : sequence.states) state.base.head<2>() += shift;
  for (Eigen::Vector3d& point : sequence.bucket_points) point.head<2>() += shift;
  const auto moved = motion_of(there, sequence);
  ASSERT_EQ(nodes.size(), moved.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    EXPECT_LT((nodes[i].q - moved[i].q).tail(test_machine().num_joints()).norm(), 1e-4) << i;
    EXPECT_NEAR(nodes[i].t_s, moved[i].t_s, 1e-3);
  }
}

}  // namespace
}  // namespace wex
