#include "tools/check/rules.hpp"

#include <limits>

namespace wex::check {
namespace {

constexpr double kReported = std::numeric_limits<double>::quiet_NaN();

struct RuleText {
  const char* name;
  const char* unit;
  bool at_least;
  double tolerance;
  std::array<double, 3> limits;  ///< plan, refined, executed; kReported: no limit
};

// In the order of Rule. Limits are those of the decisions; tolerances cover what interpolation
// between nodes and another way to fit or measure may do.
constexpr std::array<RuleText, kNumRules> kRules{{
    {"time step", "s", true, 0.0, {1e-6, 1e-6, 1e-6}},
    {"start: distance", "m", false, 0.0, {0.01, 0.01, 0.3}},
    {"start: yaw", "deg", false, 0.0, {1.0, 1.0, 5.0}},
    {"goal: distance", "m", false, 0.0, {0.01, 0.01, 0.3}},
    {"goal: yaw", "deg", false, 0.0, {1.0, 1.0, 5.0}},
    {"base speed", "m/s", false, 0.05, {1.5, 1.5, 1.5}},
    {"joint rate / its limit", "", false, 0.05, {1.0, 1.0, kReported}},
    {"joint beyond its limit", "rad, m", false, 1e-3, {0.0, 0.0, 0.02}},
    {"passive joint off its coupling", "rad", false, 0.0, {2e-3, 2e-3, 0.02}},
    {"tyre slide moves", "m", false, 0.0, {1e-3, 1e-3, kReported}},
    {"tilt", "deg", false, 0.1, {20.0, 20.0, 20.0}},
    {"stability margin", "m", true, 0.01, {0.30, 0.25, 0.15}},
    {"limbs that carry", "", true, 0.0, {3.0, 3.0, 3.0}},
    {"contact changes in a row", "", false, 0.0, {1.0, 1.0, kReported}},
    {"contact on unknown ground", "", false, 0.0, {0.0, 0.0, 0.0}},
    {"slope under a contact", "deg", false, 0.5, {30.0, 30.0, 30.0}},
    {"contact to untraversable", "m", true, 0.03, {0.15, 0.15, 0.0}},
    {"wheel above ground, rows", "m", false, 0.0, {0.02, 0.04, 0.04}},
    {"wheel in the ground, rows", "m", true, 0.0, {-0.02, -0.03, -0.03}},
    {"wheel above ground, between", "m", false, 0.0, {0.05, 0.04, 0.04}},
    {"wheel in the ground, between", "m", true, 0.0, {-0.05, -0.03, -0.03}},
    {"wheel touches down from", "m", false, 0.0, {0.05, 0.05, kReported}},
    {"standing wheel slides", "m/s", false, 0.0, {0.40, 0.10, kReported}},
    {"side slip / travel", "%", false, 0.0, {kReported, 2.0, 5.0}},
    {"wheel turn off travel", "%", false, 0.0, {kReported, 2.0, kReported}},
    {"bucket off the ground, rows", "m", false, 0.0, {0.02, 0.04, kReported}},
    {"bucket off the ground, between", "m", false, 0.0, {0.05, 0.04, kReported}},
    {"bucket moves while it stands", "m", false, 0.0, {0.05, 0.01, 0.15}},
    {"lifted limb near its foothold", "m", true, 0.0, {-0.05, -0.05, kReported}},
    {"swing clearance", "m", true, 0.01, {0.10, 0.10, 0.0}},
    {"chassis above ground", "m", true, 0.01, {0.05, 0.05, 0.0}},
    {"leg or arm above ground", "m", true, 0.0, {0.0, 0.0, 0.0}},
    {"lifted bucket above ground", "m", true, 0.0, {0.0, 0.0, 0.0}},
    {"distance between limbs", "m", true, 0.0, {0.0, 0.0, 0.0}},
}};

}  // namespace

Findings::Findings(MotionKind kind, const Eigen::Vector2d& map_origin_m)
    : map_origin_m_(map_origin_m) {
  for (const RuleText& rule : kRules) {
    Finding finding;
    finding.rule = rule.name;
    finding.unit = rule.unit;
    finding.at_least = rule.at_least;
    finding.tolerance = rule.tolerance;
    finding.limit = rule.limits[static_cast<std::size_t>(kind)];
    finding.binding = finding.limit == finding.limit;
    findings_.push_back(std::move(finding));
  }
}

void Findings::note(Finding& finding, double value, const std::string& subject) {
  finding.observed = true;
  finding.worst = value;
  finding.t_s = t_s_;
  finding.x_m = x_m_ + map_origin_m_.x();
  finding.y_m = y_m_ + map_origin_m_.y();
  finding.subject = subject;
}

}  // namespace wex::check
