#include <gtest/gtest.h>

#include "models/terrain/synthetic.hpp"
#include "tests/models/terrain/terrain_fixtures.hpp"

namespace wex {
namespace {

std::string refusal(const std::filesystem::path& file) {
  const auto task = read_task(file);
  EXPECT_FALSE(task.has_value());
  if (task) return {};
  EXPECT_EQ(task.error().code, ErrorCode::kBadInput);
  EXPECT_NE(task.error().message.find(file.filename().string()), std::string::npos);
  return task.error().message;
}

TEST(TaskFile, ReadsBackWhatWasWritten) {
  const ScratchFolder folder("task");
  const Task task{{429581.123456789, 5150630.25, -0.1}, {1.0 / 3.0, -2.0, 3.0}};
  ASSERT_TRUE(write_task(task, folder / "map.json").has_value());
  const auto read = read_task(folder / "map.json");
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(*read, task);
}

TEST(TaskFile, TakesWholeNumbers) {
  const ScratchFolder folder("task");
  const auto task = read_task(folder.with("a.json", R"({"goal":[4,5,6],"start":[1,2,3]})"));
  ASSERT_TRUE(task.has_value());
  EXPECT_EQ(task->start, (Pose2{1.0, 2.0, 3.0}));
  EXPECT_EQ(task->goal, (Pose2{4.0, 5.0, 6.0}));
}

TEST(TaskFile, RefusesAMissingFile) {
  const ScratchFolder folder("task");
  EXPECT_NE(refusal(folder / "none.json").find("no such file"), std::string::npos);
}

TEST(TaskFile, RefusesBrokenJsonNamingTheLine) {
  const ScratchFolder folder("task");
  const auto file = folder.with("a.json", "{\n  \"start\": [1, 2, NaN],\n  \"goal\": [1,2,3]}\n");
  EXPECT_NE(refusal(file).find("line 2: is not valid JSON"), std::string::npos);
  EXPECT_NE(refusal(folder.with("b.json", "")).find("line 1"), std::string::npos);
}

TEST(TaskFile, RefusesAMissingFieldNamingIt) {
  const ScratchFolder folder("task");
  EXPECT_NE(refusal(folder.with("a.json", R"({"start":[1,2,3]})")).find("has no \"goal\""),
            std::string::npos);
}

TEST(TaskFile, RefusesWrongTypesNamingTheField) {
  const ScratchFolder folder("task");
  const auto with_start = [&](const std::string& start) {
    return refusal(folder.with("a.json", R"({"goal":[1,2,3],"start":)" + start + "}"));
  };
  EXPECT_NE(with_start("\"here\"").find("\"start\" is \"here\""), std::string::npos);
  EXPECT_NE(with_start("[1,2]").find("\"start\" is [1,2]"), std::string::npos);
  EXPECT_NE(with_start("[1,2,\"x\"]").find("\"start\" holds \"x\""), std::string::npos);
  EXPECT_NE(with_start("[1,2,null]").find("\"start\" holds null"), std::string::npos);
  EXPECT_NE(with_start("[1,2,1e999]").find("out of range"), std::string::npos);
  EXPECT_NE(refusal(folder.with("b.json", "[1,2,3]")).find("expected {\"start\""),
            std::string::npos);
}

TEST(TaskFile, RefusesUnknownFieldsNamingThem) {
  const ScratchFolder folder("task");
  EXPECT_NE(
      refusal(folder.with("a.json", R"({"start":[1,2,3],"goals":[1,2,3]})")).find("\"goals\""),
      std::string::npos);
}

TEST(TaskFile, RefusesAFolderThatIsNotThere) {
  const ScratchFolder folder("task");
  const auto written = write_task({}, folder / "none/map.json");
  ASSERT_FALSE(written.has_value());
  EXPECT_EQ(written.error().code, ErrorCode::kBadInput);
  EXPECT_NE(written.error().message.find("cannot be written: No such file"), std::string::npos);
}

}  // namespace
}  // namespace wex
