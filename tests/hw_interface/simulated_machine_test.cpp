#include "hw_interface/mujoco/simulated_machine.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <numeric>

#include "models/excavator/mjcf.hpp"
#include "tests/hw_interface/test_ground.hpp"
#include "tests/support/scratch_folder.hpp"

namespace wex {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;
constexpr double kTick_s = 0.01;
constexpr double kGravity_m_s2 = 9.81;

const MachineModel& m545() {
  static const MachineModel machine = load_machine().value();
  return machine;
}

std::unique_ptr<SimulatedMachine> machine_on(const TerrainMap& terrain, const Eigen::VectorXd& q) {
  return SimulatedMachine::create(m545(), terrain, q).value();
}

int wheel_joint(int leg) { return m545().legs[leg].wheel - kNumBaseCoordinates; }

/// Everything held where it was read, wheels at one speed.
/// Speed of each wheel's centre per speed of the base; 1 when driving straight.
using SpeedRatios = std::array<double, kNumWheels>;
constexpr SpeedRatios kStraight{1.0, 1.0, 1.0, 1.0};

JointCommand driving(const MachineState& hold, double speed_m_s, const SpeedRatios& ratios) {
  JointCommand command;
  command.num_joints = m545().num_joints();
  command.position_target = hold.position;
  for (int i = 0; i < command.num_joints; ++i) {
    command.has_position_target[i] = m545().joints[i].role != JointRole::kWheel;
  }
  for (int leg = 0; leg < kNumWheels; ++leg) {
    command.rate[wheel_joint(leg)] =
        m545().legs[leg].wheel_sign * ratios[leg] * speed_m_s / m545().legs[leg].radius_m;
  }
  return command;
}

void drive(SimulatedMachine& io, double speed_m_s, double duration_s,
           const SpeedRatios& ratios = kStraight) {
  JointCommand command = driving(io.read(), speed_m_s, ratios);
  const double end_s = io.read().t_s + duration_s;
  for (double t_s = io.read().t_s; t_s < end_s - 1e-6; t_s = io.read().t_s) {
    command.valid_until_s = t_s + 0.2;
    ASSERT_EQ(io.write(command), WriteOutcome::kAccepted);
    io.wait_until(t_s + kTick_s);
  }
}

double total_load_n(const GroundTruth& truth) {
  return std::accumulate(truth.wheel_load_n.begin(), truth.wheel_load_n.end(), 0.0);
}

TEST(SimulatedMachine, StandsStillOnFlatGroundAtItsStaticSag) {
  const auto io = machine_on(flat_ground(), standing_on_plane(m545()));
  const GroundTruth start = io->ground_truth();
  EXPECT_NEAR(start.base[kBaseZ], m545().default_base_height_m, 5e-3);
  EXPECT_NEAR(total_load_n(start), m545().total_mass_kg * kGravity_m_s2, 100.0);
  double fastest_m_s = 0.0;
  for (double t_s = 0.0; t_s < 10.0; t_s += kTick_s) {
    io->wait_until(t_s);
    fastest_m_s = std::max(fastest_m_s, std::abs(io->ground_truth().base_vertical_rate_m_s));
  }
  const GroundTruth end = io->ground_truth();
  RecordProperty("fastest_um_s", std::to_string(1e6 * fastest_m_s));
  EXPECT_LT(fastest_m_s, 1e-3);
  EXPECT_NEAR(end.base[kBaseZ], start.base[kBaseZ], 1e-3);
  for (int leg = 0; leg < kNumWheels; ++leg) {
    EXPECT_LT(end.wheel_penetration_m[leg], 2e-3);
    EXPECT_NEAR(end.tyre_deflection_m[leg], m545().legs[leg].static_sag_m, 5e-3);
    EXPECT_EQ(end.airborne_s[leg], 0.0);
  }
  EXPECT_FALSE(end.body_contact);
  EXPECT_GT(end.stability_margin_m, 1.0);
}

TEST(SimulatedMachine, DoesNotCreepParkedOnSlopes) {
  struct Slope {
    double along_deg, across_deg;
  };
  for (const Slope slope : {Slope{0.0, 15.0}, Slope{20.0, 0.0}, Slope{-20.0, 0.0}}) {
    const double a = std::tan(slope.along_deg * kDeg), b = std::tan(slope.across_deg * kDeg);
    const TerrainMap terrain = ground_of([&](double x, double y) { return a * x + b * y; });
    const auto io = machine_on(terrain, standing_on_plane(m545(), a, b));
    io->wait_until(2.0);
    const Eigen::Vector3d before = io->ground_truth().base.head<3>();
    io->wait_until(12.0);
    const double creep_m_s = (io->ground_truth().base.head<3>() - before).norm() / 10.0;
    RecordProperty("creep_um_s_" + std::to_string(static_cast<int>(slope.along_deg)),
                   std::to_string(1e6 * creep_m_s));
    EXPECT_LT(creep_m_s, 1e-3) << slope.along_deg << " / " << slope.across_deg << " degrees";
    EXPECT_GT(total_load_n(io->ground_truth()), 0.95 * m545().total_mass_kg * kGravity_m_s2);
  }
}

TEST(SimulatedMachine, DrivesStraightWithoutSideSlip) {
  const auto io = machine_on(flat_ground(), standing_on_plane(m545(), 0.0, 0.0, -3.0));
  drive(*io, 0.5, 7.0);
  const GroundTruth truth = io->ground_truth();
  EXPECT_GT(truth.base[kBaseX], -3.0 + 3.0);
  EXPECT_NEAR(truth.base[kBaseY], 0.0, 0.02);
  EXPECT_NEAR(truth.base[kBaseYaw], 0.0, 0.01);
  for (int leg = 0; leg < kNumWheels; ++leg) {
    EXPECT_NEAR(truth.wheel_travel_m[leg], truth.base[kBaseX] + 3.0, 0.03);
    EXPECT_LT(truth.side_slip_m[leg], 0.02 * truth.wheel_travel_m[leg]);
  }
}

/// Turns each wheel's axle onto the centre of a circle to the left of the base; q must stand level
/// at the origin.
SpeedRatios steer_onto_circle(double radius_m, Eigen::VectorXd& q) {
  const Eigen::Vector2d centre(0.0, radius_m);
  KinematicTree::Workspace workspace = m545().tree.make_workspace();
  SpeedRatios ratios{};
  for (int round = 0; round < 20; ++round) {  // the wheel moves as it is steered
    m545().tree.update(q, workspace);
    for (int leg = 0; leg < kNumWheels; ++leg) {
      const WheeledLeg& l = m545().legs[leg];
      const Eigen::Vector2d to_centre =
          centre - m545().tree.position(workspace, l.carrier_body, l.p_carrier_wheel).head<2>();
      const Eigen::Vector2d axle =
          m545().tree.direction(workspace, l.carrier_body, l.axle_carrier).head<2>();
      q[l.steer] +=
          std::atan2(axle.x() * to_centre.y() - axle.y() * to_centre.x(), axle.dot(to_centre));
      ratios[leg] = to_centre.norm() / radius_m;
    }
  }
  return ratios;
}

TEST(SimulatedMachine, DrivesItsTightestCurveWithLittleSideSlip) {
  const double radius_m = m545().min_turning_radius_m;
  Eigen::VectorXd q = standing_on_plane(m545());
  const SpeedRatios ratios = steer_onto_circle(radius_m, q);
  const auto io = machine_on(flat_ground(), q);
  const BaseCoordinates start = io->ground_truth().base;
  drive(*io, 0.5, 12.0, ratios);
  const GroundTruth truth = io->ground_truth();
  const double turned_rad = truth.base[kBaseYaw] - start[kBaseYaw];
  EXPECT_GT(turned_rad, 1.0);
  const double chord_m = (truth.base - start).head<2>().norm();
  EXPECT_NEAR(chord_m, 2.0 * radius_m * std::sin(turned_rad / 2.0), 0.10);
  for (int leg = 0; leg < kNumWheels; ++leg) {
    EXPECT_LT(truth.side_slip_m[leg], 0.02 * truth.wheel_travel_m[leg]);
    RecordProperty("side_slip_" + std::to_string(leg),
                   std::to_string(truth.side_slip_m[leg] / truth.wheel_travel_m[leg]));
  }
}

TEST(SimulatedMachine, ClimbsTwentyDegreesAtTheCommandedSpeed) {
  const double slope = std::tan(20.0 * kDeg);
  const TerrainMap terrain = ground_of([&](double x, double) { return slope * x; });
  const auto io = machine_on(terrain, standing_on_plane(m545(), slope, 0.0, -3.0));
  const double start_m = io->ground_truth().base[kBaseX] / std::cos(20.0 * kDeg);
  drive(*io, 0.4, 8.0);
  const double end_m = io->ground_truth().base[kBaseX] / std::cos(20.0 * kDeg);
  EXPECT_NEAR(end_m - start_m, 0.4 * 8.0 - 0.25, 0.15) << "minus the way lost while speeding up";
}

TEST(SimulatedMachine, StopsItsWheelsWhenStalledAtAWall) {
  constexpr double kWall_m = 1.5;
  const TerrainMap terrain =
      ground_of([](double x, double) { return x > 3.0 - 1e-6 ? kWall_m : 0.0; });
  const auto io = machine_on(terrain, standing_on_plane(m545(), 0.0, 0.0, -1.0));
  drive(*io, 0.4, 6.0);
  EXPECT_EQ(io->health().stall_stops, 1);
  EXPECT_EQ(io->health().level, HealthLevel::kHolding);
  const MachineState held = io->read();
  drive(*io, 0.4, 2.0);
  const MachineState later = io->read();
  EXPECT_LT((later.base - held.base).head<3>().norm(), 0.02);
  EXPECT_EQ(io->health().stall_stops, 1) << "not tried again by itself";
  drive(*io, -0.4, 3.0);
  EXPECT_LT(io->read().base[kBaseX], held.base[kBaseX] - 0.5) << "backing off ends the stall";
}

TEST(SimulatedMachine, StartsWhereItIsPutOnSkewGroundWithYawUnwrapped) {
  // A map that is asymmetric in every way: rows, columns, sign and offset must all be right.
  const auto height = [](double x, double y) { return 5.0 + 0.05 * x - 0.12 * y + 0.001 * x * y; };
  const TerrainMap terrain = ground_of(height);
  Eigen::VectorXd q = standing_on_plane(m545());
  const Eigen::Vector2d place(2.0, -1.5);
  const Eigen::Vector3d forward = Eigen::Vector3d(1.0, 0.0, 0.05 - 0.0015).normalized();
  const Eigen::Vector3d normal = Eigen::Vector3d(-0.05 + 0.0015, 0.12 - 0.002, 1.0).normalized();
  Eigen::Isometry3d T_world_base = Eigen::Isometry3d::Identity();
  T_world_base.linear() << forward, normal.cross(forward), normal;
  T_world_base.translation() << place, height(place.x(), place.y());
  T_world_base.translation() += m545().default_base_height_m * normal;
  q.head<kNumBaseCoordinates>() = base_coordinates_from(T_world_base);
  q[kBaseYaw] += 4.0 * std::numbers::pi;
  const auto io = machine_on(terrain, q);
  const MachineState state = io->read();
  EXPECT_LT((state.base - q.head<kNumBaseCoordinates>()).cwiseAbs().maxCoeff(), 0.03)
      << state.base.transpose() << " instead of " << q.head<kNumBaseCoordinates>().transpose();
  for (const double load_n : io->ground_truth().wheel_load_n) EXPECT_GT(load_n, 10e3);
}

TEST(SimulatedMachine, FallsIntoUnknownGround) {
  const TerrainMap terrain = ground_of(
      [](double x, double) { return x > 1.0 ? std::numeric_limits<double>::quiet_NaN() : 0.0; });
  const auto io = machine_on(terrain, standing_on_plane(m545()));
  EXPECT_GT(io->ground_truth().base[kBasePitch], 5.0 * kDeg) << "nose down";
}

TEST(SimulatedMachine, EvensOutItsWheelLoadsOnTwistedGround) {
  const TerrainMap terrain = ground_of([](double x, double y) { return 0.007 * x * y; });
  std::array<double, 2> warp{};
  for (const bool balance : {false, true}) {
    SimulationSettings settings;
    settings.load_balance = balance;
    const auto io =
        SimulatedMachine::create(m545(), terrain, standing_on_plane(m545()), settings).value();
    const MachineState before = io->read();
    drive(*io, 0.0, 20.0);
    const auto& load_n = io->ground_truth().wheel_load_n;
    warp[balance] =
        std::abs(load_n[0] - load_n[1] - load_n[2] + load_n[3]) / total_load_n(io->ground_truth());
    const MachineState after = io->read();
    for (int i = 0; i < after.num_joints; ++i) {
      // A braked wheel yields to what the legs push against one another.
      const double tolerance = m545().joints[i].role == JointRole::kWheel ? 0.03 : 0.01;
      EXPECT_NEAR(after.position[i], before.position[i], tolerance)
          << m545().joints[i].name << ": the caller does not see the balance";
    }
    EXPECT_EQ(io->load_balance_offset_rad()[0] != 0.0, balance);
  }
  EXPECT_GT(warp[0], 0.3);
  EXPECT_LT(warp[1], 0.06);
}

TEST(SimulatedMachine, TellsTheJointsOfTheModelFileInItsOrder) {
  const Eigen::VectorXd q = standing_on_plane(m545());
  const auto io = machine_on(flat_ground(), q);
  const Eigen::VectorXd planned = scalar_joint_values(m545(), q);
  const Eigen::VectorXd measured = io->scalar_joint_positions();
  ASSERT_EQ(measured.size(), planned.size());
  EXPECT_LT((measured - planned).cwiseAbs().maxCoeff(), 0.02);
}

TEST(SimulatedMachine, MovesTheSameWayEveryTime) {
  std::array<Eigen::VectorXd, 2> ends;
  for (Eigen::VectorXd& end : ends) {
    const auto io = machine_on(flat_ground(), standing_on_plane(m545()));
    drive(*io, 0.6, 2.0);
    end = io->scalar_joint_positions();
  }
  EXPECT_EQ(ends[0], ends[1]);
}

TEST(SimulatedMachine, DrawsItselfIntoAPngFile) {
  const auto io = machine_on(flat_ground(), standing_on_plane(m545()));
  const ScratchFolder folder("picture");
  const auto file = folder / "machine.png";
  const auto drawn = io->render(file.string(), 320, 200);
  ASSERT_TRUE(drawn) << drawn.error().message;
  std::ifstream stream(file, std::ios::binary);
  std::string png((std::istreambuf_iterator<char>(stream)), {});
  ASSERT_GT(png.size(), 5000u) << "an empty scene compresses to less";
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_FALSE(io->render("/nowhere/at/all.png"));
}

}  // namespace
}  // namespace wex
