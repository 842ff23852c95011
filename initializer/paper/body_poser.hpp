#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>

#include "initializer/paper/leg_inverse.hpp"
#include "initializer/paper/paper_check.hpp"
#include "initializer/stepping/arm_kinematics.hpp"
#include "initializer/stepping/footing.hpp"
#include "initializer/stepping/wheel_placer.hpp"

namespace wex {

/// A leg on the ground, and the base it belongs to.
struct StandingLeg {
  BaseCoordinates base;
  LegJoints joints;
};

/// Whole-body poses for the post-processing: legs at vertices or on the ground, the arm where it
/// is. One per thread.
class BodyPoser {
 public:
  /// All must outlive it.
  ///   errors  kBadInput: legs or arm of another kind
  [[nodiscard]] static Result<BodyPoser> build(const TerrainMap& terrain,
                                               const MachineModel& machine,
                                               const Roadmaps& roadmaps, const PaperCheck& check,
                                               const PlanSettings& settings);

  [[nodiscard]] LegJoints vertex_joints(std::size_t leg, int vertex) const;
  /// On the ground: hips as in transport posture if the wheel can stand so, which is where the
  /// vertices nearest to default lead; else as it stood before; else spread as at the first vertex
  /// of those that touch that can be steered to roll along the path; else steered as at the first
  /// that touches.
  ///   clear   whether the leg keeps away from the machine's other limbs
  ///   before  if given: the wheel stood so one station earlier, and must get here on the ground
  [[nodiscard]] Result<LegJoints, const char*> standing(
      const BaseCoordinates& base, double curvature_1_m, std::size_t leg,
      const std::function<bool(const LegJoints&)>& clear,
      const std::optional<StandingLeg>& before = std::nullopt);
  [[nodiscard]] double clearance_m(const BaseCoordinates& base, std::size_t leg,
                                   const LegJoints& joints) {
    return inverse_.clearance_m(base, leg, joints);
  }
  [[nodiscard]] LegJoints read_leg(const Eigen::VectorXd& q, std::size_t leg) const;
  void write_leg(const LegJoints& joints, std::size_t leg, Eigen::VectorXd& q) const;
  [[nodiscard]] ArmPosture vertex_posture(int vertex) const;

  /// The machine at q standing on some contacts.
  [[nodiscard]] Footing footing(const Eigen::VectorXd& q, const ContactFlags& contacts);

  [[nodiscard]] const ArmKinematics& arm() const noexcept { return arm_; }
  [[nodiscard]] const StanceGround& ground() const noexcept { return placer_.ground(); }

 private:
  BodyPoser(const TerrainMap& terrain, const MachineModel& machine, const Roadmaps& roadmaps,
            const PaperCheck& check, WheelPlacer placer, ArmKinematics arm,
            double min_signed_distance_m);

  [[nodiscard]] bool stays_on_ground(const StandingLeg& from, const StandingLeg& to,
                                     std::size_t leg);

  const TerrainMap* terrain_;
  const MachineModel* machine_;
  const Roadmaps* roadmaps_;
  const PaperCheck* check_;
  WheelPlacer placer_;
  ArmKinematics arm_;
  LegInverse inverse_;
  KinematicTree::Workspace workspace_;
};

}  // namespace wex
