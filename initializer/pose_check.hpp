#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "initializer/leg_table.hpp"
#include "initializer/make_plan.hpp"
#include "models/excavator/machine_model.hpp"
#include "models/terrain/terrain_map.hpp"
#include "models/types/pose.hpp"

namespace wex {

/// Why the machine cannot stand somewhere. In the order of "how far it got".
enum class Rejection {
  kNone = 0,
  kOffMap,
  kUnknownGround,
  kTilt,
  kUntraversable,
  kNearUntraversable,
  kOutOfReach,
  kSteeringLimit,
  kBelly,
  kUnstable,
};
inline constexpr std::size_t kNumRejections = 10;

/// The machine on its four wheels. Meaningful beyond `rejection` and `wheel` only if it can stand.
struct StandingPose {
  Rejection rejection = Rejection::kNone;
  int wheel = -1;                                            ///< the wheel to blame, -1 if none
  Eigen::Vector2d where_world_xy = Eigen::Vector2d::Zero();  ///< what the rejection is about [m]
  BaseCoordinates base = BaseCoordinates::Zero();
  std::array<double, kNumWheels> hfe_rad{}, steer_rad{};
  double stability_margin_m = 0.0;

  [[nodiscard]] bool ok() const noexcept { return rejection == Rejection::kNone; }
};

/// One sentence part, such as "wheel LF would stand on untraversable ground at (1.0, 2.0)".
///   map_origin_m  added to positions, so that the reader gets them in the frame of the map file
[[nodiscard]] std::string describe(const StandingPose& pose, const Eigen::Vector2d& map_origin_m);
/// The same without the place, for counts.
[[nodiscard]] std::string describe(Rejection rejection);

/// Roll and pitch of a base whose z axis is the given unit normal, at the given yaw.
struct Tilt {
  double roll_rad = 0.0, pitch_rad = 0.0;
};
[[nodiscard]] Tilt tilt_from_normal(const Eigen::Vector3d& normal_world, double yaw_rad);

/// Can the machine stand on its four wheels, arm in transport posture? The paper's Algorithm 1
/// (candidate heights and normals) and Algorithm 2 for four contacts. Refers to terrain and
/// machine, which must outlive it. Immutable, allocation-free queries, safe for concurrent use.
class PoseCheck {
 public:
  using Steering = std::array<LegTable::Steer, kNumWheels>;

  /// errors  kBadInput: a machine whose legs cannot be put on the ground by hip flexion
  [[nodiscard]] static Result<PoseCheck> build(const TerrainMap& terrain,
                                               const MachineModel& machine,
                                               const PlanSettings& settings);
  /// The same with tables of the machine's legs that were built before.
  PoseCheck(const TerrainMap& terrain, const MachineModel& machine, const PlanSettings& settings,
            std::array<LegTable, kNumWheels> legs);

  /// Base height, roll and pitch by Algorithm 1: of all candidates that can stand the one with the
  /// lowest cost, so that a demand which is dropped never makes a pose fail. Where legs do not
  /// reach or the chassis is too low, also the plane under the four wheels, up to 0.4 m higher. If
  /// none can stand, the rejection is that of the candidate with the lowest cost.
  [[nodiscard]] StandingPose stand(const Pose2& pose, const Steering& steering) const;

  /// The same with the base given: wheels on the ground by hip flexion, then every check.
  [[nodiscard]] StandingPose check(const BaseCoordinates& base, const Steering& steering) const;

  /// All-wheel steering for a curvature of the base's path [1/m].
  [[nodiscard]] Steering steering_for(double curvature_1_m,
                                      const std::array<double, kNumWheels>& hfe_rad) const;
  [[nodiscard]] std::array<double, kNumWheels> default_hfe_rad() const;

  [[nodiscard]] const std::array<LegTable, kNumWheels>& legs() const noexcept { return legs_; }

 private:
  struct Grounding {
    Rejection rejection = Rejection::kNone;
    double hfe_rad = 0.0;
    Eigen::Vector3d p_world_wheel = Eigen::Vector3d::Zero();
  };
  /// All four legs of one base pose and what Algorithm 1 charges for it.
  struct Trial {
    std::array<Grounding, kNumWheels> legs;
    double cost = 0.0;
    int num_ungrounded = 0;
  };

  struct GroundPlane {
    Tilt tilt;
    double height_m = 0.0;  ///< under the base origin; NaN where a wheel has no known ground
  };

  [[nodiscard]] Grounding ground_leg(const Eigen::Isometry3d& T_world_base, int leg,
                                     const LegTable::Steer& steer) const;
  void settle(const Eigen::Isometry3d& T_world_base, int leg, const LegTable::Steer& steer,
              Grounding& grounding) const;
  [[nodiscard]] GroundPlane plane_under_wheels(const Pose2& pose) const;
  [[nodiscard]] Rejection ground_under(const Eigen::Vector2d& p_world_xy) const;
  [[nodiscard]] Trial try_base(const BaseCoordinates& base, const Eigen::Isometry3d& T_world_base,
                               const Steering& steering) const;
  [[nodiscard]] StandingPose judge(const BaseCoordinates& base,
                                   const Eigen::Isometry3d& T_world_base, const Trial& trial,
                                   const Steering& steering) const;
  [[nodiscard]] Rejection ground_under_belly(const Eigen::Isometry3d& T_world_base) const;
  [[nodiscard]] double stability_margin(const Eigen::Isometry3d& T_world_base, const Trial& trial,
                                        const Steering& steering) const;

  const TerrainMap* terrain_;
  const MachineModel* machine_;
  PlanSettings settings_;
  std::array<LegTable, kNumWheels> legs_;
  Eigen::Vector3d moment_base_ = Eigen::Vector3d::Zero();  ///< kg m, every leg at hfe = steer = 0
  double mass_kg_ = 0.0;
  std::vector<Eigen::Vector3d> p_base_belly_;  ///< samples of the chassis' underside
};

/// Signed distance of a point to the nearest edge line of the quadrilateral LF, LH, RH, RF;
/// positive inside [m].
[[nodiscard]] double support_margin_m(const Eigen::Vector2d& p,
                                      const std::array<Eigen::Vector2d, kNumWheels>& contacts);

}  // namespace wex
