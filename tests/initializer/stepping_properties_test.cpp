// What must hold of stances and their projection whatever the ground.
#include <gtest/gtest.h>

#include <random>

#include "initializer/stepping/certificate.hpp"
#include "test_worlds.hpp"

namespace wex {
namespace {

using Admission = Certifier::Admission;

/// Bumps, and a ditch across them that must be stepped over.
double broken_ground(double x, double y) {
  return std::abs(x + 0.2 * y - 1.0) < 0.9 ? -3.0 : 0.9 * bumps(x, y);
}

struct Query {
  Pose2 pose;
  double curvature_1_m = 0.0;
};

const std::vector<Query>& queries() {
  static const std::vector<Query> all = [] {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> x(-5.0, 6.0), y(-2.5, 2.5), turn(-3.1, 3.1),
        small(-0.3, 0.3);
    std::vector<Query> made;
    for (int k = 0; k < 150; ++k) {
      // Half of them head for the ditch; a third each turn left, right or not.
      made.push_back({{x(random), y(random), k % 2 == 0 ? 0.2 + small(random) : turn(random)},
                      (k % 3 - 1) / 4.5});
    }
    return made;
  }();
  return all;
}

Certifier certifier_on(const TerrainMap& map, const PlanSettings& settings = {}) {
  auto certifier = Certifier::build(map, test_machine(), settings);
  if (!certifier) throw std::runtime_error(certifier.error().message);
  return *std::move(certifier);
}

/// How often each answer was given, so that no property holds for want of cases.
struct Answers {
  int refused = 0, stepping = 0, driving = 0;
  void count(Admission admission) {
    ++(admission == Admission::kRefused         ? refused
       : admission == Admission::kNeedsStepping ? stepping
                                                : driving);
  }
  void expect_all_kinds() const {
    EXPECT_GE(refused, 10);
    EXPECT_GE(stepping, 10);
    EXPECT_GE(driving, 10);
  }
};

TEST(SteppingProperties, MirroredTerrainGivesMirroredFeasibility) {
  const TerrainMap map = make_map(24.0, 16.0, broken_ground);
  const TerrainMap mirror =
      make_map(24.0, 16.0, [](double x, double y) { return broken_ground(x, -y); });
  const Certifier left = certifier_on(map), right = certifier_on(mirror);
  Answers answers;
  for (const auto& [pose, curvature] : queries()) {
    const Admission here = left.admits(pose, curvature);
    answers.count(here);
    EXPECT_EQ(here, right.admits({pose.x_m, -pose.y_m, -pose.yaw_rad}, -curvature))
        << pose.x_m << " " << pose.y_m << " " << pose.yaw_rad << " " << curvature;
  }
  answers.expect_all_kinds();
}

TEST(SteppingProperties, ShiftingMapAndPoseTogetherChangesNothing) {
  const Eigen::Vector2d shift(107.3, -54.9);
  const double up_m = 321.0;
  const TerrainMap map = make_map(24.0, 16.0, broken_ground);
  const TerrainMap moved =
      make_map(24.0, 16.0, [&](double x, double y) { return broken_ground(x, y) + up_m; }, shift);
  const Certifier here = certifier_on(map), there = certifier_on(moved);
  Answers answers;
  for (const auto& [pose, curvature] : queries()) {
    const Admission admission = here.admits(pose, curvature);
    answers.count(admission);
    EXPECT_EQ(admission,
              there.admits({pose.x_m + shift.x(), pose.y_m + shift.y(), pose.yaw_rad}, curvature))
        << pose.x_m << " " << pose.y_m << " " << pose.yaw_rad;
  }
  answers.expect_all_kinds();
}

TEST(SteppingProperties, AskingForMoreNeverMakesAnInfeasiblePoseFeasible) {
  const TerrainMap map = make_map(24.0, 16.0, broken_ground);
  const auto never_more = [&](const char* name, double PlanSettings::* demand,
                              const std::vector<double>& rising) {
    SCOPED_TRACE(name);
    std::vector<Admission> before;
    int lost = 0;
    for (const double value : rising) {
      PlanSettings settings;
      settings.*demand = value;
      const Certifier certifier = certifier_on(map, settings);
      for (std::size_t k = 0; k < queries().size(); ++k) {
        const Admission now = certifier.admits(queries()[k].pose, queries()[k].curvature_1_m);
        if (before.size() == k) {
          before.push_back(now);
          continue;
        }
        if (before[k] == Admission::kRefused) {
          EXPECT_EQ(now, Admission::kRefused) << "query " << k << " at " << value;
        } else if (now == Admission::kRefused) {
          ++lost;
        }
        before[k] = now;
      }
    }
    EXPECT_GE(lost, 5) << "it makes no difference";
  };
  never_more("stability", &PlanSettings::min_stability_margin_m, {0.1, 0.3, 0.6, 0.9});
  never_more("edges", &PlanSettings::min_signed_distance_m, {0.05, 0.15, 0.3, 0.5});
  never_more("belly", &PlanSettings::belly_clearance_m, {0.0, 0.05, 0.4, 0.8});
}

TEST(SteppingProperties, ARaisedMarginNeverMakesAPathFeasible) {
  // Square over a gap: the sequence found at a margin keeps every smaller one, too.
  const TerrainMap map =
      make_map(30.0, 12.0, [](double x, double) { return std::abs(x) < 1.0 ? -4.0 : 0.0; });
  const DrivePath path{{{-7.5, 0.0, 0.0}, 0.0, 15.0}};
  bool feasible = true;
  int changes = 0;
  for (const double margin_m : {0.1, 0.3, 0.5, 0.7, 1.2}) {
    PlanSettings settings;
    settings.min_stability_margin_m = margin_m;
    const auto sequence = certifier_on(map, settings).certify(path);
    if (sequence) {
      EXPECT_TRUE(feasible) << margin_m;
      EXPECT_GE(sequence->min_margin_m, margin_m);
    }
    changes += sequence.has_value() != feasible ? 1 : 0;
    feasible = sequence.has_value();
  }
  EXPECT_FALSE(feasible) << "no machine of this size has 1.2 m on three contacts";
  EXPECT_EQ(changes, 1);
}

}  // namespace
}  // namespace wex
