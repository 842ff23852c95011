#include "hw_interface/load_balance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace wex {
namespace {

constexpr double kPeriod_s = 0.01;

const MachineModel& m545() {
  static const MachineModel machine = load_machine().value();
  return machine;
}

/// Four legs of known vertical stiffness on ground that is out of plane by warp_m.
class Legs {
 public:
  explicit Legs(double warp_m) : warp_m_(warp_m) {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(m545().num_coordinates());
    q.tail(m545().num_joints()) = m545().default_posture();
    KinematicTree::Workspace w = m545().tree.make_workspace();
    m545().tree.update(q, w);
    Eigen::Matrix3Xd jacobian(3, m545().num_coordinates());
    for (int leg = 0; leg < kNumWheels; ++leg) {
      const WheeledLeg& l = m545().legs[leg];
      m545().tree.position_jacobian(w, l.carrier_body, l.p_carrier_wheel, jacobian);
      lever_m_[leg] = jacobian(2, l.hfe);
    }
  }
  static std::array<double, kMaxJoints> position() {
    std::array<double, kMaxJoints> position{};
    for (int i = 0; i < m545().num_joints(); ++i) position[i] = m545().joints[i].default_position;
    return position;
  }
  double lever_m(int leg) const { return lever_m_[leg]; }
  /// Hip efforts that carry the load, with the balance's raise of the wheels.
  std::array<double, kMaxJoints> effort(const std::array<double, kNumWheels>& offset_rad) const {
    constexpr double kStiffness_n_m = 6e5, kLoad_n = 28e3;
    constexpr std::array<double, kNumWheels> kSign{1.0, -1.0, -1.0, 1.0};
    std::array<double, kMaxJoints> effort{};
    for (int leg = 0; leg < kNumWheels; ++leg) {
      const double raise_m = kSign[leg] * warp_m_ - lever_m_[leg] * offset_rad[leg];
      effort[m545().legs[leg].hfe - kNumBaseCoordinates] =
          -lever_m_[leg] * std::max(0.0, kLoad_n + kStiffness_n_m * raise_m);
    }
    return effort;
  }

 private:
  double warp_m_;
  std::array<double, kNumWheels> lever_m_{};
};

TEST(LoadBalance, EvensOutTheDiagonalsSlowlyWithLittleOvershoot) {
  const Legs legs(0.02);
  LoadBalance balance(m545(), kPeriod_s);
  balance.update(Legs::position(), legs.effort(balance.offset_rad()), true);
  const double start = balance.warp();
  EXPECT_NEAR(start, 0.02 * 6e5 / 28e3, 0.01);
  double lowest = start;
  for (int i = 0; i < 100; ++i)
    balance.update(Legs::position(), legs.effort(balance.offset_rad()), true);
  EXPECT_GT(balance.warp(), 0.5 * start) << "slower than driving dynamics";
  for (int i = 0; i < 3000; ++i) {
    balance.update(Legs::position(), legs.effort(balance.offset_rad()), true);
    lowest = std::min(lowest, balance.warp());
  }
  EXPECT_LT(balance.warp(), 0.05);
  EXPECT_GT(lowest, -0.1 * start);
  EXPECT_GT(balance.offset_rad()[0], 0.0) << "the wheel that carries more goes up";
  EXPECT_LT(balance.offset_rad()[1], 0.0);
}

TEST(LoadBalance, StaysWithinItsLimit) {
  const Legs legs(0.03);
  LoadBalanceSettings settings;
  settings.max_raise_m = 0.01;
  LoadBalance limited(m545(), kPeriod_s, settings);
  for (int i = 0; i < 6000; ++i)
    limited.update(Legs::position(), legs.effort(limited.offset_rad()), true);
  for (int leg = 0; leg < kNumWheels; ++leg) {
    EXPECT_NEAR(std::abs(legs.lever_m(leg) * limited.offset_rad()[leg]), 0.01, 1e-12);
    EXPECT_EQ(limited.offset_rate_rad_s()[leg], 0.0) << "at rest at its limit";
  }
}

TEST(LoadBalance, RollAndPitchMomentsAloneMoveNothing) {
  LoadBalance balance(m545(), kPeriod_s);
  const std::array<double, kMaxJoints> base = Legs(0.0).effort({});
  for (const bool side : {false, true}) {
    std::array<double, kMaxJoints> effort = base;
    const int partner = side ? 2 : 1;  // LF and LH, or LF and RF, carry more
    for (const int leg : {0, partner}) effort[m545().legs[leg].hfe - kNumBaseCoordinates] *= 1.4;
    for (int i = 0; i < 500; ++i) balance.update(Legs::position(), effort, true);
  }
  for (const double offset_rad : balance.offset_rad()) EXPECT_EQ(offset_rad, 0.0);
}

TEST(LoadBalance, LeavesALiftedLegAlone) {
  LoadBalance balance(m545(), kPeriod_s);
  std::array<double, kMaxJoints> effort = Legs(0.0).effort({});
  effort[m545().legs[0].hfe - kNumBaseCoordinates] = 3e3;  // hangs
  for (int i = 0; i < 500; ++i) balance.update(Legs::position(), effort, true);
  for (const double offset_rad : balance.offset_rad()) EXPECT_EQ(offset_rad, 0.0);
}

TEST(LoadBalance, KeepsItsOffsetWhileInactive) {
  const Legs legs(0.02);
  LoadBalance balance(m545(), kPeriod_s);
  for (int i = 0; i < 300; ++i)
    balance.update(Legs::position(), legs.effort(balance.offset_rad()), true);
  const auto offset_rad = balance.offset_rad();
  EXPECT_NE(offset_rad[0], 0.0);
  for (int i = 0; i < 300; ++i)
    balance.update(Legs::position(), legs.effort(balance.offset_rad()), false);
  EXPECT_EQ(balance.offset_rad(), offset_rad);
  EXPECT_EQ(balance.offset_rate_rad_s()[0], 0.0);
}

}  // namespace
}  // namespace wex
