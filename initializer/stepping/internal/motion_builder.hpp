#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "initializer/stepping/arm_kinematics.hpp"
#include "initializer/stepping/arm_motion.hpp"
#include "initializer/stepping/base_motion.hpp"
#include "initializer/stepping/bucket_phase.hpp"
#include "initializer/stepping/counterweight.hpp"
#include "initializer/stepping/motion_nodes.hpp"
#include "initializer/stepping/stepping_motion.hpp"
#include "initializer/stepping/wheel_placer.hpp"
#include "models/excavator/collision_model.hpp"

namespace wex {

/// What a motion is made with; built once per terrain and machine.
struct MotionParts {
  const TerrainMap& terrain;
  const MachineModel& machine;
  PlanSettings settings;
  SteppingMotionSettings motion;
  WheelPlacer placer;
  ArmKinematics arm;
  CollisionModel collision;
};

/// A run with everything decided but the nodes.
struct PreparedRun {
  BaseRun base;
  std::optional<BucketPath> bucket;
  std::vector<HeldPosture> held;  ///< arm in the air: transport posture, or counterweights
};

/// Makes the untimed nodes of one sequence.
class MotionBuilder {
 public:
  MotionBuilder(const MotionParts& parts, const CertifiedSequence& sequence,
                double steering_window_m);
  [[nodiscard]] Result<std::vector<MotionNode>, MotionFailure> build();
  /// Whether it failed because of wheels that found no ground to stand on or to clear.
  [[nodiscard]] bool missed_ground() const { return missed_ground_; }

 private:
  using Done = Result<void, MotionFailure>;
  using Hips = std::array<double, kNumWheels>;

  // What is decided before any node is made.
  Done prepare(PreparedRun& run);
  Done prepare_support(PreparedRun& run);
  Done raise_legs_clear(BaseRun& run);
  // As the machine stands in workspace_, of the ground.
  bool leg_clear(std::size_t leg, double clearance_m, bool claw_only) const;
  bool tyre_rests(std::size_t wheel) const;
  std::optional<std::string> judge(const BaseRun& run, const BaseKnot& knot);
  Result<std::vector<BucketStance>, MotionFailure> stances(const BaseRun& run);

  // Poses of the whole body; wheel angles stay zero.
  Result<WheelPlacement, PlacementFailure> placed(const BaseRun::Point& point, std::uint8_t lifted,
                                                  const Hips& lifted_hfe_rad);
  Eigen::VectorXd posture(const BaseRun::Point& point, const WheelPlacement& placement,
                          const ArmPosture& arm) const;
  Result<Eigen::VectorXd, std::string> posture_at(const PreparedRun& run, double sigma_m,
                                                  const ArmPosture* held);
  Result<Footing, MotionFailure> footing(const BaseRun& run, std::size_t knot, std::uint8_t lifted);

  // Nodes.
  void add(const Eigen::VectorXd& q, double duration_s = 0.0);  // at least so long from the last
  void lift_contact(std::size_t limb);                          // after a pause
  void set_contact(std::size_t limb);
  Done drive(const PreparedRun& run);
  Done drive_between(const PreparedRun& run, const ArmPosture* held, double sigma_0,
                     const Eigen::VectorXd& q_0, double sigma_1, const Eigen::VectorXd& q_1,
                     int depth);
  bool needs_a_node_between(const PreparedRun& run, const Eigen::VectorXd& q_0,
                            const Eigen::VectorXd& q_1, const Eigen::VectorXd& q_middle) const;
  Done step_onto(const PreparedRun& run);
  Done step_off(const PreparedRun& run, const ArmPosture& next);
  Done move_wheels(const PreparedRun& run, std::size_t knot, bool up);
  Done move_arm(const Footing& footing, const ArmPosture& to);
  ArmPosture arm_now() const { return parts_.arm.posture_of(nodes_.back().q); }
  ArmPosture bucket_posture(const PreparedRun& run, std::size_t knot) const;
  double bucket_height_m(const Footing& footing, const ArmPosture& arm) const;
  Result<ArmPosture, MotionFailure> arm_after(const std::vector<PreparedRun>& runs,
                                              std::size_t on_wheels);
  [[nodiscard]] tl::unexpected<MotionFailure> failure(std::string why) const {
    return tl::unexpected<MotionFailure>({state_, std::move(why)});
  }
  [[nodiscard]] tl::unexpected<MotionFailure> arm_failure(std::string why) const {
    return tl::unexpected<MotionFailure>({state_, std::move(why), true});
  }

  const MotionParts& parts_;
  const CertifiedSequence& sequence_;
  ArmMover mover_;
  KinematicTree::Workspace workspace_;
  Eigen::VectorXd transport_;  // whole body
  Hips guess_rad_;
  std::vector<MotionNode> nodes_;
  ContactFlags contacts_ = kDrivingContacts;
  double speed_m_s_ = 0.0;
  std::size_t state_ = 0;
  double steering_window_m_;
  bool missed_ground_ = false;
};

}  // namespace wex
