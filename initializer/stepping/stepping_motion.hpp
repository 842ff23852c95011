#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "initializer/leg_table.hpp"
#include "initializer/stepping/certificate.hpp"
#include "models/types/plan.hpp"

namespace wex {

/// Where a certified sequence could not be turned into a motion of the whole body, and why.
struct MotionFailure {
  std::size_t state = 0;  ///< index into CertifiedSequence::states
  std::string why;        ///< part of a sentence
  bool arm = false;       ///< another bucket point may do
};

/// How limbs move when they are not simply driving.
struct SteppingMotionSettings {
  double swing_clearance_m = 0.10;  ///< lifted tyres and links above the ground
  double self_collision_m = 0.10;   ///< between limbs, and limb and chassis
  /// Between capsules of cabin and wheels, which together are at least 0.12 m wider than what they
  /// cover; hind wheels pass that close when the base is low.
  double cabin_overlap_m = 0.05;
  double max_node_step_m = 0.2;         ///< of the base; limbs move at most 0.1 m (0.1 rad) a node
  double bucket_approach_m = 0.3;       ///< the bucket comes down this far vertically ...
  double bucket_lowering_m_s = 0.05;    ///< ... at this speed, and stands still for a moment
  double contact_change_pause_s = 1.0;  ///< load is confirmed before the next limb is lifted
  double rate_fraction = 0.8;           ///< of every joint's rate limit
  double stepping_speed_m_s = 0.15;     ///< of the base with a wheel in the air
  double max_base_acceleration_m_s2 = 0.3;
  double steering_window_m = 2.0;  ///< curvature is averaged over this, or less where it must
  double base_window_m = 1.5;      ///< base height, pitch and roll, twice in a row
};

/// Turns certified sequences into motions of the whole body. Tables are built once; queries do not
/// change it and are safe for concurrent use.
class SteppingMotion {
 public:
  /// terrain and machine must outlive it.
  ///   errors  kBadInput: legs that cannot be put on the ground, an arm that is not a plane chain
  [[nodiscard]] static Result<SteppingMotion> build(const TerrainMap& terrain,
                                                    const MachineModel& machine,
                                                    const PlanSettings& settings,
                                                    const SteppingMotionSettings& motion = {});
  /// The same with tables of the machine's legs that were built before.
  [[nodiscard]] static Result<SteppingMotion> build(const TerrainMap& terrain,
                                                    const MachineModel& machine,
                                                    const PlanSettings& settings,
                                                    std::array<LegTable, kNumWheels> legs,
                                                    const SteppingMotionSettings& motion = {});
  ~SteppingMotion();
  SteppingMotion(SteppingMotion&&) noexcept;

  /// Whole-body nodes of a certified sequence, timed from zero: wheels on their contacts by inverse
  /// kinematics, one contact change between successive nodes, lifted wheels and the arm along
  /// checked paths (ground, own limbs, stability), the bucket fixed in the world while it stands,
  /// cabin slews on four wheels. Durations obey joint, wheel, steering and pump limits.
  ///   sequence  starts and ends on four wheels (contract)
  [[nodiscard]] Result<std::vector<WholeBodyNode>, MotionFailure> nodes(
      const CertifiedSequence& sequence) const;

 private:
  struct Impl;
  explicit SteppingMotion(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// The same in one call; tables are built anew.
[[nodiscard]] Result<std::vector<WholeBodyNode>, MotionFailure> stepping_motion(
    const TerrainMap& terrain, const MachineModel& machine, const PlanSettings& settings,
    const CertifiedSequence& sequence, const SteppingMotionSettings& motion = {});

}  // namespace wex
