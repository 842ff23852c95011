#include "hw_interface/stopping_speed.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "models/excavator/machine_model.hpp"

namespace wex {
namespace {

constexpr double kDegree = 0.017453292519943295;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(StoppingSpeedTest, DownhillAndOnSideSlopesItIsSlower) {
  const StoppingSpeed speed;
  EXPECT_DOUBLE_EQ(speed.at(0.0), 0.63);
  EXPECT_DOUBLE_EQ(speed.at(-20.0 * kDegree), 0.63);
  EXPECT_NEAR(speed.at(20.0 * kDegree), 0.69 - 1.45 * 0.342020, 1e-6);
  EXPECT_DOUBLE_EQ(speed.at(0.0, 9.0 * kDegree), 0.63);
  EXPECT_NEAR(speed.at(0.0, 20.0 * kDegree), 0.75 - 0.75 * 0.342020, 1e-6);
  EXPECT_DOUBLE_EQ(speed.at(0.0, -20.0 * kDegree), speed.at(0.0, 20.0 * kDegree));
  EXPECT_DOUBLE_EQ(speed.at(20.0 * kDegree, 20.0 * kDegree), speed.at(20.0 * kDegree));
}

TEST(StoppingSpeedTest, AnySlopeCanBeLeftAndNoNumberMeansTheLeast) {
  const StoppingSpeed speed;
  EXPECT_DOUBLE_EQ(speed.at(60.0 * kDegree), 0.05);
  EXPECT_DOUBLE_EQ(speed.at(0.0, 80.0 * kDegree), 0.05);
  EXPECT_DOUBLE_EQ(speed.at(kNaN), 0.05);
  EXPECT_DOUBLE_EQ(speed.at(0.0, kNaN), 0.05);
}

TEST(StoppingSpeedTest, TheShareBringsTheMeanToTheLimitOfTheWayItGoes) {
  const StoppingSpeed speed;
  const double down = speed.at(10.0 * kDegree);
  EXPECT_DOUBLE_EQ(speed.share_of(0.6, 10.0 * kDegree) * 0.6, down);
  EXPECT_DOUBLE_EQ(speed.share_of(-0.6, -10.0 * kDegree) * 0.6, down) << "backwards down the slope";
  EXPECT_DOUBLE_EQ(speed.share_of(-0.6, 10.0 * kDegree), 1.0);
  EXPECT_DOUBLE_EQ(speed.share_of(0.6, -10.0 * kDegree), 1.0);
  EXPECT_DOUBLE_EQ(speed.share_of(0.63, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(speed.share_of(1.26, 0.0), 0.5);
  EXPECT_DOUBLE_EQ(speed.share_of(0.6, 0.0, 20.0 * kDegree) * 0.6, speed.at(0.0, 20.0 * kDegree));
}

TEST(StoppingSpeedTest, StaysBelowWhatWasMeasured) {
  const double measured_m_s[] = {0.70, 0.60, 0.51, 0.37, 0.25};
  for (int i = 0; i < 5; ++i) {
    EXPECT_LT(StoppingSpeed{}.at(5.0 * i * kDegree), measured_m_s[i]) << 5 * i << " degrees";
  }
}

TEST(TiltTest, IsTheAngleOfTheVerticalAxis) {
  EXPECT_NEAR(tilt_of(0.2, 0.0), 0.2, 1e-12);
  EXPECT_NEAR(tilt_of(0.0, -0.3), 0.3, 1e-12);
  EXPECT_NEAR(tilt_of(0.2, 0.3), std::acos(std::cos(0.2) * std::cos(0.3)), 1e-12);
  EXPECT_EQ(tilt_of(0.0, 0.0), 0.0);
  EXPECT_NEAR(tilt_of(180.0 * kDegree, 0.0), 180.0 * kDegree, 1e-7) << "upside down";
}

/// The model's own arm over its whole workspace.
class SlewAgainstTheModelTest : public ::testing::Test {
 protected:
  SlewAgainstTheModelTest()
      : machine_(load_machine().value()),
        workspace_(machine_.tree.make_workspace()),
        q_(Eigen::VectorXd::Zero(machine_.num_coordinates())) {
    const std::vector<KinematicTree::Body>& bodies = machine_.tree.bodies();
    cabin_ = body("TURN");
    slewing_.resize(bodies.size());
    for (std::size_t i = 1; i < bodies.size(); ++i) {
      slewing_[i] =
          static_cast<int>(i) == cabin_ || slewing_[static_cast<std::size_t>(bodies[i].parent)];
    }
  }
  int body(const char* joint) const {
    return machine_.joints[*machine_.coordinate(joint) - kNumBaseCoordinates].body;
  }
  double reach_of(const char* joint) const {
    return (workspace_.p_world_joint[static_cast<std::size_t>(body(joint))] - slew_origin()).x();
  }
  Eigen::Vector3d slew_origin() const {
    return workspace_.p_world_joint[static_cast<std::size_t>(cabin_)];
  }
  struct Slewing {
    double inertia_kg_m2 = 0.0, moment_kg_m = 0.0;
  };
  Slewing measure() const {
    Slewing sum;
    Eigen::Vector2d moment = Eigen::Vector2d::Zero();
    const std::vector<KinematicTree::Body>& bodies = machine_.tree.bodies();
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (!slewing_[i]) continue;
      const Eigen::Isometry3d& T_world_body = workspace_.T_world_body[i];
      const Eigen::Vector2d com = (T_world_body * bodies[i].p_body_com - slew_origin()).head<2>();
      const Eigen::Vector3d axis = T_world_body.linear().transpose() * Eigen::Vector3d::UnitZ();
      sum.inertia_kg_m2 +=
          axis.dot(bodies[i].inertia_kg_m2 * axis) + bodies[i].mass_kg * com.squaredNorm();
      moment += bodies[i].mass_kg * com;
    }
    sum.moment_kg_m = moment.norm();
    return sum;
  }
  /// Visits `steps` values of each of the four joints and of EE_YAW from stop to stop.
  template <typename Visit>
  void over_the_workspace(int steps, Visit visit) {
    const auto value = [&](const char* joint, int step) {
      const Joint& limits = machine_.joints[*machine_.coordinate(joint) - kNumBaseCoordinates];
      const double way = limits.continuous ? 3.0 : limits.upper - limits.lower;
      return (limits.continuous ? 0.0 : limits.lower) + way * step / (steps - 1);
    };
    for (int n = 0; n < steps * steps * steps * steps * steps; ++n) {
      const int boom = n % steps, dipper = n / steps % steps, tele = n / steps / steps % steps,
                pitch = n / steps / steps / steps % steps, yaw = n / steps / steps / steps / steps;
      const ReachingJoints q{value("BOOM", boom), value("DIPPER", dipper), value("TELE", tele),
                             value("EE_PITCH", pitch)};
      q_[*machine_.coordinate("BOOM")] = q.boom;
      q_[*machine_.coordinate("DIPPER")] = q.dipper;
      q_[*machine_.coordinate("TELE")] = q.tele;
      q_[*machine_.coordinate("EE_PITCH")] = q.ee_pitch;
      q_[*machine_.coordinate("EE_YAW")] = value("EE_YAW", yaw);
      machine_.tree.update(q_, workspace_);
      visit(q);
    }
  }

  MachineModel machine_;
  KinematicTree::Workspace workspace_;
  Eigen::VectorXd q_;
  int cabin_ = -1;
  std::vector<bool> slewing_;
};

TEST_F(SlewAgainstTheModelTest, TheReachIsTheModels) {
  over_the_workspace(4, [&](const ReachingJoints& q) {
    const ArmReach reach = ArmReach::of(q);
    ASSERT_NEAR(reach.elbow_m, reach_of("DIPPER"), 1e-3);
    ASSERT_NEAR(reach.wrist_m, reach_of("EE_PITCH"), 1e-3);
  });
}

TEST_F(SlewAgainstTheModelTest, InertiaAndMomentBoundTheModelsFromAboveAndNotFar) {
  const StoppingSlew slew;
  double mean_excess = 0.0;
  int count = 0;
  over_the_workspace(6, [&](const ReachingJoints& q) {
    const ArmReach reach = ArmReach::of(q);
    const Slewing model = measure();
    ASSERT_GE(slew.inertia_kg_m2(reach), 0.99 * model.inertia_kg_m2)
        << q.boom << ' ' << q.dipper << ' ' << q.tele << ' ' << q.ee_pitch;
    ASSERT_GE(slew.moment_kg_m(reach), model.moment_kg_m);
    mean_excess += slew.inertia_kg_m2(reach) / model.inertia_kg_m2 - 1.0;
    ++count;
  });
  EXPECT_LT(mean_excess / count, 0.1);
}

TEST(ArmReachTest, TheBucketTurnsAboutTheWrist) {
  const ReachingJoints q{0.5, 0.2, 0.3, -0.84};  // the bucket's frame along the floor
  EXPECT_NEAR(ArmReach::of(q).bucket_m, ArmReach::of(q).wrist_m + 0.5, 1e-12);
  EXPECT_NEAR(ArmReach::of({0.5, 0.2, 0.3, -0.84 + 0.25}).bucket_m,
              ArmReach::of(q).wrist_m + 0.5 * (std::cos(0.25) + std::sin(0.25)), 1e-12);
}

TEST(StoppingSlewTest, MassesCountByTheirDistanceOnEitherSide) {
  const StoppingSlew slew;
  EXPECT_DOUBLE_EQ(slew.inertia_kg_m2({}), 6200.0);
  EXPECT_DOUBLE_EQ(slew.inertia_kg_m2({2.0, 3.0, 4.0}), 6200.0 + 2800.0 + 4500.0 + 17600.0);
  EXPECT_DOUBLE_EQ(slew.inertia_kg_m2({-2.0, -3.0, -4.0}), slew.inertia_kg_m2({2.0, 3.0, 4.0}));
  EXPECT_DOUBLE_EQ(slew.moment_kg_m({}), 0.0);
  EXPECT_DOUBLE_EQ(slew.moment_kg_m({2.0, 3.0, 4.0}), 1400.0 + 1500.0 + 4400.0);
  EXPECT_DOUBLE_EQ(slew.moment_kg_m({-2.0, -3.0, -4.0}), slew.moment_kg_m({2.0, 3.0, 4.0}));
}

TEST(StoppingSlewTest, FurtherOutAndOnSlopesItIsSlower) {
  const StoppingSlew slew;
  const ArmReach transport = ArmReach::of({1.0, -0.85, 0.0, -2.0});
  const ArmReach stretched = ArmReach::of({0.8, 0.0, 1.0, -2.0});
  EXPECT_NEAR(slew.at(transport), 0.12 * 52e3 / slew.inertia_kg_m2(transport), 1e-12);
  EXPECT_GT(slew.at(transport), 0.3);
  EXPECT_LT(slew.at(stretched), 0.14);
  const double weight_nm = 9.81 * std::sin(0.2) * slew.moment_kg_m(transport);
  EXPECT_NEAR(slew.at(transport, 0.2), slew.at(transport) * (1.0 - weight_nm / 52e3), 1e-12);
  EXPECT_DOUBLE_EQ(slew.at(transport, -0.2), slew.at(transport, 0.2));
}

TEST(StoppingSlewTest, BetweenTheLeastAndTheMost) {
  StoppingSlew slew;
  EXPECT_DOUBLE_EQ(slew.at(ArmReach{7.0, 7.0, 7.0}, 1.0), 0.03);
  EXPECT_DOUBLE_EQ(slew.at(ArmReach{}), 0.8);
  EXPECT_DOUBLE_EQ(slew.at(ArmReach{kNaN, 1.0, 1.0}), 0.03);
  EXPECT_DOUBLE_EQ(slew.at(ArmReach{}, kNaN), 0.03);
}

TEST(StoppingSlewTest, AnArmThatGoesOutCountsAsBeingThere) {
  const StoppingSlew slew;
  const ReachingJoints mid{0.9, -0.4, 0.5, -1.5};
  const double standing = slew.at(mid, {}, 0.1);
  EXPECT_DOUBLE_EQ(standing, slew.at(ArmReach::of(mid), 0.1));
  EXPECT_DOUBLE_EQ(slew.at(mid, {-0.2, 0.4, 0.2, 0.6}, 0.1),
                   slew.at(ArmReach::of({0.8, -0.2, 0.6, -1.2}), 0.1));
  EXPECT_DOUBLE_EQ(slew.at(mid, {0.2, -0.4, -0.2, 0.0}, 0.1), standing) << "going in gives nothing";
  const ReachingJoints low{-0.4, 0.0, 0.5, -1.5};  // raised, it would reach further out
  EXPECT_DOUBLE_EQ(slew.at(low, {}, 0.1), slew.at(ArmReach::of(low), 0.1)) << "it stands";
}

}  // namespace
}  // namespace wex
