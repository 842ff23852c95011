#include "tools/check/plan_checker.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "models/excavator/mjcf.hpp"
#include "models/types/cpu_clock.hpp"
#include "tools/check/motion_judge.hpp"
#include "tools/check/rules.hpp"

namespace wex::check {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
const std::string kMachine = "machine";

}  // namespace

struct PlanChecker::Impl {
  CheckedMachine machine;
  CheckedGround ground;
  Eigen::Vector2d map_origin_m;
  std::vector<std::string> joint_names;
};

namespace {

void judge_end(const Motion::Row& row, const Pose2& pose, Rule distance, Rule yaw,
               Findings& findings) {
  findings.at(row.t_s, row.p_base.x(), row.p_base.y());
  findings.observe(distance, std::hypot(row.p_base.x() - pose.x_m, row.p_base.y() - pose.y_m),
                   kMachine);
  const Eigen::Matrix3d R = row.R_base.toRotationMatrix();
  const double yaw_rad = std::atan2(R(1, 0), R(0, 0));
  findings.observe(yaw, std::abs(wrap_angle(yaw_rad - pose.yaw_rad)) / kDegree, kMachine);
}

Result<std::string> read_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (!stream || !(text << stream.rdbuf())) {
    return fail(ErrorCode::kBadInput, file.string() + ": cannot be read");
  }
  return text.str();
}

const char* file_of(MotionKind kind) {
  switch (kind) {
    case MotionKind::kPlan:
      return "plan.csv";
    case MotionKind::kRefined:
      return "refined.csv";
    case MotionKind::kExecuted:
      break;
  }
  return "executed.csv";
}

}  // namespace

PlanChecker::PlanChecker(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
PlanChecker::PlanChecker(PlanChecker&&) noexcept = default;
PlanChecker::~PlanChecker() = default;

Result<PlanChecker> PlanChecker::create(const std::string& mjcf, const Raster& raster) {
  Result<CheckedMachine> machine = CheckedMachine::load(mjcf);
  if (!machine) return tl::unexpected(machine.error());
  std::vector<std::string> names;
  for (const CheckedJoint& joint : machine->joints()) names.push_back(joint.name);
  return PlanChecker(
      std::make_unique<Impl>(Impl{std::move(*machine), CheckedGround(raster.elevation),
                                  raster.map_origin_m, std::move(names)}));
}

const std::vector<std::string>& PlanChecker::joint_names() const noexcept {
  return impl_->joint_names;
}

CheckReport PlanChecker::check(const Motion& motion, const Task& task, MotionKind kind) {
  WEX_EXPECTS(motion.rows.size() >= 2 && motion.joint_names == impl_->joint_names);
  const double begin_s = thread_cpu_time_s();
  Findings findings(kind, impl_->map_origin_m);
  judge_end(motion.rows.front(), task.start, Rule::kStartDistance, Rule::kStartYaw, findings);
  judge_end(motion.rows.back(), task.goal, Rule::kGoalDistance, Rule::kGoalYaw, findings);
  CheckReport report;
  report.kind = kind;
  report.rows = static_cast<int>(motion.rows.size());
  report.postures = judge_motion(impl_->machine, impl_->ground, motion, findings);
  report.findings = findings.take();
  report.accepted = std::none_of(report.findings.begin(), report.findings.end(),
                                 [](const Finding& f) { return f.violations > 0; });
  report.cpu_s = thread_cpu_time_s() - begin_s;
  return report;
}

const Finding* CheckReport::find(const std::string& rule) const {
  const auto found = std::find_if(findings.begin(), findings.end(),
                                  [&](const Finding& f) { return f.rule == rule; });
  return found == findings.end() ? nullptr : &*found;
}

std::string CheckReport::verdict() const {
  const auto worst = std::max_element(
      findings.begin(), findings.end(),
      [](const Finding& a, const Finding& b) { return a.violations < b.violations; });
  if (worst == findings.end() || worst->violations == 0) return "";
  std::ostringstream text;
  text.precision(3);
  text << worst->rule << ": " << worst->worst << ' ' << worst->unit << " ("
       << (worst->at_least ? "at least " : "at most ") << worst->limit << ") at t = " << std::fixed
       << worst->t_s << " s, x = " << worst->x_m << ", y = " << worst->y_m << ", "
       << worst->subject;
  return text.str();
}

Result<CheckReport> check_plan(const std::filesystem::path& folder,
                               const std::filesystem::path& map, MotionKind kind) {
  Result<Raster> raster = read_raster(map);
  if (!raster) return tl::unexpected(raster.error());
  if (raster->elevation.size_x < 2 || raster->elevation.size_y < 2) {
    return fail(ErrorCode::kBadInput, map.string() + ": has fewer than 2 x 2 cells");
  }
  const std::filesystem::path model_file = folder / "model.xml";
  const Result<std::string> mjcf = read_text(model_file);
  if (!mjcf) return tl::unexpected(mjcf.error());
  Result<PlanChecker> checker = PlanChecker::create(*mjcf, *raster);
  if (!checker) {
    return fail(checker.error().code, model_file.string() + ": " + checker.error().message);
  }
  Result<Task> task = read_result_task(folder / "result.json");
  if (!task) return tl::unexpected(task.error());
  for (Pose2* pose : {&task->start, &task->goal}) {
    pose->x_m -= raster->map_origin_m.x();
    pose->y_m -= raster->map_origin_m.y();
  }
  const Result<Motion> motion =
      read_motion(folder / file_of(kind), checker->joint_names(), raster->map_origin_m);
  if (!motion) return tl::unexpected(motion.error());
  return checker->check(*motion, *task, kind);
}

Result<CheckReport> check_plan(const MachineModel& machine, const Raster& raster,
                               const Plan& plan) {
  const Result<std::string> mjcf = machine_mjcf(machine);
  if (!mjcf) return tl::unexpected(mjcf.error());
  Result<PlanChecker> checker = PlanChecker::create(*mjcf, raster);
  if (!checker) return tl::unexpected(checker.error());
  const Result<Motion> motion = motion_from(machine, plan.nodes);
  if (!motion) return tl::unexpected(motion.error());
  if (motion->rows.size() < 2) return fail(ErrorCode::kBadInput, "a plan of fewer than two nodes");
  return checker->check(*motion, plan.task, MotionKind::kPlan);
}

}  // namespace wex::check
