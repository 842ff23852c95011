#include "tools/check/plan_checker.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tools/check/checked_motions.hpp"
#include "tools/check/check_command.hpp"

namespace wex::check {
namespace {

using test::bucket_ahead;
using test::coordinate;
using test::driving;
using test::front_pair_on_the_bucket;
using test::make_raster;
using test::standing;
using test::Standstill;
using testing::HasSubstr;

CheckReport judge(const Plan& plan, const Raster& raster = make_raster()) {
  auto report = check_plan(test::machine(), raster, plan);
  if (!report) throw std::runtime_error(report.error().message);
  return *std::move(report);
}

double worst(const CheckReport& report, const std::string& rule) {
  const Finding* finding = report.find(rule);
  if (!finding || !finding->observed) throw std::runtime_error("nothing observed: " + rule);
  return finding->worst;
}

/// Names of violated rules.
std::vector<std::string> violated(const CheckReport& report) {
  std::vector<std::string> rules;
  for (const Finding& finding : report.findings) {
    if (finding.violations > 0) rules.push_back(finding.rule);
  }
  return rules;
}

#define EXPECT_ACCEPTED(report) EXPECT_TRUE((report).accepted) << check_table(report)
#define EXPECT_CAUGHT(report, rule)                                                             \
  do {                                                                                          \
    EXPECT_FALSE((report).accepted);                                                            \
    EXPECT_THAT(violated(report), testing::Contains(std::string(rule))) << check_table(report); \
  } while (false)
#define EXPECT_ONLY(report, rule) \
  EXPECT_THAT(violated(report), testing::ElementsAre(std::string(rule))) << check_table(report)

TEST(PlanChecker, AcceptsStraightDrivingOnFlatGround) {
  const CheckReport report = judge(driving());
  EXPECT_ACCEPTED(report);
  EXPECT_EQ(report.rows, 51);
  EXPECT_GE(report.postures, 1001);  // 10 m in centimetres
  EXPECT_NEAR(worst(report, "wheel above ground, rows"), 0.0, 1e-3);
  EXPECT_NEAR(worst(report, "wheel in the ground, rows"), 0.0, 1e-3);
  EXPECT_NEAR(worst(report, "side slip / travel"), 0.0, 1e-6);
  EXPECT_NEAR(worst(report, "wheel turn off travel"), 0.0, 1e-6);
  EXPECT_NEAR(worst(report, "base speed"), 0.5, 1e-3);
  EXPECT_GT(worst(report, "stability margin"), 1.0);
  EXPECT_EQ(report.verdict(), "");
}

TEST(PlanChecker, AcceptsThePairLiftOnTheBucket) {
  const CheckReport report = judge(front_pair_on_the_bucket());
  EXPECT_ACCEPTED(report);
  EXPECT_EQ(worst(report, "limbs that carry"), 3.0);
  EXPECT_EQ(worst(report, "contact changes in a row"), 1.0);
  EXPECT_LT(worst(report, "bucket moves while it stands"), 1e-6);
  EXPECT_LT(worst(report, "stability margin"), worst(judge(driving()), "stability margin"));
}

TEST(PlanChecker, AcceptsALiftedWheelWithTheArmAsCounterweight) {
  Eigen::VectorXd balanced = bucket_ahead(1.0);
  balanced[coordinate("TURN")] = 135.0 * test::kDegree;
  const double down = standing()[coordinate("RF_HFE")];
  const auto lift = [&](const Eigen::VectorXd& arm) {
    return Standstill()
        .arm_to(arm)
        .contact(Limb::kRF, false)
        .to("RF_HFE", 0.1)
        .to("RF_HFE", down)
        .contact(Limb::kRF, true)
        .plan();
  };
  EXPECT_ACCEPTED(judge(lift(balanced)));
  EXPECT_ONLY(judge(lift(bucket_ahead(1.0))), "stability margin");  // the arm over the lifted wheel
}

TEST(PlanChecker, FindsAWheelThatIsLiftedButScheduled) {
  Plan plan = driving();
  plan.nodes[20].q[coordinate("LF_HFE")] += 0.055;  // about 6 cm
  const CheckReport report = judge(plan);
  EXPECT_CAUGHT(report, "wheel above ground, rows");
  EXPECT_CAUGHT(report, "wheel above ground, between");
  const Finding& finding = *report.find("wheel above ground, rows");
  EXPECT_NEAR(finding.worst, 0.06, 0.01);
  EXPECT_EQ(finding.subject, "LF");
  EXPECT_NEAR(finding.t_s, 8.0, 1e-9);
  EXPECT_NEAR(finding.x_m, 200.0 - 1.0 + 2.45, 0.1);  // map frame, at the wheel
  EXPECT_THAT(report.verdict(), HasSubstr("wheel above ground"));
}

TEST(PlanChecker, FindsAWheelPressedIntoTheGround) {
  Plan plan = driving();
  plan.nodes[20].q[coordinate("RH_HFE")] -= 0.03;
  EXPECT_CAUGHT(judge(plan), "wheel in the ground, rows");
}

TEST(PlanChecker, FindsGroundThatChangedUnderTheWheels) {
  const auto raised = [](double x, double y) {
    return std::hypot(x - 2.0, y - 1.54) < 0.05 ? 0.1 : 0.0;  // one cell on LF's way
  };
  const CheckReport report = judge(driving(), make_raster(raised));
  EXPECT_CAUGHT(report, "wheel in the ground, rows");
  EXPECT_NEAR(report.find("wheel in the ground, rows")->x_m, 202.0, 0.3);
}

TEST(PlanChecker, FindsUnknownGroundUnderAWheel) {
  const auto hole = [](double x, double y) {
    return std::hypot(x - 2.0, y - 1.54) < 0.05 ? std::nan("") : 0.0;
  };
  EXPECT_CAUGHT(judge(driving(), make_raster(hole)), "contact on unknown ground");
}

TEST(PlanChecker, FindsAWheelOffTheMap) {
  Raster raster = make_raster();
  raster.elevation.size_x = 160;  // ends at x = 0.9
  std::vector<float> values;
  for (int j = 0; j < raster.elevation.size_y; ++j) values.insert(values.end(), 160, 0.0F);
  raster.elevation.values = values;
  EXPECT_CAUGHT(judge(driving(), raster), "contact on unknown ground");
}

TEST(PlanChecker, FindsAWheelNearAnEdgeOnly) {
  // A pit beside the way: its rim this far from the left wheels' middle.
  const auto pit = [](double rim_m) {
    return make_raster([rim_m](double, double y) { return y > 1.54 + rim_m ? -2.0 : 0.0; });
  };
  EXPECT_CAUGHT(judge(driving(), pit(0.05)), "contact to untraversable");
  EXPECT_ACCEPTED(judge(driving(), pit(0.6)));
}

TEST(PlanChecker, FindsABucketThatMovesWhileItStands) {
  Plan plan = front_pair_on_the_bucket();
  bool stood = false;
  for (WholeBodyNode& node : plan.nodes) {
    const bool stands = node.contacts[static_cast<std::size_t>(Limb::kArm)];
    if (stands && stood) node.q[coordinate("TURN")] += 0.02;
    stood = stands;
  }
  EXPECT_CAUGHT(judge(plan), "bucket moves while it stands");
}

TEST(PlanChecker, FindsABucketThatDoesNotTouchTheGround) {
  Plan plan = front_pair_on_the_bucket();
  for (WholeBodyNode& node : plan.nodes) node.q[coordinate("BOOM")] += 0.005;  // about 3 cm
  EXPECT_CAUGHT(judge(plan), "bucket off the ground, rows");
}

TEST(PlanChecker, FindsTwoContactChangesAtOnce) {
  Plan plan = front_pair_on_the_bucket();
  // Without the nodes where LF alone is lifted both go together.
  std::erase_if(plan.nodes, [](const WholeBodyNode& node) {
    return node.contacts == ContactFlags{false, true, true, true, true};
  });
  EXPECT_CAUGHT(judge(plan), "contact changes in a row");
}

TEST(PlanChecker, FindsTwoWheelsThatCarryAlone) {
  Plan plan = front_pair_on_the_bucket();
  for (WholeBodyNode& node : plan.nodes)
    node.contacts[static_cast<std::size_t>(Limb::kArm)] = false;
  const CheckReport report = judge(plan);
  EXPECT_CAUGHT(report, "limbs that carry");
  EXPECT_CAUGHT(report, "stability margin");
}

TEST(PlanChecker, FindsAWheelThatIsScheduledBeforeItTouches) {
  const double down = standing()[coordinate("LF_HFE")];
  const Plan plan = Standstill()
                        .to(bucket_ahead(0.4))
                        .to(bucket_ahead(0.0))
                        .contact(Limb::kArm, true)
                        .contact(Limb::kLF, false)
                        .to("LF_HFE", 0.1)
                        .to("LF_HFE", down + 0.08)
                        .contact(Limb::kLF, true)
                        .to("LF_HFE", down)
                        .contact(Limb::kArm, false)
                        .plan();
  EXPECT_CAUGHT(judge(plan), "wheel touches down from");
}

TEST(PlanChecker, FindsASwingWheelTooLowOverTheGround) {
  // LF is carried 2 m ahead over the ground in the air while the others roll.
  const auto carried = [](double hfe_rad) {
    Eigen::VectorXd balanced = bucket_ahead(1.0);
    balanced[coordinate("TURN")] = 225.0 * test::kDegree;
    const double down = standing()[coordinate("LF_HFE")];
    Standstill lift;
    Plan plan = lift.arm_to(balanced).contact(Limb::kLF, false).to("LF_HFE", hfe_rad).plan();
    for (int i = 0; i < 20; ++i) {
      WholeBodyNode node = plan.nodes.back();
      node.t_s += 0.4;
      node.q[kBaseX] += 0.1;
      for (const WheeledLeg& leg : test::machine().legs) {
        node.q[leg.wheel] += leg.wheel_sign * 0.1 / leg.radius_m;
      }
      plan.nodes.push_back(node);
    }
    WholeBodyNode lowered = plan.nodes.back();
    lowered.t_s += 5.0;
    lowered.q[coordinate("LF_HFE")] = down;
    plan.nodes.push_back(lowered);
    lowered.t_s += 1.0;
    lowered.contacts = kDrivingContacts;
    plan.nodes.push_back(lowered);
    plan.task.goal.x_m = 2.0;
    return plan;
  };
  EXPECT_ACCEPTED(judge(carried(-0.1)));
  EXPECT_ONLY(judge(carried(-0.32)), "swing clearance");
}

TEST(PlanChecker, FindsAMarginThatIsTooSmall) {
  // Far out to the right, on four wheels, with the machine rolled to that side.
  Eigen::VectorXd q = bucket_ahead(1.5);
  q[coordinate("TELE")] = 1.7;
  q[coordinate("DIPPER")] = 0.9;
  q[coordinate("TURN")] = -90.0 * test::kDegree;
  EXPECT_GT(worst(judge(Standstill().to(q).plan()), "stability margin"), 0.3);
  Plan plan = Standstill().to(q).plan();
  for (WholeBodyNode& node : plan.nodes) node.contacts[static_cast<std::size_t>(Limb::kRF)] = false;
  EXPECT_CAUGHT(judge(plan), "stability margin");
}

TEST(PlanChecker, FindsAJointBeyondItsLimit) {
  Plan plan = driving();
  plan.nodes[7].q[coordinate("BOOM")] = 1.30;
  const CheckReport report = judge(plan);
  EXPECT_CAUGHT(report, "joint beyond its limit");
  EXPECT_NEAR(worst(report, "joint beyond its limit"), 0.02, 1e-6);
  EXPECT_EQ(report.find("joint beyond its limit")->subject, "BOOM");
}

TEST(PlanChecker, FindsAJointThatIsTooFast) {
  Plan plan = driving();
  plan.nodes[7].q[coordinate("TURN")] = 0.5;  // 0.4 s from its neighbours: 1.25 rad/s
  const CheckReport report = judge(plan);
  EXPECT_ONLY(report, "joint rate / its limit");
  EXPECT_EQ(report.find("joint rate / its limit")->subject, "TURN");
}

TEST(PlanChecker, FindsABaseThatJumps) {
  Plan plan = driving();
  for (std::size_t i = 20; i < plan.nodes.size(); ++i) plan.nodes[i].q[kBaseX] += 1.0;
  plan.task.goal.x_m += 1.0;
  const CheckReport report = judge(plan);
  EXPECT_CAUGHT(report, "base speed");
  EXPECT_CAUGHT(report, "standing wheel slides");
}

TEST(PlanChecker, FindsContactsThatSlideSideways) {
  Plan plan = driving();
  for (std::size_t i = 20; i < plan.nodes.size(); ++i) plan.nodes[i].q[kBaseY] += 0.2;
  plan.task.goal.y_m += 0.2;
  const CheckReport report = judge(plan);
  EXPECT_CAUGHT(report, "standing wheel slides");
  EXPECT_NEAR(worst(report, "side slip / travel"), 100.0 * 0.2 / 10.0, 0.05);
}

TEST(PlanChecker, FindsWheelsThatDoNotTurn) {
  Plan plan = driving();
  for (WholeBodyNode& node : plan.nodes) {
    for (const WheeledLeg& leg : test::machine().legs) node.q[leg.wheel] = 0.0;
  }
  EXPECT_NEAR(worst(judge(plan), "wheel turn off travel"), 100.0, 1e-3);
  EXPECT_CAUGHT(judge(plan), "standing wheel slides");
}

TEST(PlanChecker, FindsTimeThatGoesBack) {
  Plan plan = driving();
  plan.nodes[30].t_s = plan.nodes[29].t_s - 0.1;
  EXPECT_CAUGHT(judge(plan), "time step");
}

TEST(PlanChecker, FindsAnEndThatIsNotTheTask) {
  Plan plan = driving();
  plan.task.goal.y_m = 0.02;
  EXPECT_ONLY(judge(plan), "goal: distance");
  plan = driving();
  plan.task.start.yaw_rad = 2.0 * test::kDegree;
  EXPECT_ONLY(judge(plan), "start: yaw");
}

TEST(PlanChecker, FindsTooMuchTilt) {
  Plan plan = driving();
  for (WholeBodyNode& node : plan.nodes) node.q[kBasePitch] = 21.0 * test::kDegree;
  EXPECT_CAUGHT(judge(plan), "tilt");
}

TEST(PlanChecker, FindsABoulderUnderTheChassis) {
  const auto boulder = [](double height_m) {
    return make_raster([height_m](double x, double y) {
      return std::max(0.0, height_m - 2.0 * std::hypot(x, y));
    });
  };
  EXPECT_ACCEPTED(judge(driving(), boulder(0.5)));
  const CheckReport report = judge(driving(), boulder(0.58));
  EXPECT_ONLY(report, "chassis above ground");
  EXPECT_NEAR(worst(report, "chassis above ground"), 0.02, 0.005);
}

TEST(PlanChecker, FindsTheArmInTheGround) {
  EXPECT_CAUGHT(judge(Standstill().to(bucket_ahead(0.4)).to(bucket_ahead(-0.3)).plan()),
                "lifted bucket above ground");
}

TEST(PlanChecker, FindsLimbsThatCollide) {
  Eigen::VectorXd q = standing();
  q[coordinate("TURN")] = 40.0 * test::kDegree;
  q[coordinate("BOOM")] = 0.3;
  q[coordinate("DIPPER")] = -1.0;
  q[coordinate("EE_PITCH")] = -0.5;  // the bucket in the left front wheel
  const CheckReport report = judge(Standstill().to(q).plan());
  EXPECT_CAUGHT(report, "distance between limbs");
}

TEST(PlanChecker, KnowsNothingOfWhereTheMapLies) {
  Raster moved = make_raster();
  moved.map_origin_m = {500000.0, 5000000.0};
  const CheckReport here = judge(front_pair_on_the_bucket());
  const CheckReport there = judge(front_pair_on_the_bucket(), moved);
  ASSERT_EQ(here.findings.size(), there.findings.size());
  for (std::size_t i = 0; i < here.findings.size(); ++i) {
    EXPECT_EQ(here.findings[i].worst, there.findings[i].worst) << here.findings[i].rule;
  }
}

}  // namespace
}  // namespace wex::check
