#include "initializer/internal/squared_paths.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "initializer/internal/direct_paths.hpp"

namespace wex {
namespace {

constexpr double kRaySpacingM = 1.0;
constexpr int kRaysPerSide = 5;
constexpr double kRayStepM = 0.2;
constexpr double kGradientReachM = 0.8;  // over which an edge's direction is averaged
constexpr double kReachM = 10.0;         // of a line before its edge
constexpr double kLineStepM = 0.2;
// Before the edge, from where the wheels must be lifted: where the line may be joined.
constexpr std::array<double, 6> kRunUpsM = {0.4, 1.2, 2.2, 3.4, 5.0, 7.0};

/// A point where traversable ground ends, and the way straight across.
struct Edge {
  Eigen::Vector2d p_world;
  double yaw_rad = 0.0;
};

/// Poses along a line of one heading, and what they ask for.
struct Line {
  Pose2 first;
  std::vector<Footholds> footholds;  ///< every kLineStepM
  std::size_t edge = 0;

  [[nodiscard]] Pose2 at(std::size_t k) const {
    return pose_along({first, 0.0, 0.0}, static_cast<double>(k) * kLineStepM);
  }
};

std::optional<double> yaw_across(const TerrainMap& terrain, const Eigen::Vector2d& p,
                                 const Eigen::Vector2d& onward) {
  // The least squares gradient of the signed distance on a disc.
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  constexpr int kSteps = 4;
  for (int i = -kSteps; i <= kSteps; ++i) {
    for (int j = -kSteps; j <= kSteps; ++j) {
      const Eigen::Vector2d offset = kGradientReachM / kSteps * Eigen::Vector2d(i, j);
      const double distance_m = terrain.signed_distance_m(p + offset);
      if (offset.norm() > kGradientReachM || std::isnan(distance_m)) continue;
      gradient += distance_m * offset;
    }
  }
  if (gradient.norm() < 1e-3) return std::nullopt;
  const Eigen::Vector2d across = gradient.dot(onward) > 0.0 ? gradient : -gradient;
  return std::atan2(across.y(), across.x());
}

/// The first edge on every ray beside the way from start to goal.
std::vector<Edge> edges_between(const TerrainMap& terrain, const Pose2& start, const Pose2& goal) {
  const Eigen::Vector2d from(start.x_m, start.y_m), to(goal.x_m, goal.y_m);
  const double length_m = (to - from).norm();
  std::vector<Edge> edges;
  if (length_m < kRayStepM) return edges;
  const Eigen::Vector2d onward = (to - from) / length_m, left(-onward.y(), onward.x());
  for (int ray = -kRaysPerSide; ray <= kRaysPerSide; ++ray) {
    bool inside = false;
    for (double s = 0.0; s < length_m; s += kRayStepM) {
      const Eigen::Vector2d p = from + s * onward + kRaySpacingM * ray * left;
      const double distance_m = terrain.signed_distance_m(p);
      if (std::isnan(distance_m)) break;
      if (inside && distance_m <= 0.0) {
        if (const auto yaw_rad = yaw_across(terrain, p, onward)) edges.push_back({p, *yaw_rad});
        break;
      }
      inside = distance_m > 0.0;
    }
  }
  return edges;
}

Line line_through(const Edge& edge, double yaw_rad, double length_m,
                  const PoseFootholds& footholds) {
  Line line;
  const Eigen::Vector2d along(std::cos(yaw_rad), std::sin(yaw_rad));
  const Eigen::Vector2d first = edge.p_world - kReachM * along;
  line.first = {first.x(), first.y(), yaw_rad};
  line.edge = static_cast<std::size_t>(kReachM / kLineStepM);
  const auto count = static_cast<std::size_t>((kReachM + length_m) / kLineStepM);
  for (std::size_t k = 0; k < count; ++k) line.footholds.push_back(footholds(line.at(k), 0.0));
  return line;
}

/// The cheapest way on four wheels.
std::optional<DrivePath> drive(const Pose2& from, const Pose2& to, const SearchSettings& settings,
                               const PoseFootholds& footholds) {
  for (DrivePath& path : direct_paths(from, to, settings.turning_radius_m, settings.cost)) {
    const bool drivable = path_is_valid(
        path, settings.subnode_spacing_m, [&](const Pose2& pose, double curvature_1_m) {
          return footholds(pose, curvature_1_m) == Footholds::kAllWheels;
        });
    if (drivable) return std::move(path);
  }
  return std::nullopt;
}

/// Start to line, along it across all that needs stepping, line to goal.
std::optional<DrivePath> path_over(const Line& line, const Pose2& start, const Pose2& goal,
                                   const SearchSettings& settings, const PoseFootholds& footholds) {
  const std::vector<Footholds>& feet = line.footholds;
  // Back from the edge to the last place where all wheels stand.
  std::size_t stands = std::min(line.edge, feet.size() - 1);
  while (stands > 0 && feet[stands] == Footholds::kSomeWheels) --stands;
  if (feet[stands] != Footholds::kAllWheels) return std::nullopt;
  std::optional<DrivePath> path;
  std::size_t joined = 0;
  for (const double run_up_m : kRunUpsM) {
    const auto back = static_cast<std::size_t>(run_up_m / kLineStepM);
    if (back > stands) break;
    const std::size_t k = stands - back;
    if (std::any_of(feet.begin() + static_cast<std::ptrdiff_t>(k),
                    feet.begin() + static_cast<std::ptrdiff_t>(stands),
                    [](Footholds f) { return f == Footholds::kNone; })) {
      break;
    }
    if (feet[k] != Footholds::kAllWheels) continue;
    path = drive(start, line.at(k), settings, footholds);
    joined = k;
    if (path) break;
  }
  if (!path) return std::nullopt;

  bool stepped = false;
  std::size_t stood = 0;  // poses on four wheels in a row
  for (std::size_t k = stands; k < feet.size() && feet[k] != Footholds::kNone; ++k) {
    stepped = stepped || feet[k] == Footholds::kSomeWheels;
    stood = feet[k] == Footholds::kAllWheels ? stood + 1 : 0;
    constexpr std::size_t kLeast = 3, kEvery = 4;
    if (!stepped || stood < kLeast || (stood - kLeast) % kEvery != 0) continue;
    const auto rest = drive(line.at(k), goal, settings, footholds);
    if (!rest) continue;
    append_path(*path, {{line.at(joined), 0.0, static_cast<double>(k - joined) * kLineStepM}});
    append_path(*path, *rest);
    return path;
  }
  return std::nullopt;
}

}  // namespace

std::vector<DrivePath> squared_paths(const TerrainMap& terrain, const Pose2& start,
                                     const Pose2& goal, const SearchSettings& settings,
                                     const PoseFootholds& footholds, std::size_t max_paths) {
  const double length_m = std::hypot(goal.x_m - start.x_m, goal.y_m - start.y_m);
  std::vector<DrivePath> paths;
  for (const Edge& edge : edges_between(terrain, start, goal)) {
    const Line line = line_through(edge, edge.yaw_rad, length_m, footholds);
    if (auto path = path_over(line, start, goal, settings, footholds)) {
      paths.push_back(*std::move(path));
    }
  }
  std::stable_sort(paths.begin(), paths.end(), [&](const DrivePath& a, const DrivePath& b) {
    return path_cost_m(a, settings.cost) < path_cost_m(b, settings.cost);
  });
  if (paths.size() > max_paths) paths.resize(max_paths);
  return paths;
}

}  // namespace wex
