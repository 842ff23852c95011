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

TEST_F(PaperPlan, PostProcessingChangesOneContactAtATimeOverAHole) {
  // Under the left wheels alone, short enough for one of them at a time.
  const double left_m = default_wheel(Limb::kLF).y();
  const TerrainMap map = make_map(30.0, 20.0, [&](double x, double y) {
    return std::abs(x) < 0.5 && y > left_m - 0.9 && y < left_m + 2.0 ? -3.0 : 0.0;
  });
  const PlanSettings settings;
  const PaperCheck check = paper_check(map, settings);
  auto post = PostProcessing::build(map, test_machine(), test_roadmaps(), check, settings);
  ASSERT_TRUE(post);
  const auto nodes = post->nodes({{{-5.0, 0.0, 0.0}, 0.0, 10.0}});
  ASSERT_TRUE(nodes) << describe(nodes.error().stage) << ": " << nodes.error().why << " at x "
                     << nodes.error().where.x_m;
  int changes = 0;
  std::array<bool, kNumLimbs> was_lifted{};
  for (std::size_t i = 1; i < nodes->size(); ++i) {
    int here = 0;
    for (std::size_t k = 0; k < kNumLimbs; ++k) {
      here += (*nodes)[i].contacts[k] != (*nodes)[i - 1].contacts[k];
      was_lifted[k] = was_lifted[k] || !(*nodes)[i].contacts[k];
    }
    EXPECT_LE(here, 1) << "node " << i;
    EXPECT_GT((*nodes)[i].t_s, (*nodes)[i - 1].t_s);
    changes += here;
  }
  EXPECT_GE(changes, 4);  // both left wheels up and down
  EXPECT_TRUE(was_lifted[0] && was_lifted[2]);
  EXPECT_FALSE(was_lifted[1] || was_lifted[3]);
  EXPECT_EQ(nodes->back().contacts, kDrivingContacts);
  Plan plan;
  plan.task = {{-5.0, 0.0, 0.0}, {5.0, 0.0, 0.0}};
  plan.nodes = *nodes;
  const PlanVerdict verdict = verify_plan(map, test_machine(), plan, settings);
  EXPECT_TRUE(verdict.ok) << verdict.violation;
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
  const Roadmaps roadmaps = with_bucket_at(with_plain_legs(test_roadmaps()), places);
  const PlanSettings settings;
  const PaperCheck check = paper_check(map, settings, roadmaps);
  auto post = PostProcessing::build(map, test_machine(), roadmaps, check, settings);
  ASSERT_TRUE(post);
  const auto nodes = post->nodes({{{-5.0, 0.0, 0.0}, 0.0, 10.0}});
  ASSERT_TRUE(nodes) << describe(nodes.error().stage) << ": " << nodes.error().why << " at x "
                     << nodes.error().where.x_m;
  std::string schedule;
  for (std::size_t i = 1; i < nodes->size(); ++i) {
    for (std::size_t k = 0; k < kNumLimbs; ++k) {
      if ((*nodes)[i].contacts[k] == (*nodes)[i - 1].contacts[k]) continue;
      schedule += ((*nodes)[i].contacts[k] ? " +" : " -") + std::string(kLimbNames[k]);
    }
  }
  EXPECT_EQ(schedule, " +ARM -LF -RF +RF +LF -ARM +ARM -LH -RH +RH +LH -ARM");
  Plan plan;
  plan.task = {{-5.0, 0.0, 0.0}, {5.0, 0.0, 0.0}};
  plan.nodes = *nodes;
  const PlanVerdict verdict = verify_plan(map, test_machine(), plan, settings);
  EXPECT_TRUE(verdict.ok) << verdict.violation;
}

}  // namespace
}  // namespace wex
