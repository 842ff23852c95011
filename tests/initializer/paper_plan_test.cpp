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
                           const PlanSettings& settings, int* num_paths = nullptr) {
    const PaperCheck check = paper_check(terrain, settings);
    auto post = PostProcessing::build(terrain, test_machine(), test_roadmaps(), check, settings);
    if (!post) return tl::unexpected<Error>(post.error());
    const std::function<void(const PlanProgress&)> observer = [&](const PlanProgress& progress) {
      if (num_paths != nullptr) *num_paths = progress.num_paths;
    };
    return PaperSearch(terrain, test_machine(), task, settings, observer, check, *post, 0.0).run();
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
  const auto none = plan(map, {{-8.0, 0.0, 0.0}, {8.0, 0.0, 0.0}}, by_iterations(60));
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::kNoPlan);
  EXPECT_THAT(none.error().message, testing::HasSubstr("poses were refused"));
  EXPECT_THAT(none.error().message, testing::Not(testing::HasSubstr("found and lost")));
}

}  // namespace
}  // namespace wex
