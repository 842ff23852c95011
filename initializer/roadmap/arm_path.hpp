#pragma once

#include <Eigen/Core>
#include <memory>
#include <type_traits>
#include <vector>

#include "initializer/roadmap/limb_roadmap.hpp"
#include "models/excavator/machine_model.hpp"
#include "models/types/result.hpp"

namespace wex {

struct ArmPathSettings {
  double max_step = 0.05;     ///< rad or m between postures looked at along a motion
  int nearest_vertices = 24;  ///< of the roadmap, tried as ways in and out
  /// Of the estimate of what is left; above 1: fewer postures looked at, longer ways.
  double heuristic_weight = 2.0;
  int max_checks = 3500;  ///< postures looked at before giving up
};

/// A motion of the arm: postures in ArmLimb::coordinates order, straight in joint space between
/// them. Continuous joints (the cabin) run on beyond a turn, so that differences are the motion.
struct ArmPath {
  std::vector<Eigen::VectorXd> postures;  ///< from start to goal; those two at least
  double duration_s = 0.0;                ///< if every joint moves at its fastest rate between them
  int checks = 0;                         ///< postures looked at
  int vertices = 0;                       ///< of the roadmap closed by the search; 0: direct
};

enum class ArmPathError {
  kStartInvalid,
  kGoalInvalid,
  kNoPath,  ///< nothing else is reachable over the roadmap
  kTooManyChecks
};

/// Arm motions from posture to posture with base and legs fixed: straight in joint space if that is
/// valid, the cabin turning either way; else by A* over the arm's roadmap, whose vertices and edges
/// are judged by the caller only when the search comes to them; the way found is cut short. A
/// search reuses its memory: one object per thread. Deterministic.
class ArmPathPlanner {
 public:
  /// Both must outlive the planner; `arm` is the arm's roadmap of that machine (contract).
  ArmPathPlanner(const MachineModel& machine, const LimbRoadmap& arm,
                 const ArmPathSettings& settings = {});
  ~ArmPathPlanner();
  ArmPathPlanner(ArmPathPlanner&&) noexcept;
  ArmPathPlanner& operator=(ArmPathPlanner&&) noexcept;

  /// start, goal  in ArmLimb::coordinates order; the goal is met up to whole turns of continuous
  ///              joints
  /// valid        bool(const Eigen::VectorXd& arm_q): whether the arm may be there
  template <typename Valid>
  [[nodiscard]] Result<ArmPath, ArmPathError> plan(const Eigen::VectorXd& start,
                                                   const Eigen::VectorXd& goal, Valid&& valid) {
    using Predicate = std::remove_reference_t<Valid>;
    const Validity validity{const_cast<void*>(static_cast<const void*>(std::addressof(valid))),
                            [](void* predicate, const Eigen::VectorXd& q) -> bool {
                              return (*static_cast<Predicate*>(predicate))(q);
                            }};
    return plan_with(start, goal, validity);
  }

 private:
  struct Validity {
    void* predicate;
    bool (*call)(void*, const Eigen::VectorXd&);
  };
  [[nodiscard]] Result<ArmPath, ArmPathError> plan_with(const Eigen::VectorXd& start,
                                                        const Eigen::VectorXd& goal,
                                                        const Validity& valid);
  struct Search;
  std::unique_ptr<Search> search_;
};

}  // namespace wex
