// What a user can get wrong, through the built program: exit code 2, one sentence on stderr that
// names the culprit, nothing left behind.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "models/terrain/raster_io.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/tools/program.hpp"

namespace wex::test {
namespace {

using ::testing::HasSubstr;

class BadInput : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("wex_bad_input_" + std::to_string(getpid()) + "_" +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
    write_ground("ground.asc", [](double, double) { return 0.0; });
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// 30 x 16 m of 0.1 m cells, the task of the JSON beside it in the middle.
  template <typename Height>
  void write_ground(const std::string& name, const Height& height) {
    Raster raster;
    raster.elevation.size_x = 301;
    raster.elevation.size_y = 161;
    for (int j = 0; j < 161; ++j) {
      for (int i = 0; i < 301; ++i) {
        raster.elevation.values.push_back(static_cast<float>(height(0.1 * i, 0.1 * j)));
      }
    }
    ASSERT_TRUE(write_esri_ascii(raster, folder_ / name).has_value());
    write((folder_ / name).replace_extension("json").filename(),
          R"({"start": [7.5, 8, 0], "goal": [20, 8, 0]})");
  }
  void write(const std::filesystem::path& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
  }

  /// A grid with this header over four rows of four heights.
  void write_grid(const std::string& name, const std::string& header, const std::string& rows) {
    write(name, header + rows);
    write(std::filesystem::path(name).replace_extension("json"),
          R"({"start": [1, 1, 0], "goal": [2, 1, 0]})");
  }
  static std::string header(const std::string& cell_size = "1", const std::string& columns = "4") {
    return "ncols " + columns + "\nnrows 4\nxllcenter 0\nyllcenter 0\ncellsize " + cell_size + "\n";
  }
  static std::string rows() { return "0 0 0 0\n0 0 0 0\n0 0 0 0\n0 0 0 0\n"; }

  void expect_refused(const std::vector<std::string>& arguments,
                      const std::vector<std::string>& words) {
    const std::vector<std::string> before = listing(folder_);
    const ProgramOutcome outcome = run_program(folder_, arguments);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_THAT(outcome.err, ::testing::StartsWith("wex: "));
    for (const std::string& word : words) EXPECT_THAT(outcome.err, HasSubstr(word));
    EXPECT_EQ(listing(folder_), before);
  }
  void expect_map_refused(const std::string& map, const std::vector<std::string>& words) {
    expect_refused({"run", map, "--out", "results"}, words);
  }
  /// A run over ground.asc with one more option.
  void expect_option_refused(const std::string& option, const std::vector<std::string>& words) {
    expect_refused({"run", "ground.asc", "--out", "results", option}, words);
  }

  std::filesystem::path folder_;
};

TEST_F(BadInput, MissingFile) { expect_map_refused("nowhere.asc", {"nowhere.asc"}); }

TEST_F(BadInput, TruncatedGrid) {
  write_grid("short.asc", header(), "0 0 0 0\n0 0 0 0\n0 0\n");
  expect_map_refused("short.asc", {"short.asc", "16"});
}

TEST_F(BadInput, LettersInAGrid) {
  write_grid("letters.asc", header(), "0 0 0 0\n0 0 stone 0\n0 0 0 0\n0 0 0 0\n");
  expect_map_refused("letters.asc", {"letters.asc", "line 7", "stone"});
}

TEST_F(BadInput, DegreesAsCoordinateSystem) {
  write_grid("degrees.asc", header("0.00001"), rows());
  write("degrees.prj",
        R"(GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137,298.257223563]],)"
        R"(PRIMEM["Greenwich",0],UNIT["Degree",0.017453292519943295]])");
  expect_map_refused("degrees.asc", {"degrees", "gdalwarp"});
}

TEST_F(BadInput, NegativeCellSize) {
  write_grid("negative.asc", header("-1"), rows());
  expect_map_refused("negative.asc", {"negative.asc", "cellsize", "positive"});
}

TEST_F(BadInput, CellSizeThatIsNotANumber) {
  write_grid("nan.asc", header("nan"), rows());
  expect_map_refused("nan.asc", {"nan.asc", "cellsize"});
}

TEST_F(BadInput, HeaderThatLiesAboutAGigabyte) {
  write_grid("huge.asc", "ncols 20000\nnrows 20000\nxllcenter 0\nyllcenter 0\ncellsize 0.1\n",
             rows());
  expect_map_refused("huge.asc", {"huge.asc", "20000"});
}

TEST_F(BadInput, GridOfNothingButNan) {
  write_grid("unknown.asc", header(),
             "nan nan nan nan\nnan nan nan nan\nnan nan nan nan\nnan nan nan nan\n");
  expect_map_refused("unknown.asc", {"unknown.asc"});
}

TEST_F(BadInput, StartOffTheMap) {
  expect_option_refused("--start=-3,8,0", {"start", "off the map", "-3.00"});
}

TEST_F(BadInput, GoalOffTheMap) {
  expect_option_refused("--goal=20,99,0", {"goal", "off the map", "99.00"});
}

TEST_F(BadInput, StartThatIsNotANumber) {
  expect_option_refused("--start=nan,8,0", {"--start", "nan,8,0", "three finite numbers"});
}

TEST_F(BadInput, GoalOfTwoNumbers) { expect_option_refused("--goal=20,8", {"--goal", "X,Y,YAW"}); }

TEST_F(BadInput, StartOnUnknownGround) {
  write_ground("hole.asc", [](double x, double y) {
    return std::hypot(x - 7.5, y - 8.0) < 4.0 ? std::nan("") : 0.0;
  });
  expect_map_refused("hole.asc", {"start", "unknown"});
}

TEST_F(BadInput, GoalOnUnknownGround) {
  write_ground("hole.asc", [](double x, double y) {
    return std::hypot(x - 20.0, y - 8.0) < 4.0 ? std::nan("") : 0.0;
  });
  expect_map_refused("hole.asc", {"goal", "unknown"});
}

TEST_F(BadInput, StartInAnUntraversableSpot) {
  write_ground("slope.asc", [](double x, double) { return std::max(0.0, 10.0 - x); });
  expect_map_refused("slope.asc", {"start", "traversable"});
}

TEST_F(BadInput, GoalInAnUntraversableSpot) {
  write_ground("slope.asc", [](double x, double) { return std::max(0.0, x - 17.0); });
  expect_map_refused("slope.asc", {"goal", "traversable"});
}

TEST_F(BadInput, OutputFolderThatCannotBeWritten) {
  write("file", "in the way");
  expect_refused({"run", "ground.asc", "--out", "file/results"}, {"file", "cannot be written"});
  expect_refused({"run", "ground.asc", "--out", "/proc/wex"}, {"/proc/wex", "cannot be written"});
  expect_refused({"plan", "ground.asc", "--out", ""}, {"cannot be written"});
}

TEST_F(BadInput, TerrainAndModelFilesThatCannotBeWritten) {
  expect_refused({"terrain", "flat", "--out", "no/folder/map.asc"}, {"no/folder"});
  expect_refused({"model", "--mjcf", "no/folder/model.xml"}, {"no/folder"});
}

TEST_F(BadInput, UnknownOption) {
  expect_refused({"run", "ground.asc", "--gaol", "1,1,0"}, {"--gaol", "wex run --help"});
}

TEST_F(BadInput, UnknownCommand) {
  expect_refused({"fly"}, {"'fly'", "run, plan", "wex --help"});
  expect_refused({"bench", "sleep"}, {"'sleep'", "kinematics"});
}

TEST_F(BadInput, NoCommandAndNoMap) {
  expect_refused({}, {"--help"});
  expect_refused({"run"}, {"map", "wex run --help"});
}

TEST_F(BadInput, NoStartAndGoal) {
  std::filesystem::remove(folder_ / "ground.json");
  expect_map_refused("ground.asc", {"--start X,Y,YAW", "--goal X,Y,YAW", "ground.json"});
  expect_option_refused("--start=7.5,8,0", {"no goal", "--goal X,Y,YAW"});
}

TEST_F(BadInput, GoalThatIsTheStart) {
  expect_option_refused("--goal=7.5,8,6.2832", {"start and goal are the same"});
}

TEST_F(BadInput, MapWithoutACell) {
  write("empty.asc", "");
  expect_refused({"plan", "empty.asc", "--out", "results"}, {"empty.asc"});
  write_grid("none.asc", "ncols 0\nnrows 0\nxllcenter 0\nyllcenter 0\ncellsize 0.1\n", "");
  expect_refused({"plan", "none.asc", "--out", "results"}, {"none.asc", "ncols"});
}

TEST_F(BadInput, MapSmallerThanTheMachine) {
  write_grid("small.asc", header(), rows());
  expect_refused({"plan", "small.asc", "--out", "results"},
                 {"the start (x 1.00, y 1.00", "wheel LF would be off the map"});
}

TEST_F(BadInput, PlanFromAPlaceToItself) {
  expect_refused({"plan", "ground.asc", "--out", "results", "--goal=7.5,8,0"},
                 {"start and goal are the same"});
}

TEST_F(BadInput, GoalSurroundedByUnknownGround) {
  // Good ground of 4 m around the goal, then nothing known.
  write_ground("island.asc", [](double x, double y) {
    const double r = std::hypot(x - 20.0, y - 8.0);
    return r > 4.5 && r < 6.0 ? std::nan("") : 0.0;
  });
  const ProgramOutcome outcome =
      run_program(folder_, {"plan", "island.asc", "--out", "results", "--iterations", "80"});
  EXPECT_EQ(outcome.exit_code, 3);
  for (const char* words : {"wex: no plan from start to goal", "80 iterations", "unknown ground"}) {
    EXPECT_THAT(outcome.err, HasSubstr(words));
  }
  EXPECT_EQ(outcome.err.back(), '\n');
}

TEST_F(BadInput, TaskFileThatIsNoTask) {
  write("ground.json", R"({"start": [7.5, 8]})");
  expect_map_refused("ground.asc", {"ground.json"});
}

TEST_F(BadInput, ValuesOutOfRange) {
  expect_option_refused("--iterations=0", {"--iterations"});
  expect_option_refused("--seed=first", {"--seed", "first"});
  expect_option_refused("--solve-delay=soon", {"--solve-delay", "soon", "milliseconds"});
  expect_option_refused("--time-budget=-1", {"--time-budget"});
  expect_option_refused("--machine=tractor", {"tractor"});
  expect_refused({"terrain", "swamp", "--out", "map.asc"}, {"swamp", "rough"});
  expect_refused({"terrain", "rough", "--difficulty", "2", "--out", "map.asc"},
                 {"difficulty", "2"});
  expect_refused({"bench", "drive", "--case", "moon"}, {"moon", "flat"});
}

TEST(Program, HelpsEverywhere) {
  const ScratchFolder folder("help");
  const std::vector<std::vector<std::string>> commands{
      {}, {"run"}, {"plan"}, {"terrain"}, {"model"}, {"bench"}, {"bench", "drive"}};
  for (std::vector<std::string> command : commands) {
    command.push_back("--help");
    const ProgramOutcome outcome = run_program(folder.path(), command);
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_THAT(outcome.out, HasSubstr("Usage"));
    EXPECT_EQ(outcome.err, "");
  }
}

TEST(Program, TellsItsVersion) {
  const ScratchFolder folder("version");
  const ProgramOutcome outcome = run_program(folder.path(), {"--version"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.out, ::testing::MatchesRegex("wex [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

}  // namespace
}  // namespace wex::test
