#include "initializer/shorten_path.hpp"

#include <cmath>
#include <vector>

namespace wex {
namespace {

constexpr double kAnchorSpacingM = 1.0;
constexpr double kLeastGainM = 1e-3;  // not worth a check below

// Each segment cut into pieces of equal length.
DrivePath cut(const DrivePath& path) {
  DrivePath pieces;
  for (const PathSegment& segment : path) {
    const int n =
        std::max(1, static_cast<int>(std::ceil(std::abs(segment.length_m) / kAnchorSpacingM)));
    for (int k = 0; k < n; ++k) {
      pieces.push_back({pose_along(segment, segment.length_m * k / n), segment.curvature_1_m,
                        segment.length_m / n});
    }
  }
  return pieces;
}

}  // namespace

DrivePath shorten_path(const DrivePath& path, const SearchSettings& settings,
                       const PoseValidity& is_valid) {
  const DrivePath pieces = cut(path);
  std::vector<Pose2> anchors;
  for (const PathSegment& piece : pieces) anchors.push_back(piece.start);
  anchors.push_back(pose_along(pieces.back(), pieces.back().length_m));

  // Cheapest way to each anchor over the earlier ones; the path itself is always one.
  struct Way {
    double cost_m = 0.0;
    std::size_t from = 0;
    DrivePath leg;
  };
  std::vector<Way> ways(anchors.size());
  for (std::size_t i = 1; i < anchors.size(); ++i) {
    const DrivePath along{pieces[i - 1]};
    ways[i] = {ways[i - 1].cost_m + path_cost_m(along, settings.cost), i - 1, along};
    for (std::size_t j = 0; j + 1 < i; ++j) {
      const double straight_m =
          std::hypot(anchors[i].x_m - anchors[j].x_m, anchors[i].y_m - anchors[j].y_m);
      if (ways[j].cost_m + straight_m > ways[i].cost_m - kLeastGainM) continue;
      DrivePath leg = reeds_shepp_path(anchors[j], anchors[i], settings.turning_radius_m);
      const double cost_m = ways[j].cost_m + path_cost_m(leg, settings.cost);
      if (cost_m > ways[i].cost_m - kLeastGainM) continue;
      if (path_is_valid(leg, settings.subnode_spacing_m, is_valid)) {
        ways[i] = {cost_m, j, std::move(leg)};
      }
    }
  }

  std::vector<std::size_t> chain;
  for (std::size_t i = anchors.size() - 1; i > 0; i = ways[i].from) chain.push_back(i);
  DrivePath shorter;
  for (auto i = chain.rbegin(); i != chain.rend(); ++i) append_path(shorter, ways[*i].leg);
  return path_cost_m(shorter, settings.cost) < path_cost_m(path, settings.cost) ? shorter : path;
}

}  // namespace wex
