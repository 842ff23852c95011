#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "models/terrain/raster_io.hpp"
#include "models/types/plan.hpp"
#include "tools/check/motion.hpp"

namespace wex::check {

/// Whose motion is judged; every kind has its own limits (README).
enum class MotionKind { kPlan, kRefined, kExecuted };

/// The worst of one rule over a motion.
struct Finding {
  std::string rule, unit;
  bool at_least = false;  ///< the limit is a lower one
  bool binding = true;    ///< false: reported, never a violation
  bool observed = false;  ///< false: nothing in the motion was subject to the rule
  double limit = 0.0, tolerance = 0.0;
  double worst = 0.0;
  int violations = 0;                      ///< postures beyond limit and tolerance
  double t_s = 0.0, x_m = 0.0, y_m = 0.0;  ///< where the worst is, map frame
  std::string subject;                     ///< limb, joint or pair of bodies
};

struct CheckReport {
  MotionKind kind = MotionKind::kPlan;
  bool accepted = false;
  std::vector<Finding> findings;
  int rows = 0, postures = 0;  ///< of the motion; looked at
  double cpu_s = 0.0;

  [[nodiscard]] const Finding* find(const std::string& rule) const;
  /// The violated rule that most postures break, as one sentence; empty if accepted.
  [[nodiscard]] std::string verdict() const;
};

/// Judges motions against a machine's exported MJCF and a raw elevation map, by MuJoCo's kinematics
/// and its own view of the ground; knows nothing of the planners. Rows are taken to be joined by
/// straight lines (base attitude along the great arc) and looked at every centimetre that base, a
/// wheel or the bucket moves. One at a time: a checker holds the state of its machine.
class PlanChecker {
 public:
  /// errors  kBadInput: a model that MuJoCo refuses, or that lacks a site or joint the checks need
  [[nodiscard]] static Result<PlanChecker> create(const std::string& mjcf, const Raster& raster);
  PlanChecker(PlanChecker&&) noexcept;
  ~PlanChecker();

  [[nodiscard]] const std::vector<std::string>& joint_names() const noexcept;

  /// motion  at least two rows, joints as joint_names() says (contract)
  /// task    local frame, as the motion
  [[nodiscard]] CheckReport check(const Motion& motion, const Task& task, MotionKind kind);

 private:
  struct Impl;
  explicit PlanChecker(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Checks what `wex plan` or `wex run` left in a folder: model.xml, result.json (start and goal)
/// and plan.csv, refined.csv or executed.csv.
///   errors  kBadInput naming file and line, column or key
[[nodiscard]] Result<CheckReport> check_plan(const std::filesystem::path& folder,
                                             const std::filesystem::path& map, MotionKind kind);

/// Checks a plan in memory. The machine is exported to MJCF and read back, as a file would be.
///   raster  the map the plan was made on
[[nodiscard]] Result<CheckReport> check_plan(const MachineModel& machine, const Raster& raster,
                                             const Plan& plan);

}  // namespace wex::check
