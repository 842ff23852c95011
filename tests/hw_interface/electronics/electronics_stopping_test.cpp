#include <algorithm>
#include <cstdio>
#include <numbers>

#include "hw_interface/mujoco/simulated_plant.hpp"
#include "tests/hw_interface/electronics/electronics_bench.hpp"
#include "tests/hw_interface/test_ground.hpp"

// T12 on wheels: what a host that dies while the machine travels costs in time and distance, by
// slope and speed. All times are of the simulation.

namespace wex::can {
namespace {

constexpr int kWheel = 3;
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kTyres_m = 2e-3;  ///< from there on it only swings back in its tyres
constexpr double kFasterThanAllowed_m_s = 1.0;

struct Case {
  const char* where;
  double up_degrees, left_degrees;  ///< rise of the ground ahead and to the left
  bool extended = false;            ///< arm stretched out: bucket 4.2 m ahead, 1 m high
};

class Drive {
 public:
  explicit Drive(const Case& which) : plant_(make_plant(which)), bench_(1, {}, plant_.get()) {
    bench_.enable();
  }
  /// As fast as asked, or as the electronics let it.
  void travel(double speed_m_s, double duration_s = 2.0) {
    const double rate_rad_s = speed_m_s / m545().legs.front().radius_m;
    const double step_rad_s = m545().joints[wheel()].max_acceleration * 0.01;
    for (double rate = 0.0; std::abs(rate) < std::abs(rate_rad_s);) {
      rate += std::clamp(rate_rad_s - rate, -step_rad_s, step_rad_s);
      for (int zone = 0; zone < kNumWheels; ++zone) {
        bench_.set_rate(zone, kWheel, m545().legs[zone].wheel_sign * rate);
      }
      bench_.step();
    }
    bench_.steps(static_cast<int>(duration_s / 0.01));
  }
  double speed_m_s() { return plant_->sense().base_velocity.head<3>().norm(); }

  struct Stop {
    double speed_m_s = 0.0, way_m = 0.0, pitch_degrees = 0.0, least_load_n = 1e9;
    int ms = 0, lifted_ms = 0;
  };
  /// The host is gone; two seconds of what follows.
  Stop silence() {
    Stop stop;
    stop.speed_m_s = speed_m_s();
    const BaseCoordinates before = plant_->sense().base;
    bench_.send_commands = bench_.send_heartbeat = false;
    std::vector<double> way_m;
    for (int i = 0; i < 200; ++i) {
      bench_.step();
      const BaseCoordinates moved = plant_->sense().base - before;
      way_m.push_back(moved.head<3>().norm());
      stop.pitch_degrees = std::max(stop.pitch_degrees, std::abs(moved[kBasePitch]) / kDegree);
      for (const double load_n : plant_->ground_truth().wheel_load_n) {
        stop.least_load_n = std::min(stop.least_load_n, load_n);
        if (load_n <= 0.0) stop.lifted_ms += 10;
      }
    }
    stop.way_m = *std::max_element(way_m.begin(), way_m.end());
    const auto there = std::find_if(way_m.begin(), way_m.end(),
                                    [&](double way) { return way >= stop.way_m - kTyres_m; });
    stop.ms = 10 * static_cast<int>(there - way_m.begin() + 1);
    return stop;
  }
  Eigen::Vector3d place() { return plant_->sense().base.head<3>(); }
  ElectronicsBench& bench() { return bench_; }

 private:
  static int wheel() { return m545().legs.front().wheel - kNumBaseCoordinates; }
  static std::unique_ptr<SimulatedPlant> make_plant(const Case& which) {
    const double slope_x = std::tan(which.up_degrees * kDegree);
    const double slope_y = std::tan(which.left_degrees * kDegree);
    constexpr double kStart_m = -5.0;
    const TerrainMap ground =
        ground_of([=](double x, double y) { return slope_x * x + slope_y * y; });
    Eigen::VectorXd q = standing_on_plane(m545(), slope_x, slope_y, kStart_m);
    if (which.extended) {
      q[*m545().coordinate("BOOM")] = 0.8;
      q[*m545().coordinate("DIPPER")] = 0.0;
      q[*m545().coordinate("TELE")] = 1.0;
    }
    auto plant = SimulatedPlant::create(m545(), ground, q).value();
    EXPECT_TRUE(plant->settle().has_value());
    return plant;
  }
  std::unique_ptr<SimulatedPlant> plant_;
  ElectronicsBench bench_;
};

class StoppingTest : public ::testing::TestWithParam<Case> {};

TEST_P(StoppingTest, TravellingItStandsWithin150MsOfTheLastGoodCommandOnItsFourWheels) {
  for (const double asked_m_s : {0.2, 0.4, kFasterThanAllowed_m_s}) {
    if (GetParam().extended && asked_m_s < 0.3) continue;
    Drive drive(GetParam());
    drive.travel(asked_m_s);
    const Drive::Stop stop = drive.silence();
    std::printf(
        "T12 (simulated): %s, %.1f m/s asked, %.2f m/s: stands after %d ms and %.3f m, nods "
        "by %.1f degrees, least wheel load %.0f N\n",
        GetParam().where, asked_m_s, stop.speed_m_s, stop.ms, stop.way_m, stop.pitch_degrees,
        stop.least_load_n);
    EXPECT_GT(stop.speed_m_s, 0.15);
    EXPECT_LE(stop.ms, 150);
    EXPECT_LT(stop.pitch_degrees, 1.0);
    EXPECT_EQ(stop.lifted_ms, 0);
    EXPECT_TRUE(drive.bench().electronics->brakes_closed());
  }
}

INSTANTIATE_TEST_SUITE_P(, StoppingTest,
                         ::testing::Values(Case{"level", 0, 0}, Case{"20 degrees up", 20, 0},
                                           Case{"10 degrees down", -10, 0},
                                           Case{"15 degrees down", -15, 0},
                                           Case{"20 degrees down", -20, 0},
                                           Case{"side slope of 20 degrees", 0, 20},
                                           Case{"level, arm extended", 0, 0, true},
                                           Case{"20 degrees down, arm extended", -20, 0, true},
                                           Case{"15 degrees down, arm extended", -15, 0, true}),
                         [](const auto& info) {
                           std::string name = info.param.where;
                           std::erase_if(name, [](char c) { return !std::isalnum(c); });
                           return name;
                         });

// Down the slope backwards is down the slope.
TEST(StoppingOnTheWayDownTest, TheWayDownIsSlowInBothDirections) {
  Drive uphill({"20 degrees up", 20, 0});
  uphill.travel(kFasterThanAllowed_m_s);
  const double up_m_s = uphill.speed_m_s();
  Drive backwards({"20 degrees up", 20, 0});
  backwards.travel(-kFasterThanAllowed_m_s);
  EXPECT_GT(up_m_s, 2.0 * backwards.speed_m_s());
  EXPECT_LE(backwards.silence().ms, 150);
}

class HoldOnSlopeTest : public ::testing::TestWithParam<Case> {};

TEST_P(HoldOnSlopeTest, NothingCreepsInHold) {
  Drive drive(GetParam());
  drive.travel(0.2, 0.5);
  drive.bench().send_commands = false;
  drive.bench().steps(100);
  ASSERT_EQ(drive.bench().mode(), MachineMode::kHold);
  const Eigen::Vector3d after_a_second = drive.place();
  drive.bench().steps(1000);
  ASSERT_EQ(drive.bench().mode(), MachineMode::kHold);
  const double drift_mm = 1e3 * (drive.place() - after_a_second).norm();
  std::printf("HOLD (simulated): %s, %.2f mm in the 10 s after the first one\n", GetParam().where,
              drift_mm);
  EXPECT_LT(drift_mm, 1.0);
}

INSTANTIATE_TEST_SUITE_P(, HoldOnSlopeTest,
                         ::testing::Values(Case{"side slope of 15 degrees", 0, 15},
                                           Case{"20 degrees up", 20, 0},
                                           Case{"20 degrees down", -20, 0}),
                         [](const auto& info) {
                           std::string name = info.param.where;
                           std::erase_if(name, [](char c) { return !std::isalnum(c); });
                           return name;
                         });

}  // namespace
}  // namespace wex::can
