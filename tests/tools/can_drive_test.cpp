// What a run does when the machine on the bus holds, faults, is stopped or refuses commands, and
// what result.json says of the bus. The machine is scripted, or electronics behind a pipe.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "models/excavator/mjcf.hpp"
#include "tests/support/host_bench.hpp"
#include "tools/wex/drive.hpp"
#include "tools/wex/real_time_priority.hpp"
#include "tools/wex/run_report.hpp"
#include "tools/wex/solver_thread.hpp"

namespace wex::app {
namespace {

using ::testing::HasSubstr;

constexpr double kSpeed = 0.5, kLength = 3.0;

/// Rolls along x as its wheels are told, and obeys a script by machine time.
class ScriptedMachine final : public MachineIo {
 public:
  ScriptedMachine(const MachineModel& machine, const Eigen::VectorXd& q)
      : machine_(machine), q_(q) {}

  MachineState read() noexcept override {
    MachineState state;
    state.t_s = t_s - 0.01;
    state.age_s = 0.01;
    state.base = q_.head<kNumBaseCoordinates>();
    state.base_velocity.setZero();
    state.base_velocity[0] = speed_;
    state.num_joints = machine_.num_joints();
    for (int j = 0; j < state.num_joints; ++j) state.position[j] = q_[kNumBaseCoordinates + j];
    return state;
  }
  WriteOutcome write(const JointCommand& command) noexcept override {
    const WriteOutcome outcome = outcome_at(t_s);
    command_ = taken(outcome) ? command : JointCommand{};
    return outcome;
  }
  void stop() noexcept override {
    if (!stopped_at_s) stopped_at_s = t_s;
    command_ = JointCommand{};
  }
  void release() noexcept override {}
  MachineHealth health() const noexcept override { return {}; }
  Lifecycle lifecycle() const noexcept override { return lifecycle_at(t_s); }
  void wait_until(double until_s) override {
    const double to_s = std::max(until_s, t_s) + extra_s;
    const WheeledLeg& leg = machine_.legs[0];
    speed_ = command_.rate[leg.wheel - kNumBaseCoordinates] * leg.wheel_sign * leg.radius_m;
    q_[kBaseX] += speed_ * (to_s - t_s);
    t_s = to_s;
    if (on_wait) on_wait();
  }

  double x() const { return q_[kBaseX]; }

  std::function<Lifecycle(double)> lifecycle_at = [](double) { return Lifecycle::kActive; };
  std::function<WriteOutcome(double)> outcome_at = [](double) { return WriteOutcome::kAccepted; };
  std::function<void()> on_wait;
  double extra_s = 0.0;  ///< every wait takes that much longer
  double t_s = 100.0;
  std::optional<double> stopped_at_s;

 private:
  const MachineModel& machine_;
  Eigen::VectorXd q_;
  JointCommand command_;
  double speed_ = 0.0;
};

class CanDriveTest : public ::testing::Test {
 protected:
  CanDriveTest()
      : terrain_(flat()), reference_(straight()), io_(machine(), reference_.nodes.front().q) {
    instruments_.cause = [] { return "as the script says"; };
    instruments_.solve = [this](const HorizonInput& input) {
      inputs_.push_back(input);
      return follow(input);
    };
    settings_.solve_delay_s = 0.05;
    settings_.hold_s = 2.0;
  }

  static const MachineModel& machine() { return can::bench_machine(); }
  static TerrainMap flat() {
    Grid grid;
    grid.size_x = grid.size_y = 200;
    grid.values.assign(200 * 200, 0.0f);
    return *TerrainMap::build(std::move(grid));
  }

  static RefinedTrajectory straight() {
    RefinedTrajectory trajectory;
    trajectory.dt_s = 0.25;
    for (double t = 0.0; t <= kLength / kSpeed + 1e-9; t += 0.25) {
      WholeBodyNode node;
      node.t_s = t;
      node.q = Eigen::VectorXd::Zero(machine().num_coordinates());
      node.q[kBaseX] = 5.0 + kSpeed * t;
      node.q[kBaseY] = 10.0;
      node.q[kBaseZ] = machine().default_base_height_m;
      for (const WheeledLeg& leg : machine().legs) {
        node.q[leg.wheel] = leg.wheel_sign * kSpeed * t / leg.radius_m;
      }
      trajectory.nodes.push_back(node);
    }
    return trajectory;
  }

  /// The reference's motion from the input on, closing a tenth of the gap per node.
  HorizonResult follow(const HorizonInput& input) const {
    HorizonResult result;
    result.usable = result.report.feasible = true;
    const Eigen::VectorXd first = sample(reference_.nodes, input.reference_time_s).q;
    for (int k = 0; k <= 20; ++k) {
      const double ahead_s = 0.25 * k;
      const Eigen::VectorXd at = sample(reference_.nodes, input.reference_time_s + ahead_s).q;
      WholeBodyNode node{input.t_s + ahead_s, input.q + at - first, kDrivingContacts};
      const double gap = std::min(1.0, 0.1 * k) * (first[kBaseX] - input.q[kBaseX]);
      node.q[kBaseX] += gap;
      for (const WheeledLeg& leg : machine().legs) {
        node.q[leg.wheel] += leg.wheel_sign * gap / leg.radius_m;
      }
      result.nodes.push_back(node);
    }
    return result;
  }

  DriveRecord run() {
    return drive(terrain_, machine(), reference_, {5.0 + kLength, 10.0, 0.0}, io_, instruments_,
                 settings_);
  }

  void expect_stopped(const DriveRecord& record, double at_s, const std::string& words) {
    ASSERT_TRUE(record.failure);
    EXPECT_EQ(record.failure->code, ErrorCode::kStoppedSafely);
    EXPECT_THAT(record.failure->message, HasSubstr(words));
    ASSERT_TRUE(io_.stopped_at_s);
    EXPECT_NEAR(*io_.stopped_at_s, at_s, 0.03);
  }

  TerrainMap terrain_;
  RefinedTrajectory reference_;
  ScriptedMachine io_;
  DriveInstruments instruments_;
  DriveSettings settings_;
  std::vector<HorizonInput> inputs_;
};

TEST_F(CanDriveTest, WithoutGroundTruthTheGoalIsReachedAndWhatOnlyTruthKnowsIsNull) {
  RunReport report;
  report.drive = run();
  EXPECT_FALSE(report.drive->failure) << report.drive->failure->message;
  EXPECT_LT(report.drive->goal_error_m, 0.1);
  EXPECT_EQ(report.drive->samples.back().contacts, kDrivingContacts);
  EXPECT_EQ(static_cast<std::size_t>(report.drive->samples.back().scalar_joints.size()),
            scalar_joint_names(machine())->size());
  const auto json = nlohmann::json::parse(result_json(report))["drive"];
  for (const char* key :
       {"min_loaded_stability_margin_m", "side_slip_ratio", "max_wheel_penetration_m",
        "max_tyre_deflection_m", "hold_vertical_rate_m_s"}) {
    EXPECT_TRUE(json[key].is_null()) << key;
  }
  EXPECT_TRUE(json["wheel_lift_off_s"]["LF"].is_null());
  EXPECT_GT(json["min_stability_margin_m"].get<double>(), 0.0);
  EXPECT_EQ(summary_table(report).find("side slip"), std::string::npos);
}

TEST_F(CanDriveTest, AFaultAnEmergencyStopAndADisabledMachineEndTheDriveWithTheirCause) {
  for (const auto& [lifecycle, words] :
       {std::pair{Lifecycle::kFault, "in fault: as the script says"},
        {Lifecycle::kEStop, "emergency stop: as the script says"},
        {Lifecycle::kInactive, "not enabled any more"},
        {Lifecycle::kUnconfigured, "not heard any more"}}) {
    ScriptedMachine fresh(machine(), reference_.nodes.front().q);
    fresh.lifecycle_at = [lifecycle](double t_s) {
      return t_s < 103.0 ? Lifecycle::kActive : lifecycle;
    };
    const DriveRecord record = drive(terrain_, machine(), reference_, {5.0 + kLength, 10.0, 0.0},
                                     fresh, instruments_, settings_);
    ASSERT_TRUE(record.failure) << words;
    EXPECT_EQ(record.failure->code, ErrorCode::kStoppedSafely);
    EXPECT_THAT(record.failure->message, HasSubstr(words));
    EXPECT_NEAR(*fresh.stopped_at_s, 103.0, 0.03);
    EXPECT_NEAR(record.simulated_s - record.duration_s, settings_.after_loss_s, 0.03);
  }
}

TEST_F(CanDriveTest, AFaultWhileHoldingAtTheGoalIsNotASuccess) {
  io_.lifecycle_at = [this](double t_s) {
    return io_.stopped_at_s && t_s > *io_.stopped_at_s + 1.0 ? Lifecycle::kFault
                                                             : Lifecycle::kActive;
  };
  const DriveRecord record = run();
  EXPECT_LT(record.goal_error_m, 0.1);
  ASSERT_TRUE(record.failure);
  EXPECT_THAT(record.failure->message, HasSubstr("in fault"));
}

TEST_F(CanDriveTest, AHoldIsWaitedOutWithTheReferenceStandingStill) {
  for (const WriteOutcome outcome : {WriteOutcome::kRejectedNotActive, WriteOutcome::kBusStalled,
                                     WriteOutcome::kRejectedStale}) {
    inputs_.clear();
    ScriptedMachine fresh(machine(), reference_.nodes.front().q);
    double x_begin = 0.0, x_end = 0.0;
    fresh.outcome_at = [outcome](double t_s) {
      return t_s < 103.0 || t_s > 105.0 ? WriteOutcome::kAccepted : outcome;
    };
    fresh.on_wait = [&] {
      if (fresh.t_s < 103.02) x_begin = fresh.x();
      if (fresh.t_s < 105.0) x_end = fresh.x();
    };
    const DriveRecord record = drive(terrain_, machine(), reference_, {5.0 + kLength, 10.0, 0.0},
                                     fresh, instruments_, settings_);
    EXPECT_FALSE(record.failure) << record.failure->message;
    EXPECT_LT(record.goal_error_m, 0.1);
    EXPECT_NEAR(x_end, x_begin, 0.01);
    double first = 0.0, last = 0.0;  // reference times asked for while holding
    for (const HorizonInput& input : inputs_) {
      if (input.t_s < 103.2 || input.t_s > 105.0) continue;
      if (first == 0.0) first = input.reference_time_s;
      last = input.reference_time_s;
      EXPECT_DOUBLE_EQ(input.qdot.norm(), 0.0);  // it stands
    }
    EXPECT_GT(first, 1.0);
    EXPECT_NEAR(last, first, 1e-9);
  }
}

TEST_F(CanDriveTest, AHoldThatDoesNotEndStopsSafely) {
  io_.outcome_at = [](double t_s) {
    return t_s < 103.0 ? WriteOutcome::kAccepted : WriteOutcome::kRejectedNotActive;
  };
  expect_stopped(run(), 103.0 + settings_.hold_patience_s, "holds since");
}

TEST_F(CanDriveTest, ARefusedCommandStopsAtOnce) {
  for (const auto& [outcome, words] : {std::pair{WriteOutcome::kRejectedNotFinite, "not finite"},
                                       {WriteOutcome::kRejectedRange, "beyond its limits"},
                                       {WriteOutcome::kRejectedWrongSize, "number of joints"}}) {
    ScriptedMachine fresh(machine(), reference_.nodes.front().q);
    fresh.outcome_at = [outcome](double t_s) {
      return t_s < 103.0 ? WriteOutcome::kAccepted : outcome;
    };
    const DriveRecord record = drive(terrain_, machine(), reference_, {5.0 + kLength, 10.0, 0.0},
                                     fresh, instruments_, settings_);
    ASSERT_TRUE(record.failure) << words;
    EXPECT_EQ(record.failure->code, ErrorCode::kStoppedSafely);
    EXPECT_THAT(record.failure->message, HasSubstr(words));
    EXPECT_NEAR(*fresh.stopped_at_s, 103.0, 0.02);
  }
}

TEST_F(CanDriveTest, AClockThatDoesNotWaitIsFollowedNotCaughtUpWith) {
  io_.extra_s = 0.02;  // three periods pass with every wait
  const DriveRecord record = run();
  EXPECT_FALSE(record.failure) << record.failure->message;
  EXPECT_NEAR(record.duration_s, *io_.stopped_at_s - 100.0, 0.01);  // the machine's own time
  EXPECT_NEAR(record.duration_s, kLength / kSpeed, 3.0);
  for (std::size_t k = 1; k < record.samples.size(); ++k) {
    EXPECT_GT(record.samples[k].t_s, record.samples[k - 1].t_s);
  }
}

TEST_F(CanDriveTest, ASlowSolveBesideNeverKeepsTheControlLoopWaiting) {
  settings_.solve_beside = true;
  settings_.solve_delay_s.reset();
  // The machine's clock waits for a solve that is due and only lacks a processor, so that what is
  // late is late by the clock and not by the load of the computer.
  std::atomic<double> machine_s = io_.t_s, until_s = 0.0;
  std::atomic<bool> solving = false;
  io_.on_wait = [&] {
    machine_s = io_.t_s;
    std::this_thread::sleep_for(std::chrono::microseconds(solving ? 200 : 1000));
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
    while (solving && machine_s >= until_s && std::chrono::steady_clock::now() < end) {
      std::this_thread::yield();
    }
  };
  std::atomic<int> solves = 0;
  instruments_.solve = [&](const HorizonInput& input) {
    // Every fifth solve takes 0.3 s of the machine's time.
    until_s = machine_s + (++solves % 5 == 0 ? 0.3 : 0.02);
    solving = true;
    while (machine_s < until_s && until_s < 115.0) std::this_thread::yield();
    solving = false;
    return follow(input);
  };
  const DriveRecord record = run();
  EXPECT_FALSE(record.failure) << record.failure->message;
  EXPECT_LT(record.goal_error_m, 0.1);
  const auto late = std::count_if(record.solves.begin(), record.solves.end(),
                                  [](const SolveSample& solve) { return solve.late; });
  EXPECT_GE(late, 1);
  for (const SolveSample& solve : record.solves) EXPECT_GE(solve.applied_s, solve.t_s);
  RunReport report;
  report.drive = record;
  EXPECT_GE(nlohmann::json::parse(result_json(report))["mpc"]["misses"].get<long>(), late);
}

TEST(SolverThread, HandsOverEachResultOnceAndRethrows) {
  SolverThread solver([](const HorizonInput& input) {
    if (input.t_s < 0.0) throw std::runtime_error("no");
    HorizonResult result;
    result.report.iterations = static_cast<int>(input.t_s);
    return result;
  });
  for (const int value : {3, 4}) {
    EXPECT_FALSE(solver.busy());
    HorizonInput input;
    input.t_s = value;
    solver.begin(input);
    EXPECT_TRUE(solver.busy());
    std::optional<SolverThread::Solved> solved;
    while (!(solved = solver.take())) std::this_thread::yield();
    EXPECT_EQ(solved->result.report.iterations, value);
    EXPECT_FALSE(solver.take());
  }
  HorizonInput bad;
  bad.t_s = -1.0;
  solver.begin(bad);
  const auto take = [&] {
    while (!solver.take()) std::this_thread::yield();
  };
  EXPECT_THROW(take(), std::runtime_error);
}

TEST(SolverThread, EndsInEveryState) {
  const auto solve = [](const HorizonInput&) { return HorizonResult{}; };
  {
    SolverThread idle(solve);
  }
  {
    SolverThread solving(solve);
    solving.begin({});
  }
  {
    SolverThread finished(solve);
    finished.begin({});
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // its result is not taken
  }
}

TEST(RealTimePriorityTest, IsGivenBackAndNotInherited) {
  const int before = sched_getscheduler(0);
  {
    const RealTimePriority priority;
    if (priority.granted()) {
      EXPECT_EQ(sched_getscheduler(0) & ~SCHED_RESET_ON_FORK, SCHED_FIFO);
    } else {
      EXPECT_EQ(sched_getscheduler(0), before);
    }
    int beside = -1;
    std::thread([&] { beside = sched_getscheduler(0); }).join();
    EXPECT_EQ(beside, before);
  }
  EXPECT_EQ(sched_getscheduler(0), before);
}

TEST(BusReport, SaysWhatHappenedOnTheBus) {
  can::HostBench bench;
  bench.drive();
  bench.port.set_receiving({.loss = 0.05});
  bench.wait(2.0);
  bench.port.set_receiving({});
  bench.wait(0.5);
  RunReport report;
  report.bus = bus_report("vcan7", true, *bench.host);
  auto bus = nlohmann::json::parse(result_json(report))["bus"];
  EXPECT_EQ(bus["interface"], "vcan7");
  EXPECT_EQ(bus["pace"], "lock step");
  EXPECT_EQ(bus["end_state"], "active");
  EXPECT_TRUE(bus["cause"].is_null());
  EXPECT_TRUE(bus["log"].is_null());
  EXPECT_GT(bus["messages"]["ZoneCommand"]["sent"].get<long>(), 1000);
  EXPECT_GT(bus["messages"]["ZoneFeedback"]["received"].get<long>(), 1000);
  EXPECT_GT(bus["messages"]["ZoneFeedback"]["lost"].get<long>(), 20);
  EXPECT_GT(bus["load"].get<double>(), 0.0);
  EXPECT_EQ(bus["faults"], 0);
  EXPECT_GT(bus["max_feedback_age_s"].get<double>(), 0.005);
  long latencies = 0;
  for (const auto& count : bus["command_to_report_ms"]["counts"]) latencies += count.get<long>();
  EXPECT_GT(latencies, 10);
  EXPECT_EQ(bus["command_to_report_ms"]["counts"].size(),
            bus["command_to_report_ms"]["upper_edges"].size() + 1);
  EXPECT_THAT(summary_table(report), HasSubstr("vcan7"));

  bench.far.electronics().set_estop_chain(true);
  bench.wait(0.1);
  report.bus = bus_report("vcan7", true, *bench.host);
  bus = nlohmann::json::parse(result_json(report))["bus"];
  EXPECT_EQ(bus["end_state"], "e-stop");
  EXPECT_EQ(bus["cause"], can::describe(can::HostCause::kEStopOpen));
}

}  // namespace
}  // namespace wex::app
