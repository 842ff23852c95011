#include <gmock/gmock.h>

#include <random>

#include "mpc/nlp/driving_constraints.hpp"
#include "mpc/nlp/joint_rates.hpp"
#include "mpc/nlp/rolling_slip.hpp"
#include "mpc/nlp/static_stability.hpp"
#include "mpc/nlp/wheel_height.hpp"
#include "mpc/nlp/wheel_speed.hpp"
#include "mpc/nlp/wheel_traversability.hpp"
#include "tests/support/driving_plan.hpp"

namespace wex {
namespace {

constexpr double kStep = 1e-6;       // of central differences, m or rad
constexpr double kTolerance = 2e-5;  // absolute and relative

class Constraints : public ::testing::Test {
 protected:
  MachineModel machine_ = load_machine().value();
  NlpLayout layout_ = make_driving_layout(machine_, 4);
  TerrainMap terrain_ = test::rolling_ground(0.15);
  NodeKinematicsEvaluator evaluator_{machine_, layout_};
  Eigen::VectorXd q_held_ =
      test::arc_plan(terrain_, machine_, {3.0, 0.0, 0.2}, 1.0, 0.1).nodes[0].q;
  std::mt19937 random_{7};

  NodeVector random_node(double spread = 0.15) {
    std::uniform_real_distribution<double> noise(-spread, spread);
    NodeVector x = layout_.gather(q_held_);
    for (double& value : x) value += noise(random_);
    return x;
  }

  NodeKinematics kinematics(const NodeVector& x) {
    NodeKinematics node;
    evaluator_.evaluate(x, q_held_, node);
    return node;
  }

  Eigen::VectorXd value(const NodeConstraint& constraint, const NodeVector& x) {
    Eigen::VectorXd value(constraint.num_rows());
    Eigen::MatrixXd jacobian(constraint.num_rows(), layout_.node_size());
    constraint.evaluate(kinematics(x), value, jacobian);
    return value;
  }

  Eigen::VectorXd value(const IntervalConstraint& constraint, const NodeVector& from,
                        const NodeVector& to) {
    Eigen::VectorXd value(constraint.num_rows());
    Eigen::MatrixXd jacobian(constraint.num_rows(), layout_.node_size());
    Eigen::MatrixXd other = jacobian;
    constraint.evaluate(kinematics(from), kinematics(to), value, jacobian, other);
    return value;
  }

  void expect_close(const Eigen::MatrixXd& analytic, const Eigen::MatrixXd& numeric,
                    const BlockPattern& pattern, std::string_view name) {
    for (int r = 0; r < analytic.rows(); ++r) {
      for (int c = 0; c < analytic.cols(); ++c) {
        EXPECT_NEAR(analytic(r, c), numeric(r, c), kTolerance * (1.0 + std::abs(numeric(r, c))))
            << name << " row " << r << " column " << c;
        if (!pattern(r, c)) {
          EXPECT_EQ(analytic(r, c), 0.0) << name << " outside its pattern";
        }
      }
    }
  }

  void check_jacobian(const NodeConstraint& constraint) {
    for (int trial = 0; trial < 20; ++trial) {
      const NodeVector x = random_node();
      Eigen::VectorXd ignored(constraint.num_rows());
      Eigen::MatrixXd analytic(constraint.num_rows(), layout_.node_size());
      constraint.evaluate(kinematics(x), ignored, analytic);
      Eigen::MatrixXd numeric = analytic;
      for (int i = 0; i < layout_.node_size(); ++i) {
        NodeVector plus = x, minus = x;
        plus[i] += kStep;
        minus[i] -= kStep;
        numeric.col(i) = (value(constraint, plus) - value(constraint, minus)) / (2.0 * kStep);
      }
      expect_close(analytic, numeric, constraint.pattern(), constraint.name());
    }
  }

  void check_jacobian(const IntervalConstraint& constraint) {
    for (int trial = 0; trial < 20; ++trial) {
      const NodeVector from = random_node(), to = random_node();
      Eigen::VectorXd ignored(constraint.num_rows());
      Eigen::MatrixXd by_from(constraint.num_rows(), layout_.node_size());
      Eigen::MatrixXd by_to = by_from;
      constraint.evaluate(kinematics(from), kinematics(to), ignored, by_from, by_to);
      Eigen::MatrixXd numeric_from = by_from, numeric_to = by_to;
      for (int i = 0; i < layout_.node_size(); ++i) {
        NodeVector plus = from, minus = from;
        plus[i] += kStep;
        minus[i] -= kStep;
        numeric_from.col(i) =
            (value(constraint, plus, to) - value(constraint, minus, to)) / (2.0 * kStep);
        plus = minus = to;
        plus[i] += kStep;
        minus[i] -= kStep;
        numeric_to.col(i) =
            (value(constraint, from, plus) - value(constraint, from, minus)) / (2.0 * kStep);
      }
      expect_close(by_from, numeric_from, constraint.pattern(), constraint.name());
      expect_close(by_to, numeric_to, constraint.pattern(), constraint.name());
    }
  }
};

TEST_F(Constraints, WheelHeightHasExactJacobian) {
  check_jacobian(WheelHeight(terrain_, machine_, layout_, {0.01, 0.0, -0.02, 0.0}));
}

TEST_F(Constraints, WheelTraversabilityHasExactJacobian) {
  check_jacobian(WheelTraversability(terrain_, machine_, layout_, 0.15));
}

TEST_F(Constraints, StaticStabilityHasExactJacobian) {
  check_jacobian(StaticStability(layout_, 0.25));
}

TEST_F(Constraints, RollingSlipHasExactJacobian) {
  check_jacobian(RollingSlip(machine_, layout_, 0.25));
}

TEST_F(Constraints, WheelSpeedHasExactJacobian) {
  check_jacobian(WheelSpeed(machine_, layout_, 0.25, 0.9));
}

TEST_F(Constraints, JointRatesHaveExactJacobian) {
  check_jacobian(JointRates(machine_, layout_, 0.25, 0.9));
}

TEST_F(Constraints, WheelHeightIsZeroWhereTheDiscTouchesFlatGround) {
  const TerrainMap flat = test::rolling_ground(0.0);
  NodeVector x = layout_.gather(q_held_);
  const NodeKinematics node = kinematics(x);
  const Eigen::VectorXd height = value(WheelHeight(flat, machine_, layout_), x);
  for (int w = 0; w < kNumWheels; ++w) {
    EXPECT_NEAR(height[w], node.p_world_wheel[w].z() - machine_.legs[w].radius_m, 1e-9);
  }
}

TEST_F(Constraints, RollingStraightAheadDoesNotSlipAndMovingSidewaysDoes) {
  NodeVector from = layout_.gather(q_held_);
  from[kBaseYaw] = 0.0;
  NodeVector ahead = from, sideways = from;
  ahead[kBaseX] += 0.1;
  sideways[kBaseY] += 0.1;
  const RollingSlip slip(machine_, layout_, 0.25);
  EXPECT_LT(value(slip, from, ahead).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_NEAR(value(slip, from, sideways).minCoeff(), 0.4, 1e-6);
}

TEST_F(Constraints, RollingBodySidewaysOverUprightPatchCountsAsSlip) {
  // Rolling the base about its x axis moves a wheel centre at height h by -h and its patch by r
  // more.
  NodeVector from = layout_.gather(q_held_);
  from[kBaseYaw] = 0.0;
  NodeVector rolled = from;
  rolled[kBaseRoll] += 1e-4;
  const Eigen::VectorXd slip = value(RollingSlip(machine_, layout_, 1.0), from, rolled);
  const NodeKinematics node = kinematics(from);
  for (int w = 0; w < kNumWheels; ++w) {
    const double patch_height_m = node.p_world_wheel[w].z() - 0.6 - from[kBaseZ];
    EXPECT_NEAR(slip[w] / 1e-4, -patch_height_m, 5e-3);
  }
}

TEST_F(Constraints, StabilityMarginIsTheDistanceToTheNearestEdge) {
  NodeVector x = layout_.gather(q_held_);
  const NodeKinematics node = kinematics(x);
  const Eigen::VectorXd margins = value(StaticStability(layout_, 0.25), x);
  EXPECT_DOUBLE_EQ(margins.minCoeff(), stability_margin_m(node));
  EXPECT_GT(margins.minCoeff(), 0.3);
}

}  // namespace
}  // namespace wex
