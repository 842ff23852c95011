#include "tools/wex/reference_progress.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace wex::app {
namespace {

constexpr double kDt = 0.1;
constexpr ReferenceProgressSettings kAtOnce{.head_start_s = 0.0};

/// 0.5 m/s along x for 10 s, then back for 10 s.
std::vector<WholeBodyNode> there_and_back() {
  std::vector<WholeBodyNode> nodes;
  for (int k = 0; k <= 80; ++k) {
    WholeBodyNode node;
    node.t_s = 0.25 * k;
    node.q = Eigen::VectorXd::Zero(kNumBaseCoordinates);
    node.q[kBaseX] = 0.5 * std::min(node.t_s, 20.0 - node.t_s);
    nodes.push_back(node);
  }
  return nodes;
}

BaseCoordinates base_at(double x) {
  BaseCoordinates base = BaseCoordinates::Zero();
  base[kBaseX] = x;
  return base;
}

TEST(ReferenceProgress, RunsWithRealTimeWhileTheMachineKeepsUp) {
  ReferenceProgress progress(there_and_back(), kAtOnce);
  for (int k = 0; k < 50; ++k) progress.advance(kDt, base_at(0.5 * kDt * k - 0.1));
  EXPECT_NEAR(progress.time_s(), 5.0, 1e-9);
  EXPECT_NEAR(progress.fraction(), 0.25, 1e-9);
}

TEST(ReferenceProgress, DoesNotRunAwayFromAMachineThatStands) {
  ReferenceProgress progress(there_and_back(), kAtOnce);
  for (int k = 0; k < 600; ++k) progress.advance(kDt, base_at(0.0));
  // At 0.5 m/s the full-stop lag of 0.45 m is reached after 0.9 s.
  EXPECT_LT(progress.time_s(), 0.91);
  EXPECT_GT(progress.time_s(), 0.6);
  EXPECT_FALSE(progress.finished());
}

TEST(ReferenceProgress, GoesOnWhenTheMachineCatchesUp) {
  ReferenceProgress progress(there_and_back(), kAtOnce);
  for (int k = 0; k < 100; ++k) progress.advance(kDt, base_at(0.0));
  const double waited_s = progress.time_s();
  progress.advance(kDt, base_at(0.5 * waited_s));
  EXPECT_NEAR(progress.time_s(), waited_s + kDt, 1e-9);
}

TEST(ReferenceProgress, NeverGoesBackwardsAndEndsAtTheEnd) {
  ReferenceProgress progress(there_and_back(), kAtOnce);
  double last_s = progress.time_s();
  for (int k = 0; k < 400; ++k) {
    const double reference_x = 0.5 * std::min(last_s, 20.0 - last_s);
    progress.advance(kDt, base_at(reference_x + (k % 3 - 1) * 0.4));
    EXPECT_GE(progress.time_s(), last_s);
    last_s = progress.time_s();
  }
  EXPECT_TRUE(progress.finished());
  EXPECT_DOUBLE_EQ(progress.time_s(), 20.0);
  EXPECT_DOUBLE_EQ(progress.fraction(), 1.0);
}

TEST(ReferenceProgress, MeasuresTheLagAlongTheDirectionOfTravel) {
  ReferenceProgress progress(there_and_back(), kAtOnce);
  for (int k = 0; k < 150; ++k) {
    const double t = progress.time_s();
    progress.advance(kDt, base_at(0.5 * std::min(t, 20.0 - t)));
  }
  // At 15 s the reference is at 2.5 m and travels towards -x: behind means a larger x.
  EXPECT_NEAR(progress.lag_m(base_at(2.8)), 0.3, 1e-6);
  EXPECT_NEAR(progress.lag_m(base_at(2.2)), -0.3, 1e-6);
  EXPECT_NEAR(progress.error_m(base_at(2.2)), 0.3, 1e-6);
}

TEST(ReferenceProgress, ALateralErrorIsNoLag) {
  ReferenceProgress progress(there_and_back(), kAtOnce);
  BaseCoordinates base = base_at(0.0);
  base[kBaseY] = 2.0;
  EXPECT_NEAR(progress.lag_m(base), 0.0, 1e-9);
}

TEST(ReferenceProgress, GivesTheMachineAHeadStartBeforeTheReferenceMoves) {
  ReferenceProgress progress(there_and_back(), {.head_start_s = 0.3});
  EXPECT_DOUBLE_EQ(progress.time_s(), -0.3);
  EXPECT_DOUBLE_EQ(progress.fraction(), 0.0);
  EXPECT_NEAR(progress.error_m(base_at(0.0)), 0.0, 1e-12);
  for (int k = 0; k < 3; ++k) progress.advance(kDt, base_at(0.0));
  EXPECT_NEAR(progress.time_s(), 0.0, 1e-12);
}

TEST(ReferenceProgress, RefusesAnEmptyTrajectory) {
  EXPECT_THROW(ReferenceProgress({}), std::logic_error);
}

}  // namespace
}  // namespace wex::app
