#include "models/terrain/terrain_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "models/terrain/internal/bspline_surface.hpp"
#include "models/terrain/internal/distance_transform.hpp"
#include "models/terrain/internal/plane_fit.hpp"
#include "models/terrain/internal/tyre_dilation.hpp"

namespace wex {

using terrain_internal::BsplineSurface;
using terrain_internal::PlaneFit;

struct TerrainMap::Layers {
  Eigen::Vector2d map_origin_m = Eigen::Vector2d::Zero();
  Grid elevation;
  PlaneFit fit;
  PlaneFit filter;
  Grid slope;
  Grid dilated;
  Grid traversable;
  Grid signed_distance;
  std::vector<std::int32_t> nearest_traversable;  ///< cell index; -1 if the map has none
  BsplineSurface dilated_surface;
  BsplineSurface signed_distance_surface;
};

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kRoundOff = 1e-9;  // cells; a point this close to a sample is that sample

/// Position in cells: sample (i, j) is at (i, j).
Eigen::Vector2d in_cells(const Grid& grid, const Eigen::Vector2d& p_world_xy) {
  return (p_world_xy - grid.origin_m) / grid.cell_m;
}

bool on_map(const Grid& grid, const Eigen::Vector2d& cells) {
  return cells.x() >= -kRoundOff && cells.y() >= -kRoundOff &&
         cells.x() <= grid.size_x - 1 + kRoundOff && cells.y() <= grid.size_y - 1 + kRoundOff;
}

/// Index of the sample nearest to a point, clamped to the map.
std::size_t nearest_cell(const Grid& grid, const Eigen::Vector2d& cells) {
  const int i = static_cast<int>(std::clamp(std::round(cells.x()), 0.0, grid.size_x - 1.0));
  const int j = static_cast<int>(std::clamp(std::round(cells.y()), 0.0, grid.size_y - 1.0));
  return static_cast<std::size_t>(j) * grid.size_x + i;
}

/// One axis of a bilinear query: the samples around, and the weight of the upper one. On a sample
/// the upper one is not needed, so it falls together with the lower.
struct Between {
  int lower = 0, upper = 0;
  double weight = 0.0;
};

Between between(double u, int size) {
  const double clamped = std::clamp(u, 0.0, size - 1.0);
  const double sample = std::round(clamped);
  if (std::abs(clamped - sample) < kRoundOff) {
    return {static_cast<int>(sample), static_cast<int>(sample), 0.0};
  }
  const int lower = static_cast<int>(clamped);
  return {lower, lower + 1, clamped - lower};
}

double bilinear(const Grid& grid, const Eigen::Vector2d& p_world_xy) {
  const Eigen::Vector2d cells = in_cells(grid, p_world_xy);
  if (!on_map(grid, cells)) return kNan;
  const Between x = between(cells.x(), grid.size_x);
  const Between y = between(cells.y(), grid.size_y);
  const auto mix = [](double a, double b, double weight) { return a + weight * (b - a); };
  const double south = mix(grid.at(x.lower, y.lower), grid.at(x.upper, y.lower), x.weight);
  const double north = mix(grid.at(x.lower, y.upper), grid.at(x.upper, y.upper), x.weight);
  return mix(south, north, y.weight);
}

Grid same_shape(const Grid& grid, std::vector<float> values) {
  return Grid{grid.size_x, grid.size_y, grid.cell_m, grid.origin_m, std::move(values)};
}

std::vector<std::uint8_t> known_mask(const Grid& grid) {
  std::vector<std::uint8_t> known(grid.values.size());
  std::transform(grid.values.begin(), grid.values.end(), known.begin(),
                 [](float value) { return std::isnan(value) ? 0 : 1; });
  return known;
}

Grid slope_of(const PlaneFit& fit) {
  std::vector<float> slope(fit.gradient.size());
  for (std::size_t cell = 0; cell < slope.size(); ++cell) {
    slope[cell] = std::isnan(fit.height.values[cell]) ? std::numeric_limits<float>::quiet_NaN()
                                                      : std::atan(fit.gradient[cell].norm());
  }
  return same_shape(fit.height, std::move(slope));
}

/// The cell where a tyre that stands over a cell touches the ground: uphill by the normal. At a
/// kink, as at the foot of a riser, it touches on the gentler side.
std::size_t touched_cell(const Grid& dilated, int i, int j, double radius_m) {
  const auto slope_along = [&](int di, int dj) {
    const auto height = [&](int sign) {
      return dilated.at(std::clamp(i + sign * di, 0, dilated.size_x - 1),
                        std::clamp(j + sign * dj, 0, dilated.size_y - 1));
    };
    const double back = height(0) - height(-1), ahead = height(1) - height(0);
    return (std::abs(back) < std::abs(ahead) ? back : ahead) / dilated.cell_m;
  };
  const Eigen::Vector2d gradient(slope_along(1, 0), slope_along(0, 1));
  const Eigen::Vector2d here(i, j);
  if (!gradient.allFinite()) return nearest_cell(dilated, here);
  const double uphill_cells = radius_m / dilated.cell_m / std::sqrt(1.0 + gradient.squaredNorm());
  return nearest_cell(dilated, here + uphill_cells * gradient);
}

/// A tyre can stand here: the ground is gentle, the tyre reaches it before its flanks do, and
/// nothing unknown lies under it. Gentle is the ground where the tyre touches it, which on a slope
/// is not below its centre, or what it rolls over: on the rim of a pit that is level, while a plane
/// fitted to the ground leans into the pit.
std::vector<std::uint8_t> traversable_mask(const Grid& elevation, const Grid& slope,
                                           const Grid& dilated, const Grid& rolling_slope,
                                           const TerrainSettings& settings) {
  std::vector<std::uint8_t> mask =
      terrain_internal::known_within(elevation, settings.wheel_radius_m);
  const auto max_slope = static_cast<float>(settings.max_slope_rad);
  const auto tolerance = static_cast<float>(settings.touch_tolerance_m);
  std::size_t cell = 0;
  for (int j = 0; j < elevation.size_y; ++j) {
    for (int i = 0; i < elevation.size_x; ++i, ++cell) {
      if (mask[cell] == 0) continue;
      const bool gentle =
          rolling_slope.values[cell] <= max_slope ||
          slope.values[touched_cell(dilated, i, j, settings.wheel_radius_m)] <= max_slope;
      if (!gentle || !(dilated.values[cell] - elevation.values[cell] <= tolerance)) mask[cell] = 0;
    }
  }
  return mask;
}

/// Unknown cells take the value of the nearest known cell.
Grid filled_from_neighbours(Grid grid) {
  const std::vector<std::uint8_t> known = known_mask(grid);
  if (std::find(known.begin(), known.end(), 0) == known.end()) return grid;
  const auto nearest =
      terrain_internal::transform_distance(known, grid.size_x, grid.size_y).nearest;
  for (std::size_t cell = 0; cell < known.size(); ++cell) {
    if (known[cell] == 0) grid.values[cell] = grid.values[nearest[cell]];
  }
  return grid;
}

/// Ground a tyre may rest on, carried on for some cells where it ends at a cliff: a spline through
/// the cliff would swing about the ground beside it by centimetres.
Grid without_cliffs(Grid dilated, const std::vector<std::uint8_t>& traversable,
                    const std::vector<std::int32_t>& nearest_traversable) {
  constexpr double kReachCells = 4.5;  // a jump dies away by 0.27 from cell to cell
  constexpr double kJumpM = 0.25, kSteepest = 0.7;
  const Grid before = dilated;
  const auto size_x = static_cast<std::size_t>(dilated.size_x);
  for (std::size_t cell = 0; cell < traversable.size(); ++cell) {
    if (traversable[cell] != 0 || nearest_traversable[cell] < 0) continue;
    const auto near = static_cast<std::size_t>(nearest_traversable[cell]);
    const auto along = [](std::size_t a, std::size_t b) {
      return static_cast<double>(a) - static_cast<double>(b);
    };
    const double cells =
        std::hypot(along(cell % size_x, near % size_x), along(cell / size_x, near / size_x));
    const double jump_m = std::abs(before.values[cell] - before.values[near]);
    if (cells < kReachCells && jump_m > kJumpM + kSteepest * cells * dilated.cell_m) {
      dilated.values[cell] = before.values[near];
    }
  }
  return dilated;
}

Result<void> check_buildable(const Grid& elevation, const TerrainSettings& settings) {
  WEX_EXPECTS(elevation.values.size() ==
              static_cast<std::size_t>(elevation.size_x) * elevation.size_y);
  WEX_EXPECTS(settings.fit_radius_m > 0.0 && settings.filter_radius_m > 0.0 &&
              settings.wheel_radius_m > 0.0 && settings.max_slope_rad > 0.0 &&
              settings.touch_tolerance_m >= 0.0);
  constexpr int kSmallestSize = 4;
  if (elevation.size_x < kSmallestSize || elevation.size_y < kSmallestSize) {
    return fail(ErrorCode::kBadInput, "the elevation grid has " + std::to_string(elevation.size_x) +
                                          " x " + std::to_string(elevation.size_y) +
                                          " cells, expected at least 4 x 4");
  }
  if (!std::isfinite(elevation.cell_m) || elevation.cell_m <= 0.0) {
    return fail(ErrorCode::kBadInput, "the cell size of the elevation grid is " +
                                          std::to_string(elevation.cell_m) +
                                          " m, expected a positive number");
  }
  if (!elevation.origin_m.allFinite()) {
    return fail(ErrorCode::kBadInput, "the origin of the elevation grid is not a finite position");
  }
  bool any_known = false;
  for (const float height : elevation.values) {
    if (std::isinf(height)) {
      return fail(ErrorCode::kBadInput,
                  "the elevation grid holds an infinite height, expected finite or unknown");
    }
    any_known = any_known || !std::isnan(height);
  }
  if (!any_known) {
    return fail(ErrorCode::kBadInput, "the elevation grid has no known cell");
  }
  return {};
}

}  // namespace

TerrainMap::TerrainMap(std::shared_ptr<const Layers> layers) : layers_(std::move(layers)) {}

Result<TerrainMap> TerrainMap::build(Grid elevation, const TerrainSettings& settings,
                                     const Eigen::Vector2d& map_origin_m) {
  if (const auto checked = check_buildable(elevation, settings); !checked) {
    return tl::unexpected<Error>(checked.error());
  }
  auto layers = std::make_shared<Layers>();
  layers->map_origin_m = map_origin_m;
  layers->fit = terrain_internal::fit_planes(elevation, settings.fit_radius_m);
  layers->filter = terrain_internal::fit_planes(elevation, settings.filter_radius_m);
  layers->slope = slope_of(layers->fit);
  layers->dilated = terrain_internal::dilate_by_tyre(elevation, settings.wheel_radius_m);

  const Grid rolling_slope =
      slope_of(terrain_internal::fit_planes(layers->dilated, settings.fit_radius_m));
  const std::vector<std::uint8_t> mask =
      traversable_mask(elevation, layers->slope, layers->dilated, rolling_slope, settings);
  layers->traversable = same_shape(elevation, std::vector<float>(mask.begin(), mask.end()));
  layers->signed_distance =
      same_shape(elevation, terrain_internal::signed_distance(mask, elevation.size_x,
                                                              elevation.size_y, elevation.cell_m));
  layers->nearest_traversable =
      terrain_internal::transform_distance(mask, elevation.size_x, elevation.size_y).nearest;

  layers->dilated_surface = BsplineSurface(
      filled_from_neighbours(without_cliffs(layers->dilated, mask, layers->nearest_traversable)));
  layers->signed_distance_surface = BsplineSurface(layers->signed_distance);
  layers->elevation = std::move(elevation);
  return TerrainMap(std::move(layers));
}

const Grid& TerrainMap::elevation() const noexcept { return layers_->elevation; }
const Grid& TerrainMap::fitted_height() const noexcept { return layers_->fit.height; }
const Grid& TerrainMap::filtered_height() const noexcept { return layers_->filter.height; }
const Grid& TerrainMap::slope() const noexcept { return layers_->slope; }
const Grid& TerrainMap::dilated_height() const noexcept { return layers_->dilated; }
const Grid& TerrainMap::traversable() const noexcept { return layers_->traversable; }
const Grid& TerrainMap::signed_distance() const noexcept { return layers_->signed_distance; }
const Eigen::Vector2d& TerrainMap::map_origin_m() const noexcept { return layers_->map_origin_m; }

Eigen::Vector2d TerrainMap::min_corner_m() const noexcept { return layers_->elevation.origin_m; }

Eigen::Vector2d TerrainMap::max_corner_m() const noexcept {
  const Grid& grid = layers_->elevation;
  return grid.origin_m + grid.cell_m * Eigen::Vector2d(grid.size_x - 1, grid.size_y - 1);
}

bool TerrainMap::contains(const Eigen::Vector2d& p_world_xy) const noexcept {
  return on_map(layers_->elevation, in_cells(layers_->elevation, p_world_xy));
}

bool TerrainMap::known(const Eigen::Vector2d& p_world_xy) const noexcept {
  return !std::isnan(height_m(p_world_xy));
}

double TerrainMap::height_m(const Eigen::Vector2d& p_world_xy) const noexcept {
  return bilinear(layers_->elevation, p_world_xy);
}

double TerrainMap::filtered_height_m(const Eigen::Vector2d& p_world_xy) const noexcept {
  return bilinear(layers_->filter.height, p_world_xy);
}

double TerrainMap::dilated_height_m(const Eigen::Vector2d& p_world_xy) const noexcept {
  return bilinear(layers_->dilated, p_world_xy);
}

double TerrainMap::signed_distance_m(const Eigen::Vector2d& p_world_xy) const noexcept {
  return bilinear(layers_->signed_distance, p_world_xy);
}

Eigen::Vector3d TerrainMap::normal(const Eigen::Vector2d& p_world_xy) const noexcept {
  const Eigen::Vector2d cells = in_cells(layers_->elevation, p_world_xy);
  if (!on_map(layers_->elevation, cells)) return Eigen::Vector3d::UnitZ();
  return layers_->fit.normal_at(nearest_cell(layers_->elevation, cells));
}

Eigen::Vector3d TerrainMap::filtered_normal(const Eigen::Vector2d& p_world_xy) const noexcept {
  const Eigen::Vector2d cells = in_cells(layers_->elevation, p_world_xy);
  if (!on_map(layers_->elevation, cells)) return Eigen::Vector3d::UnitZ();
  return layers_->filter.normal_at(nearest_cell(layers_->elevation, cells));
}

bool TerrainMap::traversable_at(const Eigen::Vector2d& p_world_xy) const noexcept {
  const Eigen::Vector2d cells = in_cells(layers_->elevation, p_world_xy);
  return on_map(layers_->elevation, cells) &&
         layers_->traversable.values[nearest_cell(layers_->elevation, cells)] > 0.5F;
}

Eigen::Vector2d TerrainMap::nearest_traversable(const Eigen::Vector2d& p_world_xy) const noexcept {
  const Grid& grid = layers_->elevation;
  const Eigen::Vector2d cells = in_cells(grid, p_world_xy);
  if (cells.hasNaN()) return {kNan, kNan};
  const std::int32_t nearest = layers_->nearest_traversable[nearest_cell(grid, cells)];
  if (nearest < 0) return {kNan, kNan};
  return grid.origin_m +
         grid.cell_m * Eigen::Vector2d(nearest % grid.size_x, nearest / grid.size_x);
}

SurfaceSample TerrainMap::dilated_surface(const Eigen::Vector2d& p_world_xy) const noexcept {
  return layers_->dilated_surface.sample(p_world_xy);
}

SurfaceSample TerrainMap::signed_distance_surface(
    const Eigen::Vector2d& p_world_xy) const noexcept {
  return layers_->signed_distance_surface.sample(p_world_xy);
}

}  // namespace wex
