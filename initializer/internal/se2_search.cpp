#include "initializer/internal/se2_search.hpp"

#include <ompl/base/MotionValidator.h>
#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/goals/GoalState.h>
#include <ompl/base/samplers/InformedStateSampler.h>
#include <ompl/base/spaces/ReedsSheppStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/util/Console.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>

#include "initializer/internal/ompl_planners.hpp"

namespace wex {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;
using StateSe2 = ob::SE2StateSpace::StateType;

constexpr double kGoalToleranceM = 1e-6;  // only the goal itself is the goal

Pose2 pose_of(const ob::State* state) {
  const auto* s = state->as<StateSe2>();
  return {s->getX(), s->getY(), s->getYaw()};
}

void set_pose(ob::State* state, const Pose2& pose) {
  auto* s = state->as<StateSe2>();
  s->setXY(pose.x_m, pose.y_m);
  s->setYaw(wrap_angle(pose.yaw_rad));
}

// Reeds-Shepp curves to steer along; distance plus weighted yaw to find neighbours by.
class SteeringSpace : public ob::ReedsSheppStateSpace {
 public:
  SteeringSpace(double turning_radius_m, double yaw_weight_m_rad)
      : ob::ReedsSheppStateSpace(turning_radius_m), yaw_weight_m_rad_(yaw_weight_m_rad) {}

  double distance(const ob::State* a, const ob::State* b) const override {
    const Pose2 p = pose_of(a), q = pose_of(b);
    return std::hypot(p.x_m - q.x_m, p.y_m - q.y_m) +
           yaw_weight_m_rad_ * std::abs(wrap_angle(p.yaw_rad - q.yaw_rad));
  }

  [[nodiscard]] DrivePath path(const ob::State* a, const ob::State* b) const {
    const ReedsSheppPath curve = reedsShepp(a, b);
    DrivePath path;
    Pose2 pose = pose_of(a);
    for (int i = 0; i < 5; ++i) {
      if (curve.type_[i] == RS_NOP || curve.length_[i] == 0.0) continue;
      const double turn =
          curve.type_[i] == RS_LEFT ? 1.0 : (curve.type_[i] == RS_RIGHT ? -1.0 : 0.0);
      path.push_back({pose, turn / rho_, curve.length_[i] * rho_});
      pose = pose_along(path.back(), path.back().length_m);
    }
    if (path.empty()) path.push_back({pose, 0.0, 0.0});
    return path;
  }

 private:
  double yaw_weight_m_rad_;
};

// Uniform over the bounds; once a path is known, only where a shorter one could pass.
class SeededSampler : public ob::StateSampler {
 public:
  SeededSampler(const ob::StateSpace* space, const SearchSettings& settings, const Pose2& start,
                const Pose2& goal, const double& best_cost_m, std::uint64_t seed)
      : ob::StateSampler(space),
        settings_(settings),
        start_(start),
        goal_(goal),
        best_cost_m_(best_cost_m),
        generator_(seed) {}

  void sampleUniform(ob::State* state) override {
    constexpr int kMaxTries = 100;
    Pose2 pose;
    for (int i = 0; i < kMaxTries; ++i) {
      pose = {uniform(settings_.x_min_m, settings_.x_max_m),
              uniform(settings_.y_min_m, settings_.y_max_m), uniform(-M_PI, M_PI)};
      const double through_m = std::hypot(pose.x_m - start_.x_m, pose.y_m - start_.y_m) +
                               std::hypot(pose.x_m - goal_.x_m, pose.y_m - goal_.y_m);
      if (through_m <= best_cost_m_) break;
    }
    set_pose(state, pose);
  }
  void sampleUniformNear(ob::State* state, const ob::State* near, double distance) override {
    const Pose2 p = pose_of(near);
    set_pose(state, {p.x_m + uniform(-distance, distance), p.y_m + uniform(-distance, distance),
                     p.yaw_rad + uniform(-distance, distance)});
    space_->enforceBounds(state);
  }
  void sampleGaussian(ob::State* state, const ob::State* mean, double deviation) override {
    sampleUniformNear(state, mean, deviation);
  }

 private:
  // Spelled out rather than std::uniform_real_distribution: the same on every standard library.
  double uniform(double low, double high) {
    constexpr double kUnit = 1.0 / 9007199254740992.0;  // 2^-53
    return low + (high - low) * kUnit * static_cast<double>(generator_() >> 11);
  }

  const SearchSettings& settings_;
  Pose2 start_, goal_;
  const double& best_cost_m_;
  std::mt19937_64 generator_;
};

// For BIT*: the space's own sampler, which knows where a shorter path could pass; OMPL's default
// would draw from a sampler of its own that no seed reaches.
class InformedBySpace : public ob::InformedSampler {
 public:
  InformedBySpace(const ob::ProblemDefinitionPtr& problem, unsigned max_calls)
      : ob::InformedSampler(problem, max_calls), sampler_(space_->allocStateSampler()) {}
  bool sampleUniform(ob::State* state, const ob::Cost&) override {
    sampler_->sampleUniform(state);
    return true;
  }
  bool sampleUniform(ob::State* state, const ob::Cost&, const ob::Cost& most) override {
    return sampleUniform(state, most);
  }
  [[nodiscard]] bool hasInformedMeasure() const override { return false; }
  [[nodiscard]] double getInformedMeasure(const ob::Cost&) const override {
    return space_->getMeasure();
  }

 private:
  ob::StateSamplerPtr sampler_;
};

class PathValidator : public ob::MotionValidator {
 public:
  PathValidator(const ob::SpaceInformationPtr& si, const SteeringSpace* space, double spacing_m,
                const PoseValidity& is_valid)
      : ob::MotionValidator(si), space_(space), spacing_m_(spacing_m), is_valid_(is_valid) {}

  bool checkMotion(const ob::State* a, const ob::State* b) const override {
    return path_is_valid(space_->path(a, b), spacing_m_, is_valid_);
  }
  bool checkMotion(const ob::State* a, const ob::State* b,
                   std::pair<ob::State*, double>& last_valid) const override {
    const bool valid = checkMotion(a, b);
    last_valid.second = valid ? 1.0 : 0.0;
    if (last_valid.first != nullptr) space_->copyState(last_valid.first, valid ? b : a);
    return valid;
  }

 private:
  const SteeringSpace* space_;
  double spacing_m_;
  const PoseValidity& is_valid_;
};

// Cost of driving along the Reeds-Shepp curve. The default cost-to-go of OMPL would be the
// neighbour distance, which overestimates arcs and so cuts off optimal branches.
class DrivingCost : public ob::OptimizationObjective {
 public:
  DrivingCost(const ob::SpaceInformationPtr& si, const SteeringSpace* space,
              const SearchSettings& settings, const Pose2& goal)
      : ob::OptimizationObjective(si), space_(space), settings_(settings) {
    description_ = "driving cost";
    setCostToGoHeuristic([this, goal](const ob::State* state, const ob::Goal*) {
      const Pose2 p = pose_of(state);
      const double turn = std::abs(wrap_angle(goal.yaw_rad - p.yaw_rad));
      return ob::Cost(std::max(std::hypot(goal.x_m - p.x_m, goal.y_m - p.y_m),
                               settings_.turning_radius_m * turn));
    });
  }
  ob::Cost stateCost(const ob::State*) const override { return identityCost(); }
  ob::Cost motionCost(const ob::State* a, const ob::State* b) const override {
    return ob::Cost(path_cost_m(space_->path(a, b), settings_.cost));
  }
  ob::InformedSamplerPtr allocInformedStateSampler(const ob::ProblemDefinitionPtr& problem,
                                                   unsigned max_calls) const override {
    return std::make_shared<InformedBySpace>(problem, max_calls);
  }

 private:
  const SteeringSpace* space_;
  const SearchSettings& settings_;
};

}  // namespace

DrivePath reeds_shepp_path(const Pose2& from, const Pose2& to, double turning_radius_m) {
  const SteeringSpace space(turning_radius_m, 1.0);
  ob::State* a = space.allocState();
  ob::State* b = space.allocState();
  set_pose(a, from);
  set_pose(b, to);
  DrivePath path = space.path(a, b);
  space.freeState(a);
  space.freeState(b);
  const double whole_turns = from.yaw_rad - path.front().start.yaw_rad;
  for (PathSegment& segment : path) segment.start.yaw_rad += whole_turns;
  return path;
}

bool path_is_valid(const DrivePath& path, double spacing_m, const PoseValidity& is_valid) {
  struct Subnode {
    Pose2 pose;
    double curvature_1_m;
  };
  std::vector<Subnode> subnodes;
  for (const PathSegment& segment : path) {
    const int steps =
        std::max(1, static_cast<int>(std::ceil(std::abs(segment.length_m) / spacing_m - 1e-9)));
    for (int k = 0; k <= steps; ++k) {  // both ends: the steering differs from the neighbour's
      subnodes.push_back(
          {pose_along(segment, segment.length_m * k / steps), segment.curvature_1_m});
    }
  }
  const std::size_t n = subnodes.size();
  if (!is_valid(subnodes.back().pose, subnodes.back().curvature_1_m)) return false;
  for (std::size_t stride = 16; stride > 0; stride /= 2) {
    for (std::size_t i = 0; i + 1 < n; i += stride) {
      const bool seen = stride < 16 && i % (2 * stride) == 0;
      if (!seen && !is_valid(subnodes[i].pose, subnodes[i].curvature_1_m)) return false;
    }
  }
  return true;
}

struct Se2Search::Impl {
  Pose2 start, goal;
  SearchSettings settings;
  PoseValidity is_valid;
  double best_cost_m = std::numeric_limits<double>::infinity();
  std::shared_ptr<SteeringSpace> space;
  std::shared_ptr<ob::ProblemDefinition> problem;
  AnytimePlanner planner;
  std::string failure;

  void build(std::uint64_t seed) {
    space = std::make_shared<SteeringSpace>(settings.turning_radius_m, settings.yaw_weight_m_rad);
    ob::RealVectorBounds bounds(2);
    bounds.setLow(0, settings.x_min_m);
    bounds.setHigh(0, settings.x_max_m);
    bounds.setLow(1, settings.y_min_m);
    bounds.setHigh(1, settings.y_max_m);
    space->setBounds(bounds);
    space->setStateSamplerAllocator([this, seed](const ob::StateSpace* s) {
      return std::make_shared<SeededSampler>(s, settings, start, goal, best_cost_m, seed);
    });

    auto si = std::make_shared<ob::SpaceInformation>(space);
    si->setStateValidityChecker(
        [this](const ob::State* state) { return is_valid(pose_of(state), 0.0); });
    si->setMotionValidator(
        std::make_shared<PathValidator>(si, space.get(), settings.subnode_spacing_m, is_valid));
    si->setup();

    problem = std::make_shared<ob::ProblemDefinition>(si);
    ob::State* state = space->allocState();
    set_pose(state, start);
    problem->addStartState(state);
    set_pose(state, goal);
    auto goal_state = std::make_shared<ob::GoalState>(si);
    goal_state->setState(state);
    goal_state->setThreshold(kGoalToleranceM);
    space->freeState(state);
    problem->setGoal(goal_state);
    problem->setOptimizationObjective(
        std::make_shared<DrivingCost>(si, space.get(), settings, goal));

    planner = make_planner(si, problem, settings, seed);
  }

  std::optional<DrivePath> solution() {
    if (!problem->hasExactSolution()) return std::nullopt;
    const auto geometric = std::static_pointer_cast<og::PathGeometric>(problem->getSolutionPath());
    DrivePath path;
    for (std::size_t i = 0; i + 1 < geometric->getStateCount(); ++i) {
      append_path(path, space->path(geometric->getState(static_cast<unsigned>(i)),
                                    geometric->getState(static_cast<unsigned>(i + 1))));
    }
    const double whole_turns = start.yaw_rad - path.front().start.yaw_rad;
    for (PathSegment& segment : path) segment.start.yaw_rad += whole_turns;
    return path;
  }
};

Se2Search::Se2Search(const Pose2& start, const Pose2& goal, const SearchSettings& settings,
                     PoseValidity is_valid, std::uint64_t seed)
    : impl_(std::make_unique<Impl>()) {
  impl_->start = start;
  impl_->goal = goal;
  impl_->settings = settings;
  impl_->is_valid = std::move(is_valid);
  try {
    ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
    impl_->build(seed);
  } catch (const std::exception& e) {
    impl_->failure = e.what();
  }
}

Se2Search::~Se2Search() = default;

int Se2Search::iterations() const {
  return impl_->planner.planner ? impl_->planner.iterations() : 0;
}

double Se2Search::best_cost_m() const {
  const double cost_m = impl_->planner.planner ? impl_->planner.best_cost_m() : HUGE_VAL;
  return std::isfinite(cost_m) ? cost_m : HUGE_VAL;
}

Result<std::optional<DrivePath>> Se2Search::find_cheaper_than(double cost_m,
                                                              const std::function<bool()>& stop) {
  if (!impl_->failure.empty()) {
    return fail(ErrorCode::kInternal, "OMPL failed: " + impl_->failure);
  }
  try {
    bool stopped = false;
    const ob::PlannerTerminationCondition done([&] {
      const double best_m = best_cost_m();
      impl_->best_cost_m = best_m;
      if (best_m < cost_m) return true;
      stopped = stop();
      return stopped;
    });
    impl_->problem->clearSolutionPaths();
    impl_->planner.planner->solve(done);
    if (stopped && !(best_cost_m() < cost_m)) return std::nullopt;
    return impl_->solution();
  } catch (const std::exception& e) {
    impl_->failure = e.what();
    return fail(ErrorCode::kInternal, "OMPL failed: " + impl_->failure);
  }
}

}  // namespace wex
