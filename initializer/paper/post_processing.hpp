#pragma once

#include <memory>
#include <string>
#include <vector>

#include "initializer/drive_path.hpp"
#include "initializer/paper/paper_check.hpp"
#include "models/types/plan.hpp"

namespace wex {

/// Where a path of the base is lost on its way to a plan.
enum class PaperStage {
  kStance,    ///< Algorithm 2 refuses a station of the path
  kSchedule,  ///< no place for a full contact phase between two sets of contacts
  kLegs,      ///< a wheel's inverse kinematics
  kBucket,    ///< no common bucket point, or out of reach along its phase
  kArm,       ///< no way for the arm over its roadmap
  kVerified,  ///< the finished plan does not pass verify_plan
};
inline constexpr std::size_t kNumPaperStages = 6;
[[nodiscard]] const char* describe(PaperStage stage) noexcept;

struct PaperFailure {
  PaperStage stage{};
  Pose2 where;
  std::string why;        ///< part of a sentence
  bool stepping = false;  ///< the path asks for other contacts than four wheels somewhere
};

/// The paper's post-processing: from a path of the base to a motion of the whole body. Contacts
/// change one at a time, standing; in between a full contact phase; one bucket point for the whole
/// of a contact phase, halfway between the closest pair of roadmap positions at its two ends;
/// inverse kinematics at every node; the arm moves over its roadmap, what collides left out. The
/// base follows Algorithm 1 from node to node as it comes. One per thread: it keeps workspaces.
class PostProcessing {
 public:
  /// All must outlive it; roadmaps and check of the same machine and terrain (contract).
  ///   errors  kBadInput: as PaperCheck::build
  [[nodiscard]] static Result<PostProcessing> build(const TerrainMap& terrain,
                                                    const MachineModel& machine,
                                                    const Roadmaps& roadmaps,
                                                    const PaperCheck& check,
                                                    const PlanSettings& settings);
  ~PostProcessing();
  PostProcessing(PostProcessing&&) noexcept;

  /// Whole-body nodes of a path, timed from zero.
  [[nodiscard]] Result<std::vector<WholeBodyNode>, PaperFailure> nodes(const DrivePath& path);

 private:
  struct Impl;
  explicit PostProcessing(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace wex
