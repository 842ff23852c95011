#include "initializer/internal/squared_paths.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace wex {
namespace {

constexpr double kRaySpacingM = 1.0;
constexpr int kRaysPerSide = 5;
constexpr double kRayStepM = 0.2;
constexpr double kGradientReachM = 1.6;  // over which the steps of an edge by cells average out
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
  constexpr int kSteps = 8;
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

/// Ways around one end of the path, a few arcs long, that never lift a wheel.
class Manoeuvres {
 public:
  struct Way {
    Pose2 pose;      ///< where it leads, or, at the goal, comes from
    DrivePath path;  ///< in driving order; empty: none
    double cost_m = 0.0;
  };

  Manoeuvres(const Pose2& end, bool is_goal, const SearchSettings& settings,
             const PoseFootholds& footholds)
      : settings_(settings),
        is_goal_(is_goal),
        drivable_([&footholds](const Pose2& pose, double curvature_1_m) {
          return footholds(pose, curvature_1_m) == Footholds::kAllWheels;
        }) {
    ways_.push_back({end, {}, 0.0});
    for (int arcs = 0; arcs < kArcs; ++arcs) {
      const std::size_t known = ways_.size();
      for (std::size_t k = first_leaf_; k < known; ++k) extend(k);
      first_leaf_ = known;
    }
    std::stable_sort(ways_.begin(), ways_.end(),
                     [](const Way& a, const Way& b) { return a.cost_m < b.cost_m; });
  }

  /// The cheapest found between the end and another pose.
  [[nodiscard]] std::optional<DrivePath> connect(const Pose2& other) const {
    std::optional<DrivePath> best;
    double least_m = 1e9;
    for (const Way& way : ways_) {
      if (way.cost_m + std::hypot(other.x_m - way.pose.x_m, other.y_m - way.pose.y_m) >= least_m) {
        continue;
      }
      const DrivePath link = is_goal_
                                 ? reeds_shepp_path(other, way.pose, settings_.turning_radius_m)
                                 : reeds_shepp_path(way.pose, other, settings_.turning_radius_m);
      DrivePath path = is_goal_ ? link : way.path;
      append_path(path, is_goal_ ? way.path : link);
      const double cost_m = path_cost_m(path, settings_.cost);
      if (cost_m >= least_m || !path_is_valid(link, settings_.subnode_spacing_m, drivable_)) {
        continue;
      }
      least_m = cost_m;
      best = std::move(path);
    }
    return best;
  }

 private:
  static constexpr int kArcs = 2;
  static constexpr std::array<double, 4> kLengthsM = {1.5, 3.0, 5.0, 7.5};

  void extend(std::size_t from) {
    for (const double turn : {-1.0, 0.0, 1.0}) {
      for (const double gear : {1.0, -1.0}) {
        double driven_m = 0.0;
        for (const double length_m : kLengthsM) {
          const Way& way = ways_[from];
          const PathSegment segment{way.pose, turn / settings_.turning_radius_m, gear * length_m};
          const PathSegment added{pose_along(segment, gear * driven_m), segment.curvature_1_m,
                                  gear * (length_m - driven_m)};
          if (!path_is_valid({added}, settings_.subnode_spacing_m, drivable_)) break;
          driven_m = length_m;
          const Pose2 end = pose_along(segment, segment.length_m);
          Way longer;
          longer.pose = end;
          if (is_goal_) {
            longer.path = {{end, segment.curvature_1_m, -segment.length_m}};
            append_path(longer.path, way.path);
          } else {
            longer.path = way.path;
            append_path(longer.path, {segment});
          }
          longer.cost_m = path_cost_m(longer.path, settings_.cost);
          ways_.push_back(std::move(longer));
        }
      }
    }
  }

  const SearchSettings& settings_;
  bool is_goal_;
  PoseValidity drivable_;
  std::vector<Way> ways_;
  std::size_t first_leaf_ = 0;
};

/// Start to line, along it across all that needs stepping, line to goal.
std::optional<DrivePath> path_over(const Line& line, const Manoeuvres& from_start,
                                   const Manoeuvres& to_goal) {
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
    path = from_start.connect(line.at(k));
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
    const auto rest = to_goal.connect(line.at(k));
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
  const Manoeuvres from_start(start, false, settings, footholds);
  const Manoeuvres to_goal(goal, true, settings, footholds);
  std::vector<DrivePath> paths;
  for (const Edge& edge : edges_between(terrain, start, goal)) {
    const Line line = line_through(edge, edge.yaw_rad, length_m + kReachM, footholds);
    if (auto path = path_over(line, from_start, to_goal)) {
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
