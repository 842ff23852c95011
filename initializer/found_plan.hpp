#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "initializer/drive_path.hpp"
#include "initializer/make_plan.hpp"
#include "initializer/pose_check.hpp"
#include "models/types/pose.hpp"

namespace wex {

struct StanceTables;

/// What a search before this one found that helps it, and how much is asked of it.
struct SearchAids {
  std::shared_ptr<const StanceTables> tables;  ///< of the machine; null: built when needed
  std::vector<DrivePath> paths;                ///< from start to goal, tried before all others
  std::optional<BaseCoordinates> begin;        ///< base at the start, if not Algorithm 1's
  bool first_will_do = false;                  ///< the first plan ends the search
  std::optional<DrivePath> hopeless;           ///< known not to do
  bool other_paths = true;  ///< false: none but `paths`, nothing that must be searched for
};

/// A plan with what a later search can use.
struct FoundPlan {
  Plan plan;
  std::vector<DrivePath> paths;  ///< of every plan that was the best of its time; last: of `plan`
  std::shared_ptr<const StanceTables> tables;  ///< null if stepping was never looked at
};

/// make_plan without the paper's mode: what it is made of, and what it can be given.
///   check  of this terrain and machine, with these settings (contract)
///   errors as make_plan
[[nodiscard]] Result<FoundPlan> find_plan(const TerrainMap& terrain, const MachineModel& machine,
                                          const Task& task, const PlanSettings& settings,
                                          const PoseCheck& check, SearchAids aids,
                                          const std::function<void(const PlanProgress&)>& observer,
                                          double begin_s);

/// What is wrong with the first unusable setting; empty if nothing is.
[[nodiscard]] std::string settings_complaint(const PlanSettings& settings);

}  // namespace wex
