#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "models/terrain/terrain_map.hpp"

namespace wex {

/// The layers that stances are judged by, cell by cell side by side so that a query touches one
/// cache line. Everything off the map or unknown is infinitely high and infinitely close to an
/// edge: whatever needs the ground there is refused.
class StanceGround {
 public:
  explicit StanceGround(const TerrainMap& terrain);

  /// Tyre-dilated height, bilinear; huge off the map and over unknown ground. No allocation.
  [[nodiscard]] double dilated_m(double x, double y) const noexcept {
    const Corner c = corner(x, y);
    return c.mix([](const Cell& cell) { return static_cast<double>(cell.dilated_m); });
  }
  /// The same for tyres that must stay clear: at a cliff the height of its upper side.
  [[nodiscard]] double dilated_top_side_m(double x, double y) const noexcept {
    constexpr float kCliffM = 0.25F;
    const Corner c = corner(x, y);
    const auto [low, high] = std::minmax(
        {c.south[0].dilated_m, c.south[1].dilated_m, c.north[0].dilated_m, c.north[1].dilated_m});
    if (high - low > kCliffM) return static_cast<double>(high);
    return c.mix([](const Cell& cell) { return static_cast<double>(cell.dilated_m); });
  }
  /// Gradient of the dilated height over the cell around.
  [[nodiscard]] Eigen::Vector2d dilated_gradient(double x, double y) const noexcept;
  /// Distance to ground no wheel may stand on, positive on good ground (the map's signed distance).
  [[nodiscard]] double clear_m(double x, double y) const noexcept {
    return corner(x, y).mix([](const Cell& cell) { return static_cast<double>(cell.clear_m); });
  }
  [[nodiscard]] double height_m(double x, double y) const noexcept {
    return corner(x, y).mix([](const Cell& cell) { return static_cast<double>(cell.height_m); });
  }
  /// Highest ground of the 3 x 3 cells around: what links and chassis must stay clear of.
  [[nodiscard]] double highest_m(double x, double y) const noexcept {
    return static_cast<double>(cells_[nearest(x, y)].highest_m);
  }

  /// No tyre-dilated height within 0.8 m along x and y is higher; no ground within 1.2 m.
  [[nodiscard]] double dilated_top_m(double x, double y) const noexcept {
    return static_cast<double>(tops_[nearest(x, y)].dilated_m);
  }
  [[nodiscard]] double ground_top_m(double x, double y) const noexcept {
    return static_cast<double>(tops_[nearest(x, y)].ground_m);
  }
  static constexpr double kDilatedTopReach_m = 0.8, kGroundTopReach_m = 1.2;

  static constexpr double kNowhere_m = 1e6;  ///< height of what is not known

 private:
  struct Cell {
    float dilated_m, highest_m, clear_m, height_m;
  };
  struct Top {
    float dilated_m, ground_m;
  };
  struct Corner {
    const Cell* south;
    const Cell* north;
    double u, v;
    template <typename Field>
    [[nodiscard]] double mix(const Field& field) const noexcept {
      const double a = field(south[0]), b = field(south[1]), c = field(north[0]),
                   d = field(north[1]);
      const double low = a + u * (b - a), high = c + u * (d - c);
      return low + v * (high - low);
    }
  };
  [[nodiscard]] Corner corner(double x, double y) const noexcept {
    const double u = std::clamp((x - x_m_) * per_m_, 0.0, max_u_);
    const double v = std::clamp((y - y_m_) * per_m_, 0.0, max_v_);
    const int i = static_cast<int>(u), j = static_cast<int>(v);
    const Cell* south = cells_.data() + static_cast<std::size_t>(j * size_x_ + i);
    return {south, south + size_x_, u - i, v - j};
  }

  [[nodiscard]] std::size_t nearest(double x, double y) const noexcept {
    const int i = static_cast<int>(std::clamp((x - x_m_) * per_m_ + 0.5, 0.0, max_i_));
    const int j = static_cast<int>(std::clamp((y - y_m_) * per_m_ + 0.5, 0.0, max_j_));
    return static_cast<std::size_t>(j * size_x_ + i);
  }

  // One ring of unknown cells all around, so that queries off the map end there.
  std::vector<Cell> cells_;
  std::vector<Top> tops_;
  int size_x_ = 0, size_y_ = 0;
  double x_m_ = 0.0, y_m_ = 0.0, per_m_ = 10.0;  // of the outermost ring's first cell
  double max_u_ = 0.0, max_v_ = 0.0, max_i_ = 0.0, max_j_ = 0.0;
};

}  // namespace wex
