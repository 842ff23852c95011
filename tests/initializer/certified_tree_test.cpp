#include "initializer/stepping/certified_tree.hpp"

#include <gtest/gtest.h>

#include "test_worlds.hpp"

namespace wex {
namespace {

const Pose2 kStart{-6.0, 0.0, 0.2}, kGoal{6.0, 0.0, -0.1};

SearchSettings settings_for(const TerrainMap& map) {
  SearchSettings settings;
  settings.x_min_m = map.min_corner_m().x();
  settings.x_max_m = map.max_corner_m().x();
  settings.y_min_m = map.min_corner_m().y();
  settings.y_max_m = map.max_corner_m().y();
  return settings;
}

struct World {
  explicit World(const HeightFunction& height)
      : map(make_map(26.0, 16.0, height)),
        certifier(*Certifier::build(map, test_machine(), PlanSettings{})) {}
  [[nodiscard]] CertifiedTree tree(std::uint64_t seed = 1) const {
    return {certifier, kStart, kGoal, settings_for(map), seed};
  }
  /// The first sequence of a tree, if one grows in time.
  [[nodiscard]] std::optional<CertifiedSequence> grow(CertifiedTree& tree, int samples) const {
    for (int k = 0; k < samples; ++k) {
      if (auto sequence = tree.grow()) return sequence;
    }
    return std::nullopt;
  }
  TerrainMap map;
  Certifier certifier;
};

double gap(double x, double) { return std::abs(x) < 0.75 ? -4.0 : 0.0; }

/// One whole sequence: stations, states and bucket points fit together as if certified at once.
void expect_whole(const CertifiedSequence& sequence) {
  ASSERT_FALSE(sequence.states.empty());
  EXPECT_EQ(sequence.states.front().station, 0U);
  EXPECT_EQ(sequence.states.back().station, sequence.stations.size() - 1);
  EXPECT_EQ(sequence.states.back().support, Support{});
  EXPECT_NEAR(sequence.stations.front().pose.x_m, kStart.x_m, 1e-6);
  EXPECT_NEAR(sequence.stations.back().pose.x_m, kGoal.x_m, 1e-3);
  EXPECT_NEAR(sequence.stations.back().pose.y_m, kGoal.y_m, 1e-3);
  EXPECT_NEAR(sequence.stations.back().s_m, path_length_m(sequence.path), 1e-6);
  EXPECT_GE(sequence.min_margin_m, 0.30);
  for (std::size_t i = 0; i < sequence.states.size(); ++i) {
    const SteppingState& state = sequence.states[i];
    const Pose2& pose = sequence.stations[state.station].pose;
    EXPECT_NEAR(state.base[kBaseX], pose.x_m, 1e-6) << i;
    EXPECT_NEAR(state.base[kBaseYaw], pose.yaw_rad, 1e-6) << i;
    if (state.support.bucket >= 0) {
      ASSERT_LT(static_cast<std::size_t>(state.support.bucket), sequence.bucket_points.size());
      const Eigen::Vector3d& point =
          sequence.bucket_points[static_cast<std::size_t>(state.support.bucket)];
      EXPECT_LT((point - state.base.head<3>()).head<2>().norm(), 9.0) << "within the arm's reach";
    }
    if (i == 0) continue;
    const SteppingState& last = sequence.states[i - 1];
    EXPECT_GE(state.station, last.station);
    EXPECT_LE(state.station, last.station + 1);
    EXPECT_LT((state.base - last.base).norm(), 0.4) << i;
  }
}

TEST(CertifiedTree, ReachesTheGoalOverFlatGroundOnFourWheels) {
  const World world([](double, double) { return 0.0; });
  CertifiedTree tree = world.tree();
  const auto sequence = world.grow(tree, 40);
  ASSERT_TRUE(sequence);
  expect_whole(*sequence);
  for (const SteppingState& state : sequence->states) EXPECT_EQ(state.support, Support{});
  EXPECT_GT(tree.size(), 1U);
}

TEST(CertifiedTree, CrossesAGapWhateverTheSeed) {
  const World world(gap);
  for (const std::uint64_t seed : {1, 2}) {
    SCOPED_TRACE(seed);
    CertifiedTree tree = world.tree(seed);
    const auto sequence = world.grow(tree, 200);
    ASSERT_TRUE(sequence);
    expect_whole(*sequence);
  }
}

TEST(CertifiedTree, IsTheSameForTheSameSeed) {
  const World world(gap);
  CertifiedTree one = world.tree(5), same = world.tree(5);
  const auto a = world.grow(one, 200), b = world.grow(same, 200);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(one.iterations(), same.iterations());
  EXPECT_EQ(one.size(), same.size());
  ASSERT_EQ(a->states.size(), b->states.size());
  EXPECT_EQ(a->states.back().base, b->states.back().base);
  EXPECT_EQ(a->cost, b->cost);
}

TEST(CertifiedTree, NeverCrossesWhatCannotBeCrossed) {
  const World world([](double x, double) { return std::abs(x) < 2.6 ? -4.0 : 0.0; });
  CertifiedTree tree = world.tree();
  EXPECT_FALSE(world.grow(tree, 8));
  EXPECT_EQ(tree.iterations(), 8);
  EXPECT_GT(tree.size(), 1U) << "it grew on its side";
}

TEST(AppendSequence, ShiftsStationsPointsAndWholeTurns) {
  const World world(gap);
  const DrivePath first{{{-7.0, 0.0, 0.0}, 0.0, 2.0}};
  const DrivePath second{{{-5.0, 0.0, 2.0 * 3.14159265358979323846}, 0.0, 11.0}};
  auto sequence = world.certifier.certify(first);
  ASSERT_TRUE(sequence);
  const auto more = world.certifier.certify(second, sequence->states.back().base);
  ASSERT_TRUE(more) << more.error().why;
  ASSERT_FALSE(more->bucket_points.empty());
  const std::size_t states = sequence->states.size(), stations = sequence->stations.size();
  const std::size_t points = sequence->bucket_points.size();
  const double cost = sequence->cost;
  append_sequence(*sequence, *more);
  EXPECT_EQ(sequence->states.size(), states + more->states.size() - 1);
  EXPECT_EQ(sequence->stations.size(), stations + more->stations.size() - 1);
  EXPECT_DOUBLE_EQ(sequence->cost, cost + more->cost);
  EXPECT_NEAR(sequence->stations.back().s_m, 13.0, 1e-9);
  EXPECT_NEAR(sequence->stations.back().pose.yaw_rad, 0.0, 1e-9);
  EXPECT_NEAR(sequence->states.back().base[kBaseYaw], 0.0, 1e-9);
  EXPECT_EQ(sequence->states.back().station, sequence->stations.size() - 1);
  for (std::size_t i = 1; i < more->states.size(); ++i) {
    const SteppingState& from = more->states[i];
    const SteppingState& to = sequence->states[states + i - 1];
    if (from.support.bucket < 0) continue;
    EXPECT_EQ(sequence->bucket_points[static_cast<std::size_t>(to.support.bucket)],
              more->bucket_points[static_cast<std::size_t>(from.support.bucket)]);
  }
  EXPECT_EQ(sequence->bucket_points.size(), points + more->bucket_points.size());
}

}  // namespace
}  // namespace wex
