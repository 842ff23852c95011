#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "initializer/drive_path.hpp"
#include "initializer/make_plan.hpp"
#include "initializer/stepping/certificate.hpp"
#include "initializer/stepping/stance_check.hpp"

namespace wex {

/// What the ground under the four wheels says of a pose: a guess of the base, and bounds of its
/// height.
struct GroundUnder {
  double height_m = 0.0;  ///< of the ground that wheels can use, mean; 0 where there is none
  double pitch_rad = 0.0, roll_rad = 0.0;
  double lowest_base_m = 0.0, highest_base_m = 0.0;  ///< world z at which an axle could stand
  bool any = false;                                  ///< some wheel has ground
};
[[nodiscard]] GroundUnder ground_under(const StanceCheck& check, const Pose2& pose) noexcept;

/// One layer of the graph: a station of the path.
struct PathLayer {
  Pose2 pose;
  double curvature_1_m = 0.0;  ///< steered, averaged along the path as the motion will be
  double step_m = 0.0;         ///< from the layer before
  double roll_rad = 0.0;
  int nominal_z = 0, nominal_pitch = 0;  ///< grid cells that follow the ground
  int first_z = 0, num_z = 0, first_pitch = 0, num_pitch = 0;
  std::size_t first_pose = 0;  ///< number of poses in the layers before
  /// Bucket points this layer may use, ahead and behind, ascending.
  std::array<std::vector<int>, 2> buckets;

  [[nodiscard]] std::size_t num_poses() const noexcept {
    return static_cast<std::size_t>(num_z) * static_cast<std::size_t>(num_pitch);
  }
};

/// Distances driven between which stations lie closer together; none if they end before they begin.
struct FinePart {
  double from_m = 0.0, to_m = -1.0;
};

/// The graph's grid along one path.
struct PathGrid {
  double z_m = 0.0, z_step_m = 0.1;  ///< height of cell 0
  double pitch_rad = 0.0, pitch_step_rad = 0.0873;
  std::vector<Station> stations;
  std::vector<PathLayer> layers;
  std::vector<Eigen::Vector3d> bucket_points;

  [[nodiscard]] static PathGrid of(const StanceCheck& check, const DrivePath& path,
                                   const PlanSettings& plan, const CertificateSettings& settings,
                                   const std::optional<BaseCoordinates>& begin,
                                   const FinePart& fine = {});

  [[nodiscard]] BaseCoordinates base(const PathLayer& layer, int z, int pitch) const noexcept {
    BaseCoordinates base;
    base << layer.pose.x_m, layer.pose.y_m, z_m + z_step_m * z, layer.pose.yaw_rad,
        pitch_rad + pitch_step_rad * pitch, layer.roll_rad;
    return base;
  }
};

/// Place of a bucket point ahead of the base and to its left [m].
[[nodiscard]] Eigen::Vector2d bucket_in_heading(const Pose2& pose,
                                                const Eigen::Vector3d& point) noexcept;

}  // namespace wex
