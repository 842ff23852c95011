#include <algorithm>
#include <cstdio>

#include "hw_interface/mujoco/simulated_plant.hpp"
#include "tests/hw_interface/electronics/electronics_bench.hpp"
#include "tests/hw_interface/test_ground.hpp"

// The electronics in front of the simulated machine: what a lost host costs in time and distance.

namespace wex::can {
namespace {

constexpr int kLeftFront = 0, kArm = 4;
constexpr int kHfe = 1, kWheel = 3, kTurn = 0, kBoom = 1;
constexpr double kOilColumn_rad = 1e-3;
constexpr double kStandingSpeed_m_s = 0.02;  ///< of the base

std::unique_ptr<SimulatedPlant> standing_plant(double slope_x = 0.0) {
  const TerrainMap ground = ground_of([&](double x_m, double) { return slope_x * x_m; });
  auto plant = SimulatedPlant::create(m545(), ground, standing_on_plane(m545(), slope_x)).value();
  EXPECT_TRUE(plant->settle().has_value());
  return plant;
}

class ElectronicsSimulatedTest : public ::testing::Test {
 protected:
  explicit ElectronicsSimulatedTest(double slope_x = 0.0)
      : plant_(standing_plant(slope_x)), bench_(1, {}, plant_.get()) {}

  Eigen::Vector3d bucket() {
    const PlantState state = plant_->sense();
    Eigen::VectorXd q(m545().num_coordinates());
    q.head<kNumBaseCoordinates>() = state.base;
    for (int i = 0; i < m545().num_joints(); ++i) q[kNumBaseCoordinates + i] = state.position[i];
    KinematicTree::Workspace workspace = m545().tree.make_workspace();
    m545().tree.update(q, workspace);
    return m545().tree.position(workspace, m545().arm->contact_body, m545().arm->p_body_contact);
  }
  double fastest_joint() const {
    const JointMeasurement measured = plant_->measure();
    double fastest = 0.0;
    for (int i = 0; i < m545().num_joints(); ++i) {
      if (m545().joints[i].role == JointRole::kWheel) continue;
      fastest = std::max(fastest, std::abs(measured.rate[i]));
    }
    return fastest;
  }
  static int joint_at(int zone, int index) {
    for (int i = 0; i < m545().num_joints(); ++i) {
      const JointSlot slot = slot_of(m545().joints[i].name);
      if (slot.zone == zone && slot.index == index) return i;
    }
    return -1;
  }
  double speed_m_s() { return plant_->sense().base_velocity.head<3>().norm(); }
  void drive(double wheel_rate_rad_s) {
    for (double rate = 0.0; rate < wheel_rate_rad_s;) {
      rate = std::min(wheel_rate_rad_s, rate + 0.008);
      for (int zone = 0; zone < kNumWheels; ++zone) {
        bench_.set_rate(zone, kWheel, m545().legs[zone].wheel_sign * rate);
      }
      bench_.step();
    }
  }
  /// Two seconds from now: when the way came to within `tolerance` of the furthest it got [ms].
  /// From there on it only swings back in its oil columns and tyres.
  template <typename Way>
  std::int64_t standstill_ms(double tolerance, Way way_from_here) {
    std::vector<double> way;
    for (int i = 0; i < 200; ++i) {
      bench_.step();
      way.push_back(way_from_here());
    }
    const double furthest = *std::max_element(way.begin(), way.end());
    const auto there =
        std::find_if(way.begin(), way.end(), [&](double w) { return w >= furthest - tolerance; });
    return 10 * (there - way.begin() + 1);
  }
  auto way_of_joint(int zone, int index) {
    const int joint = joint_at(zone, index);
    const double start = plant_->measure().position[joint];
    return [this, joint, start] { return std::abs(plant_->measure().position[joint] - start); };
  }

  std::unique_ptr<SimulatedPlant> plant_;
  ElectronicsBench bench_;
};

class ElectronicsUphillTest : public ElectronicsSimulatedTest {
 protected:
  ElectronicsUphillTest() : ElectronicsSimulatedTest(std::tan(0.26)) {}  // 15 degrees
};
TEST_F(ElectronicsSimulatedTest, EnablingDoesNotMoveTheMachine) {
  const Eigen::Vector3d before = bucket();
  bench_.enable();
  bench_.steps(100);
  EXPECT_EQ(bench_.mode(), MachineMode::kEnabled);
  EXPECT_LT((bucket() - before).norm(), 2e-3);
}

TEST_F(ElectronicsSimulatedTest, TheMachineDrivesAndStopsOverTheBus) {
  bench_.enable();
  const double start_m = plant_->sense().base.x();
  drive(0.8);
  bench_.steps(300);
  EXPECT_NEAR(speed_m_s(), 0.8 * 0.6, 0.05);
  bench_.commands = {};
  bench_.steps(150);
  EXPECT_LT(speed_m_s(), kStandingSpeed_m_s);
  EXPECT_TRUE(bench_.electronics->brakes_closed());
  EXPECT_EQ(bench_.mode(), MachineMode::kEnabled);
  EXPECT_GT(plant_->sense().base.x() - start_m, 1.2);
}

// T12: every cylinder and the cabin at speed, then silence.
TEST_F(ElectronicsSimulatedTest, ArmAndLegsStandWithin150MsOfTheLastGoodCommand) {
  struct Case {
    const char* name;
    int zone, index;
    double rate;
  };
  for (const Case& which : {Case{"BOOM", kArm, kBoom, -0.35}, Case{"TURN", kArm, kTurn, 0.3},
                            Case{"DIPPER", kArm, 2, 0.5}, Case{"LF_HFE", kLeftFront, kHfe, -0.2}}) {
    bench_.commands = {};
    bench_.send_commands = true;
    bench_.heartbeat.request = HostRequest::kDisable;
    bench_.steps(50);
    bench_.enable();
    bench_.ramp(which.zone, which.index, which.rate);
    bench_.steps(which.zone == kArm ? 60 : 20);
    const Eigen::Vector3d at_last_command = bucket();
    const double rate = fastest_joint();
    ASSERT_GT(rate, 0.5 * std::abs(which.rate)) << which.name;
    bench_.send_commands = false;  // the host's process is gone, its heartbeat hangs on
    const auto way = way_of_joint(which.zone, which.index);
    const std::int64_t stop_ms = standstill_ms(kOilColumn_rad, way);
    const double way_m = (bucket() - at_last_command).norm();
    std::printf(
        "T12 (simulated): %s at %.2f, stands %lld ms after the last command, bucket %.3f m\n",
        which.name, rate, static_cast<long long>(stop_ms), way_m);
    EXPECT_LE(stop_ms, 150) << which.name;
  }
}

TEST_F(ElectronicsUphillTest, HoldKeepsTheMachineOnItsLegsAndInItsPlace) {
  bench_.enable();
  drive(0.4);
  bench_.steps(100);
  bench_.send_commands = false;
  bench_.steps(200);
  ASSERT_EQ(bench_.mode(), MachineMode::kHold);
  const Eigen::Vector3d before = plant_->sense().base.head<3>();
  bench_.steps(500);
  EXPECT_LT((plant_->sense().base.head<3>() - before).norm(), 0.01);
  for (const double load_n : plant_->ground_truth().wheel_load_n) EXPECT_GT(load_n, 3000.0);
}

TEST_F(ElectronicsSimulatedTest, AnEStopWhileTheArmMovesStopsIt) {
  bench_.enable();
  bench_.ramp(kArm, kBoom, -0.35);
  bench_.steps(50);
  ASSERT_GT(fastest_joint(), 0.3);
  bench_.electronics->set_estop_chain(true);
  const std::int64_t stop_ms = standstill_ms(kOilColumn_rad, way_of_joint(kArm, kBoom));
  std::printf("e-stop (simulated): BOOM at 0.35 rad/s stands after %lld ms\n",
              static_cast<long long>(stop_ms));
  EXPECT_LE(stop_ms, 100);
  EXPECT_TRUE(bench_.electronics->brakes_closed());
}

}  // namespace
}  // namespace wex::can
