#include "initializer/verify_plan.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "tests/initializer/test_worlds.hpp"

namespace wex {
namespace {

using testing::HasSubstr;

class VerifyPlan : public testing::Test {
 protected:
  void SetUp() override {
    auto made = make_plan(map_, test_machine(), {{-4.0, 0.0, 0.0}, {4.0, 0.0, 0.0}});
    ASSERT_TRUE(made) << made.error().message;
    plan_ = *std::move(made);
  }
  [[nodiscard]] PlanVerdict verdict() const { return verify_plan(map_, test_machine(), plan_); }

  TerrainMap map_ = flat_map();
  Plan plan_;
};

TEST_F(VerifyPlan, AcceptsWhatThePlannerReturns) {
  const PlanVerdict seen = verdict();
  EXPECT_TRUE(seen.ok) << seen.violation;
  EXPECT_LT(seen.worst_height_error_m, 1e-4);
  EXPECT_DOUBLE_EQ(seen.min_stability_margin_m, plan_.min_stability_margin_m);
}

TEST_F(VerifyPlan, SeesAWheelOffTheGround) {
  plan_.nodes[7].q[kBaseZ] += 2e-3;
  EXPECT_THAT(verdict().violation, HasSubstr("node 7: wheel LF off the ground"));
}

TEST_F(VerifyPlan, SeesAJointBeyondItsLimits) {
  plan_.nodes[3].q[test_machine().legs[1].steer] = 1.5;
  EXPECT_THAT(verdict().violation, HasSubstr("node 3: RF_STEER beyond its limits"));
}

TEST_F(VerifyPlan, SeesTooMuchTilt) {
  plan_.nodes[5].q[kBaseRoll] = 0.4;
  EXPECT_THAT(verdict().violation, HasSubstr("tilt"));
}

TEST_F(VerifyPlan, SeesARateBeyondItsShareOfTheLimit) {
  const int wheel = test_machine().legs[2].wheel;
  plan_.nodes[9].q[wheel] += 0.9;
  EXPECT_THAT(verdict().violation, HasSubstr("rate of LH_WHEEL"));
}

TEST_F(VerifyPlan, SeesTimeThatDoesNotIncrease) {
  plan_.nodes[4].t_s = plan_.nodes[3].t_s;
  EXPECT_THAT(verdict().violation, HasSubstr("node 4: time"));
}

TEST_F(VerifyPlan, SeesNodesTooFarApart) {
  plan_.nodes.erase(plan_.nodes.begin() + 6);
  EXPECT_THAT(verdict().violation, HasSubstr("distance to the next node"));
}

TEST_F(VerifyPlan, SeesAWrongEnd) {
  plan_.task.goal.x_m += 0.01;
  EXPECT_THAT(verdict().violation, HasSubstr("not at the goal"));
}

TEST_F(VerifyPlan, SeesAStabilityMarginBelowTheDemand) {
  PlanSettings settings;
  settings.min_stability_margin_m = plan_.min_stability_margin_m + 0.01;
  EXPECT_THAT(verify_plan(map_, test_machine(), plan_, settings).violation,
              HasSubstr("stability margin"));
}

TEST_F(VerifyPlan, SeesTooLittleClearanceUnderTheChassis) {
  PlanSettings settings;
  settings.belly_clearance_m = 0.7;
  EXPECT_THAT(verify_plan(map_, test_machine(), plan_, settings).violation,
              HasSubstr("clearance under the chassis"));
}

TEST_F(VerifyPlan, SeesGroundThatIsNotTraversable) {
  const TerrainMap with_pit = make_map(40.0, 30.0, [](double x, double y) {
    return std::hypot(x - 4.0, y - 1.5) < 1.0 ? -2.0 : 0.0;
  });
  EXPECT_THAT(verify_plan(with_pit, test_machine(), plan_).violation,
              HasSubstr("untraversable ground"));
}

TEST_F(VerifyPlan, SeesTheCarriedBucketRunIntoAPillarBetweenTheWheels) {
  // At the goal the bucket is carried 5.5 to 6.3 m along x, its underside 0.7 m above the base.
  const double base_m = plan_.nodes.back().q[kBaseZ];
  const auto pillar = [&](double height_m) {
    return make_map(40.0, 30.0, [height_m](double x, double y) {
      return x > 5.75 && x < 6.05 && y > -0.45 && y < 0.05 ? height_m : 0.0;
    });
  };
  EXPECT_TRUE(verify_plan(pillar(base_m + 0.5), test_machine(), plan_).ok);
  EXPECT_THAT(verify_plan(pillar(base_m + 0.9), test_machine(), plan_).violation,
              HasSubstr("cutting_edge in the ground"));
}

TEST_F(VerifyPlan, SeesValuesThatAreNotNumbers) {
  plan_.nodes[2].q[kBaseX] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(verdict().violation, HasSubstr("not finite"));
}

/// Over a gap on the bucket; the nodes in question are found by their contacts.
class VerifySteppingPlan : public testing::Test {
 protected:
  static constexpr std::size_t kBucket = 4;

  static void SetUpTestSuite() {
    PlanSettings settings;
    settings.iterations = 40;
    auto made = make_plan(map(), test_machine(), {{-7.0, 0.0, 0.0}, {7.0, 0.0, 0.0}}, settings);
    ASSERT_TRUE(made) << made.error().message;
    made_ = *std::move(made);
  }
  static const TerrainMap& map() {
    static const TerrainMap made =
        make_map(30.0, 12.0, [](double x, double) { return std::abs(x) < 0.75 ? -2.0 : 0.0; });
    return made;
  }
  [[nodiscard]] PlanVerdict verdict() const { return verify_plan(map(), test_machine(), plan_); }
  /// The first node at which a limb has just changed its contact to `contact`.
  [[nodiscard]] std::size_t change(std::size_t limb, bool contact) const {
    std::size_t i = 1;
    while (plan_.nodes[i - 1].contacts[limb] == contact || plan_.nodes[i].contacts[limb] != contact)
      ++i;
    return i;
  }

  static Plan made_;
  Plan plan_ = made_;
};
Plan VerifySteppingPlan::made_;

TEST_F(VerifySteppingPlan, AcceptsWhatThePlannerReturns) {
  EXPECT_TRUE(verdict().ok) << verdict().violation;
}

TEST_F(VerifySteppingPlan, SeesALiftedWheelInTheGround) {
  const std::size_t lift = change(0, false);
  plan_.nodes[lift].q[test_machine().legs[0].hfe] -= 0.005;  // 6 mm: what the ball model allows
  EXPECT_THAT(verdict().violation, testing::Not(HasSubstr("in the ground")));
  plan_.nodes[lift].q[test_machine().legs[0].hfe] -= 0.05;
  EXPECT_THAT(verdict().violation, HasSubstr("lifted wheel LF in the ground"));
  EXPECT_EQ(verdict().node, lift);
}

TEST_F(VerifySteppingPlan, SeesAStandingWheelOverTheGap) {
  const std::size_t lift = change(0, false), touch = change(0, true);
  plan_.nodes[(lift + touch) / 2].contacts[0] = true;
  EXPECT_THAT(verdict().violation, HasSubstr("wheel LF on untraversable ground"));
}

TEST_F(VerifySteppingPlan, SeesTheStandingBucketMove) {
  const std::size_t touch = change(kBucket, true), lift = change(kBucket, false);
  const std::size_t node = (touch + lift) / 2;
  plan_.nodes[node].q[test_machine().arm->coordinates.front()] += 0.01;
  EXPECT_THAT(verdict().violation, HasSubstr("the standing bucket moves"));
  EXPECT_EQ(verdict().node, node);
}

TEST_F(VerifySteppingPlan, SeesTheStandingBucketOffTheGround) {
  const std::size_t touch = change(kBucket, true);
  plan_.nodes[touch].q[test_machine().arm->coordinates[1]] -= 0.02;
  EXPECT_THAT(verdict().violation, HasSubstr("bucket off the ground"));
}

TEST_F(VerifySteppingPlan, SeesTwoContactsThatChangeAtOnce) {
  const std::size_t lift = change(0, false);
  plan_.nodes[lift].contacts[1] = false;
  EXPECT_THAT(verdict().violation, HasSubstr("two contacts change at once"));
}

TEST_F(VerifySteppingPlan, SeesTooFewContacts) {
  const std::size_t lift = change(0, false);
  for (const std::size_t limb : {std::size_t{1}, kBucket}) plan_.nodes[lift].contacts[limb] = false;
  EXPECT_THAT(verdict().violation, HasSubstr("fewer than three contacts"));
}

}  // namespace
}  // namespace wex
