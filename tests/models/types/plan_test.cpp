#include "models/types/plan.hpp"

#include <gmock/gmock.h>

#include <random>
#include <stdexcept>

namespace wex {
namespace {

constexpr double kTolerance = 1e-12;  // of the node's own unit: interpolation is a few roundings

WholeBodyNode node(double t_s, double first, double second, bool rear_left_loaded = true) {
  WholeBodyNode result;
  result.t_s = t_s;
  result.q = Eigen::Vector2d(first, second);
  result.contacts[static_cast<int>(Limb::kLH)] = rear_left_loaded;
  return result;
}

const std::vector<WholeBodyNode> kNodes{node(1.0, 0.0, 4.0), node(2.0, 1.0, 2.0, false),
                                        node(4.0, 5.0, -2.0)};

bool rear_left_loaded_at(double t_s) {
  return sample(kNodes, t_s).contacts[static_cast<int>(Limb::kLH)];
}

TEST(Sample, GivesTheNodeItselfAtItsTime) {
  for (const WholeBodyNode& expected : kNodes) {
    const WholeBodyNode sampled = sample(kNodes, expected.t_s);
    EXPECT_DOUBLE_EQ(sampled.t_s, expected.t_s);
    EXPECT_EQ(sampled.q, expected.q);
    EXPECT_EQ(sampled.contacts, expected.contacts);
  }
}

TEST(Sample, InterpolatesLinearlyBetweenUnevenNodes) {
  const WholeBodyNode sampled = sample(kNodes, 2.5);
  EXPECT_DOUBLE_EQ(sampled.t_s, 2.5);
  EXPECT_NEAR(sampled.q[0], 2.0, kTolerance);
  EXPECT_NEAR(sampled.q[1], 1.0, kTolerance);
}

TEST(Sample, StaysBetweenTheNeighboursAtRandomTimes) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> time_s(1.0, 4.0);
  for (int i = 0; i < 1000; ++i) {
    const double t_s = time_s(random);
    const double slope_of_first = t_s < 2.0 ? 1.0 : 2.0;
    const double expected = (t_s < 2.0 ? 0.0 : 1.0) + slope_of_first * (t_s - (t_s < 2.0 ? 1 : 2));
    EXPECT_NEAR(sample(kNodes, t_s).q[0], expected, kTolerance) << "t = " << t_s << " s";
  }
}

TEST(Sample, KeepsTheContactsOfTheNodeAtOrBefore) {
  EXPECT_TRUE(rear_left_loaded_at(1.999));
  EXPECT_FALSE(rear_left_loaded_at(2.0));
  EXPECT_FALSE(rear_left_loaded_at(3.999));
  EXPECT_TRUE(rear_left_loaded_at(4.0));
}

TEST(Sample, HoldsTheFirstAndTheLastNodeOutsideTheirTimes) {
  EXPECT_EQ(sample(kNodes, -3.0).q, kNodes.front().q);
  EXPECT_EQ(sample(kNodes, 100.0).q, kNodes.back().q);
  EXPECT_EQ(sample({node(2.0, 8.0, 9.0)}, 2.5).q, Eigen::Vector2d(8.0, 9.0));
}

TEST(Sample, TreatsAnEmptyListAsACallerBug) {
  EXPECT_THROW(static_cast<void>(sample({}, 0.0)), std::logic_error);
}

}  // namespace
}  // namespace wex
