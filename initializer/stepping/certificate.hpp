#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "initializer/drive_path.hpp"
#include "initializer/make_plan.hpp"
#include "models/excavator/machine_model.hpp"
#include "models/terrain/terrain_map.hpp"
#include "models/types/pose.hpp"
#include "models/types/result.hpp"

namespace wex {

struct StanceTables;

/// Which limbs carry the machine: the wheels that are not lifted, and a bucket that stands.
struct Support {
  std::uint8_t lifted = 0;  ///< bit i: wheel i (Limb order) is in the air
  int bucket = -1;          ///< index into CertifiedSequence::bucket_points, -1: in the air
  bool operator==(const Support&) const = default;
};

/// Arm joints that matter to planning; EE_ROLL and EE_YAW stay in transport posture.
struct ArmPosture {
  double turn_rad = 0.0, boom_rad = 0.0, dipper_rad = 0.0, tele_m = 0.0, ee_pitch_rad = 0.0;
};

/// One state of a certified sequence.
struct SteppingState {
  std::size_t station = 0;                         ///< index into CertifiedSequence::stations
  BaseCoordinates base = BaseCoordinates::Zero();  ///< x, y, yaw are the station's
  Support support;
  /// Bucket in contact: a posture that reaches it with the margin here. One wheel lifted without
  /// bucket: the counterweight. Else not used (transport posture).
  ArmPosture arm;
  double margin_m = 0.0;  ///< static stability of the worst arm posture this state allows
};

/// A whole path, decided. Successive states differ either in pose (one station and at most one grid
/// cell of height and pitch) or in support, never in both; supports change between four wheels and
/// another support only, so every slew and every new bucket point happens on four wheels.
struct CertifiedSequence {
  DrivePath path;
  std::vector<Station> stations;
  std::vector<Eigen::Vector3d> bucket_points;  ///< world, on the ground
  std::vector<SteppingState> states;
  double cost = 0.0;
  double min_margin_m = 0.0;
};

/// How far a path could be followed, and what stops the machine there.
struct CertificateFailure {
  std::size_t station = 0;  ///< the furthest reached
  Pose2 where;
  std::string why;  ///< part of a sentence
};

/// Costs and grid of the layered graph; the values measured for this machine.
struct CertificateSettings {
  double height_step_m = 0.1;
  double pitch_step_rad = 0.08726646259971647;  ///< 5 degrees
  double max_pitch_offset_rad =
      0.2617993877991494;  ///< 15 degrees about level and the ground's own
  double bucket_spacing_m = 0.4;
  double min_bucket_distance_m = 3.3;
  double lift_cost_m = 3.0, bucket_cost_m = 6.0;  ///< per change of support, in metres of driving
  double stepping_share = 1.0;  ///< extra cost per metre driven with a wheel in the air
  double inflation_m = 0.02;    ///< of clearances in the graph, so that poses between states pass
};

/// A state of a sequence that cannot be realised, and why.
struct Objection {
  std::size_t state = 0;
  std::string why;      ///< part of a sentence
  bool bucket = false;  ///< it is the bucket's point that does not do
};
/// Told of a sequence; nothing if it will do.
using SequenceJudge = std::function<std::optional<Objection>(const CertifiedSequence&)>;

/// Decides whether the machine can follow an SE(2) path, stepping where it must, by A* over
/// station x base height x pitch x support. Roll and the middle of the pitch grid follow the
/// ground. Tables are built once; queries do not change it and are safe for concurrent use.
class Certifier {
 public:
  /// terrain and machine must outlive it.
  ///   errors  kBadInput: legs that cannot be put on the ground
  [[nodiscard]] static Result<Certifier> build(const TerrainMap& terrain,
                                               const MachineModel& machine,
                                               const PlanSettings& settings,
                                               const CertificateSettings& certificate = {});
  /// The same with tables of the machine that were built before (not null).
  Certifier(const TerrainMap& terrain, std::shared_ptr<const StanceTables> tables,
            const PlanSettings& settings, const CertificateSettings& certificate = {});
  ~Certifier();
  Certifier(Certifier&&) noexcept;

  /// The sequence that follows the whole path at the lowest cost, starting and ending on four
  /// wheels; poses between its states were checked too.
  ///   begin  base height, pitch and roll to start from, the nominal ones where not given
  ///   judge  a state it objects to is avoided, and the next best sequence told to it, some times
  [[nodiscard]] Result<CertifiedSequence, CertificateFailure> certify(
      const DrivePath& path, const std::optional<BaseCoordinates>& begin = std::nullopt,
      const SequenceJudge& judge = {}) const;

  /// Like certify, but a path that cannot be followed to its end gives the sequence up to its last
  /// four-wheel state, path and stations cut there; nullopt if that is not beyond
  /// `min_progress_m`.
  [[nodiscard]] std::optional<CertifiedSequence> certify_prefix(
      const DrivePath& path, double min_progress_m,
      const std::optional<BaseCoordinates>& begin = std::nullopt) const;

  /// What the projection of the graph onto (x, y, yaw) says of a pose: never stricter than the
  /// graph. No allocation.
  enum class Admission { kRefused, kNeedsStepping, kOnFourWheels };
  [[nodiscard]] Admission admits(const Pose2& pose, double curvature_1_m) const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wex
