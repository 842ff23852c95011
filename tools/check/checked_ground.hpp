#pragma once

#include <Eigen/Core>
#include <array>
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

  /// What stands on the ground: a tyre is a ball that rolls over it, a bucket touches it here.
  enum class Foot { kTyre, kBucket };

  /// Slope of the plane through the samples within 0.3 m of the nearest one, or of the one that a
  /// tyre over it touches (on a slope that is uphill) [rad]; or of the heights that a tyre's
  /// underside has over them, whichever is less: on the rim of a pit that is level. NaN where the
  /// sample is unknown, no plane fits, or a tyre's flanks keep it off by more than 12 cm.
  [[nodiscard]] double slope_rad(double x, double y, Foot foot);

  /// Distance to the nearest sample where slope_rad is not at most `max_slope_rad`, or that is off
  /// the map; at most `reach_m`.
  [[nodiscard]] double untraversable_distance_m(double x, double y, Foot foot, double max_slope_rad,
                                                double reach_m);

 private:
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  enum class Surface { kRaw, kRolled };
  /// A tyre of 0.6 m that is let down over a sample.
  struct Rolled {
    float height_m = std::numeric_limits<float>::quiet_NaN();  ///< of its underside
    std::array<int, 2> touches{};                              ///< sample
  };
  [[nodiscard]] double slope_of_cell(int i, int j, Foot foot);
  [[nodiscard]] double fitted_slope_rad(int i, int j, Surface surface);
  [[nodiscard]] const Rolled& rolled(int i, int j);
  [[nodiscard]] double lowered_onto_samples(const Eigen::Vector3d& p_world_centre,
                                            const Eigen::Vector3d& axle_world, double radius_m,
                                            double half_width_m) const;

  Grid grid_;
  double cells_per_m_, last_x_, last_y_;
  int blocks_x_, blocks_y_;
  std::vector<float> block_max_;
  std::array<std::vector<float>, 2> slope_;  ///< by Foot; kNotFitted until asked for
  std::vector<Rolled> rolled_;               ///< height NaN until asked for
};

}  // namespace wex::check
