// The closed loop against a planar stand-in for the machine and a stand-in for the optimizer: what
// is tested is timing, arrival and every way a drive can end.
#include "tools/wex/drive.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace wex::app {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kSpeed = 0.5, kLength = 3.0;

/// Rolls along x as its wheels are told; every other coordinate stays.
class RollingMachine final : public MachineIo {
 public:
  RollingMachine(const MachineModel& machine, const Eigen::VectorXd& q)
      : machine_(machine), q_(q) {}

  MachineState read() noexcept override {
    MachineState state;
    state.t_s = t_s_;
    state.base = q_.head<kNumBaseCoordinates>();
    state.base_velocity.setZero();
    state.base_velocity[0] = speed_;
    state.num_joints = machine_.num_joints();
    for (int j = 0; j < state.num_joints; ++j) state.position[j] = q_[kNumBaseCoordinates + j];
    return state;
  }
  WriteOutcome write(const JointCommand& command) noexcept override {
    command_ = command;
    ++writes;
    longest_validity_s = std::max(longest_validity_s, command.valid_until_s - t_s_);
    return WriteOutcome::kAccepted;
  }
  void stop() noexcept override {
    stopped_at_s = t_s_;
    command_ = JointCommand{};
  }
  void release() noexcept override {}
  MachineHealth health() const noexcept override { return {}; }
  void wait_until(double t_s) override {
    const WheeledLeg& leg = machine_.legs[0];
    const double rate = command_.rate[leg.wheel - kNumBaseCoordinates];
    speed_ = blocked || t_s > command_.valid_until_s ? 0.0 : rate * leg.wheel_sign * leg.radius_m;
    q_[kBaseX] += speed_ * (t_s - t_s_);
    if (tip_at_s && t_s >= *tip_at_s) q_[kBaseRoll] = 31.0 * kDegree;
    t_s_ = t_s;
  }

  bool blocked = false;
  std::optional<double> tip_at_s;
  int writes = 0;
  double longest_validity_s = 0.0;
  std::optional<double> stopped_at_s;
  double t_s_ = 100.0;  ///< machine time need not begin at zero

 private:
  const MachineModel& machine_;
  Eigen::VectorXd q_;
  JointCommand command_;
  double speed_ = 0.0;
};

class DriveTest : public ::testing::Test {
 protected:
  DriveTest()
      : terrain_(flat()),
        machine_(*load_machine()),
        reference_(straight()),
        io_(machine_, reference_.nodes.front().q) {
    instruments_.ground_truth = [this] { return truth_; };
    instruments_.scalar_joints = [] { return Eigen::VectorXd(Eigen::VectorXd::Zero(3)); };
    instruments_.solve = [this](const HorizonInput& input) {
      inputs_.push_back(input);
      solve_times_s_.push_back(io_.t_s_);
      return follow(input);
    };
    settings_.solve_delay_s = 0.05;
    settings_.hold_s = 2.0;
  }

  static TerrainMap flat() {
    Grid grid;
    grid.size_x = grid.size_y = 200;
    grid.values.assign(200 * 200, 0.0f);
    return *TerrainMap::build(std::move(grid));
  }

  RefinedTrajectory straight() const {
    RefinedTrajectory trajectory;
    trajectory.dt_s = 0.25;
    for (double t = 0.0; t <= kLength / kSpeed + 1e-9; t += 0.25) {
      WholeBodyNode node;
      node.t_s = t;
      node.q = Eigen::VectorXd::Zero(machine_.num_coordinates());
      node.q[kBaseX] = 5.0 + kSpeed * t;
      node.q[kBaseY] = 10.0;
      node.q[kBaseZ] = machine_.default_base_height_m;
      for (const WheeledLeg& leg : machine_.legs) {
        node.q[leg.wheel] = leg.wheel_sign * kSpeed * t / leg.radius_m;
      }
      trajectory.nodes.push_back(node);
    }
    return trajectory;
  }

  /// The reference's motion, started at the input, closing a tenth of the gap per node.
  HorizonResult follow(const HorizonInput& input) const {
    HorizonResult result;
    result.usable = result.report.feasible = true;
    result.report.worst_residual["height_m"] = 1e-3;
    for (int k = 0; k <= 20; ++k) {
      const double ahead_s = 0.25 * k;
      const Eigen::VectorXd at = sample(reference_.nodes, input.reference_time_s + ahead_s).q;
      const Eigen::VectorXd first = sample(reference_.nodes, input.reference_time_s).q;
      WholeBodyNode node{input.t_s + ahead_s, input.q + at - first, kDrivingContacts};
      const double gap = std::min(1.0, 0.1 * k) * (first[kBaseX] - input.q[kBaseX]);
      node.q[kBaseX] += gap;
      for (const WheeledLeg& leg : machine_.legs) {
        node.q[leg.wheel] += leg.wheel_sign * gap / leg.radius_m;
      }
      result.nodes.push_back(node);
    }
    return result;
  }

  DriveRecord run() {
    return drive(terrain_, machine_, reference_, {5.0 + kLength, 10.0, 0.0}, io_, instruments_,
                 settings_);
  }

  TerrainMap terrain_;
  MachineModel machine_;
  RefinedTrajectory reference_;
  RollingMachine io_;
  GroundTruth truth_;
  DriveInstruments instruments_;
  DriveSettings settings_;
  std::vector<HorizonInput> inputs_;
  std::vector<double> solve_times_s_;
};

TEST_F(DriveTest, ReachesTheGoalAndRecordsAtItsRates) {
  const DriveRecord record = run();
  EXPECT_FALSE(record.failure) << record.failure->message;
  EXPECT_LT(record.goal_error_m, 0.1);
  EXPECT_NEAR(record.duration_s, kLength / kSpeed, 2.0);
  EXPECT_NEAR(record.simulated_s, record.duration_s + settings_.hold_s, 0.02);
  ASSERT_GT(record.samples.size(), 100u);
  EXPECT_DOUBLE_EQ(record.samples.front().t_s, 0.0);
  EXPECT_NEAR(record.samples[1].t_s, settings_.log_period_s, 1e-9);
  EXPECT_NEAR(static_cast<double>(record.solves.size()), record.duration_s / 0.1, 1.5);
  EXPECT_DOUBLE_EQ(record.worst_residual.at("height_m"), 1e-3);
  EXPECT_NEAR(io_.writes * settings_.control_period_s, record.duration_s, 0.1);
  EXPECT_LE(io_.longest_validity_s, settings_.command_validity_s + 1e-9);
}

TEST_F(DriveTest, ComputesEachResultForTheMomentItTakesEffect) {
  const DriveRecord record = run();
  for (std::size_t k = 0; k < inputs_.size(); ++k) {
    EXPECT_NEAR(inputs_[k].t_s, solve_times_s_[k] + 0.05, 1e-9);
    EXPECT_NEAR(record.solves[k].applied_s - record.solves[k].t_s, 0.05, 1e-9);
  }
  // While rolling steadily the predicted state is the speed times the delay ahead.
  const std::size_t middle = inputs_.size() / 2;
  const double x_now = record.samples[2 * middle].base[kBaseX];
  EXPECT_NEAR(inputs_[middle].q[kBaseX], x_now + kSpeed * 0.05, 0.01);
}

TEST_F(DriveTest, SolvesLessOftenWhenTheDelayExceedsThePeriod) {
  settings_.solve_delay_s = 0.25;
  const DriveRecord record = run();
  EXPECT_FALSE(record.failure);
  for (std::size_t k = 1; k < solve_times_s_.size(); ++k) {
    EXPECT_NEAR(solve_times_s_[k] - solve_times_s_[k - 1], 0.25, 1e-9);
  }
}

TEST_F(DriveTest, StopsSafelyBeforeTheLastTrajectoryEndsWhenTheOptimizerFails) {
  instruments_.solve = [this](const HorizonInput& input) {
    if (io_.t_s_ < 102.0) return follow(input);
    HorizonResult result;
    result.report.status = "did not converge";
    return result;
  };
  // A long reference: the loop must not end by arriving.
  for (WholeBodyNode& node : reference_.nodes) node.t_s *= 5.0;
  const DriveRecord record = run();
  ASSERT_TRUE(record.failure);
  EXPECT_EQ(record.failure->code, ErrorCode::kStoppedSafely);
  EXPECT_NE(record.failure->message.find("did not converge"), std::string::npos);
  ASSERT_TRUE(io_.stopped_at_s);
  // Last usable result: computed for 101.95 s, 5 s long, followed to 1.5 s before its end.
  EXPECT_NEAR(*io_.stopped_at_s, 101.95 + 5.0 - 1.5, 0.05);
}

TEST_F(DriveTest, StopsSafelyWhenTheOptimizerNeverSucceeds) {
  instruments_.solve = [](const HorizonInput&) { return HorizonResult{}; };
  const DriveRecord record = run();
  ASSERT_TRUE(record.failure);
  EXPECT_EQ(record.failure->code, ErrorCode::kStoppedSafely);
  EXPECT_EQ(io_.writes, 0);
}

TEST_F(DriveTest, GivesUpAfterThreeTimesThePlannedDuration) {
  io_.blocked = true;
  const DriveRecord record = run();
  ASSERT_TRUE(record.failure);
  EXPECT_EQ(record.failure->code, ErrorCode::kStoppedSafely);
  EXPECT_NE(record.failure->message.find("time ran out"), std::string::npos);
  EXPECT_NEAR(record.duration_s, 3.0 * kLength / kSpeed, 0.05);
  EXPECT_NEAR(record.goal_error_m, kLength, 0.01);
  EXPECT_LT(inputs_.back().reference_time_s, 1.2);  // the reference waited
}

TEST_F(DriveTest, EndsOutOfLimitsWhenTheMachineTips) {
  io_.tip_at_s = 103.0;
  const DriveRecord record = run();
  ASSERT_TRUE(record.failure);
  EXPECT_EQ(record.failure->code, ErrorCode::kOutOfLimits);
  EXPECT_NEAR(*io_.stopped_at_s, 103.0, 0.02);
  EXPECT_NEAR(record.extremes.max_roll_rad, 31.0 * kDegree, 1e-9);
}

TEST_F(DriveTest, EndsOutOfLimitsWhenTheBodyTouchesTheGround) {
  instruments_.ground_truth = [this] {
    GroundTruth truth;
    truth.body_contact = io_.t_s_ > 102.0;
    return truth;
  };
  const DriveRecord record = run();
  ASSERT_TRUE(record.failure);
  EXPECT_EQ(record.failure->code, ErrorCode::kOutOfLimits);
  EXPECT_NE(record.failure->message.find("body"), std::string::npos);
}

TEST_F(DriveTest, CountsSlipAndTravelFromItsOwnBeginning) {
  instruments_.ground_truth = [this] {
    GroundTruth truth;
    truth.side_slip_m.fill(5.0 + 0.001 * (io_.t_s_ - 100.0));
    truth.wheel_travel_m.fill(70.0 + 0.5 * (io_.t_s_ - 100.0));
    return truth;
  };
  const DriveRecord record = run();
  for (int i = 0; i < kNumWheels; ++i) {
    EXPECT_NEAR(record.extremes.side_slip_m[i], 0.001 * record.duration_s, 1e-9);
    EXPECT_NEAR(record.extremes.travel_m[i], 0.5 * record.duration_s, 1e-9);
  }
}

}  // namespace
}  // namespace wex::app
