#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "tools/check/plan_checker.hpp"

namespace wex::check {

/// Every rule, in the order of the report.
enum class Rule {
  kTimeStep,
  kStartDistance,
  kStartYaw,
  kGoalDistance,
  kGoalYaw,
  kBaseSpeed,
  kJointRate,
  kJointLimit,
  kCoupling,
  kTyreSlide,
  kTilt,
  kStability,
  kCarrying,
  kContactChanges,
  kUnknownGround,
  kGroundSlope,
  kUntraversableDistance,
  kWheelAboveAtRows,
  kWheelBelowAtRows,
  kWheelAboveBetween,
  kWheelBelowBetween,
  kTouchDown,
  kSlide,
  kSideSlip,
  kRollingError,
  kBucketHeightAtRows,
  kBucketHeightBetween,
  kBucketDrift,
  kNearFoothold,
  kSwingClearance,
  kChassisClearance,
  kLimbClearance,
  kBucketClearance,
  kSelfDistance,
  kCount
};
inline constexpr std::size_t kNumRules = static_cast<std::size_t>(Rule::kCount);

/// Collects the worst value of every rule and where it is.
class Findings {
 public:
  Findings(MotionKind kind, const Eigen::Vector2d& map_origin_m);

  /// Where the values that follow are from (local frame).
  void at(double t_s, double x_m, double y_m) {
    t_s_ = t_s;
    x_m_ = x_m;
    y_m_ = y_m;
  }
  void observe(Rule rule, double value, const std::string& subject) {
    Finding& finding = findings_[static_cast<std::size_t>(rule)];
    const double sign = finding.at_least ? -1.0 : 1.0;
    // Negated, so that a value that is not a number is the worst of all.
    const bool within = sign * value <= sign * finding.limit + finding.tolerance;
    if (!within && finding.binding) ++finding.violations;
    if (finding.observed && sign * value <= sign * finding.worst) return;
    note(finding, value, subject);
  }
  /// A value better than this cannot change the report.
  [[nodiscard]] double relevant_below(Rule rule) const {
    const Finding& finding = findings_[static_cast<std::size_t>(rule)];
    if (!finding.observed) return kFar;
    return std::max(finding.worst, finding.limit);
  }
  [[nodiscard]] std::vector<Finding> take() { return std::move(findings_); }

  /// Distances beyond this are of no interest and reported as this [m].
  static constexpr double kFar = 0.5;

 private:
  void note(Finding& finding, double value, const std::string& subject);

  Eigen::Vector2d map_origin_m_;
  std::vector<Finding> findings_;
  double t_s_ = 0.0, x_m_ = 0.0, y_m_ = 0.0;
};

}  // namespace wex::check
