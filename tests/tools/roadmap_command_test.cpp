#include "tools/wex/roadmap_command.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

namespace wex::app {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class RoadmapCommand : public ::testing::Test {
 protected:
  RoadmapCommand()
      : folder_(fs::temp_directory_path() /
                ("wex_roadmap_command_" + std::to_string(::getpid()) + "_" +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    options_.settings.leg_vertices = 40;
    options_.settings.arm_vertices = 50;
    options_.cache = folder_ / "cache";
    options_.out = folder_ / "out";
  }
  ~RoadmapCommand() override { fs::remove_all(folder_); }

  Result<void> run() {
    text_.str("");
    return run_roadmap(options_, text_);
  }

  fs::path folder_;
  RoadmapOptions options_;
  std::ostringstream text_;
};

TEST_F(RoadmapCommand, PrintsEveryLimbAndDrawsBothViews) {
  const auto done = run();
  ASSERT_TRUE(done) << done.error().message;
  for (const std::string_view limb : kLimbNames) {
    EXPECT_THAT(text_.str(), HasSubstr(std::string("\n").append(limb).append(" ")));
  }
  for (const char* picture : {"roadmap_side.png", "roadmap_top.png"}) {
    EXPECT_GT(fs::file_size(options_.out / picture), 10000U);
    EXPECT_THAT(text_.str(), HasSubstr((options_.out / picture).string()));
  }
}

TEST_F(RoadmapCommand, SaysWhyAFileWasRefused) {
  ASSERT_TRUE(run());
  for (const auto& entry : fs::directory_iterator(options_.cache)) {
    std::ofstream(entry.path(), std::ios::app) << "more";
  }
  ASSERT_TRUE(run());
  EXPECT_THAT(text_.str(), HasSubstr("damaged"));
  ASSERT_TRUE(run());
  EXPECT_THAT(text_.str(), Not(HasSubstr("damaged")));
}

TEST_F(RoadmapCommand, RefusesTheRoadmapOfAnotherMachineAndMakesItsOwn) {
  ASSERT_TRUE(run());
  const MachineModel other = load_machine(WEX_TEST_DATA_DIR "/small_walker").value();
  ASSERT_TRUE(load_or_build_roadmaps(other, options_.settings, options_.cache));
  const auto file = [&](const MachineModel& machine) {
    return roadmap_file(machine, options_.settings, options_.cache).value();
  };
  fs::copy_file(file(other), file(load_machine().value()), fs::copy_options::overwrite_existing);
  ASSERT_TRUE(run());
  EXPECT_THAT(text_.str(), HasSubstr("was made for another machine"));
  ASSERT_TRUE(run());
  EXPECT_THAT(text_.str(), Not(HasSubstr("another machine")));
}

TEST_F(RoadmapCommand, RefusesFoldersThatCannotBeWrittenAndUnknownMachines) {
  std::ofstream(folder_ / "a_file") << "in the way";
  options_.cache = folder_ / "a_file";
  EXPECT_EQ(run().error().code, ErrorCode::kBadInput);
  options_.cache = folder_ / "cache";
  options_.out = folder_ / "a_file" / "out";
  EXPECT_EQ(run().error().code, ErrorCode::kBadInput);
  options_.out = folder_ / "out";
  options_.machine = "no_such_machine";
  EXPECT_EQ(run().error().code, ErrorCode::kBadInput);
}

}  // namespace
}  // namespace wex::app
