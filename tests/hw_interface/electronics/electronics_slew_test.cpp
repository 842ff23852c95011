#include <gmock/gmock.h>

#include <algorithm>
#include <cstdio>
#include <numbers>

#include "hw_interface/mujoco/simulated_plant.hpp"
#include "tests/hw_interface/electronics/electronics_bench.hpp"
#include "tests/hw_interface/test_ground.hpp"

// T12 on the cabin: what a host that dies while the cabin slews costs in time and angle, by the
// arm's posture, the slope, and while the arm goes out. All times are of the simulation.

namespace wex::can {
namespace {

constexpr int kArm = 4, kTurn = 0;
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kOilColumn_rad = 1e-3;  ///< from there on it only swings back in its oil column
constexpr double kFullRate_rad_s = 0.8;

struct Case {
  const char* where;
  ReachingJoints arm;
  double up_degrees = 0.0;    ///< rise of the ground ahead; the arm then points to the left
  double least_rad_s = 0.0;   ///< the cabin may slew at least as fast
  ReachingJoints arm_rate{};  ///< while the cabin slews
  int going_out_ms = 0;
};

class Slew {
 public:
  explicit Slew(const Case& which) : plant_(make_plant(which)), bench_(1, {}, plant_.get()) {
    bench_.enable();
    bench_.ramp(kArm, kTurn, kFullRate_rad_s);
    const std::array<double, 4> goal{kFullRate_rad_s, which.arm_rate.boom, which.arm_rate.dipper,
                                     which.arm_rate.tele};
    for (int ms = 0; ms < which.going_out_ms; ms += 10) {
      for (int i = 0; i < 4; ++i) {
        const double step = limits_of({kArm, i}).max_acceleration * 0.01;
        const double now = bench_.commands[kArm].rate[i];
        bench_.set_rate(kArm, i, now + std::clamp(goal[i] - now, -step, step));
      }
      bench_.step();
    }
  }
  double angle_rad() const { return plant_->measure().position[turn()]; }
  double rate_rad_s() const { return plant_->measure().rate[turn()]; }
  const ElectronicsCounters& counters() const { return bench_.electronics->counters(); }

  struct Stop {
    double angle_rad = 0.0, least_load_n = 1e9;
    int ms = 0;
  };
  /// The host is gone; a second of what follows.
  Stop silence() {
    Stop stop;
    const double before_rad = angle_rad();
    bench_.send_commands = bench_.send_heartbeat = false;
    std::vector<double> way_rad;
    for (int i = 0; i < 100; ++i) {
      bench_.step();
      way_rad.push_back(angle_rad() - before_rad);
      for (const double load_n : plant_->ground_truth().wheel_load_n) {
        stop.least_load_n = std::min(stop.least_load_n, load_n);
      }
    }
    stop.angle_rad = *std::max_element(way_rad.begin(), way_rad.end());
    const auto there = std::find_if(way_rad.begin(), way_rad.end(), [&](double way) {
      return way >= stop.angle_rad - kOilColumn_rad;
    });
    stop.ms = 10 * static_cast<int>(there - way_rad.begin() + 1);
    return stop;
  }

 private:
  static int turn() { return *m545().coordinate("TURN") - kNumBaseCoordinates; }
  static std::unique_ptr<SimulatedPlant> make_plant(const Case& which) {
    const double slope = std::tan(which.up_degrees * kDegree);
    Eigen::VectorXd q = standing_on_plane(m545(), slope);
    q[*m545().coordinate("BOOM")] = which.arm.boom;
    q[*m545().coordinate("DIPPER")] = which.arm.dipper;
    q[*m545().coordinate("TELE")] = which.arm.tele;
    q[*m545().coordinate("EE_PITCH")] = which.arm.ee_pitch;
    if (which.up_degrees != 0.0) q[*m545().coordinate("TURN")] = 0.5 * std::numbers::pi;
    auto plant =
        SimulatedPlant::create(m545(), ground_of([=](double x, double) { return slope * x; }), q)
            .value();
    EXPECT_TRUE(plant->settle().has_value());
    return plant;
  }
  std::unique_ptr<SimulatedPlant> plant_;
  ElectronicsBench bench_;
};

class SlewStoppingTest : public ::testing::TestWithParam<Case> {};

// Asked for full rate, which no machine stops in time, it goes as fast as the electronics let it.
TEST_P(SlewStoppingTest, SlewingTheCabinStandsWithin150MsOfTheLastGoodCommand) {
  Case which = GetParam();
  if (which.going_out_ms == 0) which.going_out_ms = 300;
  Slew slew(which);
  const double rate_rad_s = slew.rate_rad_s();
  const Slew::Stop stop = slew.silence();
  std::printf(
      "T12 (simulated): TURN, %s, %.1f rad/s asked, %.3f rad/s: stands after %d ms and %.1f "
      "degrees, least wheel load %.0f N\n",
      which.where, kFullRate_rad_s, rate_rad_s, stop.ms, stop.angle_rad / kDegree,
      stop.least_load_n);
  EXPECT_GT(rate_rad_s, which.least_rad_s);
  EXPECT_LE(stop.ms, 150);
  EXPECT_GT(stop.least_load_n, 1000.0);
  EXPECT_THAT(slew.counters().limits, testing::Each(0)) << "applied, not refused";
}

constexpr ReachingJoints kTransport{1.0, -0.85, 0.0, -2.0}, kMid{0.9, -0.4, 0.5, -1.5},
    kStretched{0.8, 0.0, 1.0, -2.0}, kFurthest{0.1, 1.0, 1.76, 0.0};

INSTANTIATE_TEST_SUITE_P(
    , SlewStoppingTest,
    ::testing::Values(Case{"transport", kTransport, 0.0, 0.3}, Case{"mid", kMid, 0.0, 0.165},
                      Case{"stretched", kStretched, 0.0, 0.115},
                      Case{"furthest", kFurthest, 0.0, 0.05},
                      Case{"transport on 20 degrees", kTransport, 20.0, 0.18},
                      Case{"mid on 20 degrees", kMid, 20.0, 0.07},
                      Case{"stretched on 20 degrees", kStretched, 20.0, 0.04},
                      Case{
                          "going out from transport", kTransport, 0.0, 0.2, {-0.3, 0.5, 0.4}, 1600},
                      Case{"going out from mid", kMid, 0.0, 0.1, {-0.3, 0.5, 0.4}, 1200}),
    [](const auto& info) {
      std::string name = info.param.where;
      std::erase_if(name, [](char c) { return !std::isalnum(c); });
      return name;
    });

}  // namespace
}  // namespace wex::can
