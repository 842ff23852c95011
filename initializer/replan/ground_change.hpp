#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "models/terrain/terrain_map.hpp"
#include "models/types/result.hpp"

namespace wex {

/// An axis-parallel rectangle of ground, local world frame [m].
struct GroundRect {
  Eigen::Vector2d min_m, max_m;

  [[nodiscard]] GroundRect inflated(double by_m) const {
    return {min_m - Eigen::Vector2d::Constant(by_m), max_m + Eigen::Vector2d::Constant(by_m)};
  }
  [[nodiscard]] GroundRect united(const GroundRect& other) const {
    return {min_m.cwiseMin(other.min_m), max_m.cwiseMax(other.max_m)};
  }
};

/// Where two maps of one place differ in anything a plan is judged by: heights, what tyres roll on,
/// and the distance to bad ground where that is short. Found by comparing the layers themselves, so
/// that how far a change reaches need not be guessed.
class GroundChange {
 public:
  /// where  outside of it elevations are the same; else it is found by comparing them
  /// errors kBadInput: the maps are not two of one grid
  [[nodiscard]] static Result<GroundChange> between(const TerrainMap& before,
                                                    const TerrainMap& after,
                                                    const std::optional<GroundRect>& where);

  [[nodiscard]] bool none() const noexcept { return sums_.empty() || sums_.back() == 0; }
  /// Any changed cell in a rectangle, the cells around its edge included. Constant time.
  [[nodiscard]] bool meets(const GroundRect& rect) const noexcept;

 private:
  Eigen::Vector2d origin_m_ = Eigen::Vector2d::Zero();  ///< of cell (0, 0) of the part looked at
  double cell_m_ = 0.1;
  int size_x_ = 0, size_y_ = 0;
  std::vector<std::int32_t> sums_;  ///< changed cells south-west of a corner, (size + 1) each way
};

}  // namespace wex
