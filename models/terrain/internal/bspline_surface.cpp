#include "models/terrain/internal/bspline_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace wex::terrain_internal {
namespace {

/// Factors of the tridiagonal system c[i-1] + 4 c[i] + c[i+1] = 6 f[i], the same for every line.
/// Factor 0 is zero: the first coefficient is known.
std::vector<double> elimination_factors(int size) {
  std::vector<double> factor(size, 0.0);
  for (int i = 1; i + 1 < size; ++i) factor[i] = 1.0 / (4.0 - factor[i - 1]);
  return factor;
}

/// Coefficients of `lines` interleaved cubic splines at once: sample k of line l stands at
/// data[k * sample_stride + l * line_stride] and samples -1 and size get the natural ends.
void prefilter(double* data, int size, std::ptrdiff_t sample_stride, int lines,
               std::ptrdiff_t line_stride) {
  const std::vector<double> factor = elimination_factors(size);
  const auto at = [&](int k, int l) -> double& {
    return data[k * sample_stride + l * line_stride];
  };
  // A zero second derivative at the ends makes the end coefficients equal to the end samples.
  for (int k = 1; k + 1 < size; ++k) {
    for (int l = 0; l < lines; ++l) at(k, l) = (6.0 * at(k, l) - at(k - 1, l)) * factor[k];
  }
  for (int k = size - 2; k >= 1; --k) {
    for (int l = 0; l < lines; ++l) at(k, l) -= factor[k] * at(k + 1, l);
  }
  for (int l = 0; l < lines; ++l) {
    at(-1, l) = 2.0 * at(0, l) - at(1, l);
    at(size, l) = 2.0 * at(size - 1, l) - at(size - 2, l);
  }
}

/// The four basis functions that live on a cell, and their derivatives, at t in [0, 1].
struct Basis {
  std::array<double, 4> value, first, second;

  explicit Basis(double t) {
    const double s = 1.0 - t;
    value = {s * s * s / 6.0, (4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0,
             (4.0 - 6.0 * s * s + 3.0 * s * s * s) / 6.0, t * t * t / 6.0};
    first = {-0.5 * s * s, t * (1.5 * t - 2.0), -s * (1.5 * s - 2.0), 0.5 * t * t};
    second = {s, 3.0 * t - 2.0, 3.0 * s - 2.0, t};
  }
};

struct Location {
  int cell = 0;
  double t = 0.0;
  bool clamped = false;
};

Location locate(double u, int size) {
  const double clamped = std::clamp(u, 0.0, static_cast<double>(size - 1));
  const int cell = std::min(static_cast<int>(clamped), size - 2);
  constexpr double kRoundOff = 1e-9;  // cells; a point on the edge is not beyond it
  return {cell, clamped - cell, std::abs(clamped - u) > kRoundOff};
}

}  // namespace

BsplineSurface::BsplineSurface(const Grid& samples)
    : size_x_(samples.size_x),
      size_y_(samples.size_y),
      cell_m_(samples.cell_m),
      origin_m_(samples.origin_m) {
  WEX_EXPECTS(size_x_ >= 2 && size_y_ >= 2);
  const std::ptrdiff_t stride = size_x_ + 2;
  coefficients_.assign(static_cast<std::size_t>(stride) * (size_y_ + 2), 0.0);
  double* const inner = coefficients_.data() + stride + 1;
  for (int j = 0; j < size_y_; ++j) {
    for (int i = 0; i < size_x_; ++i) inner[j * stride + i] = samples.at(i, j);
  }
  prefilter(inner, size_y_, stride, size_x_, 1);
  // Along x also for the two rows just added.
  prefilter(inner - stride, size_x_, 1, size_y_ + 2, stride);
}

SurfaceSample BsplineSurface::sample(const Eigen::Vector2d& p_world_xy) const noexcept {
  SurfaceSample result;
  if (coefficients_.empty() || std::isnan(p_world_xy.x()) || std::isnan(p_world_xy.y())) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    result.value = nan;
    result.gradient.setConstant(nan);
    result.hessian.setConstant(nan);
    return result;
  }
  const Location at_x = locate((p_world_xy.x() - origin_m_.x()) / cell_m_, size_x_);
  const Location at_y = locate((p_world_xy.y() - origin_m_.y()) / cell_m_, size_y_);
  const Basis in_x(at_x.t);
  const Basis in_y(at_y.t);

  double value = 0.0, d_x = 0.0, d_y = 0.0, d_xx = 0.0, d_xy = 0.0, d_yy = 0.0;
  const std::ptrdiff_t stride = size_x_ + 2;
  for (int b = 0; b < 4; ++b) {
    // Coefficient (cell - 1) of the samples is number cell of the padded array.
    const double* const c = coefficients_.data() + (at_y.cell + b) * stride + at_x.cell;
    double row = 0.0, row_first = 0.0, row_second = 0.0;
    for (int a = 0; a < 4; ++a) {
      row += in_x.value[a] * c[a];
      row_first += in_x.first[a] * c[a];
      row_second += in_x.second[a] * c[a];
    }
    value += in_y.value[b] * row;
    d_x += in_y.value[b] * row_first;
    d_y += in_y.first[b] * row;
    d_xx += in_y.value[b] * row_second;
    d_xy += in_y.first[b] * row_first;
    d_yy += in_y.second[b] * row;
  }
  if (at_x.clamped) d_x = d_xx = d_xy = 0.0;
  if (at_y.clamped) d_y = d_yy = d_xy = 0.0;
  result.value = value;
  result.gradient << d_x / cell_m_, d_y / cell_m_;
  result.hessian << d_xx, d_xy, d_xy, d_yy;
  result.hessian /= cell_m_ * cell_m_;
  return result;
}

}  // namespace wex::terrain_internal
