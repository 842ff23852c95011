// Table, CSV and rates of the initializer's benchmark, of rows whose figures are known.
#include "tools/bench/initializer_bench.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "models/terrain/terrain_map.hpp"
#include "tools/bench/initializer_bench_cells.hpp"
#include "tools/bench/initializer_bench_table.hpp"
#include "tools/bench/initializer_comparison.hpp"

namespace wex {
namespace {

using testing::HasSubstr;
using testing::Not;

InitializerRow row(const std::string& cell, std::uint64_t seed, bool accepted, double first_s) {
  InitializerRow made;
  made.cell = cell;
  made.seed = seed;
  made.paths = 1;
  made.found = made.accepted = made.first_accepted = accepted;
  made.first_s = first_s;
  made.total_s = 1.25;
  made.first_cost = 20.5;
  made.cost = 18.25;
  made.length_m = 15.125;
  made.duration_s = 61.5;
  made.margin_m = 0.375;
  made.lifts = 4;
  if (!accepted) made.reason = "no plan, 3 of 4 poses\nwere rejected";
  return made;
}

const InitializerCell kGap{"gap 0.25", "gap", 0.25, true, true};
const InitializerCell kRough{"rough 1.00", "rough", 1.0, true, false};

/// `good` of `all` rows accepted, with first plans after 0.1, 0.2, ... s.
std::vector<InitializerRow> rows_of(const InitializerCell& cell, int good, int all) {
  std::vector<InitializerRow> rows;
  for (int k = 0; k < all; ++k) {
    rows.push_back(row(cell.name, static_cast<std::uint64_t>(k + 1), k < good, 0.1 * (k + 1)));
  }
  return rows;
}

TEST(InitializerBenchCsv, ALineReadsBackAsTheRow) {
  for (const bool accepted : {true, false}) {
    const InitializerRow written = row("gap 0.25", 7, accepted, 0.0625);
    std::string line = csv_line(written);
    ASSERT_EQ(line.back(), '\n');
    EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1);
    line.pop_back();
    const auto read = row_of(line);
    ASSERT_TRUE(read) << line;
    EXPECT_EQ(read->cell, written.cell);
    EXPECT_EQ(read->seed, written.seed);
    EXPECT_EQ(read->paths, written.paths);
    EXPECT_EQ(read->found, written.found);
    EXPECT_EQ(read->first_accepted, written.first_accepted);
    EXPECT_EQ(read->accepted, written.accepted);
    EXPECT_EQ(read->first_s, 0.0625);
    EXPECT_EQ(read->total_s, written.total_s);
    EXPECT_EQ(read->first_cost, written.first_cost);
    EXPECT_EQ(read->cost, written.cost);
    EXPECT_EQ(read->length_m, written.length_m);
    EXPECT_EQ(read->duration_s, written.duration_s);
    EXPECT_EQ(read->margin_m, written.margin_m);
    EXPECT_EQ(read->lifts, written.lifts);
    EXPECT_EQ(read->reason, accepted ? "" : "no plan; 3 of 4 poses were rejected");
  }
}

TEST(InitializerBenchCsv, OtherLinesAreNoRows) {
  for (const char* line :
       {"", "cell,seed", "a,b,c,d,e,f,g,h,i,j,k,l,m,n,o", "gap,1,1,1,1,1,0,0,0,0,0,0,0,four,"}) {
    EXPECT_FALSE(row_of(line)) << line;
  }
}

TEST(InitializerBenchCsv, HasAHeaderWithANamePerColumn) {
  const std::string text = initializer_csv(rows_of(kGap, 2, 2));
  const std::string header = text.substr(0, text.find('\n'));
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), 14);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
  EXPECT_FALSE(row_of(header)) << "the header is no row";
}

TEST(InitializerBenchTable, ShowsRatesPercentilesAndThePooledInterval) {
  const std::string table = initializer_table({kGap}, rows_of(kGap, 9, 10));
  EXPECT_THAT(table, HasSubstr("gap 0.25"));
  EXPECT_THAT(table, HasSubstr("9/10"));
  // First plans after 0.1 to 0.9 s: median 0.5, 95 % between the last two, at most 0.9.
  EXPECT_THAT(table, HasSubstr("0.500   0.860   0.900"));
  EXPECT_THAT(table, HasSubstr("= 90.0 % (95 % interval 59.6 to 98.2 %)"));
  EXPECT_THAT(table, HasSubstr("gap 0.25, seed 10: no plan"));
}

TEST(InitializerBenchTable, PoolsOnlyCellsThatAreJudged) {
  std::vector<InitializerRow> rows = rows_of(kGap, 10, 10);
  for (const InitializerRow& more : rows_of(kRough, 0, 10)) rows.push_back(more);
  const std::string table = initializer_table({kGap, kRough}, rows);
  EXPECT_THAT(table, HasSubstr("10/10"));
  EXPECT_THAT(table, HasSubstr("0/10"));
  EXPECT_THAT(table, HasSubstr("= 100.0 %"));
}

TEST(InitializerBenchTable, LeavesOutCellsThatWereNotRun) {
  EXPECT_THAT(initializer_table({kGap, kRough}, rows_of(kGap, 1, 1)), Not(HasSubstr("rough")));
}

TEST(InitializerBenchRates, NinetyFivePercentPooledAndEightyInEveryCell) {
  const InitializerCell step{"step 0.25", "step", 0.25, true, true};
  const auto holds = [&](int gap_good, int step_good) {
    std::vector<InitializerRow> rows = rows_of(kGap, gap_good, 80);
    for (const InitializerRow& more : rows_of(step, step_good, 20)) rows.push_back(more);
    return rates_hold({kGap, step}, rows);
  };
  EXPECT_TRUE(holds(80, 20));
  EXPECT_TRUE(holds(75, 20)) << "95 of 100";
  EXPECT_FALSE(holds(74, 20)) << "94 of 100";
  EXPECT_TRUE(holds(80, 16)) << "80 % in a cell";
  EXPECT_FALSE(holds(80, 15));
}

TEST(InitializerBenchRates, CellsThatAreNotJudgedDoNotCountAndNothingIsNoSuccess) {
  std::vector<InitializerRow> rows = rows_of(kGap, 10, 10);
  for (const InitializerRow& more : rows_of(kRough, 0, 10)) rows.push_back(more);
  EXPECT_TRUE(rates_hold({kGap, kRough}, rows));
  EXPECT_FALSE(rates_hold({kGap}, {}));
}

TEST(InitializerBenchCells, AreTheTwentyAndTheSideSlope) {
  const auto cells = initializer_cells(InitializerBenchSet::kCells);
  EXPECT_EQ(cells.size(), 21U);
  std::set<std::string> names;
  for (const InitializerCell& cell : cells) names.insert(cell.name);
  EXPECT_EQ(names.size(), cells.size());
  for (const char* name :
       {"flat", "rough 0.25", "gap 1.00", "step 0.75", "wall", "hole", "bridge", "side_slope"}) {
    EXPECT_TRUE(names.contains(name)) << name;
  }
}

TEST(InitializerBenchCells, EveryTaskOfEverySetLiesOnItsMap) {
  for (const auto set :
       {InitializerBenchSet::kCells, InitializerBenchSet::kHard, InitializerBenchSet::kBeyond}) {
    for (const InitializerCell& cell : initializer_cells(set)) {
      if (cell.terrain == "rough") continue;  // drawn like the others, and slow to make
      SCOPED_TRACE(cell.name);
      const auto terrain = initializer_task(set, cell, 3);
      ASSERT_TRUE(terrain) << terrain.error().message;
      const Grid& grid = terrain->raster.elevation;
      for (const Pose2& pose : {terrain->task.start, terrain->task.goal}) {
        const Eigen::Vector2d cells =
            (Eigen::Vector2d(pose.x_m, pose.y_m) - terrain->raster.map_origin_m - grid.origin_m) /
            grid.cell_m;
        EXPECT_GE(cells.minCoeff(), 30.0);
        EXPECT_LE(cells.x(), grid.size_x - 30.0);
        EXPECT_LE(cells.y(), grid.size_y - 30.0);
      }
    }
  }
}

TEST(InitializerBenchCells, HardTasksTurnAndMoveTheEndsFurther) {
  const InitializerCell cell = initializer_cells(InitializerBenchSet::kHard).front();
  double most_yaw = 0.0, most_y = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Task task = initializer_task(InitializerBenchSet::kHard, cell, seed).value().task;
    for (const Pose2& pose : {task.start, task.goal}) {
      most_yaw = std::max(most_yaw, std::abs(pose.yaw_rad));
      most_y = std::max(most_y, std::abs(pose.y_m - 8.0));
    }
  }
  EXPECT_GT(most_yaw, 1.0);
  EXPECT_LE(most_yaw, 1.5708);
  EXPECT_GT(most_y, 1.5);
  EXPECT_LE(most_y, 3.0);
}

TEST(InitializerComparison, EveryMechanismOfEitherModeIsSwitchedOffOnce) {
  const auto variants = initializer_variants(InitializerComparison::kMechanisms);
  ASSERT_EQ(variants.size(), 10U);
  std::set<std::string> names;
  for (const InitializerVariant& variant : variants) {
    names.insert(variant.name);
    PlanAblation ablation;
    if (variant.off == nullptr) continue;
    ablation.*variant.off = false;
    const int left = ablation.certificate_first + ablation.alignment + ablation.blocking +
                     ablation.certified_tree + ablation.filtered_heights +
                     ablation.nearest_traversable + ablation.arm_centring + ablation.arm_support;
    EXPECT_EQ(left, 7) << variant.name;
    const bool of_paper = !ablation.filtered_heights || !ablation.nearest_traversable ||
                          !ablation.arm_centring || !ablation.arm_support;
    EXPECT_EQ(variant.mode, of_paper ? PlanMode::kPaper : PlanMode::kCertified) << variant.name;
  }
  EXPECT_EQ(names.size(), variants.size());
}

TEST(InitializerComparison, CountsPathsAndAcceptedPlansOfEveryVariant) {
  std::vector<InitializerVariantRows> variants;
  for (const InitializerVariant& variant : initializer_variants(InitializerComparison::kModes)) {
    variants.push_back({variant, rows_of(kGap, 3, 4)});
    for (const InitializerRow& more : rows_of(kRough, 1, 2)) variants.back().rows.push_back(more);
  }
  ASSERT_EQ(variants.size(), 2U);
  for (InitializerRow& row : variants.back().rows) {
    row.accepted = false;
    row.paths = row.seed == 1;
  }
  const std::string by_cell = comparison_by_cell({kGap, kRough}, variants);
  EXPECT_THAT(by_cell, HasSubstr("|      4      3/4      0.200  |      1      0/4          -"));
  const std::string by_variant = comparison_by_variant({kGap, kRough}, variants);
  EXPECT_THAT(by_variant, HasSubstr("     3/4/4      1/2/2       4/6/6     0.150     0.285"));
  EXPECT_THAT(by_variant, HasSubstr("     0/1/4      0/1/2       0/2/6         -         -"));
}

TEST(InitializerBench, RefusesCellsItDoesNotKnow) {
  InitializerBenchOptions options;
  options.cells = {"swamp"};
  std::ostringstream out, err;
  const auto outcome = bench_initializer(options, out, err);
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(outcome.error().message, HasSubstr("swamp"));
}

}  // namespace
}  // namespace wex
