#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "initializer/make_plan.hpp"
#include "initializer/paper/paper_search.hpp"
#include "initializer/verify_plan.hpp"
#include "tests/initializer/paper_worlds.hpp"

namespace wex {
namespace {

/// As make_plan does it, with the small roadmaps.
class PaperPlan : public testing::TestWithParam<PlannerKind> {
 protected:
  static Result<Plan> plan(const TerrainMap& terrain, const Task& task,
                           const PlanSettings& settings, int* num_paths = nullptr,
                           SearchCensus* census = nullptr) {
    const PaperCheck check = paper_check(terrain, settings);
    auto post = PostProcessing::build(terrain, test_machine(), test_roadmaps(), check, settings);
    if (!post) return tl::unexpected<Error>(post.error());
    const std::function<void(const PlanProgress&)> observer = [&](const PlanProgress& progress) {
      if (num_paths != nullptr) *num_paths = progress.num_paths;
    };
    PaperSearch search(terrain, test_machine(), task, settings, observer, check, *post, 0.0);
    auto plan = search.run();
    if (census != nullptr) *census = search.census();
    return plan;
  }
  static PlanSettings by_iterations(int iterations) {
    PlanSettings settings;
    settings.iterations = iterations;
    return settings;
  }
};

const Task kAcross{{-5.0, 0.0, 0.0}, {5.0, 1.0, 0.1}};

TEST_P(PaperPlan, DrivesOverFlatGroundWithEveryPlanner) {
  const TerrainMap flat = flat_map(30.0, 20.0);
  PlanSettings settings = by_iterations(400);
  settings.planner = GetParam();
  int num_paths = 0;
  const auto driven = plan(flat, kAcross, settings, &num_paths);
  ASSERT_TRUE(driven) << driven.error().message;
  EXPECT_GE(num_paths, 1);
  EXPECT_TRUE(verify_plan(flat, test_machine(), *driven, settings).ok);
  for (const WholeBodyNode& node : driven->nodes) EXPECT_EQ(node.contacts, kDrivingContacts);
  EXPECT_LT(driven->path_length_m, 30.0);
}

INSTANTIATE_TEST_SUITE_P(AllPlanners, PaperPlan,
                         testing::Values(PlannerKind::kRrtSharp, PlannerKind::kRrtStar,
                                         PlannerKind::kBitStar, PlannerKind::kPrmStar));

TEST_F(PaperPlan, TheSameSeedGivesTheSamePlanBitForBit) {
  const TerrainMap map = make_map(30.0, 20.0, [](double x, double y) { return 0.2 * bumps(x, y); });
  const auto once = plan(map, kAcross, by_iterations(60));
  const auto again = plan(map, kAcross, by_iterations(60));
  ASSERT_EQ(once.has_value(), again.has_value());
  ASSERT_TRUE(once) << once.error().message;
  ASSERT_EQ(once->nodes.size(), again->nodes.size());
  for (std::size_t i = 0; i < once->nodes.size(); ++i) {
    EXPECT_EQ(once->nodes[i].q, again->nodes[i].q);
    EXPECT_EQ(once->nodes[i].t_s, again->nodes[i].t_s);
  }
}

TEST_F(PaperPlan, SaysWhatStoodInTheWayWhenThereIsNoPlan) {
  // A ditch that neither legs nor arm get across.
  const TerrainMap map =
      make_map(30.0, 20.0, [](double x, double) { return std::abs(x) < 5.0 ? -20.0 : 0.0; });
  SearchCensus census;
  const auto none =
      plan(map, {{-8.0, 0.0, 0.0}, {8.0, 0.0, 0.0}}, by_iterations(60), nullptr, &census);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::kNoPlan);
  EXPECT_THAT(none.error().message, testing::HasSubstr("poses were refused"));
  EXPECT_THAT(none.error().message, testing::Not(testing::HasSubstr("found and lost")));
  EXPECT_GT(census.num_poses(), 60U);
  EXPECT_FALSE(census.rejections().empty());
  EXPECT_TRUE(census.failed_paths().empty());
}

// A gap askew: one front wheel loses the ground before the other, and most paths that pass
// Algorithm 2 at every pose are lost in what follows, whether one becomes a plan or not.
TEST_F(PaperPlan, SaysWherePathsWereLost) {
  const TerrainMap map = make_map(
      30.0, 20.0, [](double x, double y) { return std::abs(x + 0.05 * y) < 0.5 ? -2.0 : 0.0; });
  SearchCensus census;
  int num_paths = 0;
  const auto found =
      plan(map, {{-7.5, 0.0, 0.0}, {7.5, 0.0, 0.0}}, by_iterations(300), &num_paths, &census);
  ASSERT_FALSE(census.failed_paths().empty());
  EXPECT_LE(census.failed_paths().size(), static_cast<std::size_t>(num_paths) - found.has_value());
  for (const FailedPath& path : census.failed_paths()) {
    EXPECT_TRUE(path.stepping);
    EXPECT_LT(std::abs(path.where.x_m), 4.0) << "where the gap is under the machine";
    EXPECT_THAT(path.why, testing::ContainsRegex("^(contact schedule|legs|bucket point|arm motion|"
                                                 "verification): "));
  }
}

/// Contacts made and broken, in order.
std::string schedule_of(const std::vector<WholeBodyNode>& nodes) {
  std::string schedule;
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    for (std::size_t k = 0; k < kNumLimbs; ++k) {
      if (nodes[i].contacts[k] == nodes[i - 1].contacts[k]) continue;
      schedule += (nodes[i].contacts[k] ? " +" : " -") + std::string(kLimbNames[k]);
    }
  }
  return schedule;
}

/// Straight ahead along y = 0; the finished plan must pass verification.
std::string schedule_straight_ahead(const TerrainMap& map, const Roadmaps& roadmaps) {
  const PlanSettings settings;
  const PaperCheck check = paper_check(map, settings, roadmaps);
  auto post = PostProcessing::build(map, test_machine(), roadmaps, check, settings);
  if (!post) return post.error().message;
  auto nodes = post->nodes({{{-5.0, 0.0, 0.0}, 0.0, 10.0}});
  if (!nodes) return std::string(describe(nodes.error().stage)) + ": " + nodes.error().why;
  for (std::size_t i = 1; i < nodes->size(); ++i) {
    EXPECT_GT((*nodes)[i].t_s, (*nodes)[i - 1].t_s) << "node " << i;
  }
  EXPECT_EQ(nodes->back().contacts, kDrivingContacts);
  Plan plan;
  plan.task = {{-5.0, 0.0, 0.0}, {5.0, 0.0, 0.0}};
  plan.nodes = *std::move(nodes);
  const PlanVerdict verdict = verify_plan(map, test_machine(), plan, settings);
  EXPECT_TRUE(verdict.ok) << verdict.violation;
  return schedule_of(plan.nodes);
}

// By hand: under the left wheels alone. With 0.15 m at either edge it closes 1.7 m of a wheel's
// way, and by its hip a front wheel reaches 1.1 m along, a hind wheel 0.6 m: either must go up and
// come down once, no wheel on the right side ever.
TEST_F(PaperPlan, OverAHoleTheWheelsOfOneSideAreLiftedOneByOne) {
  const double left_m = default_wheel(Limb::kLF).y();
  const TerrainMap map = make_map(30.0, 20.0, [&](double x, double y) {
    return std::abs(x) < 0.7 && y > left_m - 0.9 && y < left_m + 2.5 ? -3.0 : 0.0;
  });
  EXPECT_EQ(schedule_straight_ahead(map, test_roadmaps()), " -LF +LF -LH +LH");
  EXPECT_EQ(schedule_straight_ahead(map, with_plain_legs(test_roadmaps())), " -LF +LF -LH +LH");
}

// The same, a little shorter: spread forward the wheel finds the far side one station after it
// stood on the near side, spread back. It cannot have rolled there: it is lifted once more.
TEST_F(PaperPlan, AWheelIsLiftedOverWhatItCannotRollOver) {
  const double left_m = default_wheel(Limb::kLF).y();
  const TerrainMap map = make_map(30.0, 20.0, [&](double x, double y) {
    return std::abs(x) < 0.5 && y > left_m - 0.9 && y < left_m + 2.5 ? -3.0 : 0.0;
  });
  EXPECT_EQ(schedule_straight_ahead(map, test_roadmaps()), " -LF +LF -LF +LF -LH +LH");
}

// By hand: legs that only go up and down, square to the gap, lose and find the ground in pairs, so
// that each axle goes over on the bucket: down, two wheels up, two wheels down, bucket up. Twice
// six changes. The bucket can stand every 0.2 m ahead and behind, as far apart as the stations are,
// so that one place serves a phase. Too narrow a gap for a wheel to find its floor, and so shallow
// that the fits of Algorithm 1 across a rim tilt by little.
TEST_F(PaperPlan, TheBucketCarriesEachAxleInTurnOverAGap) {
  const TerrainMap map =
      make_map(30.0, 20.0, [](double x, double) { return std::abs(x) < 0.5 ? -0.6 : 0.0; });
  std::vector<Eigen::Vector2d> places;
  for (int i = 0; i < 12; ++i) {
    places.emplace_back(4.2 + 0.2 * i, 0.0);
    places.emplace_back(-4.2 - 0.2 * i, 0.0);
  }
  EXPECT_EQ(schedule_straight_ahead(map, with_bucket_at(with_plain_legs(test_roadmaps()), places)),
            " +ARM -LF -RF +RF +LF -ARM +ARM -LH -RH +RH +LH -ARM");
}

}  // namespace
}  // namespace wex
