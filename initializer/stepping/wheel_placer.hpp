#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "initializer/leg_table.hpp"
#include "initializer/make_plan.hpp"
#include "initializer/stepping/stance_ground.hpp"
#include "models/excavator/machine_model.hpp"
#include "models/terrain/terrain_map.hpp"
#include "models/types/limbs.hpp"

namespace wex {

/// Legs of one base pose: hip flexion and steering, and what they mean for stability.
struct WheelPlacement {
  std::array<double, kNumWheels> hfe_rad{}, steer_rad{};
  std::array<Eigen::Vector3d, kNumWheels> p_world_patch;  ///< where tyres touch; lifted: unused
  Eigen::Vector3d moment_base;  ///< mass times centre of mass of all but cabin and arm [kg m]
};

/// What keeps a wheel or the chassis from being where it should.
struct PlacementFailure {
  int wheel = -1;  ///< -1: the chassis
  const char* why = "";
};

/// Puts wheels where a schedule wants them: on the ground by hip flexion, the disc resting on it,
/// or lifted clear of it. Refers to terrain and machine, which must outlive it. Immutable, no
/// allocation in queries, safe for concurrent use.
class WheelPlacer {
 public:
  /// errors  kBadInput: legs that cannot be put on the ground
  [[nodiscard]] static Result<WheelPlacer> build(const TerrainMap& terrain,
                                                 const MachineModel& machine,
                                                 const PlanSettings& settings);
  /// The same with tables of the machine's legs that were built before.
  WheelPlacer(const TerrainMap& terrain, const MachineModel& machine, const PlanSettings& settings,
              std::array<LegTable, kNumWheels> legs);

  /// Legs at a base pose, wheels of `lifted` at the given hip flexion, the others resting.
  ///   guess  hip flexion of a similar pose
  [[nodiscard]] Result<WheelPlacement, PlacementFailure> place(
      const BaseCoordinates& base, double curvature_1_m, std::uint8_t lifted,
      const std::array<double, kNumWheels>& lifted_hfe_rad,
      const std::array<double, kNumWheels>& guess_rad) const;

  /// The lowest hip flexion above which, all the way to the end stop, the wheel is at least
  /// `clearance_m` above the ground; nothing if the wheel is not even clear there.
  [[nodiscard]] std::optional<double> lowest_clear_rad(const BaseCoordinates& base,
                                                       double curvature_1_m, int wheel,
                                                       double clearance_m) const;

  /// The chassis' underside is clear of the ground.
  [[nodiscard]] bool belly_clear(const BaseCoordinates& base) const;

  [[nodiscard]] std::array<double, kNumWheels> default_hfe_rad() const;
  [[nodiscard]] double upper_rad(int wheel) const;
  [[nodiscard]] const StanceGround& ground() const noexcept { return ground_; }
  [[nodiscard]] double mass_kg() const noexcept { return mass_kg_; }

 private:
  [[nodiscard]] const char* rest(const Eigen::Isometry3d& T_world_base, std::size_t wheel,
                                 const LegTable::Steer& steer, double& hfe_rad) const;
  [[nodiscard]] double gap_m(const Eigen::Isometry3d& T_world_base, std::size_t wheel,
                             const LegTable::Steer& steer, double hfe_rad, double* slope) const;
  [[nodiscard]] const char* ground_under(const Eigen::Vector2d& p_world_xy) const;

  const TerrainMap* terrain_;
  const MachineModel* machine_;
  StanceGround ground_;
  PlanSettings settings_;
  std::array<LegTable, kNumWheels> legs_;
  Eigen::Vector3d moment_base_ = Eigen::Vector3d::Zero();
  double mass_kg_ = 0.0;
  std::vector<Eigen::Vector3d> p_base_belly_;
};

}  // namespace wex
