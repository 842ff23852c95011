#include "initializer/stepping/stepping_timing.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "test_worlds.hpp"

namespace wex {
namespace {

constexpr double kShare = 0.8;
constexpr SteppingTimingSettings kSettings{};

MotionNode standing() {
  MotionNode node;
  node.q = Eigen::VectorXd::Zero(test_machine().num_coordinates());
  node.q.tail(test_machine().num_joints()) = test_machine().transport_posture();
  node.stop = true;
  return node;
}

const Joint& joint(const std::string& name) {
  return test_machine()
      .joints[static_cast<std::size_t>(*test_machine().coordinate(name) - kNumBaseCoordinates)];
}

// A move of some joints from rest to rest in equal pieces.
std::vector<MotionNode> move(const std::vector<std::pair<std::string, double>>& steps, int pieces) {
  std::vector<MotionNode> nodes;
  for (int i = 0; i <= pieces; ++i) {
    MotionNode node = standing();
    node.stop = i == 0 || i == pieces;
    for (const auto& [name, step] : steps) {
      node.q[*test_machine().coordinate(name)] += step * i / pieces;
    }
    nodes.push_back(node);
  }
  return nodes;
}

TEST(SteppingTiming, OneJointTakesItsRateAndAcceleration) {
  const double angle_rad = 3.0;
  const auto t_s = node_times_s(test_machine(), move({{"TURN", angle_rad}}, 60), kSettings);
  const double rate = kShare * joint("TURN").max_rate;
  const double expected_s = angle_rad / rate + rate / joint("TURN").max_acceleration;
  EXPECT_NEAR(t_s.back(), expected_s, 0.05 * expected_s);
  for (std::size_t i = 1; i < t_s.size(); ++i) {
    EXPECT_LE(angle_rad / 60 / (t_s[i] - t_s[i - 1]), rate + 1e-9);
  }
}

TEST(SteppingTiming, ThePumpIsShared) {
  const double angle_rad = 0.8;
  const auto together = move(
      {{"BOOM", -angle_rad}, {"DIPPER", angle_rad}, {"TELE", angle_rad}, {"EE_PITCH", angle_rad}},
      16);
  double flow_m3 = 0.0;
  for (const char* name : {"BOOM", "DIPPER", "TELE", "EE_PITCH"}) {
    flow_m3 += angle_rad * joint(name).max_effort / test_machine().pump_pressure_pa;
  }
  EXPECT_NEAR(shortest_duration_s(test_machine(), together.front().q, together.back().q, kShare),
              flow_m3 / test_machine().pump_flow_limit_w_over_pa, 1e-9);
  const double alone_s =
      node_times_s(test_machine(), move({{"BOOM", -angle_rad}}, 16), kSettings).back();
  EXPECT_GT(node_times_s(test_machine(), together, kSettings).back(), alone_s + 0.5);
}

TEST(SteppingTiming, WheelsTakeNoOilFromThePump) {
  const auto nodes = move({{"LF_WHEEL", 10.0}}, 10);
  EXPECT_NEAR(shortest_duration_s(test_machine(), nodes.front().q, nodes.back().q, kShare),
              10.0 / (kShare * joint("LF_WHEEL").max_rate), 1e-9);
}

TEST(SteppingTiming, TheBaseKeepsToSpeedAndAcceleration) {
  std::vector<MotionNode> nodes;
  for (int i = 0; i <= 50; ++i) {
    nodes.push_back(standing());
    nodes.back().stop = i == 0 || i == 50;
    nodes.back().q[kBaseX] = 0.1 * i;
    nodes.back().base_speed_m_s = 0.5;
  }
  const auto t_s = node_times_s(test_machine(), nodes, kSettings);
  const double expected_s = 5.0 / 0.5 + 0.5 / kSettings.max_base_acceleration_m_s2;
  EXPECT_NEAR(t_s.back(), expected_s, 0.05 * expected_s);
  for (std::size_t i = 1; i < t_s.size(); ++i) EXPECT_LE(0.1 / (t_s[i] - t_s[i - 1]), 0.5 + 1e-9);
}

TEST(SteppingTiming, ACornerIsTakenAsSlowlyAsAccelerationAsks) {
  std::vector<MotionNode> straight, corner;
  for (int i = 0; i <= 40; ++i) {
    straight.push_back(standing());
    straight.back().stop = i == 0 || i == 40;
    straight.back().q[kBaseX] = 0.1 * i;
    corner.push_back(straight.back());
    corner.back().q[kBaseZ] = 0.08 * std::max(0, i - 20);
  }
  const auto fast = node_times_s(test_machine(), straight, kSettings);
  const auto slow = node_times_s(test_machine(), corner, kSettings);
  EXPECT_GT(slow[21] - slow[19], 1.1 * (fast[21] - fast[19]));
  EXPECT_NEAR(slow[10], fast[10], 1e-9) << "far from the corner nothing changes";
}

TEST(SteppingTiming, PausesLastAndTimesIncrease) {
  std::vector<MotionNode> nodes{standing(), standing(), standing()};
  nodes[0].min_duration_s = 1.5;
  const auto t_s = node_times_s(test_machine(), nodes, kSettings);
  EXPECT_NEAR(t_s[1], 1.5, 1e-12);
  EXPECT_GT(t_s[2], t_s[1]);
}

TEST(SteppingTiming, OneNodeIsNoMotion) {
  EXPECT_EQ(node_times_s(test_machine(), {standing()}, kSettings), std::vector<double>{0.0});
}

}  // namespace
}  // namespace wex
