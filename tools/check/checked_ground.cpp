#include "tools/check/checked_ground.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "models/types/result.hpp"

namespace wex::check {
namespace {

constexpr double kFitRadiusM = 0.3;
constexpr double kTyreRadiusM = 0.6, kFlankM = 0.12;
constexpr double kTyrePressM = 0.04;  // about the static sag
constexpr float kNotFitted = -1.0F;
constexpr int kBlockCells = 8;
// Samples of the tyre's lower half: about 3 cm along the tread, 5 to 10 cm across.
constexpr int kTreadSamples = 45, kWidthSamples = 5;
constexpr double kTreadHalfAngleRad = 1.2;

struct TreadAngles {
  std::array<double, kTreadSamples> cosine, sine;
};

TreadAngles tread_angles() {
  TreadAngles angles{};
  for (std::size_t k = 0; k < kTreadSamples; ++k) {
    const double angle =
        kTreadHalfAngleRad * (2.0 * static_cast<double>(k) / (kTreadSamples - 1) - 1.0);
    angles.cosine[k] = std::cos(angle);
    angles.sine[k] = std::sin(angle);
  }
  return angles;
}

}  // namespace

CheckedGround::CheckedGround(Grid elevation) : grid_(std::move(elevation)) {
  WEX_EXPECTS(grid_.size_x >= 2 && grid_.size_y >= 2 && grid_.cell_m > 0.0);
  cells_per_m_ = 1.0 / grid_.cell_m;
  last_x_ = grid_.size_x - 1;
  last_y_ = grid_.size_y - 1;
  for (std::vector<float>& slopes : slope_) slopes.assign(grid_.values.size(), kNotFitted);
  rolled_.assign(grid_.values.size(), Rolled{});
  blocks_x_ = (grid_.size_x + kBlockCells - 1) / kBlockCells;
  blocks_y_ = (grid_.size_y + kBlockCells - 1) / kBlockCells;
  block_max_.assign(static_cast<std::size_t>(blocks_x_) * blocks_y_,
                    -std::numeric_limits<float>::infinity());
  for (int j = 0; j < grid_.size_y; ++j) {
    for (int i = 0; i < grid_.size_x; ++i) {
      float& block =
          block_max_[static_cast<std::size_t>(j / kBlockCells) * blocks_x_ + i / kBlockCells];
      const float height = grid_.at(i, j);
      if (height > block) block = height;  // false for NaN
    }
  }
}

double CheckedGround::max_height_m(double x, double y, double radius_m) const noexcept {
  // One sample more on every side: bilinear heights between samples come from both.
  const auto block = [&](double position_m, double origin_m, double reach_m, int num_blocks) {
    const double cell = (position_m - origin_m + reach_m) * cells_per_m_;
    return std::clamp(static_cast<int>(std::floor(cell / kBlockCells)), 0, num_blocks - 1);
  };
  const double reach_m = radius_m + grid_.cell_m;
  const int i0 = block(x, grid_.origin_m.x(), -reach_m, blocks_x_);
  const int i1 = block(x, grid_.origin_m.x(), reach_m, blocks_x_);
  const int j0 = block(y, grid_.origin_m.y(), -reach_m, blocks_y_);
  const int j1 = block(y, grid_.origin_m.y(), reach_m, blocks_y_);
  float highest = -std::numeric_limits<float>::infinity();
  for (int j = j0; j <= j1; ++j) {
    for (int i = i0; i <= i1; ++i) {
      highest = std::max(highest, block_max_[static_cast<std::size_t>(j) * blocks_x_ + i]);
    }
  }
  return highest;
}

// Smallest vertical way down of the cylinder onto the map's samples below it.
double CheckedGround::lowered_onto_samples(const Eigen::Vector3d& c, const Eigen::Vector3d& a,
                                           double radius_m, double half_width_m) const {
  const double ax = std::abs(a.x()), ay = std::abs(a.y());
  const double half_x = radius_m * std::sqrt(std::max(0.0, 1.0 - ax * ax)) + half_width_m * ax;
  const double half_y = radius_m * std::sqrt(std::max(0.0, 1.0 - ay * ay)) + half_width_m * ay;
  const auto first = [&](double low_m, double origin_m) {
    return std::max(0, static_cast<int>(std::ceil((low_m - origin_m) * cells_per_m_)));
  };
  const auto last = [&](double high_m, double origin_m, int size) {
    return std::min(size - 1, static_cast<int>(std::floor((high_m - origin_m) * cells_per_m_)));
  };
  const int i0 = first(c.x() - half_x, grid_.origin_m.x());
  const int i1 = last(c.x() + half_x, grid_.origin_m.x(), grid_.size_x);
  const int j0 = first(c.y() - half_y, grid_.origin_m.y());
  const int j1 = last(c.y() + half_y, grid_.origin_m.y(), grid_.size_y);

  const double quadratic = 1.0 - a.z() * a.z();
  double gap_m = std::numeric_limits<double>::infinity();
  for (int j = j0; j <= j1; ++j) {
    const double dy = grid_.origin_m.y() + j * grid_.cell_m - c.y();
    for (int i = i0; i <= i1; ++i) {
      const double dx = grid_.origin_m.x() + i * grid_.cell_m - c.x();
      // Lowest z of (dx, dy, z) inside the infinite cylinder: |d|^2 - (d.a)^2 = r^2.
      const double along_0 = dx * a.x() + dy * a.y();
      const double half_linear = -along_0 * a.z();
      const double constant = dx * dx + dy * dy - along_0 * along_0 - radius_m * radius_m;
      const double discriminant = half_linear * half_linear - quadratic * constant;
      if (discriminant < 0.0) continue;
      const double root = std::sqrt(discriminant);
      double z = (-half_linear - root) / quadratic;
      const double along = along_0 + z * a.z();
      if (std::abs(along) > half_width_m) {
        // The vertical line enters through a flat side, or not at all.
        if (std::abs(a.z()) < 1e-9) continue;
        const double enter = (std::copysign(half_width_m, along) - along_0) / a.z();
        if (enter < z || enter > (-half_linear + root) / quadratic) continue;
        z = enter;
      }
      gap_m = std::min(gap_m, c.z() + z - grid_.at(i, j));
    }
  }
  return gap_m;
}

TyreOnGround CheckedGround::tyre(const Eigen::Vector3d& c, const Eigen::Vector3d& axle,
                                 double radius_m, double half_width_m) const {
  static const TreadAngles angles = tread_angles();
  const Eigen::Vector3d down = (axle.z() * axle - Eigen::Vector3d::UnitZ()).normalized();
  const Eigen::Vector3d forward = down.cross(axle);
  std::array<double, kTreadSamples * kWidthSamples> gaps;
  double least = std::numeric_limits<double>::infinity();
  TyreOnGround result;
  std::size_t index = 0;
  for (int w = 0; w < kWidthSamples; ++w) {
    const Eigen::Vector3d middle = c + half_width_m * (2.0 * w / (kWidthSamples - 1) - 1.0) * axle;
    for (std::size_t k = 0; k < kTreadSamples; ++k, ++index) {
      const Eigen::Vector3d p =
          middle + radius_m * (angles.cosine[k] * down + angles.sine[k] * forward);
      const double gap = p.z() - height_m(p.x(), p.y());
      gaps[index] = gap;
      if (gap < least) least = gap;
      if (std::isnan(gap)) {
        result.gap_m = kUnknown;
        result.p_world_patch.setConstant(kUnknown);
        return result;
      }
    }
  }
  // Patch: samples weighed by how far they are pressed in.
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double weights = 0.0;
  index = 0;
  for (int w = 0; w < kWidthSamples; ++w) {
    const Eigen::Vector3d middle = c + half_width_m * (2.0 * w / (kWidthSamples - 1) - 1.0) * axle;
    for (std::size_t k = 0; k < kTreadSamples; ++k, ++index) {
      const double weight = least + kTyrePressM - gaps[index];
      if (weight <= 0.0) continue;
      sum += weight * (middle + radius_m * (angles.cosine[k] * down + angles.sine[k] * forward));
      weights += weight;
    }
  }
  result.p_world_patch = sum / weights;
  result.gap_m = std::min(least, lowered_onto_samples(c, axle, radius_m, half_width_m));
  result.known = true;
  return result;
}

// Underside of a tyre (a ball) that is let down over a sample, and the sample it touches.
const CheckedGround::Rolled& CheckedGround::rolled(int i, int j) {
  Rolled& rolled = rolled_[static_cast<std::size_t>(j) * grid_.size_x + i];
  if (!std::isnan(rolled.height_m)) return rolled;
  const int reach = static_cast<int>(kTyreRadiusM * cells_per_m_);
  double highest = -std::numeric_limits<double>::infinity();
  for (int v = std::max(0, j - reach); v <= std::min(grid_.size_y - 1, j + reach); ++v) {
    for (int u = std::max(0, i - reach); u <= std::min(grid_.size_x - 1, i + reach); ++u) {
      const double square =
          kTyreRadiusM * kTyreRadiusM - std::pow(std::hypot(u - i, v - j) * grid_.cell_m, 2);
      if (square <= 0.0 || std::isnan(grid_.at(u, v))) continue;
      const double height = grid_.at(u, v) + std::sqrt(square) - kTyreRadiusM;
      if (height <= highest) continue;
      highest = height;
      rolled.touches = {u, v};
    }
  }
  rolled.height_m = static_cast<float>(highest);
  return rolled;
}

double CheckedGround::fitted_slope_rad(int i, int j, Surface surface) {
  const int reach = static_cast<int>(kFitRadiusM * cells_per_m_ + 1e-6);
  const double radius_cells = kFitRadiusM * cells_per_m_ + 1e-6;
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sums = Eigen::Vector3d::Zero();
  for (int v = std::max(0, j - reach); v <= std::min(grid_.size_y - 1, j + reach); ++v) {
    for (int u = std::max(0, i - reach); u <= std::min(grid_.size_x - 1, i + reach); ++u) {
      if (std::isnan(grid_.at(u, v)) || std::hypot(u - i, v - j) > radius_cells) continue;
      const double height = surface == Surface::kRolled ? rolled(u, v).height_m : grid_.at(u, v);
      const Eigen::Vector3d row(1.0, (u - i) * grid_.cell_m, (v - j) * grid_.cell_m);
      squares += row * row.transpose();
      sums += row * (height - grid_.at(i, j));
    }
  }
  const Eigen::FullPivLU<Eigen::Matrix3d> solver(squares);
  if (!solver.isInvertible()) return kUnknown;
  const Eigen::Vector3d plane = solver.solve(sums);
  return std::atan(std::hypot(plane[1], plane[2]));
}

double CheckedGround::slope_of_cell(int i, int j, Foot foot) {
  if (i < 0 || j < 0 || i >= grid_.size_x || j >= grid_.size_y) return kUnknown;
  float& slope =
      slope_[static_cast<std::size_t>(foot)][static_cast<std::size_t>(j) * grid_.size_x + i];
  if (slope != kNotFitted) return slope;
  slope = std::numeric_limits<float>::quiet_NaN();
  if (std::isnan(grid_.at(i, j))) return slope;
  // Where the tyre's flanks touch first no wheel stands, however level it is.
  if (rolled(i, j).height_m - grid_.at(i, j) > kFlankM) return slope;
  const std::array<int, 2> touched =
      foot == Foot::kTyre ? rolled(i, j).touches : std::array<int, 2>{i, j};
  slope = static_cast<float>(std::min(fitted_slope_rad(i, j, Surface::kRolled),
                                      fitted_slope_rad(touched[0], touched[1], Surface::kRaw)));
  return slope;
}

double CheckedGround::slope_rad(double x, double y, Foot foot) {
  return slope_of_cell(static_cast<int>(std::lround((x - grid_.origin_m.x()) * cells_per_m_)),
                       static_cast<int>(std::lround((y - grid_.origin_m.y()) * cells_per_m_)),
                       foot);
}

double CheckedGround::untraversable_distance_m(double x, double y, Foot foot, double max_slope_rad,
                                               double reach_m) {
  const double u = (x - grid_.origin_m.x()) * cells_per_m_;
  const double v = (y - grid_.origin_m.y()) * cells_per_m_;
  const double reach = reach_m * cells_per_m_;
  double nearest = reach;
  for (int j = static_cast<int>(std::floor(v - reach)); j <= v + reach; ++j) {
    for (int i = static_cast<int>(std::floor(u - reach)); i <= u + reach; ++i) {
      const double distance = std::hypot(i - u, j - v);
      if (distance >= nearest || slope_of_cell(i, j, foot) <= max_slope_rad) continue;
      nearest = distance;
    }
  }
  return nearest * grid_.cell_m;
}

}  // namespace wex::check
