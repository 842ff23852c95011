#pragma once

#include <optional>
#include <string>
#include <vector>

#include "initializer/stepping/arm_kinematics.hpp"
#include "initializer/stepping/footing.hpp"
#include "initializer/stepping/stance_ground.hpp"
#include "initializer/stepping/stepping_motion.hpp"
#include "models/excavator/collision_model.hpp"

namespace wex {

/// Moves of cabin and arm while the base stands: checked against the ground, own limbs, stability.
/// One per thread: it keeps a workspace.
class ArmMover {
 public:
  ArmMover(const MachineModel& machine, const ArmKinematics& arm, const CollisionModel& collision,
           const StanceGround& ground, double min_margin_m, const SteppingMotionSettings& motion);

  /// What is wrong with a posture; nullptr if nothing.
  ///   q                 everything but the arm; the arm's coordinates are overwritten
  ///   bucket_on_ground  the bucket may touch
  [[nodiscard]] const char* fault(const Footing& footing, Eigen::VectorXd& q,
                                  const ArmPosture& posture, bool bucket_on_ground);

  /// Postures from one to another, both included, successive ones at most 0.1 rad (0.1 m) apart:
  /// straight if that is clear, else fold, slew, unfold, each in the first order of joints that is.
  ///   errors  what is in the way of the last one tried
  [[nodiscard]] Result<std::vector<ArmPosture>, std::string> path(const Footing& footing,
                                                                  const Eigen::VectorXd& q,
                                                                  const ArmPosture& from,
                                                                  const ArmPosture& to);

  /// Postures from straight above a contact down to the one that stands on it.
  ///   errors  the bucket cannot come down there, and why
  [[nodiscard]] Result<std::vector<ArmPosture>, std::string> lowering(const Footing& footing,
                                                                      const Eigen::VectorXd& q,
                                                                      const ArmPosture& standing);

 private:
  using Joints = ArmKinematics::Joints;
  const char* find_fault(const Footing& footing, Eigen::VectorXd& q, const ArmPosture& posture,
                         bool bucket_on_ground);
  bool append_clear_line(const Footing& footing, const Joints& to, std::vector<Joints>& path);
  bool append_fold(const Footing& footing, Joints fold, std::vector<Joints>& path);
  bool append_slew(const Footing& footing, double turn_rad, std::vector<Joints>& path);

  /// The posture with the bucket moved in the world, and another choice of the null space.
  [[nodiscard]] std::optional<ArmPosture> shifted(const Footing& footing, const ArmPosture& posture,
                                                  double up_m, double out_m, double tele_step_m,
                                                  double attitude_step_rad) const;
  [[nodiscard]] std::string why();

  const MachineModel& machine_;
  const ArmKinematics& arm_;
  const CollisionModel& collision_;
  const StanceGround& ground_;
  double min_margin_m_;
  SteppingMotionSettings motion_;
  KinematicTree::Workspace workspace_;
  std::vector<int> arm_capsules_;
  Eigen::VectorXd q_, q_fault_;
  const char* last_fault_ = "";
};

}  // namespace wex
