#include "initializer/stepping/certificate.hpp"

#include <gmock/gmock.h>

#include "initializer/internal/se2_search.hpp"
#include "initializer/stepping/stance_check.hpp"
#include "test_worlds.hpp"

namespace wex {
namespace {

constexpr double kMarginM = 0.30;
constexpr std::uint8_t kFrontPair = 0b0011, kRearPair = 0b1100;

DrivePath straight_to(double x_m) { return {{{-7.5, 0.0, 0.0}, 0.0, x_m + 7.5}}; }

/// Deeper than the machine can climb down.
double gap(double x, double half_width) { return std::abs(x) < half_width ? -4.0 : 0.0; }

struct World {
  explicit World(const HeightFunction& height, const CertificateSettings& settings = {})
      : map(make_map(30.0, 16.0, height)),
        certifier(*Certifier::build(map, test_machine(), PlanSettings{}, settings)) {}
  TerrainMap map;
  Certifier certifier;
};

/// Supports in the order they are used, four wheels left out.
std::vector<std::uint8_t> lifted_in_turn(const CertifiedSequence& sequence) {
  std::vector<std::uint8_t> lifted;
  for (std::size_t i = 1; i < sequence.states.size(); ++i) {
    const SteppingState& state = sequence.states[i];
    if (state.support.lifted != 0 && !(state.support == sequence.states[i - 1].support)) {
      lifted.push_back(state.support.lifted);
    }
  }
  return lifted;
}

/// What the header promises of every sequence.
void expect_sound(const World& world, const CertifiedSequence& sequence) {
  const CertificateSettings settings;
  const StanceTables tables = *StanceTables::build(test_machine());
  const StanceGround ground(world.map);
  const StanceCheck check(ground, tables);
  const ArmPlane& plane = tables.arm.plane();
  ASSERT_FALSE(sequence.states.empty());
  EXPECT_EQ(sequence.states.front().support, Support{});
  EXPECT_EQ(sequence.states.back().support, Support{});
  EXPECT_EQ(sequence.states.front().station, 0U);
  EXPECT_EQ(sequence.states.back().station, sequence.stations.size() - 1);
  for (std::size_t i = 0; i < sequence.states.size(); ++i) {
    const SteppingState& state = sequence.states[i];
    EXPECT_GE(state.margin_m, kMarginM) << i;
    EXPECT_GE(state.margin_m, sequence.min_margin_m) << i;
    const Pose2& pose = sequence.stations[state.station].pose;
    EXPECT_EQ(state.base[kBaseX], pose.x_m);
    EXPECT_EQ(state.base[kBaseYaw], pose.yaw_rad);
    if (state.support.bucket >= 0) {
      const Eigen::Vector3d& bucket =
          sequence.bucket_points[static_cast<std::size_t>(state.support.bucket)];
      EXPECT_NEAR(bucket.z(), world.map.height_m(bucket.head<2>()), 1e-6);
      // The arm reaches it, and is near it along the heading but not beside it.
      const ArmPlane::Points points = plane.points(state.arm);
      const Eigen::Vector3d p =
          T_world_base_from(state.base) *
          plane.p_base(points.contact, std::cos(state.arm.turn_rad), std::sin(state.arm.turn_rad));
      EXPECT_LT((p - bucket).norm(), 1e-6) << i;
      const Eigen::Vector2d from_base = bucket.head<2>() - state.base.head<2>();
      const Eigen::Vector2d heading(std::cos(pose.yaw_rad), std::sin(pose.yaw_rad));
      EXPECT_GE(std::abs(heading.dot(from_base)), 3.0 - 1e-9);
      EXPECT_LE(std::abs(heading.x() * from_base.y() - heading.y() * from_base.x()), 0.5 + 1e-9);
    }
    if (i == 0) continue;
    const SteppingState& last = sequence.states[i - 1];
    const BaseCoordinates change = state.base - last.base;
    if (state.support == last.support) {
      EXPECT_LE(state.station - last.station, 1U);
      EXPECT_LE(std::abs(change[kBaseZ]), settings.height_step_m + 1e-9);
      EXPECT_LE(std::abs(change[kBasePitch]), settings.pitch_step_rad + 1e-9);
    } else {
      EXPECT_EQ(change, BaseCoordinates::Zero()) << i;
      EXPECT_TRUE(state.support == Support{} || last.support == Support{}) << i;
    }
  }
}

TEST(Certificate, OnFlatGroundFourWheelsStayDown) {
  const World world([](double, double) { return 0.0; });
  const auto sequence = world.certifier.certify(straight_to(7.5));
  ASSERT_TRUE(sequence) << sequence.error().why;
  expect_sound(world, *sequence);
  EXPECT_THAT(lifted_in_turn(*sequence), testing::IsEmpty());
  EXPECT_EQ(sequence->states.size(), sequence->stations.size());
  for (const SteppingState& state : sequence->states) EXPECT_NEAR(state.base[kBaseZ], 0.95, 1e-9);
}

TEST(Certificate, CrossesAGapFrontPairFirst) {
  for (const double width_m : {1.0, 2.2, 3.5}) {
    const World world([&](double x, double) { return gap(x, 0.5 * width_m); });
    const auto sequence = world.certifier.certify(straight_to(7.5));
    ASSERT_TRUE(sequence) << width_m << ": " << sequence.error().why;
    expect_sound(world, *sequence);
    EXPECT_THAT(lifted_in_turn(*sequence), testing::ElementsAre(kFrontPair, kRearPair)) << width_m;
  }
}

TEST(Certificate, BucketStandsBeyondTheGapForTheFrontAndBeforeItForTheRear) {
  const World world([](double x, double) { return gap(x, 1.0); });
  const auto sequence = world.certifier.certify(straight_to(7.5));
  ASSERT_TRUE(sequence) << sequence.error().why;
  for (const SteppingState& state : sequence->states) {
    if (state.support.bucket < 0) continue;
    const double x = sequence->bucket_points[static_cast<std::size_t>(state.support.bucket)].x();
    if (state.support.lifted == kFrontPair) {
      EXPECT_GT(x, 1.0);
    } else {
      EXPECT_LT(x, -1.0);
    }
  }
}

TEST(Certificate, GapWiderThanTheWheelbaseStopsTheMachineBeforeIt) {
  const World world([](double x, double) { return gap(x, 2.6); });
  const auto sequence = world.certifier.certify(straight_to(7.5));
  ASSERT_FALSE(sequence);
  EXPECT_LT(sequence.error().where.x_m, 3.0);
  EXPECT_FALSE(sequence.error().why.empty());
}

TEST(Certificate, ClimbsABlockRaisingTheBase) {
  for (const double height_m : {0.5, 1.5}) {
    const World world([&](double x, double) { return x > 0.0 ? height_m : 0.0; });
    const auto sequence = world.certifier.certify(straight_to(7.5));
    ASSERT_TRUE(sequence) << height_m << ": " << sequence.error().why;
    expect_sound(world, *sequence);
    EXPECT_GT(sequence->states.back().base[kBaseZ], height_m + 0.4);
    EXPECT_THAT(lifted_in_turn(*sequence), testing::Contains(kFrontPair));
  }
}

TEST(Certificate, SkewOfAFewDegreesBreaksNothing) {
  const double tangent = std::tan(4.0 * 3.14159265358979 / 180.0);
  const World world([&](double x, double y) { return gap(x + tangent * y, 1.5); });
  const DrivePath path = reeds_shepp_path({-7.5, 0.8, 0.15}, {7.5, -0.6, -0.1}, 4.5);
  const auto sequence = world.certifier.certify(path);
  ASSERT_TRUE(sequence) << sequence.error().why;
  expect_sound(world, *sequence);
}

TEST(Certificate, FollowsRoughGroundWithRollAndPitch) {
  const World world([](double x, double y) { return 0.6 * bumps(x, y); });
  const auto sequence = world.certifier.certify(straight_to(5.0));
  ASSERT_TRUE(sequence) << sequence.error().why;
  expect_sound(world, *sequence);
  double most_roll = 0.0;
  for (const SteppingState& state : sequence->states) {
    most_roll = std::max(most_roll, std::abs(state.base[kBaseRoll]));
  }
  EXPECT_GT(most_roll, 0.02);
}

TEST(Certificate, PrefixEndsOnFourWheelsWhereThePathGetsImpossible) {
  const World world([](double x, double) { return gap(x, 2.6); });
  const auto prefix = world.certifier.certify_prefix(straight_to(7.5), 1.0);
  ASSERT_TRUE(prefix);
  expect_sound(world, *prefix);
  EXPECT_LT(prefix->stations.back().pose.x_m, -4.0);
  EXPECT_GT(prefix->stations.back().pose.x_m, -5.6);
  EXPECT_NEAR(path_length_m(prefix->path), prefix->stations.back().s_m, 1e-9);
  EXPECT_FALSE(world.certifier.certify_prefix(straight_to(7.5), 5.0));
}

TEST(Certificate, BeginsWhereItIsTold) {
  const World world([](double x, double) { return gap(x, 0.5); });
  BaseCoordinates begin;
  begin << -7.5, 0.0, 1.13, 0.0, 0.03, 0.01;
  const auto sequence = world.certifier.certify(straight_to(7.5), begin);
  ASSERT_TRUE(sequence) << sequence.error().why;
  EXPECT_LT((sequence->states.front().base - begin).norm(), 1e-9);
  expect_sound(world, *sequence);
}

TEST(Certificate, TheSameQuestionHasTheSameAnswer) {
  const World world([](double x, double) { return gap(x, 1.0); });
  const auto a = world.certifier.certify(straight_to(7.5)),
             b = world.certifier.certify(straight_to(7.5));
  ASSERT_TRUE(a && b);
  ASSERT_EQ(a->states.size(), b->states.size());
  for (std::size_t i = 0; i < a->states.size(); ++i) {
    EXPECT_EQ(a->states[i].base, b->states[i].base);
    EXPECT_EQ(a->states[i].support, b->states[i].support);
  }
}

TEST(Projection, NeverRefusesWhatTheGraphAccepts) {
  for (const double width_m : {0.0, 1.0, 3.5}) {
    const World world([&](double x, double) { return gap(x, 0.5 * width_m); });
    const auto sequence = world.certifier.certify(straight_to(7.5));
    ASSERT_TRUE(sequence);
    for (const SteppingState& state : sequence->states) {
      const auto admission = world.certifier.admits(sequence->stations[state.station].pose, 0.0);
      EXPECT_NE(admission, Certifier::Admission::kRefused) << state.base.transpose();
      if (state.support == Support{}) {
        EXPECT_EQ(admission, Certifier::Admission::kOnFourWheels);
      }
    }
  }
}

TEST(Projection, TellsDrivingFromSteppingFromNothing) {
  const World world([](double x, double) { return gap(x, 1.0); });
  EXPECT_EQ(world.certifier.admits({-7.0, 0.0, 0.0}, 0.0), Certifier::Admission::kOnFourWheels);
  EXPECT_EQ(world.certifier.admits({-2.4, 0.0, 0.0}, 0.0), Certifier::Admission::kNeedsStepping);
  EXPECT_EQ(world.certifier.admits({0.0, 0.0, 0.0}, 0.0), Certifier::Admission::kOnFourWheels)
      << "astride";
  EXPECT_EQ(world.certifier.admits({1.5, 0.0, 1.5708}, 0.0), Certifier::Admission::kRefused)
      << "along the gap, its left wheels over it";
  EXPECT_EQ(world.certifier.admits({14.0, 0.0, 0.0}, 0.0), Certifier::Admission::kRefused)
      << "off the map";
}

}  // namespace
}  // namespace wex
