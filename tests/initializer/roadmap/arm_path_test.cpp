#include "initializer/roadmap/arm_path.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace wex {
namespace {

constexpr double kPi = std::numbers::pi;

struct M545 {
  MachineModel machine = load_machine("m545").value();
  CollisionModel collision = CollisionModel::build(machine);
  LimbRoadmap arm = build_roadmap(machine, collision, Limb::kArm);
};
const M545& m545() {
  static const M545 built;
  return built;
}

/// Where elbow and bucket are in a posture, base frame.
class ArmPathOfM545 : public ::testing::Test {
 protected:
  ArmPathOfM545() : w_(machine_.tree.make_workspace()) {
    q_ = Eigen::VectorXd::Zero(machine_.num_coordinates());
    q_.tail(machine_.num_joints()) = machine_.transport_posture();
    folded_.resize(7);
    for (Eigen::Index i = 0; i < 7; ++i) folded_[i] = q_[m545().arm.coordinates[i]];
    stretched_ = folded_;
    stretched_[1] = 0.5;   // boom
    stretched_[2] = 0.4;   // dipper
    stretched_[3] = 0.6;   // telescope
    stretched_[4] = -0.5;  // bucket
  }

  void pose(const Eigen::VectorXd& arm_q) {
    for (Eigen::Index i = 0; i < 7; ++i) q_[m545().arm.coordinates[i]] = arm_q[i];
    machine_.tree.update(q_, w_);
  }
  Eigen::Vector3d bucket(const Eigen::VectorXd& arm_q) {
    pose(arm_q);
    return machine_.tree.position(w_, machine_.arm->contact_body, machine_.arm->p_body_contact);
  }
  double elbow_height_m(const Eigen::VectorXd& arm_q) {
    pose(arm_q);
    return w_.T_world_body[machine_.tree.body_index("dipper")].translation().z();
  }
  Eigen::VectorXd stretched(double turn_rad) const {
    Eigen::VectorXd posture = stretched_;
    posture[0] = turn_rad;
    return posture;
  }
  /// A post that the bucket must not come near, at an angle.
  bool bucket_at_post(const Eigen::VectorXd& arm_q, double angle_rad) {
    const Eigen::Vector3d p = bucket(arm_q);
    const double off_rad = wrap_angle(std::atan2(p.y(), p.x()) - angle_rad);
    return std::abs(off_rad) < 0.3 && p.head<2>().norm() > 4.0;
  }

  /// Straight ahead the bucket must stay out; behind posts left and behind it must be in.
  auto gate_and_posts() {
    return [this](const Eigen::VectorXd& arm_q) {
      const bool in_gate = std::abs(wrap_angle(arm_q[0])) < 0.25;
      return (!in_gate || bucket(arm_q).head<2>().norm() > 5.0) && !bucket_at_post(arm_q, 1.0) &&
             !bucket_at_post(arm_q, -2.5);
    };
  }

  /// Start, goal, and every posture no farther than 0.02 rad or m from the next.
  template <typename Valid>
  void expect_valid(const ArmPath& path, const Eigen::VectorXd& start, const Eigen::VectorXd& goal,
                    const Valid& valid) {
    ASSERT_GE(path.postures.size(), 2U);
    EXPECT_EQ(path.postures.front(), start);
    Eigen::VectorXd off = path.postures.back() - goal;
    off[0] = wrap_angle(off[0]);
    off[6] = wrap_angle(off[6]);
    EXPECT_LT(off.norm(), 1e-9);
    double least_s = 0.0;
    for (std::size_t i = 1; i < path.postures.size(); ++i) {
      const Eigen::VectorXd step = path.postures[i] - path.postures[i - 1];
      const int pieces = 1 + static_cast<int>(step.lpNorm<Eigen::Infinity>() / 0.02);
      for (int k = 0; k <= pieces; ++k) {
        EXPECT_TRUE(valid(path.postures[i - 1] + step * k / pieces)) << "leg " << i;
      }
      least_s += std::abs(step[0]) / 0.8;
    }
    EXPECT_GE(path.duration_s, least_s - 1e-9);  // no faster than the cabin turns
  }

  const MachineModel& machine_ = m545().machine;
  KinematicTree::Workspace w_;
  Eigen::VectorXd q_, folded_, stretched_;
  ArmPathPlanner planner_{m545().machine, m545().arm};
};

const auto kAnywhere = [](const Eigen::VectorXd&) { return true; };

TEST_F(ArmPathOfM545, IsStraightWhereNothingIsInTheWay) {
  const auto path = planner_.plan(folded_, stretched(1.0), kAnywhere);
  ASSERT_TRUE(path);
  expect_valid(*path, folded_, stretched(1.0), kAnywhere);
  EXPECT_EQ(path->postures.size(), 2U);
  EXPECT_EQ(path->vertices, 0);
  // The slowest is the bucket: 1.5 rad at 0.8 rad/s; boom 0.5 at 0.35; dipper 1.25 at 0.55.
  EXPECT_NEAR(path->duration_s, 1.25 / 0.55, 1e-9);
}

TEST_F(ArmPathOfM545, StandsStillWhereStartIsGoal) {
  const auto path = planner_.plan(folded_, folded_, kAnywhere);
  ASSERT_TRUE(path);
  EXPECT_EQ(path->duration_s, 0.0);
}

TEST_F(ArmPathOfM545, TurnsTheShorterWayAcrossHalfATurn) {
  const auto path = planner_.plan(stretched(3.0), stretched(-3.0), kAnywhere);
  ASSERT_TRUE(path);
  ASSERT_EQ(path->postures.size(), 2U);
  EXPECT_NEAR(path->postures.back()[0], 2.0 * kPi - 3.0, 1e-12);
}

TEST_F(ArmPathOfM545, TurnsTheOtherWayIfTheShorterIsBlocked) {
  const auto valid = [&](const Eigen::VectorXd& arm_q) {
    return std::abs(wrap_angle(arm_q[0] - 0.5)) > 0.1;  // a fence through the machine's axis
  };
  const auto path = planner_.plan(stretched(0.0), stretched(1.0), valid);
  ASSERT_TRUE(path);
  expect_valid(*path, stretched(0.0), stretched(1.0), valid);
  EXPECT_NEAR(path->postures.back()[0], 1.0 - 2.0 * kPi, 1e-9);
  EXPECT_EQ(path->vertices, 0);
}

TEST_F(ArmPathOfM545, DrawsTheArmInBehindAPost) {
  const auto valid = [&](const Eigen::VectorXd& arm_q) {
    return !bucket_at_post(arm_q, 0.6) && !bucket_at_post(arm_q, -2.5);
  };
  const Eigen::VectorXd start = stretched(0.0), goal = stretched(1.3);
  const auto path = planner_.plan(start, goal, valid);
  ASSERT_TRUE(path);
  expect_valid(*path, start, goal, valid);
  EXPECT_GT(path->postures.size(), 2U);
  // It turned the shorter way, and drew in for it.
  EXPECT_NEAR(path->postures.back()[0], 1.3, 1e-9);
}

// Below a roof the arm can be neither folded as for transport nor raised.
TEST_F(ArmPathOfM545, StaysBelowARoof) {
  const auto valid = [&](const Eigen::VectorXd& arm_q) {
    return elbow_height_m(arm_q) < 3.0 && !bucket_at_post(arm_q, 0.6) &&
           !bucket_at_post(arm_q, -2.5);
  };
  const Eigen::VectorXd start = stretched(0.0), goal = stretched(1.3);
  ASSERT_FALSE(valid(folded_));
  const auto path = planner_.plan(start, goal, valid);
  ASSERT_TRUE(path);
  expect_valid(*path, start, goal, valid);
}

// Out of a gate that is too narrow to draw the arm in, and behind a post: that takes a search.
TEST_F(ArmPathOfM545, SearchesTheRoadmapWhereDrawingInDoesNotServe) {
  const auto valid = gate_and_posts();
  const Eigen::VectorXd start = stretched(0.0), goal = stretched(1.7);
  const auto path = planner_.plan(start, goal, valid);
  ASSERT_TRUE(path);
  expect_valid(*path, start, goal, valid);
  EXPECT_GT(path->vertices, 0);
  EXPECT_LT(path->checks, ArmPathSettings{}.max_checks);
}

TEST_F(ArmPathOfM545, IsCutShort) {
  const auto valid = gate_and_posts();
  const auto path = planner_.plan(stretched(0.0), stretched(1.7), valid);
  ASSERT_TRUE(path);
  const LimbRoadmap& arm = m545().arm;
  for (std::size_t i = 2; i < path->postures.size(); ++i) {
    const Eigen::VectorXd &from = path->postures[i - 2], &to = path->postures[i];
    bool straight = true;
    for (int k = 1; k < 64; ++k) straight = straight && valid(from + (to - from) * (k / 64.0));
    const double direct = joint_distance_s(machine_, arm.coordinates, from, to);
    const double around = joint_distance_s(machine_, arm.coordinates, from, path->postures[i - 1]) +
                          joint_distance_s(machine_, arm.coordinates, path->postures[i - 1], to);
    EXPECT_FALSE(straight && direct < 0.5 * around) << "posture " << i - 1 << " is a detour";
  }
}

TEST_F(ArmPathOfM545, TellsAnInvalidStartFromAnInvalidGoal) {
  const auto ahead = [](const Eigen::VectorXd& arm_q) { return std::abs(arm_q[0]) < 0.5; };
  EXPECT_EQ(planner_.plan(stretched(1.0), folded_, ahead).error(), ArmPathError::kStartInvalid);
  EXPECT_EQ(planner_.plan(folded_, stretched(1.0), ahead).error(), ArmPathError::kGoalInvalid);
}

TEST_F(ArmPathOfM545, FindsNoWayOutOfAClosedSector) {
  const auto valid = [](const Eigen::VectorXd& arm_q) {
    const double to_fence = std::abs(std::abs(wrap_angle(arm_q[0])) - 0.5);
    return to_fence > 0.1;  // fences left and right of straight ahead
  };
  ArmPathSettings patient;
  patient.max_checks = 1000000;
  ArmPathPlanner planner(machine_, m545().arm, patient);
  EXPECT_EQ(planner.plan(folded_, stretched(2.0), valid).error(), ArmPathError::kNoPath);
}

TEST_F(ArmPathOfM545, GivesUpAfterSoManyChecks) {
  int calls = 0;
  const auto valid = [&](const Eigen::VectorXd& arm_q) {
    ++calls;
    return std::abs(std::abs(wrap_angle(arm_q[0])) - 0.5) > 0.1;
  };
  ArmPathSettings hasty;
  hasty.max_checks = 100;
  ArmPathPlanner planner(machine_, m545().arm, hasty);
  EXPECT_EQ(planner.plan(folded_, stretched(2.0), valid).error(), ArmPathError::kTooManyChecks);
  EXPECT_EQ(calls, 100);
}

TEST_F(ArmPathOfM545, IsTheSameWhateverWasPlannedBefore) {
  const auto valid = gate_and_posts();
  const auto once = planner_.plan(stretched(0.0), stretched(1.7), valid);
  (void)planner_.plan(stretched(-0.5), stretched(2.0), valid);
  const auto again = planner_.plan(stretched(0.0), stretched(1.7), valid);
  ASSERT_TRUE(once && again);
  ASSERT_EQ(once->postures.size(), again->postures.size());
  for (std::size_t i = 0; i < once->postures.size(); ++i) {
    EXPECT_EQ(once->postures[i], again->postures[i]);
  }
  EXPECT_EQ(once->checks, again->checks);
}

TEST_F(ArmPathOfM545, TakesOnlyTheArmsRoadmapAndPosturesOfItsSize) {
  RoadmapSettings settings;
  settings.leg_vertices = 5;
  const LimbRoadmap leg = build_roadmap(machine_, m545().collision, Limb::kLF, settings);
  EXPECT_THROW(ArmPathPlanner(machine_, leg), std::logic_error);
  EXPECT_THROW((void)planner_.plan(Eigen::VectorXd::Zero(3), folded_, kAnywhere), std::logic_error);
}

}  // namespace
}  // namespace wex
