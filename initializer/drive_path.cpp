#include "initializer/drive_path.hpp"

#include <algorithm>
#include <cmath>

#include "models/types/result.hpp"

namespace wex {
namespace {

constexpr double kShortestSegmentM = 1e-6;

double gear_of(const PathSegment& segment) { return segment.length_m < 0.0 ? -1.0 : 1.0; }

bool is_piece(const PathSegment& segment) {
  return std::abs(segment.length_m) >= kShortestSegmentM;
}

DrivePath pieces_of(const DrivePath& path) {
  DrivePath pieces;
  std::copy_if(path.begin(), path.end(), std::back_inserter(pieces), is_piece);
  return pieces;
}

// Integral of a piecewise linear function from its first sample to any place between the ends.
class LinearIntegral {
 public:
  LinearIntegral(const std::vector<double>& s, const std::vector<double>& values)
      : s_(s), values_(values), integral_(s.size(), 0.0) {
    for (std::size_t i = 1; i < s.size(); ++i) {
      integral_[i] = integral_[i - 1] + 0.5 * (values[i] + values[i - 1]) * (s[i] - s[i - 1]);
    }
  }

  [[nodiscard]] double operator()(double at) const {
    const auto above = std::upper_bound(s_.begin(), s_.end(), at);
    if (above == s_.begin()) return 0.0;
    if (above == s_.end()) return integral_.back();
    const std::size_t i = static_cast<std::size_t>(above - s_.begin()) - 1;
    const double u = at - s_[i];
    const double slope = (values_[i + 1] - values_[i]) / (s_[i + 1] - s_[i]);
    return integral_[i] + values_[i] * u + 0.5 * slope * u * u;
  }

 private:
  const std::vector<double>& s_;
  const std::vector<double>& values_;
  std::vector<double> integral_;
};

}  // namespace

Pose2 pose_along(const PathSegment& segment, double distance_m) {
  const double k = segment.curvature_1_m;
  const double yaw_0 = segment.start.yaw_rad;
  const double yaw_1 = yaw_0 + k * distance_m;
  if (std::abs(k) < 1e-9) {
    return {segment.start.x_m + distance_m * std::cos(yaw_0),
            segment.start.y_m + distance_m * std::sin(yaw_0), yaw_1};
  }
  return {segment.start.x_m + (std::sin(yaw_1) - std::sin(yaw_0)) / k,
          segment.start.y_m - (std::cos(yaw_1) - std::cos(yaw_0)) / k, yaw_1};
}

void append_path(DrivePath& path, const DrivePath& more) {
  double shift_rad = 0.0;
  if (!path.empty() && !more.empty()) {
    const double end_rad = pose_along(path.back(), path.back().length_m).yaw_rad;
    const double jump_rad = more.front().start.yaw_rad - end_rad;
    shift_rad = wrap_angle(jump_rad) - jump_rad;
  }
  for (PathSegment segment : more) {
    segment.start.yaw_rad += shift_rad;
    path.push_back(segment);
  }
}

bool same_way(const DrivePath& a, const DrivePath& b) {
  constexpr double kSameM = 1e-6;
  const auto next = [](const DrivePath& path, std::size_t i) {
    while (i < path.size() && std::abs(path[i].length_m) < kSameM) ++i;
    return i;
  };
  std::size_t i = next(a, 0), j = next(b, 0);
  while (i < a.size() && j < b.size()) {
    if (std::abs(a[i].length_m - b[j].length_m) > kSameM ||
        std::abs(a[i].curvature_1_m - b[j].curvature_1_m) > kSameM) {
      return false;
    }
    i = next(a, i + 1);
    j = next(b, j + 1);
  }
  return i == a.size() && j == b.size();
}

double path_length_m(const DrivePath& path) {
  double length_m = 0.0;
  for (const PathSegment& segment : path) length_m += std::abs(segment.length_m);
  return length_m;
}

double path_cost_m(const DrivePath& path, const PathCostWeights& weights) {
  double cost_m = 0.0;
  double gear = 0.0;
  for (const PathSegment& segment : path) {
    if (!is_piece(segment)) continue;
    const double share = segment.length_m < 0.0 ? 1.0 + weights.reverse_share : 1.0;
    cost_m += share * std::abs(segment.length_m);
    if (gear * segment.length_m < 0.0) cost_m += weights.cusp_m;
    gear = gear_of(segment);
  }
  return cost_m;
}

std::vector<Station> path_stations(const DrivePath& path, double max_spacing_m) {
  WEX_EXPECTS(!path.empty() && max_spacing_m > 0.0);
  const DrivePath pieces = pieces_of(path);
  if (pieces.empty()) return {{0.0, path.front().start, 1.0, true}};

  std::vector<Station> stations{{0.0, pieces.front().start, gear_of(pieces.front()), true}};
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const PathSegment& piece = pieces[i];
    const double length_m = std::abs(piece.length_m);
    const double gear = gear_of(piece);
    const bool last = i + 1 == pieces.size();
    const bool stops_after = last || gear_of(pieces[i + 1]) != gear;
    int steps = std::max(1, static_cast<int>(std::ceil(length_m / max_spacing_m - 1e-9)));
    if (stations.back().stop && stops_after) steps = std::max(steps, 2);
    const double s_0 = stations.back().s_m;
    for (int k = 1; k <= steps; ++k) {
      const double along_m = length_m * k / steps;
      stations.push_back(
          {s_0 + along_m, pose_along(piece, gear * along_m), gear, k == steps && stops_after});
    }
  }
  return stations;
}

std::vector<double> steered_curvature_1_m(const DrivePath& path,
                                          const std::vector<Station>& stations, double window_m) {
  WEX_EXPECTS(window_m > 0.0);
  const DrivePath pieces = pieces_of(path);
  std::vector<double> ends_m{0.0}, integral{0.0};  // of curvature over distance driven
  for (const PathSegment& piece : pieces) {
    const double length_m = std::abs(piece.length_m);
    ends_m.push_back(ends_m.back() + length_m);
    integral.push_back(integral.back() + piece.curvature_1_m * length_m);
  }
  const auto integral_to = [&](double s) {
    if (s <= 0.0 || pieces.empty()) return 0.0;
    std::size_t i = 0;
    while (i + 1 < pieces.size() && s > ends_m[i + 1]) ++i;
    return integral[i] + pieces[i].curvature_1_m * (s - ends_m[i]);  // the last piece goes on
  };
  const double half_m = 0.5 * window_m;
  std::vector<double> curvature(stations.size());
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const double s = stations[i].s_m;
    const double mean = (integral_to(s + half_m) - integral_to(s - half_m)) / window_m;
    curvature[i] = std::min(1.0, s / half_m) * mean;
  }
  return curvature;
}

std::vector<double> moving_average(const std::vector<double>& s, const std::vector<double>& values,
                                   double window_m) {
  WEX_EXPECTS(s.size() == values.size() && !s.empty());
  // Beyond an end the function goes on as its own mirror image through the end point.
  std::vector<double> s_beyond, values_beyond;
  const auto add = [&](double at, double value) {
    s_beyond.push_back(at);
    values_beyond.push_back(value);
  };
  for (std::size_t i = s.size() - 1; i > 0; --i) {
    add(2.0 * s.front() - s[i], 2.0 * values.front() - values[i]);
  }
  for (std::size_t i = 0; i < s.size(); ++i) add(s[i], values[i]);
  for (std::size_t i = s.size() - 1; i > 0; --i) {
    add(2.0 * s.back() - s[i - 1], 2.0 * values.back() - values[i - 1]);
  }
  const LinearIntegral integral(s_beyond, values_beyond);
  const double half_m = std::min(0.5 * window_m, s.back() - s.front());
  std::vector<double> mean(values);
  if (half_m <= 0.0) return mean;
  for (std::size_t i = 0; i < s.size(); ++i) {
    mean[i] = (integral(s[i] + half_m) - integral(s[i] - half_m)) / (2.0 * half_m);
  }
  return mean;
}

}  // namespace wex
