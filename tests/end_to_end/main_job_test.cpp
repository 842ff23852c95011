// The main job through the application library: a short drive over a bundled kind of ground.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "models/terrain/raster_io.hpp"
#include "models/terrain/synthetic.hpp"
#include "tools/wex/pipeline.hpp"

namespace wex::app {
namespace {

namespace fs = std::filesystem;

std::string read_file(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// Columns of a CSV file by name.
std::map<std::string, std::vector<double>> read_csv(const fs::path& file) {
  std::ifstream stream(file);
  std::string line, cell;
  std::getline(stream, line);
  std::vector<std::string> names;
  for (std::stringstream cells(line); std::getline(cells, cell, ',');) names.push_back(cell);
  std::map<std::string, std::vector<double>> columns;
  while (std::getline(stream, line)) {
    std::stringstream cells(line);
    for (const std::string& name : names) {
      std::getline(cells, cell, ',');
      columns[name].push_back(std::stod(cell));
    }
  }
  return columns;
}

class MainJob : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("wex_main_job_" + std::to_string(getpid()));
    fs::create_directories(folder_);
    const auto terrain = make_synthetic_terrain("rough", 0.0, 3);
    ASSERT_TRUE(write_esri_ascii(terrain->raster, folder_ / "map.asc").has_value());
  }
  void TearDown() override { fs::remove_all(folder_); }

  RunOptions options(const std::string& out) const {
    RunOptions options;
    options.map = folder_ / "map.asc";
    options.start = Pose2{8.0, 8.0, 0.0};
    options.goal = Pose2{12.0, 8.3, 0.1};
    options.seed = 5;
    options.iterations = 200;
    options.solve_delay_s = 0.05;
    options.frames = 2;
    options.out = folder_ / out;
    return options;
  }

  fs::path folder_;
};

TEST_F(MainJob, DrivesToTheGoalAndLeavesEveryFile) {
  std::ostringstream err;
  Progress progress(err, true);
  const auto report = run_pipeline(options("out"), progress);
  ASSERT_TRUE(report.has_value()) << report.error().message;
  EXPECT_FALSE(report->failure) << report->failure->message;
  EXPECT_EQ(err.str(), "");
  for (const char* name : {"result.json", "plan.csv", "refined.csv", "executed.csv", "model.xml",
                           "overview.png", "timeline.png"}) {
    EXPECT_GT(read_file(folder_ / "out" / name).size(), 500u) << name;
  }
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "out")) {
    EXPECT_NE(entry.path().filename().string().front(), '.') << entry.path();
  }
  const auto json = nlohmann::json::parse(read_file(folder_ / "out" / "result.json"));
  EXPECT_EQ(json["success"], true);
  EXPECT_LE(json["goal_error_m"].get<double>(), 0.3);
  EXPECT_LE(json["goal_error_rad"].get<double>(), 0.0873);
  EXPECT_GE(json["drive"]["min_stability_margin_m"].get<double>(), 0.3);
  EXPECT_LT(json["drive"]["side_slip_ratio"].get<double>(), 0.02);
  EXPECT_LT(json["drive"]["hold_vertical_rate_m_s"].get<double>(), 0.02);
  if (report->warnings.empty()) {
    EXPECT_TRUE(fs::exists(folder_ / "out" / "frames" / "frame_02.png"));
  }

  // The files agree with each other: same columns, map frame, executed path ends at the goal.
  const auto plan = read_csv(folder_ / "out" / "plan.csv");
  const auto executed = read_csv(folder_ / "out" / "executed.csv");
  ASSERT_EQ(plan.size(), executed.size());
  EXPECT_NEAR(plan.at("base_x").front(), 8.0, 1e-6);
  EXPECT_NEAR(plan.at("base_x").back(), 12.0, 0.05);
  EXPECT_NEAR(executed.at("base_x").front(), 8.0, 0.05);
  EXPECT_NEAR(executed.at("base_x").back(), 12.0, 0.3);
  EXPECT_NEAR(executed.at("base_y").back(), 8.3, 0.3);
  const std::vector<double>& t = executed.at("t");
  for (std::size_t k = 1; k < t.size(); ++k) {
    EXPECT_GT(t[k], t[k - 1]);
    EXPECT_LE(t[k] - t[k - 1], 0.05 + 1e-9);
  }
  const std::string model = read_file(folder_ / "out" / "model.xml");
  for (const auto& [name, ignored] : executed) {
    const bool joint = name != "t" && name.rfind("base_", 0) != 0 && name.rfind("contact_", 0) != 0;
    if (!joint) continue;
    const std::string quoted = '"' + name + '"';
    EXPECT_THAT(model, ::testing::HasSubstr(quoted));
  }
}

TEST_F(MainJob, IsTheSameBitForBitWithFixedIterationsAndDelay) {
  std::ostringstream err;
  Progress progress(err, true);
  RunOptions first = options("first"), second = options("second");
  first.frames = second.frames = 0;
  ASSERT_TRUE(run_pipeline(first, progress).has_value());
  ASSERT_TRUE(run_pipeline(second, progress).has_value());
  for (const char* name : {"plan.csv", "refined.csv", "executed.csv"}) {
    const std::string once = read_file(folder_ / "first" / name);
    EXPECT_FALSE(once.empty());
    EXPECT_TRUE(once == read_file(folder_ / "second" / name)) << name;
  }
}

TEST_F(MainJob, ReplacesAnEarlierRunInTheSameFolder) {
  std::ostringstream err;
  Progress progress(err, true);
  fs::create_directories(folder_ / "out");
  for (const char* name :
       {"plan.csv", "refined.csv", "executed.csv", "bus.log", "timeline.png", "mine.txt"}) {
    std::ofstream(folder_ / "out" / name) << "old";
  }
  RunOptions plan_only = options("out");
  plan_only.depth = Depth::kPlanOnly;
  const auto report = run_pipeline(plan_only, progress);
  ASSERT_TRUE(report.has_value()) << report.error().message;
  // What a plan alone does not write is gone; what it does write, its timeline included, is its
  // own.
  for (const char* name : {"refined.csv", "executed.csv", "bus.log"}) {
    EXPECT_FALSE(fs::exists(folder_ / "out" / name)) << name;
  }
  const auto beginning_of = [&](const char* name) {
    std::ifstream file(folder_ / "out" / name, std::ios::binary);
    std::string text(4, ' ');
    file.read(text.data(), 4);
    return text;
  };
  EXPECT_EQ(beginning_of("timeline.png"), "\x89PNG");
  EXPECT_NE(beginning_of("plan.csv"), "old ");
  EXPECT_EQ(beginning_of("mine.txt"), "old ");
}

}  // namespace
}  // namespace wex::app
