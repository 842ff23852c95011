#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "tools/bench/drive_bench_table.hpp"

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

}  // namespace
}  // namespace wex
