#include "tools/wex/ground_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace wex::app {
namespace {

Color mix(const Color& a, const Color& b, double share_of_b) {
  return {a.red + share_of_b * (b.red - a.red), a.green + share_of_b * (b.green - a.green),
          a.blue + share_of_b * (b.blue - a.blue), 1.0};
}

std::uint32_t pixel(const Color& c) {
  const auto byte = [](double value) {
    return static_cast<std::uint32_t>(std::lround(255.0 * std::clamp(value, 0.0, 1.0)));
  };
  return byte(c.red) << 16 | byte(c.green) << 8 | byte(c.blue);
}

/// Brightness 0.35 to 1 of a slope under a sun in the north-west, 45 degrees high.
double hillshade(const Grid& z, int i, int j) {
  const auto at = [&](int a, int b) {
    const float value = z.at(std::clamp(a, 0, z.size_x - 1), std::clamp(b, 0, z.size_y - 1));
    return static_cast<double>(std::isfinite(value) ? value : z.at(i, j));
  };
  const Eigen::Vector3d normal =
      Eigen::Vector3d(at(i - 1, j) - at(i + 1, j), at(i, j - 1) - at(i, j + 1), 2.0 * z.cell_m)
          .normalized();
  const Eigen::Vector3d sun = Eigen::Vector3d(-1.0, 1.0, std::sqrt(2.0)).normalized();
  return std::clamp(0.35 + 0.9 * normal.dot(sun), 0.35, 1.15);
}

}  // namespace

Color height_tint(double height_m, double lo_m, double hi_m) {
  constexpr std::array<Color, 5> kScale{{{0.42, 0.55, 0.47},
                                         {0.62, 0.71, 0.53},
                                         {0.86, 0.82, 0.62},
                                         {0.77, 0.64, 0.48},
                                         {0.93, 0.91, 0.89}}};
  const double share = hi_m > lo_m ? std::clamp((height_m - lo_m) / (hi_m - lo_m), 0.0, 1.0) : 0.5;
  const double position = share * (kScale.size() - 1);
  const auto below = std::min<std::size_t>(static_cast<std::size_t>(position), kScale.size() - 2);
  return mix(kScale[below], kScale[below + 1], position - static_cast<double>(below));
}

std::pair<double, double> height_range_m(const Grid& elevation, const MapWindow& window) {
  double lo = std::numeric_limits<double>::infinity(), hi = -lo;
  for (int j = window.j0; j < window.j1; ++j) {
    for (int i = window.i0; i < window.i1; ++i) {
      const double z = elevation.at(i, j);
      if (!std::isfinite(z)) continue;
      lo = std::min(lo, z);
      hi = std::max(hi, z);
    }
  }
  return lo <= hi ? std::pair{lo, hi} : std::pair{0.0, 1.0};
}

std::pair<double, double> tint_range_m(const Grid& elevation, const MapWindow& window) {
  constexpr double kLeastRangeM = 0.5;
  const auto [lo, hi] = height_range_m(elevation, window);
  const double middle = 0.5 * (lo + hi), half = 0.5 * std::max(hi - lo, kLeastRangeM);
  return {middle - half, middle + half};
}

std::vector<std::uint32_t> ground_pixels(const TerrainMap& terrain, const MapWindow& window) {
  const Grid& z = terrain.elevation();
  const auto [lo, hi] = tint_range_m(z, window);
  constexpr Color kUnknown{0.55, 0.55, 0.58}, kForbidden{0.80, 0.12, 0.10};
  std::vector<std::uint32_t> pixels;
  pixels.reserve(static_cast<std::size_t>(window.i1 - window.i0) *
                 static_cast<std::size_t>(window.j1 - window.j0));
  for (int j = window.j1 - 1; j >= window.j0; --j) {
    for (int i = window.i0; i < window.i1; ++i) {
      if (!std::isfinite(z.at(i, j))) {
        pixels.push_back(pixel(kUnknown));
        continue;
      }
      Color c = height_tint(z.at(i, j), lo, hi);
      if (terrain.traversable().at(i, j) < 0.5f) c = mix(c, kForbidden, 0.45);
      const double light = hillshade(z, i, j);
      pixels.push_back(pixel({c.red * light, c.green * light, c.blue * light}));
    }
  }
  return pixels;
}

std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> contour_pieces(const Grid& elevation,
                                                                        const MapWindow& window,
                                                                        double step_m) {
  WEX_EXPECTS(step_m > 0.0);
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> pieces;
  for (int j = window.j0; j + 1 < window.j1; ++j) {
    for (int i = window.i0; i + 1 < window.i1; ++i) {
      const std::array<Eigen::Vector2i, 4> corner{{{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
      std::array<double, 4> z{};
      for (int k = 0; k < 4; ++k) z[k] = elevation.at(corner[k].x(), corner[k].y());
      const auto [lo, hi] = std::minmax_element(z.begin(), z.end());
      if (!std::isfinite(*lo + *hi) || !std::isfinite(z[0] + z[1] + z[2] + z[3])) continue;
      for (double level = std::ceil(*lo / step_m) * step_m; level <= *hi; level += step_m) {
        std::vector<Eigen::Vector2d> crossings;
        for (int k = 0; k < 4; ++k) {
          const double a = z[k], b = z[(k + 1) % 4];
          if ((a < level) == (b < level)) continue;
          const Eigen::Vector2d from = corner[k].cast<double>();
          const Eigen::Vector2d to = corner[(k + 1) % 4].cast<double>();
          crossings.push_back(elevation.origin_m +
                              elevation.cell_m * (from + (level - a) / (b - a) * (to - from)));
        }
        for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) {
          pieces.emplace_back(crossings[k], crossings[k + 1]);
        }
      }
    }
  }
  return pieces;
}

}  // namespace wex::app
