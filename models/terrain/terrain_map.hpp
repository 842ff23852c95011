#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "models/types/result.hpp"

namespace wex {

/// Regular grid of samples. Cell (i, j) is the sample at origin + cell * (i, j); i runs along x
/// (east), j along y (north); storage is row-major in j (index = j * size_x + i). NaN = unknown.
struct Grid {
  int size_x = 0, size_y = 0;
  double cell_m = 0.1;
  Eigen::Vector2d origin_m = Eigen::Vector2d::Zero();  ///< local world xy of sample (0, 0)
  std::vector<float> values;

  [[nodiscard]] float at(int i, int j) const {
    return values[static_cast<std::size_t>(j) * size_x + i];
  }
  [[nodiscard]] float& at(int i, int j) { return values[static_cast<std::size_t>(j) * size_x + i]; }
};

/// Value and derivatives of a C2 surface at a point, SI units.
struct SurfaceSample {
  double value = 0.0;
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();
};

/// How the layers are made. Values of the decisions; lengths in m, angles in rad.
struct TerrainSettings {
  double fit_radius_m = 0.3;
  double filter_radius_m = 2.5;
  double wheel_radius_m = 0.6;
  double max_slope_rad = 0.5235987755982988;  ///< 30 degrees
  double touch_tolerance_m =
      0.12;  ///< tyre-dilated minus raw height above which a wheel cannot touch
};

/// Named layers over one elevation grid, in a local world frame (map frame minus map_origin_m).
/// Immutable after building, cheap to move, safe for concurrent reads. Positions are local xy [m].
/// Queries outside the map or over unknown ground return NaN (bilinear) or are clamped to the edge
/// (spline); known() tells.
class TerrainMap {
 public:
  /// Layers of the elevation; unknown cells (NaN) stay unknown and are not traversable.
  ///   errors  kBadInput: grid smaller than 4 x 4, cell size not positive and finite, all unknown
  [[nodiscard]] static Result<TerrainMap> build(
      Grid elevation, const TerrainSettings& settings = {},
      const Eigen::Vector2d& map_origin_m = Eigen::Vector2d::Zero());

  [[nodiscard]] const Grid& elevation() const noexcept;
  [[nodiscard]] const Grid& fitted_height() const noexcept;    ///< plane fit, radius 0.3 m
  [[nodiscard]] const Grid& filtered_height() const noexcept;  ///< plane fit, radius 2.5 m
  [[nodiscard]] const Grid& slope() const noexcept;            ///< rad, from the 0.3 m fit
  [[nodiscard]] const Grid& dilated_height()
      const noexcept;  ///< tyre ball: max(z + sqrt(r^2-d^2)) - r
  [[nodiscard]] const Grid& traversable() const noexcept;      ///< 1 or 0
  [[nodiscard]] const Grid& signed_distance() const noexcept;  ///< m, > 0 inside traversable ground

  [[nodiscard]] const Eigen::Vector2d& map_origin_m() const noexcept;  ///< map frame = local + this
  [[nodiscard]] Eigen::Vector2d min_corner_m() const noexcept;  ///< first and last sample, local
  [[nodiscard]] Eigen::Vector2d max_corner_m() const noexcept;
  [[nodiscard]] bool contains(const Eigen::Vector2d& p_world_xy) const noexcept;
  [[nodiscard]] bool known(
      const Eigen::Vector2d& p_world_xy) const noexcept;  ///< all four cells around

  /// Bilinear; NaN off the map or where a needed cell is unknown. No allocation.
  [[nodiscard]] double height_m(const Eigen::Vector2d& p_world_xy) const noexcept;
  [[nodiscard]] double filtered_height_m(const Eigen::Vector2d& p_world_xy) const noexcept;
  [[nodiscard]] double dilated_height_m(const Eigen::Vector2d& p_world_xy) const noexcept;
  [[nodiscard]] double signed_distance_m(const Eigen::Vector2d& p_world_xy) const noexcept;
  /// Unit normals of the plane fits at the nearest cell, z > 0; vertical where unknown.
  [[nodiscard]] Eigen::Vector3d normal(const Eigen::Vector2d& p_world_xy) const noexcept;
  [[nodiscard]] Eigen::Vector3d filtered_normal(const Eigen::Vector2d& p_world_xy) const noexcept;
  [[nodiscard]] bool traversable_at(const Eigen::Vector2d& p_world_xy) const noexcept;
  /// Centre of the nearest traversable cell (local xy); NaN, NaN if the map has none.
  [[nodiscard]] Eigen::Vector2d nearest_traversable(
      const Eigen::Vector2d& p_world_xy) const noexcept;

  /// C2 cubic B-spline of the tyre-dilated height and of the signed distance, exact derivatives;
  /// clamped to the map's edge, finite everywhere (unknown cells are filled from their neighbours;
  /// where traversable ground ends at a cliff the former carries it on for half a metre).
  [[nodiscard]] SurfaceSample dilated_surface(const Eigen::Vector2d& p_world_xy) const noexcept;
  [[nodiscard]] SurfaceSample signed_distance_surface(
      const Eigen::Vector2d& p_world_xy) const noexcept;

 private:
  struct Layers;
  explicit TerrainMap(std::shared_ptr<const Layers> layers);
  std::shared_ptr<const Layers> layers_;
};

}  // namespace wex
