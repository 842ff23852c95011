#include "initializer/internal/ompl_planners.hpp"

#include <ompl/base/goals/GoalSampleableRegion.h>
#include <ompl/datastructures/NearestNeighborsLinear.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/prm/PRMstar.h>
#include <ompl/geometric/planners/rrt/RRTsharp.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>

#include <memory>
#include <type_traits>

namespace wex {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

std::uint_fast32_t own_seed(std::uint64_t seed) { return static_cast<std::uint_fast32_t>(seed); }

// Trees whose only own random draws (goal bias) follow the seed.
class SeededRrtSharp : public og::RRTsharp {
 public:
  SeededRrtSharp(const ob::SpaceInformationPtr& si, std::uint64_t seed) : og::RRTsharp(si) {
    rng_.setLocalSeed(own_seed(seed));
  }
};

class SeededRrtStar : public og::RRTstar {
 public:
  SeededRrtStar(const ob::SpaceInformationPtr& si, std::uint64_t seed) : og::RRTstar(si) {
    rng_.setLocalSeed(own_seed(seed));
  }
};

// PRM* in one thread: OMPL's solve() looks for solutions in a second one, so that neither its time
// nor its result could be told beforehand.
class SteppedPrmStar : public og::PRMstar {
 public:
  explicit SteppedPrmStar(const ob::SpaceInformationPtr& si) : og::PRMstar(si) {}

  [[nodiscard]] int num_iterations() const { return static_cast<int>(iterations_); }
  [[nodiscard]] double best_cost() const { return bestCost_.value(); }

  ob::PlannerStatus solve(const ob::PlannerTerminationCondition& done) override {
    checkValidity();
    if (startM_.empty()) begin();
    ob::PathPtr path;
    maybeConstructSolution(startM_, goalM_, path);
    while (!done) {
      ++iterations_;
      ob::State* state = si_->allocState();
      simpleSampler_->sampleUniform(state);
      if (!si_->isValid(state)) {
        si_->freeState(state);
        continue;
      }
      addMilestone(state);
      if (milestoneCount() % kMilestonesPerLook == 0) {
        maybeConstructSolution(startM_, goalM_, path);
      }
    }
    if (!path) return ob::PlannerStatus::TIMEOUT;
    pdef_->addSolutionPath(path, false, 0.0, getName());
    return ob::PlannerStatus::EXACT_SOLUTION;
  }

 private:
  static constexpr unsigned long kMilestonesPerLook = 4;

  void begin() {
    simpleSampler_ = si_->allocStateSampler();
    bestCost_ = opt_->infiniteCost();
    while (const ob::State* start = pis_.nextStart()) {
      startM_.push_back(addMilestone(si_->cloneState(start)));
    }
    while (const ob::State* goal = pis_.nextGoal()) {
      goalM_.push_back(addMilestone(si_->cloneState(goal)));
    }
  }
};

template <typename Planner>
AnytimePlanner set_up(const std::shared_ptr<Planner>& planner,
                      const ob::ProblemDefinitionPtr& problem) {
  planner->setProblemDefinition(problem);
  // Needs the problem definition set. BIT* has a kind of its own, which OMPL does not let out.
  if constexpr (!std::is_same_v<Planner, og::BITstar>) {
    planner->template setNearestNeighbors<ompl::NearestNeighborsLinear>();
  }
  planner->setup();
  return {planner, [planner] { return static_cast<int>(planner->numIterations()); },
          [planner] { return planner->bestCost().value(); }};
}

}  // namespace

AnytimePlanner make_planner(const ob::SpaceInformationPtr& si,
                            const ob::ProblemDefinitionPtr& problem, const SearchSettings& settings,
                            std::uint64_t seed) {
  switch (settings.planner) {
    case PlannerKind::kRrtSharp: {
      auto planner = std::make_shared<SeededRrtSharp>(si, seed);
      planner->setRange(settings.range_m);
      planner->setGoalBias(settings.goal_bias);
      return set_up(planner, problem);
    }
    case PlannerKind::kRrtStar: {
      auto planner = std::make_shared<SeededRrtStar>(si, seed);
      planner->setRange(settings.range_m);
      planner->setGoalBias(settings.goal_bias);
      return set_up(planner, problem);
    }
    case PlannerKind::kBitStar:
      return set_up(std::make_shared<og::BITstar>(si), problem);
    case PlannerKind::kPrmStar: {
      auto planner = std::make_shared<SteppedPrmStar>(si);
      planner->setProblemDefinition(problem);
      planner->setNearestNeighbors<ompl::NearestNeighborsLinear>();
      planner->setup();
      return {planner, [planner] { return planner->num_iterations(); },
              [planner] { return planner->best_cost(); }};
    }
  }
  WEX_EXPECTS(false);
  return {};
}

}  // namespace wex
