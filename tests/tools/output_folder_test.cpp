#include "tools/wex/output_folder.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "tests/tools/program.hpp"

namespace wex::app {
namespace {

namespace fs = std::filesystem;

class OutputFolderTest : public ::testing::Test {
 protected:
  void SetUp() override {
    root_ = fs::temp_directory_path() / ("wex_output_folder_" + std::to_string(getpid()));
    fs::create_directories(root_);
  }
  void TearDown() override { fs::remove_all(root_); }
  fs::path root_;
};

TEST_F(OutputFolderTest, DisappearsWithTheFoldersItCreatedWhenNothingIsPutIntoIt) {
  {
    const auto folder = OutputFolder::open(root_ / "a" / "b");
    ASSERT_TRUE(folder.has_value());
    EXPECT_TRUE(fs::is_directory(root_ / "a" / "b"));
  }
  EXPECT_FALSE(fs::exists(root_ / "a"));
  EXPECT_TRUE(fs::exists(root_));
}

TEST_F(OutputFolderTest, StaysWithWhatWasPublished) {
  {
    const auto folder = OutputFolder::open(root_ / "a");
    ASSERT_TRUE(folder->publish_text("sub/file.txt", "content").has_value());
  }
  EXPECT_EQ(test::read_file(root_ / "a" / "sub" / "file.txt"), "content");
  EXPECT_EQ(test::listing(root_).size(), 3u);
}

TEST_F(OutputFolderTest, KeepsAFolderThatWasThereBefore) {
  fs::create_directories(root_ / "mine");
  {
    ASSERT_TRUE(OutputFolder::open(root_ / "mine").has_value());
  }
  EXPECT_TRUE(fs::exists(root_ / "mine"));
}

TEST_F(OutputFolderTest, LeavesTheOldFileAndNoTemporaryWhenWritingFails) {
  const auto folder = OutputFolder::open(root_);
  ASSERT_TRUE(folder->publish_text("plot.png", "old").has_value());
  const Result<void> written =
      folder->publish("plot.png", [](const fs::path& file) -> Result<void> {
        EXPECT_EQ(file.extension(), ".png");
        std::ofstream(file) << "half";
        return fail(ErrorCode::kInternal, "the pen broke");
      });
  ASSERT_FALSE(written.has_value());
  EXPECT_EQ(written.error().message, "the pen broke");
  EXPECT_EQ(test::read_file(root_ / "plot.png"), "old");
  EXPECT_EQ(test::listing(root_).size(), 1u);
}

TEST_F(OutputFolderTest, RefusesAPlaceUnderAFile) {
  std::ofstream(root_ / "file") << "x";
  const auto folder = OutputFolder::open(root_ / "file" / "results");
  ASSERT_FALSE(folder.has_value());
  EXPECT_EQ(folder.error().code, ErrorCode::kBadInput);
  EXPECT_NE(folder.error().message.find("is not a folder"), std::string::npos);
}

TEST_F(OutputFolderTest, RemovesOnlyTheStaleNamesItIsTold) {
  const auto folder = OutputFolder::open(root_);
  ASSERT_TRUE(folder->publish_text("plan.csv", "1").has_value());
  ASSERT_TRUE(folder->publish_text("frames/frame_01.png", "1").has_value());
  ASSERT_TRUE(folder->publish_text("notes.txt", "mine").has_value());
  folder->remove_stale({"plan.csv", "frames", "never_there"});
  EXPECT_EQ(test::listing(root_), std::vector<std::string>{(root_ / "notes.txt").string()});
}

}  // namespace
}  // namespace wex::app
