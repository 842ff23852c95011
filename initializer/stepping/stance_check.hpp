#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "initializer/stepping/stance_ground.hpp"
#include "initializer/stepping/stance_tables.hpp"
#include "models/types/pose.hpp"

namespace wex {

/// Base pose, as the hot loops want it.
struct BaseFrame {
  Eigen::Matrix3d R_world_base = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_world_base = Eigen::Vector3d::Zero();

  [[nodiscard]] static BaseFrame from(const BaseCoordinates& base);
  [[nodiscard]] Eigen::Vector3d operator*(const Eigen::Vector3d& p_base) const noexcept {
    return R_world_base.col(0) * p_base.x() + R_world_base.col(1) * p_base.y() +
           R_world_base.col(2) * p_base.z() + p_world_base;
  }
};

/// What a stance must keep clear of. The graph asks for more than the poses between its states.
struct StanceClearances {
  double edge_m = 0.15;   ///< of a wheel's contact from ground no wheel may stand on
  double swing_m = 0.10;  ///< of a lifted tyre above the ground
  double belly_m = 0.05;
  [[nodiscard]] StanceClearances inflated(double by_m) const noexcept {
    return {edge_m + 2.0 * by_m, swing_m + 2.0 * by_m, belly_m + by_m};
  }
};

/// Why a leg cannot stand where the base is.
enum class LegFault : std::uint8_t {
  kNone,
  kNoGround,  ///< off the map, unknown, or higher than the leg can lift the wheel
  kTooLow,    ///< the ground is out of reach below
  kEdge,      ///< contact too close to ground no wheel may stand on
  kBeam,      ///< the leg's beams touch the ground
};

/// Legs over the ground at one base pose, before any choice of who carries. Masks: bit i is wheel
/// i. The arm has no part in it.
struct Stance {
  bool belly_clear = false;      ///< false: nothing else is filled in
  std::uint8_t grounded = 0;     ///< the wheel reaches ground it may stand on
  std::uint8_t swing_clear = 0;  ///< lifted fully, wheel and beams clear the ground
  std::uint8_t sweep_clear = 0;  ///< grounded, and clear on its way up and down
  std::array<LegFault, kNumWheels> fault{};
  std::array<Eigen::Vector3d, kNumWheels> p_world_wheel;  ///< standing wheels' centres
  std::array<Eigen::Vector3d, kNumWheels> p_world_patch;  ///< where their tyres touch
  std::array<Eigen::Vector3d, kNumWheels> axle_world;     ///< of standing wheels
  std::array<Eigen::Vector3d, kNumWheels> moment_grounded_base, moment_lifted_base;  ///< [kg m]

  /// All wheels can stand but those lifted, and those are clear.
  [[nodiscard]] bool allows(std::uint8_t lifted) const noexcept {
    return belly_clear && (grounded | lifted) == 0b1111 && (swing_clear & lifted) == lifted;
  }
  /// On four wheels, of which these can be lifted off or put down here.
  [[nodiscard]] bool may_lift(std::uint8_t wheels) const noexcept {
    return allows(0) && allows(wheels) && (sweep_clear & wheels) == wheels;
  }
};

/// Stances and their static stability over one terrain. Refers to ground and tables, which must
/// outlive it. All queries are const, allocation-free and safe for concurrent use.
class StanceCheck {
 public:
  StanceCheck(const StanceGround& ground, const StanceTables& tables);

  /// Every leg is lowered from its highest position until its wheel meets the ground, so that
  /// lifting it off and putting it down there is clear by construction. The wheel is a disc as in
  /// wheel_rest.
  [[nodiscard]] Stance stance(const BaseFrame& base, int steering,
                              const StanceClearances& clearances) const noexcept;

  /// The treads of the wheels that carry are on the ground as the map draws it: the rest of a disc
  /// is an approximation. About 0.2 µs a wheel.
  [[nodiscard]] bool tyres_rest(const Stance& stance, std::uint8_t lifted) const noexcept;

  /// Smallest margin on four wheels over all cabin yaws, arm folded [m].
  [[nodiscard]] double margin_on_wheels(const BaseFrame& base, const Stance& stance) const noexcept;

  struct Balanced {
    double margin_m = -1e9;
    int counter_weight = -1;  ///< index into StanceTables::counter_weights
  };
  /// The counterweight that clears the ground and gives the largest margin on the other wheels.
  [[nodiscard]] Balanced margin_with_counter_weight(const BaseFrame& base, const Stance& stance,
                                                    std::uint8_t lifted) const noexcept;

  struct OnBucket {
    double margin_m = -1e9;     ///< on the standing wheels and the bucket
    double stretched_m = -1e9;  ///< on four wheels, arm as it is but not loaded
    double turn_rad = 0.0;
    const ArmTable::Posture* posture = nullptr;
  };
  /// The arm posture that reaches a bucket point, clears the ground and gives the largest margin;
  /// looks no further once that is `enough_m`.
  ///   stretched_m  demanded of four wheels with the arm there already; below -1: not asked for
  [[nodiscard]] OnBucket margin_on_bucket(const BaseFrame& base, const Stance& stance,
                                          std::uint8_t lifted,
                                          const Eigen::Vector3d& p_world_bucket, double enough_m,
                                          double stretched_m) const noexcept;

  /// May the bucket be put down here, its edge along `yaw`'s lateral axis?
  [[nodiscard]] bool bucket_spot(double x, double y, double yaw_rad, double edge_m) const noexcept;

  [[nodiscard]] int steering(double curvature_1_m) const noexcept {
    return steering_for(curvature_1_m, tables_->min_turning_radius_m);
  }
  [[nodiscard]] const StanceGround& ground() const noexcept { return *ground_; }
  [[nodiscard]] const StanceTables& tables() const noexcept { return *tables_; }

 private:
  [[nodiscard]] bool belly_clear(const BaseFrame& base, double clearance_m) const noexcept;
  [[nodiscard]] bool beams_clear(const BaseFrame& base, const LegSample& high, const LegSample& low,
                                 double share, int num_points) const noexcept;
  [[nodiscard]] bool claw_clear(const BaseFrame& base, const LegSample& high, const LegSample& low,
                                double share, double radius_m) const noexcept;
  [[nodiscard]] bool leg_clear(const BaseFrame& base, const LegSweep& sweep, int leg,
                               const LegSample& high, const LegSample& low,
                               double share) const noexcept {
    return beams_clear(base, high, low, share, sweep.num_beam_points) &&
           (!sweep.has_claw || claw_clear(base, high, low, share,
                                          tables_->claw_radius_m[static_cast<std::size_t>(leg)]));
  }
  [[nodiscard]] LegFault lower_leg(const BaseFrame& base, const LegSweep& sweep, int leg,
                                   const StanceClearances& clearances,
                                   Stance& stance) const noexcept;
  [[nodiscard]] bool sweep_is_clear(const BaseFrame& base, const LegSweep& sweep, int leg, int end,
                                    const Eigen::Vector3d& p_world_wheel,
                                    double swing_m) const noexcept;
  [[nodiscard]] Eigen::Vector3d moment_of_legs(const Stance& stance,
                                               std::uint8_t lifted) const noexcept;
  [[nodiscard]] bool beam_clear(const Eigen::Vector3d& a, const Eigen::Vector3d& b, int samples,
                                double share, double thickness_m) const noexcept;

  const StanceGround* ground_;
  const StanceTables* tables_;
  std::vector<Eigen::Vector3d> p_base_belly_;
  double belly_radius_m_ = 0.0;
};

}  // namespace wex
