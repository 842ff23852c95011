#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "tools/bench/can_bench_parts.hpp"
#include "tools/bench/can_bench_table.hpp"

namespace wex {
namespace {

using ::testing::HasSubstr;

CanBenchPart part_of(const char* test, CanBenchOutput output) {
  CanBenchPart part;
  part.test = test;
  part.what = "what";
  part.gate = "gate";
  part.output = output;
  return part;
}

CanBenchSetting setting_of(bool full, std::vector<std::string> only = {}) {
  return {.full = full, .only = std::move(only), .build = "/build", .source = "/source"};
}

std::set<std::string> tests_of(const std::vector<CanBenchPart>& parts) {
  std::set<std::string> tests;
  for (const CanBenchPart& part : parts) {
    std::istringstream words(part.test);
    for (std::string test; words >> test;) tests.insert(test);
  }
  return tests;
}

TEST(CanBenchParts, BothFormsConsistOfAllTwentyTwoTests) {
  for (const bool full : {false, true}) {
    const auto tests = tests_of(can_bench_parts(setting_of(full)));
    for (int i = 1; i <= 22; ++i)
      EXPECT_TRUE(tests.contains(std::string("T").append(std::to_string(i)))) << i;
    EXPECT_EQ(tests.size(), 22u);
  }
}

TEST(CanBenchParts, OnlyWhatIsAskedForIsRun) {
  const auto parts = can_bench_parts(setting_of(true, {"T7", "T13"}));
  EXPECT_EQ(tests_of(parts), (std::set<std::string>{"T7", "T13"}));
  for (const CanBenchPart& part : parts) {
    if (part.output != CanBenchOutput::kFigures) continue;
    EXPECT_EQ(part.command.back(), part.test);  // the program is told to run no other
  }
  EXPECT_TRUE(can_bench_parts(setting_of(false, {"T99"})).empty());
}

TEST(CanBenchParts, RealTimePriorityIsAskedForWhereItMayBeHad) {
  for (const bool real_time : {false, true}) {
    CanBenchSetting setting = setting_of(false, {"T12"});
    setting.real_time = real_time;
    const auto part = can_bench_parts(setting).front();
    EXPECT_EQ(std::ranges::count(part.environment, "WITH_VCAN_RT=20"), real_time);
  }
}

TEST(CanBenchRows, EveryFigureIsARowAndAMissingTestFails) {
  const auto part = part_of("T6 T7", CanBenchOutput::kFigures);
  const std::string output =
      "noise\nFIGURE\tT6\ta\t1 ms\t<= 2\tpass\nFIGURE\tT6\tb\t3 ms\t<= 2\tfail\nlast words\n";
  const auto rows = can_bench_rows(part, output, 124);
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_TRUE(rows[0].passed);
  EXPECT_FALSE(rows[1].passed);
  EXPECT_EQ(rows[2].test, "T7");
  EXPECT_THAT(rows[2].figure, HasSubstr("out of time"));
  EXPECT_FALSE(rows[2].passed);
}

TEST(CanBenchRows, ATestProgramPassesWhenItsTestsRanAndPassed) {
  const auto part = part_of("T4", CanBenchOutput::kGoogleTest);
  const auto good = can_bench_rows(part, "42 flips\n[       OK ] A.B (1 ms)\n", 0);
  EXPECT_TRUE(good.front().passed);
  EXPECT_EQ(good.front().figure, "42 flips; 1 test passed");
  // ThreadSanitizer lets the tests pass and ends the program with an error.
  EXPECT_FALSE(can_bench_rows(part, "[       OK ] A.B (1 ms)\n", 66).front().passed);
  const auto bad = can_bench_rows(part, "[  FAILED  ] A.C (1 ms)\n[       OK ] A.B (1 ms)\n", 1);
  EXPECT_EQ(bad.front().figure, "failed: A.C");
  EXPECT_FALSE(bad.front().passed);
  EXPECT_FALSE(can_bench_rows(part, "", 0).front().passed);
  EXPECT_FALSE(can_bench_rows(part, "[  SKIPPED ] A.B\n", 0).front().passed);
}

TEST(CanBenchTable, RowsComeBackFromTheCsvInTheOrderOfTheTests) {
  std::vector<CanBenchRow> rows{{"T13", "stop, \"at once\"", "p50 3 ms; max 9", "<= 10", true},
                                {"T6", "loss", "1, 2", "none", false}};
  sort_by_test(rows);
  EXPECT_EQ(rows.front().test, "T6");
  const auto again = can_bench_rows_of_csv(can_bench_csv(rows) + "rubbish\n\n");
  ASSERT_EQ(again.size(), 2u);
  EXPECT_EQ(again[0].figure, "1, 2");
  EXPECT_FALSE(again[0].passed);
  EXPECT_EQ(again[1].test, "T13");
  EXPECT_EQ(again[1].what, "stop, 'at once'");
  EXPECT_TRUE(again[1].passed);
}

TEST(CanBenchTable, CountsWhatPassed) {
  const std::string table =
      can_bench_table({{"T1", "a", "b", "c", true}, {"T2", "d", "e", "", false}});
  EXPECT_THAT(table, HasSubstr("T1    pass a  [c]"));
  EXPECT_THAT(table, HasSubstr("T2    FAIL d\n"));
  EXPECT_THAT(table, HasSubstr("1 passed, 1 failed"));
}

}  // namespace
}  // namespace wex
