#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "initializer/found_plan.hpp"
#include "initializer/internal/se2_search.hpp"
#include "initializer/make_plan.hpp"
#include "initializer/pose_check.hpp"
#include "initializer/search_census.hpp"
#include "initializer/stepping/certificate.hpp"
#include "initializer/stepping/certified_tree.hpp"
#include "initializer/stepping/stepping_motion.hpp"

namespace wex {

/// One search for a plan: direct paths, then an RRT# tree for driving and one for stepping in
/// turns, then the tree of certified states; every path found is made a whole-body plan and
/// verified, and the cheapest plan kept. One thread. Refers to everything it is given.
class PlanSearch {
 public:
  PlanSearch(const TerrainMap& terrain, const MachineModel& machine, const Task& task,
             const PlanSettings& settings, const std::function<void(const PlanProgress&)>& observer,
             const PoseCheck& check, const BaseCoordinates& standing_at_start, double begin_s,
             SearchAids aids = {});

  /// errors  kNoPlan with what blocked it; kBadInput: a machine that cannot step;
  ///         kInternal: OMPL failed
  [[nodiscard]] Result<Plan> run();
  [[nodiscard]] const SearchCensus& census() const noexcept { return census_; }
  /// Of the plan that run() gave, if it steps.
  [[nodiscard]] const std::optional<CertifiedSequence>& sequence() const noexcept {
    return best_sequence_;
  }
  /// Of every plan that was the best of its time, the last one's at the end.
  [[nodiscard]] const std::vector<DrivePath>& paths() const noexcept { return paths_; }
  /// Null if stepping was never looked at.
  [[nodiscard]] const std::shared_ptr<const StanceTables>& tables() const noexcept {
    return aids_.tables;
  }

 private:
  enum Kind : std::size_t { kDriving = 0, kStepping = 1 };
  struct Block {
    Pose2 pose;
    double radius_m;
  };
  /// A tree that is grown in slices, and started anew when a path of it fails.
  struct Tree {
    std::unique_ptr<Se2Search> search;
    double wanted_m = 0.0;
    int iterations_before = 0;  ///< of earlier trees of this kind
    std::vector<Block> blocks;
    int num_rejections = 0;
  };

  [[nodiscard]] double elapsed_s() const;
  [[nodiscard]] bool out_of_budget();
  [[nodiscard]] int iterations() const;
  void report();

  [[nodiscard]] bool blocked(Kind kind, const Pose2& pose);
  [[nodiscard]] bool can_drive(const Pose2& pose, double curvature_1_m);
  [[nodiscard]] bool can_step(const Pose2& pose, double curvature_1_m);
  [[nodiscard]] bool heads_squarely(const Pose2& pose) const;

  [[nodiscard]] Result<void> build_certifier();
  [[nodiscard]] bool may_step() const;
  [[nodiscard]] Result<void> try_given_paths();
  [[nodiscard]] Result<void> try_direct_paths();
  [[nodiscard]] Result<void> grow(Kind kind);
  void grow_certified_tree();

  bool consider_driving(const DrivePath& path);
  bool consider_stepping(const DrivePath& path);
  bool consider_sequence(CertifiedSequence sequence);
  [[nodiscard]] std::optional<Objection> objection_to(const CertifiedSequence& sequence,
                                                      std::optional<Plan>& plan) const;
  bool keep(Plan plan, const DrivePath& path, std::optional<CertifiedSequence> sequence);
  void reject(Kind kind, const Pose2& where, const std::string& why);
  [[nodiscard]] Plan finished();

  const TerrainMap& terrain_;
  const MachineModel& machine_;
  const Task& task_;
  const PlanSettings& settings_;
  const std::function<void(const PlanProgress&)>& observer_;
  const PoseCheck& check_;
  std::optional<Certifier> certifier_;  ///< built when driving does not do, as is the next
  std::optional<SteppingMotion> motion_;
  BaseCoordinates standing_at_start_;
  SearchSettings search_settings_;
  std::array<PoseCheck::Steering, 3> steering_;  ///< right, straight, left

  double begin_s_, reported_s_ = 0.0, improved_s_ = 0.0, lower_bound_m_ = 0.0;
  std::optional<Plan> best_;
  std::optional<CertifiedSequence> best_sequence_;
  std::array<Tree, 2> trees_;
  std::unique_ptr<CertifiedTree> certified_tree_;
  std::uint64_t num_trees_ = 0;
  SearchCensus census_;
  SearchAids aids_;
  std::vector<DrivePath> paths_;
};

}  // namespace wex
