#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <numbers>
#include <sstream>

#include "tools/bench/drive_bench_bus.hpp"
#include "tools/bench/drive_bench_truth.hpp"

namespace wex {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(WilsonInterval, MatchesPublishedValues) {
  // Brown, Cai and DasGupta (2001) define it; values by hand from the formula.
  const auto [lo, hi] = wilson_interval(30, 30);
  EXPECT_NEAR(lo, 0.8865, 5e-4);
  EXPECT_DOUBLE_EQ(hi, 1.0);
  const auto [half_lo, half_hi] = wilson_interval(5, 10);
  EXPECT_NEAR(half_lo, 0.2366, 5e-4);
  EXPECT_NEAR(half_hi, 0.7634, 5e-4);
}

class DriveBench : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("wex_bench_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  DriveBenchResult result_of(const std::string& json, int exit_code) const {
    std::ofstream(folder_ / "result.json") << json;
    return read_drive_bench_result(folder_, exit_code);
  }
  std::filesystem::path folder_;
};

TEST_F(DriveBench, ReadsTheFiguresOfARun) {
  const DriveBenchResult r = result_of(
      R"({"success": true, "exit_code": 0, "reason": "goal reached", "goal_error_m": 0.05,
          "plan": {"path_length_m": 15.2}, "mpc": {"solves": 100, "misses": 2,
          "solve_time_ms": {"p50": 12.5, "p99": 30, "max": 110}},
          "drive": {"side_slip_ratio": 0.004, "min_stability_margin_m": 1.1, "max_roll_rad": null,
          "wheel_lift_off_s": {"LF": 0.1, "RF": 0.2, "LH": 0, "RH": 0}}})",
      0);
  EXPECT_TRUE(r.success);
  EXPECT_TRUE(r.driven);
  EXPECT_DOUBLE_EQ(r.goal_error_m, 0.05);
  EXPECT_DOUBLE_EQ(r.path_m, 15.2);
  EXPECT_DOUBLE_EQ(r.solve_p50_ms, 12.5);
  EXPECT_EQ(r.misses, 2);
  EXPECT_NEAR(r.lift_off_s, 0.3, 1e-12);
  EXPECT_DOUBLE_EQ(r.roll_rad, 0.0);
}

TEST_F(DriveBench, ARunWithoutAReadableResultIsAFailure) {
  EXPECT_FALSE(result_of("{ half", 1).success);
  EXPECT_FALSE(result_of(R"({"success": "yes"})", 0).success);
  std::filesystem::remove(folder_ / "result.json");
  const DriveBenchResult missing = read_drive_bench_result(folder_, 3);
  EXPECT_FALSE(missing.success);
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_THAT(missing.reason, HasSubstr("log.txt"));
}

TEST_F(DriveBench, TheTableCountsPerCaseAndPooledAndNamesFailures) {
  std::vector<DriveBenchRun> runs;
  std::vector<DriveBenchResult> results;
  for (const char* name : {"flat", "flat", "rough"}) {
    DriveBenchRun run;
    run.name = name;
    run.seed = static_cast<int>(runs.size()) + 1;
    runs.push_back(run);
    DriveBenchResult result;
    result.success = result.driven = true;
    result.goal_error_m = 0.1 * run.seed;
    results.push_back(result);
  }
  results[1].success = false;
  results[1].exit_code = 5;
  results[1].reason = "stopped \"safely\"";
  runs[2].rejected_draws = 4;
  const std::string table = drive_bench_table(runs, results);
  EXPECT_THAT(table, HasSubstr("flat             1/2"));
  EXPECT_THAT(table, HasSubstr("0.200"));
  EXPECT_THAT(table, HasSubstr("rough            1/1"));
  EXPECT_THAT(table, HasSubstr("pooled: 2 of 3 = 66.7 %"));
  EXPECT_THAT(table, HasSubstr("failed: flat seed 2, exit code 5: stopped"));
  EXPECT_THAT(table, Not(HasSubstr("failed: rough")));
  EXPECT_THAT(table, HasSubstr("drawn again: rough seed 3, 4 pairs"));

  const std::string csv = drive_bench_csv(runs, results);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 4);
  EXPECT_THAT(csv, HasSubstr("flat,2,"));
  EXPECT_THAT(csv, HasSubstr("\"stopped 'safely'\""));
}

/// Object "bus" of a result file; `extra` replaces values.
std::string bus_text(const std::string& extra) {
  return R"("bus": {"frames_sent": 100, "frames_received": 300, "frames_lost": 2, "repeated": 1,
      "wrong_sequence": 2, "crc_errors": 3, "malformed": 4, "unknown_ids": 5, "own_ids": 6,
      "receive_overflows": 7, "stalls": 8, "false_holds": 1, "faults": 0, "load": 0.9,
      "load_machine_time": 0.36, "max_feedback_age_s": 0.011,
      "command_to_report_ms": {"max": 7.5, "upper_edges": [1, 5], "counts": [90, 9, 1]})" +
         extra + "}";
}

TEST_F(DriveBench, FiguresOfTheBusArePooledPerCase) {
  const std::string text = R"({"success": true, "drive": {}, )" + bus_text("") + "}";
  DriveBenchResult result = result_of(text, 0);
  ASSERT_TRUE(result.bus.has_value()) << result.reason;
  EXPECT_EQ(result.bus->not_used, 21);
  EXPECT_DOUBLE_EQ(result.bus->load, 0.36);
  result.bus->machine_holds = 1;
  DriveBenchRun run;
  run.name = "ramp";
  DriveBenchResult other = result;
  other.bus->latency_counts = {10, 90, 0};
  other.bus->load = 0.2;
  const std::string table = drive_bench_table({run, run}, {result, other});
  const std::size_t header = table.find("the bus, as the host saw it");
  ASSERT_NE(header, std::string::npos);
  std::istringstream lines(table.substr(header));
  std::string line, name;
  while (std::getline(lines, line) && !line.starts_with("ramp")) {
  }
  std::istringstream values(line);
  std::vector<double> numbers;
  values >> name;
  for (double value = 0.0; values >> value;) numbers.push_back(value);
  // runs, sent, received, lost, unused, overflows, stalls, holds, faults, machine's holds, refused,
  // load, age; 100 of 200 commands are reported within 1 ms, 199 within 5 ms
  EXPECT_THAT(numbers,
              ::testing::ElementsAre(2, 200, 600, 4, 42, 14, 16, 2, 0, 2, 0, 36, 11, 1, 5, 7.5));
  EXPECT_THAT(drive_bench_table({run}, {DriveBenchResult{}}), Not(HasSubstr("the bus")));
}

TEST_F(DriveBench, AResultWithHalfABusIsAFailure) {
  EXPECT_FALSE(result_of(R"({"success": true, "bus": {"frames_sent": 1}})", 0).success);
}

/// A machine's log of a drive from x = 0 to `end_x`; `edit` changes its rows.
class DriveTruthTest : public DriveBench {
 protected:
  static constexpr const char* kHeader =
      "t,mode,session,base_x,base_y,base_z,base_yaw,base_pitch,base_roll,accepted,rejected,brakes,"
      "base_dz,sink,side_slip,travel,lift_off,margin,body_contact";
  struct LogRow {
    double t = 0.0, x = 0.0, yaw = 0.1, pitch = 0.0, roll = -0.1, rate = 0.0;
    std::string mode = "enabled";
    int brakes = 0, body = 0;
  };
  static std::vector<LogRow> drive(double end_x) {
    std::vector<LogRow> rows;
    const auto add = [&](double until, const char* mode, double speed, int brakes) {
      for (double t = rows.empty() ? 0.0 : rows.back().t + 0.01; t < until; t += 0.01) {
        LogRow row;
        row.t = t;
        row.x = std::min(end_x, (rows.empty() ? 0.0 : rows.back().x) + speed * 0.01);
        row.mode = mode;
        row.brakes = brakes;
        rows.push_back(row);
      }
    };
    add(1.0, "ready", 0.0, 1);
    add(6.0, "enabled", 0.5, 0);
    add(9.0, "hold", 0.0, 1);
    add(10.0, "ready", 0.0, 1);
    return rows;
  }
  std::filesystem::path write(const std::vector<LogRow>& rows) const {
    std::ofstream stream(folder_ / "machine.csv");
    stream << kHeader << "\n";
    for (const LogRow& r : rows) {
      stream << r.t << ',' << r.mode << ",0000abcd," << r.x << ",2,0.9," << r.yaw << ',' << r.pitch
             << ',' << r.roll << ",600,3," << r.brakes << ',' << r.rate << ",0.002,0.05,10,0.5,1.1,"
             << r.body << "\n";
    }
    return folder_ / "machine.csv";
  }
  DriveTruth truth(const std::vector<LogRow>& rows) const {
    return read_drive_truth(write(rows)).value();
  }
  const Pose2 goal_{2.4, 2.1, 0.1};
};

TEST_F(DriveTruthTest, ReadsWhereTheMachineCameToAndHow) {
  std::vector<LogRow> rows = drive(2.5);
  rows[300].pitch = 0.2;
  rows[650].rate = 0.5;    // in the first second of the hold
  rows[800].rate = -0.03;  // later in it
  const DriveTruth read = truth(rows);
  EXPECT_NEAR(goal_error_m(read, goal_), std::hypot(0.1, 0.1), 1e-6);
  EXPECT_NEAR(goal_error_rad(read, {0.0, 0.0, 2.0 * std::numbers::pi}), 0.1, 1e-6);
  EXPECT_DOUBLE_EQ(read.max_pitch_rad, 0.2);
  EXPECT_DOUBLE_EQ(read.max_roll_rad, 0.1);
  EXPECT_DOUBLE_EQ(read.hold_rate_m_s, 0.03);
  EXPECT_DOUBLE_EQ(read.side_slip_ratio, 0.005);
  EXPECT_EQ(read.holds, 1);
  EXPECT_EQ(read.commands_rejected, 3);
  EXPECT_EQ(objection(read, goal_), "");
}

TEST_F(DriveTruthTest, ObjectsWithTheReasonToEveryDriveThatIsNone) {
  const auto objection_after = [&](const std::function<void(std::vector<LogRow>&)>& edit) {
    std::vector<LogRow> rows = drive(2.5);
    edit(rows);
    return objection(truth(rows), goal_);
  };
  EXPECT_THAT(objection_after([](auto& rows) { rows[300].mode = "fault"; }), HasSubstr("fault"));
  EXPECT_THAT(objection_after([](auto& rows) { rows[300].mode = "estop"; }), HasSubstr("stop"));
  EXPECT_THAT(objection_after([](auto& rows) { rows[300].roll = -0.53; }), HasSubstr("tipped"));
  EXPECT_THAT(objection_after([](auto& rows) { rows.back().body = 1; }), HasSubstr("body"));
  EXPECT_THAT(objection_after([](auto& rows) { rows.back().brakes = 0; }), HasSubstr("brakes"));
  EXPECT_THAT(objection_after([](auto& rows) { rows.resize(500); }), HasSubstr("disabled"));
  EXPECT_THAT(objection_after([](auto& rows) { rows.back().x = 2.8; }), HasSubstr("0.41 m"));
  EXPECT_THAT(objection_after([](auto& rows) { rows.back().yaw = 0.2; }), HasSubstr("degrees"));
  EXPECT_THAT(objection_after([](auto& rows) { rows.resize(90); }), HasSubstr("never enabled"));
}

TEST_F(DriveTruthTest, TheHostsSuccessIsNotEnough) {
  DriveBenchRun run;
  run.folder = folder_;
  run.task_map.goal = goal_;
  std::ofstream(folder_ / "result.json")
      << R"({"success": true, "reason": "goal reached", "goal_error_m": 0.01, "drive": {}, )"
      << bus_text("") << "}";
  EXPECT_THAT(read_bus_result(run, 0).reason, HasSubstr("machine.csv"));
  EXPECT_FALSE(read_bus_result(run, 0).success) << "without the machine's log";

  write(drive(2.5));
  const DriveBenchResult good = read_bus_result(run, 0);
  EXPECT_TRUE(good.success) << good.reason;
  EXPECT_NEAR(good.goal_error_m, std::hypot(0.1, 0.1), 1e-6);
  EXPECT_EQ(good.bus->machine_holds, 1);
  EXPECT_EQ(good.bus->commands_rejected, 3);

  write(drive(1.0));
  const DriveBenchResult bad = read_bus_result(run, 0);
  EXPECT_FALSE(bad.success);
  EXPECT_THAT(bad.reason, HasSubstr("from the goal"));
}

TEST_F(DriveTruthTest, ALogThatIsNoneIsRefused) {
  EXPECT_FALSE(read_drive_truth(folder_ / "none.csv"));
  EXPECT_FALSE(read_drive_truth(write({})));
  std::ofstream(folder_ / "machine.csv") << "t,mode\n1,hold\n";
  EXPECT_FALSE(read_drive_truth(folder_ / "machine.csv"));
}

}  // namespace
}  // namespace wex
