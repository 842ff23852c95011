#include "initializer/replan/ground_change.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace wex {
namespace {

// How far from a changed height layers may change in a way that matters: tyre dilation 0.6 m, plane
// fits and touching points 1 m, distances up to kDistanceOfInterestM.
constexpr double kLayerReachM = 4.0;
constexpr float kDistanceOfInterestM = 1.0F;

struct Cells {
  int first_x = 0, first_y = 0, last_x = -1, last_y = -1;
};

// Bit by bit: unknown ground that stays unknown is no change.
bool differ(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) != std::bit_cast<std::uint32_t>(b) &&
         !(std::isnan(a) && std::isnan(b)) && a != b;
}

Cells cells_of(const Grid& grid, const GroundRect& rect) {
  const Eigen::Vector2d low = (rect.min_m - grid.origin_m) / grid.cell_m;
  const Eigen::Vector2d high = (rect.max_m - grid.origin_m) / grid.cell_m;
  const auto clamped = [](double value, int size) {
    return static_cast<int>(std::clamp(value, 0.0, size - 1.0));
  };
  return {clamped(std::floor(low.x()), grid.size_x), clamped(std::floor(low.y()), grid.size_y),
          clamped(std::ceil(high.x()), grid.size_x), clamped(std::ceil(high.y()), grid.size_y)};
}

std::optional<GroundRect> where_heights_differ(const Grid& before, const Grid& after) {
  Cells cells{before.size_x, before.size_y, -1, -1};
  std::size_t cell = 0;
  for (int j = 0; j < before.size_y; ++j) {
    for (int i = 0; i < before.size_x; ++i, ++cell) {
      if (!differ(before.values[cell], after.values[cell])) continue;
      cells.first_x = std::min(cells.first_x, i);
      cells.last_x = std::max(cells.last_x, i);
      cells.first_y = std::min(cells.first_y, j);
      cells.last_y = std::max(cells.last_y, j);
    }
  }
  if (cells.last_x < 0) return std::nullopt;
  return GroundRect{before.origin_m + before.cell_m * Eigen::Vector2d(cells.first_x, cells.first_y),
                    before.origin_m + before.cell_m * Eigen::Vector2d(cells.last_x, cells.last_y)};
}

}  // namespace

Result<GroundChange> GroundChange::between(const TerrainMap& before, const TerrainMap& after,
                                           const std::optional<GroundRect>& where) {
  const Grid& old_height = before.elevation();
  const Grid& new_height = after.elevation();
  if (old_height.size_x != new_height.size_x || old_height.size_y != new_height.size_y ||
      old_height.cell_m != new_height.cell_m || old_height.origin_m != new_height.origin_m ||
      before.map_origin_m() != after.map_origin_m()) {
    return fail(ErrorCode::kBadInput,
                "the changed map must have the size, cells and origin of the one before");
  }
  GroundChange change;
  const auto rect = where ? where : where_heights_differ(old_height, new_height);
  if (!rect) return change;
  const Cells cells = cells_of(old_height, rect->inflated(kLayerReachM));
  change.cell_m_ = old_height.cell_m;
  change.origin_m_ =
      old_height.origin_m + change.cell_m_ * Eigen::Vector2d(cells.first_x, cells.first_y);
  change.size_x_ = cells.last_x - cells.first_x + 1;
  change.size_y_ = cells.last_y - cells.first_y + 1;
  const std::size_t row = static_cast<std::size_t>(change.size_x_) + 1;
  change.sums_.assign(row * (static_cast<std::size_t>(change.size_y_) + 1), 0);
  for (int j = 0; j < change.size_y_; ++j) {
    std::int32_t in_row = 0;
    for (int i = 0; i < change.size_x_; ++i) {
      const auto differs = [&](const Grid& a, const Grid& b) {
        return differ(a.at(cells.first_x + i, cells.first_y + j),
                      b.at(cells.first_x + i, cells.first_y + j));
      };
      const auto near_bad_ground = [&] {
        return std::min(before.signed_distance().at(cells.first_x + i, cells.first_y + j),
                        after.signed_distance().at(cells.first_x + i, cells.first_y + j)) <
               kDistanceOfInterestM;
      };
      const bool changed =
          differs(old_height, new_height) ||
          differs(before.dilated_height(), after.dilated_height()) ||
          (differs(before.signed_distance(), after.signed_distance()) && near_bad_ground());
      in_row += changed ? 1 : 0;
      const std::size_t corner =
          static_cast<std::size_t>(j + 1) * row + static_cast<std::size_t>(i) + 1;
      change.sums_[corner] = change.sums_[corner - row] + in_row;
    }
  }
  return change;
}

bool GroundChange::meets(const GroundRect& rect) const noexcept {
  if (none()) return false;
  const Eigen::Vector2d low = (rect.min_m - origin_m_) / cell_m_;
  const Eigen::Vector2d high = (rect.max_m - origin_m_) / cell_m_;
  const auto clamped = [](double value, int size) {
    return static_cast<std::size_t>(std::clamp(value, 0.0, static_cast<double>(size)));
  };
  const std::size_t x_0 = clamped(std::floor(low.x()), size_x_),
                    x_1 = clamped(std::floor(high.x()) + 2.0, size_x_),
                    y_0 = clamped(std::floor(low.y()), size_y_),
                    y_1 = clamped(std::floor(high.y()) + 2.0, size_y_);
  const std::size_t row = static_cast<std::size_t>(size_x_) + 1;
  const auto sum = [&](std::size_t x, std::size_t y) { return sums_[y * row + x]; };
  return sum(x_1, y_1) - sum(x_0, y_1) - sum(x_1, y_0) + sum(x_0, y_0) > 0;
}

}  // namespace wex
