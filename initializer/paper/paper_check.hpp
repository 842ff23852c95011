#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "initializer/make_plan.hpp"
#include "initializer/paper/ground_quads.hpp"
#include "initializer/paper/limb_table.hpp"
#include "initializer/roadmap/limb_roadmap.hpp"

namespace wex {

/// Why Algorithm 2 turns a base pose down.
enum class PaperRejection {
  kNone = 0,
  kOffMap,
  kTilt,
  kBelly,
  kTooFewLegs,
  kSwingLeg,
  kArmInGround,
  kNoArmContact,
  kUnstable,
};
inline constexpr std::size_t kNumPaperRejections = 9;
[[nodiscard]] const char* describe(PaperRejection rejection) noexcept;

/// The machine at a base pose as Algorithm 2 leaves it: every limb at a vertex of its roadmap.
struct PaperStance {
  PaperRejection rejection = PaperRejection::kNone;
  BaseCoordinates base = BaseCoordinates::Zero();
  ContactFlags contacts{};
  std::array<int, kNumLimbs> vertex{};  ///< of the roadmaps; on the ground or swinging
  double margin_m = 0.0;

  [[nodiscard]] bool ok() const noexcept { return rejection == PaperRejection::kNone; }
};

/// What the paper leaves open.
struct PaperSettings {
  double touch_m = 0.05;  ///< eps: a contact is on the ground within this
  int min_touching = 3;   ///< configurations that have to touch for a limb to be grounded
  double swing_clearance_m = 0.10;
  double max_bucket_lean_rad = 0.7853981633974483;  ///< of the standing bucket: 45 degrees
};

/// Algorithms 1 and 2 of the paper: the base's height, roll and pitch at a place, and whether the
/// machine can stand there on four wheels, on three with the arm as counterweight, or on two and
/// the bucket. Refers to terrain and machine, which must outlive it. Immutable, no allocation in
/// queries, safe for concurrent use.
class PaperCheck {
 public:
  ///   roadmaps  of this machine (contract)
  ///   errors    kBadInput: legs without hip flexion, an arm that is not a plane chain
  [[nodiscard]] static Result<PaperCheck> build(const TerrainMap& terrain,
                                                const MachineModel& machine,
                                                const Roadmaps& roadmaps,
                                                const PlanSettings& settings,
                                                const PaperSettings& paper = {});

  /// Algorithm 1: of 4 heights x 4 normals (raw and filtered, here and at the nearest traversable
  /// place) the cheapest: wheels of the default posture that find no ground weigh most, then tilt.
  /// All NaN off the map and over unknown ground.
  [[nodiscard]] BaseCoordinates base_at(const Pose2& pose) const noexcept;

  /// Algorithm 2 with the base given.
  ///   lifted  a leg that is to swing though it could stand; -1: none
  [[nodiscard]] PaperStance stand(const BaseCoordinates& base, int lifted = -1) const noexcept;

  /// Both.
  [[nodiscard]] PaperStance stand(const Pose2& pose) const noexcept;

  /// Legs alone, as stand() grounds them: rows of vertices, -1 where a leg is not grounded.
  [[nodiscard]] std::array<int, kNumWheels> ground_legs(const BaseCoordinates& base) const noexcept;

  /// Vertices of a leg that touch traversable ground, nearest to default first. Allocates.
  [[nodiscard]] std::vector<int> touching_vertices(const BaseCoordinates& base,
                                                   std::size_t leg) const;
  /// The first vertex of a leg that is clear of the ground; -1 if none is.
  [[nodiscard]] int swing_vertex(const BaseCoordinates& base, std::size_t leg) const noexcept;

  /// Vertices of the arm that balance a stance on three wheels (contract), the most central centre
  /// of mass first, whatever may be in their way. Allocates.
  [[nodiscard]] std::vector<int> counterweights(const PaperStance& stance) const;
  /// Rows of the bucket's contact table that touch the ground and make a stable tripod of a stance
  /// on two wheels (contract), nearest to default first. Allocates.
  [[nodiscard]] std::vector<int> carrying_bucket_rows(const PaperStance& stance) const;
  [[nodiscard]] const LimbTable& bucket_table() const noexcept { return bucket_; }
  [[nodiscard]] const PaperSettings& paper() const noexcept { return paper_; }

 private:
  PaperCheck(const TerrainMap& terrain, const MachineModel& machine, const PlanSettings& settings,
             const PaperSettings& paper);

  [[nodiscard]] double pose_cost(const BaseCoordinates& base) const noexcept;
  [[nodiscard]] bool belly_clear(const CellPose& pose) const noexcept;
  [[nodiscard]] int grounded_row(std::size_t leg, const CellPose& pose) const noexcept;
  [[nodiscard]] int swing_row(std::size_t leg, const CellPose& pose) const noexcept;
  void balance_with_arm(const Eigen::Isometry3d& T_world_base, const CellPose& pose,
                        const Eigen::Vector3d& moment_base, PaperStance& stance) const noexcept;
  void support_with_arm(const Eigen::Isometry3d& T_world_base, const CellPose& pose,
                        const Eigen::Vector3d& moment_base, PaperStance& stance) const noexcept;
  /// Where the standing wheels touch, two or three; the rest is not set.
  [[nodiscard]] std::array<Eigen::Vector2d, 3> wheel_corners(
      const Eigen::Isometry3d& T_world_base, const PaperStance& stance) const noexcept;
  [[nodiscard]] Eigen::Vector3d moment_but_arm(const PaperStance& stance) const noexcept;
  [[nodiscard]] double margin_on_bucket_m(const Eigen::Isometry3d& T_world_base,
                                          const Eigen::Vector3d& moment_base,
                                          const PaperStance& stance, int row) const noexcept;
  template <typename Visit>
  void visit_touching(const LimbTable& table, const GroundQuads& ground, float offset_m,
                      const CellPose& pose, const Visit& visit) const noexcept;

  /// What Algorithm 1 knows of a leg: the wheel in default posture, and its way up and down.
  struct DefaultFoot {
    Eigen::Vector3f p_base = Eigen::Vector3f::Zero();
    float radius_m = 0.0F, up_m = 0.0F, down_m = 0.0F;
  };

  const TerrainMap* terrain_;
  PlanSettings settings_;
  PaperSettings paper_;
  GroundQuads dilated_, height_, distance_, top_;  ///< top: highest ground under the chassis
  std::array<LimbTable, kNumWheels> legs_;
  std::array<DefaultFoot, kNumWheels> feet_;
  LimbTable bucket_;  ///< of the arm: vertices at which the bucket could stand
  LimbTable swing_;   ///< of the arm: vertices with the bucket above the chassis
  Eigen::Vector3d arm_moment_base_ = Eigen::Vector3d::Zero();    ///< in default posture [kg m]
  Eigen::Vector3d fixed_moment_base_ = Eigen::Vector3d::Zero();  ///< of what is in no limb [kg m]
  double mass_kg_ = 0.0, base_height_m_ = 0.0, belly_m_ = 0.0;
  float belly_radius_m_ = 0.0F;
  std::vector<Eigen::Vector3f> p_base_belly_;
};

}  // namespace wex
