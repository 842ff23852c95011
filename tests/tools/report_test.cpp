// result.json, the summary, CSV files and pictures made from a report.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "models/excavator/mjcf.hpp"
#include "tests/tools/program.hpp"
#include "tools/wex/motion_csv.hpp"
#include "tools/wex/overview_picture.hpp"
#include "tools/wex/run_report.hpp"
#include "tools/wex/timeline_picture.hpp"

namespace wex::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::stringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

class Report : public ::testing::Test {
 protected:
  Report() : machine_(*load_machine()), names_(*scalar_joint_names(machine_)) {
    report_.options.map = "hills.asc";
    report_.options.seed = 7;
    report_.task_map = {{1.0, 2.0, 0.5}, {4.0, 2.0, -0.5}};
    report_.plan = Plan{};
    report_.plan->nodes = nodes();
    report_.refined = RefinedTrajectory{};
    report_.refined->nodes = nodes();
    report_.refined->report.status = "solved";
    report_.refined->report.worst_residual = {{"side_slip_m_s", 1e-4}, {"bad", std::nan("")}};
    report_.stages["drive"] = {2.0, 3.0};
    DriveRecord drive;
    drive.goal_error_m = 0.05;
    drive.simulated_s = 10.0;
    drive.duration_s = 8.0;
    for (int k = 0; k < 101; ++k) {
      DriveSample s;
      s.t_s = 0.1 * k;
      s.base[kBaseX] = 1.0 + 0.03 * k;
      s.scalar_joints = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(names_.size()));
      s.contacts = {true, k < 50, true, true, false};
      s.wheel_m.fill(s.base.head<2>());
      s.scheduled_margin_m = s.loaded_margin_m = 1.0;
      drive.samples.push_back(s);
      drive.solves.push_back({s.t_s, s.t_s + 0.05, 1e-3 * (k + 20), 5, true, k != 30});
    }
    drive.extremes.side_slip_m.fill(0.02);
    drive.extremes.travel_m.fill(4.0);
    drive.extremes.min_loaded_margin_m = -std::numeric_limits<double>::infinity();
    report_.drive = drive;
  }

  /// 1 m along x in 1.02 s, rolled by 0.1 rad.
  std::vector<WholeBodyNode> nodes() const {
    WholeBodyNode a, b;
    a.q = Eigen::VectorXd::Zero(machine_.num_coordinates());
    a.q[kBaseRoll] = 0.1;
    b = a;
    b.t_s = 1.02;
    b.q[kBaseX] = 1.0;
    b.q[*machine_.coordinate("BOOM")] = 0.3;
    return {a, b};
  }

  MachineModel machine_;
  std::vector<std::string> names_;
  RunReport report_;
};

TEST_F(Report, ResultJsonSaysWhatHappened) {
  const auto json = nlohmann::json::parse(result_json(report_));
  EXPECT_EQ(json["schema"], "wex-result-1");
  EXPECT_EQ(json["command"], "run");
  EXPECT_EQ(json["success"], true);
  EXPECT_EQ(json["exit_code"], 0);
  EXPECT_EQ(json["reason"], "goal reached");
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["map"], "hills.asc");
  EXPECT_EQ(json["solve_delay_ms"], "measured");
  EXPECT_EQ(json["iterations"], nullptr);
  EXPECT_EQ(json["goal"], nlohmann::json({4.0, 2.0, -0.5}));
  EXPECT_DOUBLE_EQ(json["goal_error_m"], 0.05);
  EXPECT_DOUBLE_EQ(json["stages"]["drive"]["cpu_s"], 2.0);
  EXPECT_DOUBLE_EQ(json["drive"]["real_time_factor"], 5.0);
  EXPECT_DOUBLE_EQ(json["drive"]["side_slip_ratio"], 0.005);
  EXPECT_EQ(json["mpc"]["misses"], 20);  // 101 to 120 ms
  EXPECT_EQ(json["mpc"]["unusable"], 1);
  EXPECT_NEAR(json["mpc"]["solve_time_ms"]["p50"], 70.0, 1e-9);
  EXPECT_NEAR(json["mpc"]["solve_time_ms"]["max"], 120.0, 1e-9);
}

TEST_F(Report, WhatCannotBeMeasuredIsNull) {
  const auto json = nlohmann::json::parse(result_json(report_));
  EXPECT_TRUE(json["drive"]["min_loaded_stability_margin_m"].is_null());
  EXPECT_TRUE(json["refinement"]["worst_residual"]["bad"].is_null());
}

TEST_F(Report, FailureHasItsReasonAndExitCode) {
  report_.failure = Error{ErrorCode::kStoppedSafely, "stopped safely: no \"grip\""};
  const auto json = nlohmann::json::parse(result_json(report_));
  EXPECT_EQ(json["success"], false);
  EXPECT_EQ(json["exit_code"], 5);
  EXPECT_EQ(json["reason"], "stopped safely: no \"grip\"");
  EXPECT_THAT(summary_table(report_), HasSubstr("FAILED: stopped safely"));
}

TEST_F(Report, EveryFieldIsInTheReadme) {
  const std::string readme = test::read_file(WEX_README);
  const auto json = nlohmann::json::parse(result_json(report_));
  const auto documented = [&](const std::string& key) {
    return readme.find(key) != std::string::npos;
  };
  for (const auto& [key, value] : json.items()) {
    EXPECT_TRUE(documented(key)) << key;
    if (!value.is_object() || key == "stages") continue;
    for (const auto& [inner, ignored] : value.items()) EXPECT_TRUE(documented(inner)) << inner;
  }
}

TEST_F(Report, StepsAreCounted) {
  std::vector<WholeBodyNode>& nodes = report_.plan->nodes;
  nodes.push_back(nodes.back());
  nodes[1].contacts = {false, true, true, true, true};
  nodes[2].t_s = 2.0;
  const auto json = nlohmann::json::parse(result_json(report_));
  EXPECT_EQ(json["plan"]["wheel_lifts"]["LF"], 1);
  EXPECT_EQ(json["plan"]["wheel_lifts"]["RH"], 0);
  EXPECT_EQ(json["plan"]["bucket_supports"], 1);
  EXPECT_THAT(summary_table(report_), HasSubstr("1 wheels lifted, bucket down 1 times"));
}

TEST_F(Report, ASearchWithoutAPlanIsCountedInTheMapFrame) {
  report_.plan.reset();
  report_.map_origin_m = {100.0, 200.0};
  report_.search.emplace();
  report_.search->count_pose();
  report_.search->count(Rejection::kBelly);
  report_.search->add({{1.0, 2.0, 0.5}, "wheel LF would stand too close to an edge", true});
  const auto json = nlohmann::json::parse(result_json(report_))["search"];
  EXPECT_EQ(json["poses"], 1);
  EXPECT_EQ(json["rejected_poses"][describe(Rejection::kBelly)], 1);
  EXPECT_EQ(json["failed_paths"], 1);
  ASSERT_EQ(json["failed_places"].size(), 1u);
  EXPECT_EQ(json["failed_places"][0]["where"], nlohmann::json({101.0, 202.0, 0.5}));
  EXPECT_EQ(json["failed_places"][0]["last_reason"], "wheel LF would stand too close to an edge");
}

TEST_F(Report, PlannedCsvHasTheColumnsTheRateAndBothEnds) {
  const auto lines = split(planned_motion_csv(machine_, names_, nodes(), {100.0, 200.0}), '\n');
  const auto columns = split(lines[0], ',');
  ASSERT_EQ(columns.size(), 8 + names_.size() + 5);
  EXPECT_THAT(
      std::vector<std::string>(columns.begin(), columns.begin() + 8),
      ElementsAre("t", "base_x", "base_y", "base_z", "base_qw", "base_qx", "base_qy", "base_qz"));
  EXPECT_EQ(std::vector<std::string>(columns.begin() + 8, columns.end() - 5), names_);
  EXPECT_THAT(std::vector<std::string>(columns.end() - 5, columns.end()),
              ElementsAre("contact_LF", "contact_RF", "contact_LH", "contact_RH", "contact_ARM"));
  ASSERT_EQ(lines.size(), 1u + 22u);  // 0, 0.05 ... 1.00 and 1.02
  const auto first = split(lines[1], ','), last = split(lines.back(), ',');
  EXPECT_EQ(first.size(), columns.size());
  EXPECT_EQ(first[1], "100.000000");
  EXPECT_EQ(first[2], "200.000000");
  EXPECT_NEAR(std::stod(first[4]), std::cos(0.05), 1e-8);
  EXPECT_NEAR(std::stod(first[5]), std::sin(0.05), 1e-8);
  EXPECT_EQ(last[0], "1.0200");
  EXPECT_EQ(last[1], "101.000000");
  const auto boom = std::find(columns.begin(), columns.end(), "BOOM") - columns.begin();
  EXPECT_NEAR(std::stod(last[static_cast<std::size_t>(boom)]), 0.3, 1e-7);
  EXPECT_THAT(std::vector<std::string>(last.end() - 5, last.end()),
              ElementsAre("1", "1", "1", "1", "0"));
}

TEST_F(Report, ExecutedContactsAreTheMeasuredLoads) {
  const auto lines = split(executed_motion_csv(names_, report_.drive->samples, {0.0, 0.0}), '\n');
  ASSERT_EQ(lines.size(), 102u);
  EXPECT_THAT(lines[1], ::testing::EndsWith(",1,1,1,1,0"));
  EXPECT_THAT(lines[101], ::testing::EndsWith(",1,0,1,1,0"));
}

TEST_F(Report, PicturesAreDrawn) {
  Grid grid;
  grid.size_x = grid.size_y = 100;
  for (int k = 0; k < 10000; ++k)
    grid.values.push_back(k % 97 == 0 ? NAN : 0.001f * static_cast<float>(k % 100));
  const TerrainMap terrain = *TerrainMap::build(std::move(grid));
  const auto file =
      std::filesystem::temp_directory_path() / ("wex_picture_" + std::to_string(getpid()) + ".png");
  ASSERT_TRUE(draw_overview(report_, terrain, machine_, file).has_value());
  EXPECT_THAT(test::read_file(file), ::testing::StartsWith("\x89PNG"));
  ASSERT_TRUE(draw_timeline(report_, file).has_value());
  EXPECT_THAT(test::read_file(file), ::testing::StartsWith("\x89PNG"));
  std::filesystem::remove(file);
  report_.drive.reset();
  report_.plan->nodes.back().contacts = {false, true, true, true, true};
  report_.search.emplace();
  report_.search->add({{1.0, 2.0, 0.5}, "wheel LF would stand too close to an edge", true});
  ASSERT_TRUE(draw_overview(report_, terrain, machine_, file).has_value());
  EXPECT_THAT(test::read_file(file), ::testing::StartsWith("\x89PNG"));
  ASSERT_TRUE(draw_plan_timeline(*report_.plan, machine_, "steps", file).has_value());
  EXPECT_THAT(test::read_file(file), ::testing::StartsWith("\x89PNG"));
  std::filesystem::remove(file);
}

TEST_F(Report, APictureThatCannotBeWrittenNamesItsFile) {
  const auto refused = draw_timeline(report_, "/proc/wex/timeline.png");
  ASSERT_FALSE(refused.has_value());
  EXPECT_THAT(refused.error().message, HasSubstr("/proc/wex/timeline.png"));
}

TEST(Percentile, InterpolatesBetweenOrderStatistics) {
  EXPECT_DOUBLE_EQ(percentile({3.0, 1.0, 2.0}, 50), 2.0);
  EXPECT_DOUBLE_EQ(percentile({0.0, 10.0}, 99), 9.9);
  EXPECT_DOUBLE_EQ(percentile({5.0}, 99), 5.0);
  EXPECT_DOUBLE_EQ(percentile({}, 50), 0.0);
}

}  // namespace
}  // namespace wex::app
