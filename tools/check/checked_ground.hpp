#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "models/terrain/terrain_map.hpp"

namespace wex::check {

/// What a tyre disc does on the raw map.
struct TyreOnGround {
  double gap_m = 0.0;  ///< how far it could be lowered before it touches; negative: in the ground
  Eigen::Vector3d p_world_patch = Eigen::Vector3d::Zero();  ///< middle of where it touches first
  bool known = false;  ///< every map cell that counts is known; else gap and patch are NaN
};

/// The raw elevation as the checker sees it: bilinear between samples, own plane fits, own maxima.
/// Shares nothing with TerrainMap's layers. Positions are local xy [m]. Not safe for concurrent
/// use (fitted slopes are remembered).
class CheckedGround {
 public:
  /// elevation must not be empty (contract).
  explicit CheckedGround(Grid elevation);

  /// Bilinear height; NaN off the map or where one of the four samples around is unknown.
  [[nodiscard]] double height_m(double x, double y) const noexcept {
    const double u = (x - grid_.origin_m.x()) * cells_per_m_;
    const double v = (y - grid_.origin_m.y()) * cells_per_m_;
    if (!(u >= 0.0 && v >= 0.0 && u <= last_x_ && v <= last_y_)) return kUnknown;
    const int i = u >= last_x_ ? grid_.size_x - 2 : static_cast<int>(u);
    const int j = v >= last_y_ ? grid_.size_y - 2 : static_cast<int>(v);
    const double a = u - i, b = v - j;
    const float* south = &grid_.values[static_cast<std::size_t>(j) * grid_.size_x + i];
    const float* north = south + grid_.size_x;
    return (1.0 - b) * ((1.0 - a) * south[0] + a * south[1]) +
           b * ((1.0 - a) * north[0] + a * north[1]);
  }

  /// A disc of radius r and half-width w about `axle_world` (unit vector) against the ground, by
  /// samples of its surface and by the map's own samples below it. The patch is where it would
  /// touch if it were pressed 2 cm into the ground, as tyres are.
  [[nodiscard]] TyreOnGround tyre(const Eigen::Vector3d& p_world_centre,
                                  const Eigen::Vector3d& axle_world, double radius_m,
                                  double half_width_m) const;

  /// At least the highest known sample within `radius_m`; -infinity if there is none.
  [[nodiscard]] double max_height_m(double x, double y, double radius_m) const noexcept;

  /// Slope of the plane through the known samples within 0.3 m of the nearest sample [rad], of the
  /// ground or of the heights a tyre rolls over it at, whichever is less: on the rim of a pit what
  /// the tyre touches is level. NaN where that sample is unknown or no plane fits.
  [[nodiscard]] double slope_rad(double x, double y);

  /// Distance to the nearest sample that is unknown, off the map, steeper than `max_slope_rad`, or
  /// so far below what a tyre rolls over that the tyre cannot touch it, at most `reach_m`.
  [[nodiscard]] double untraversable_distance_m(double x, double y, double max_slope_rad,
                                                double reach_m);

 private:
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  [[nodiscard]] double slope_of_cell(int i, int j);
  [[nodiscard]] double fitted_slope_rad(int i, int j, bool rolled);
  [[nodiscard]] float rolled_height_m(int i, int j);
  [[nodiscard]] double lowered_onto_samples(const Eigen::Vector3d& p_world_centre,
                                            const Eigen::Vector3d& axle_world, double radius_m,
                                            double half_width_m) const;

  Grid grid_;
  double cells_per_m_, last_x_, last_y_;
  int blocks_x_, blocks_y_;
  std::vector<float> block_max_;
  std::vector<float> slope_;   ///< kNotFitted until asked for
  std::vector<float> rolled_;  ///< lowest a tyre of 0.6 m can be over a sample; NaN until asked for
};

}  // namespace wex::check
