#include "tools/wex/options.hpp"

#include <gtest/gtest.h>

namespace wex::app {
namespace {

TEST(ParsePose, ReadsThreeNumbersWithSigns) {
  const auto pose = parse_pose("-3.5,+2e1,-0.25");
  ASSERT_TRUE(pose.has_value());
  EXPECT_EQ(*pose, (Pose2{-3.5, 20.0, -0.25}));
}

TEST(ParsePose, RefusesAnythingElseQuotingIt) {
  for (const char* text : {"", "1", "1,2", "1,2,3,4", "1,2,", ",1,2", "1;2;3", "1,2,x", "1,2,3m",
                           "nan,0,0", "0,inf,0", "1, 2, 3"}) {
    const auto pose = parse_pose(text);
    ASSERT_FALSE(pose.has_value()) << text;
    EXPECT_EQ(pose.error().code, ErrorCode::kBadInput);
    EXPECT_EQ(pose.error().message.find(text, 1), 1u);  // in quotes
  }
}

TEST(ParseSolveDelay, KnowsMeasuredAndMilliseconds) {
  EXPECT_EQ(*parse_solve_delay("measured"), std::nullopt);
  EXPECT_DOUBLE_EQ(**parse_solve_delay("50"), 0.05);
  EXPECT_DOUBLE_EQ(**parse_solve_delay("0"), 0.0);
  for (const char* text : {"", "soon", "-1", "2001", "nan", "50ms"}) {
    EXPECT_FALSE(parse_solve_delay(text).has_value()) << text;
  }
}

TEST(ExitCode, IsTheOneOfTheDecisions) {
  EXPECT_EQ(exit_code(ErrorCode::kInternal), 1);
  EXPECT_EQ(exit_code(ErrorCode::kBadInput), 2);
  EXPECT_EQ(exit_code(ErrorCode::kNoPlan), 3);
  EXPECT_EQ(exit_code(ErrorCode::kRefinementFailed), 4);
  EXPECT_EQ(exit_code(ErrorCode::kStoppedSafely), 5);
  EXPECT_EQ(exit_code(ErrorCode::kOutOfLimits), 6);
}

}  // namespace
}  // namespace wex::app
