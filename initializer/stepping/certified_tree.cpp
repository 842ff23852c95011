#include "initializer/stepping/certified_tree.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace wex {
namespace {

constexpr double kShortestEdgeM = 1.0;
constexpr double kGoalEdgeM = 18.0;       // straight to the goal from this far
constexpr double kSameDistanceM = 0.5;    // two nodes closer than this ...
constexpr double kSameYawRad = 0.12;      // ... in both are one
constexpr int kGoalHeadingPeriod = 3;     // every third sample heads like the goal ...
constexpr double kGoalHeadingRad = 0.35;  // ... within 20 degrees

}  // namespace

void append_sequence(CertifiedSequence& sequence, const CertifiedSequence& more) {
  if (sequence.states.empty()) {
    sequence = more;
    return;
  }
  // The place where both meet stands in both, once as station and state.
  const std::size_t first_station = sequence.stations.size() - 1;
  const int first_point = static_cast<int>(sequence.bucket_points.size());
  const double s_m = sequence.stations.back().s_m;
  const double turns = sequence.stations.back().pose.yaw_rad - more.stations.front().pose.yaw_rad;
  append_path(sequence.path, more.path);
  for (std::size_t i = 1; i < more.stations.size(); ++i) {
    sequence.stations.push_back(more.stations[i]);
    sequence.stations.back().s_m += s_m;
    sequence.stations.back().pose.yaw_rad += turns;
  }
  sequence.bucket_points.insert(sequence.bucket_points.end(), more.bucket_points.begin(),
                                more.bucket_points.end());
  for (std::size_t i = 1; i < more.states.size(); ++i) {
    SteppingState state = more.states[i];
    state.station += first_station;
    state.base[kBaseYaw] += turns;
    if (state.support.bucket >= 0) state.support.bucket += first_point;
    sequence.states.push_back(state);
  }
  sequence.cost += more.cost;
  sequence.min_margin_m = std::min(sequence.min_margin_m, more.min_margin_m);
}

CertifiedTree::CertifiedTree(const Certifier& certifier, const Pose2& start, const Pose2& goal,
                             const SearchSettings& settings, std::uint64_t seed)
    : certifier_(&certifier), goal_(goal), settings_(settings), generator_(seed) {
  nodes_.push_back({start, std::nullopt, -1, {}});
}

double CertifiedTree::uniform(double low, double high) {
  constexpr double kUnit = 1.0 / 9007199254740992.0;  // 2^-53
  return low + (high - low) * kUnit * static_cast<double>(generator_() >> 11);
}

Pose2 CertifiedTree::sample() {
  Pose2 pose{uniform(settings_.x_min_m, settings_.x_max_m),
             uniform(settings_.y_min_m, settings_.y_max_m),
             uniform(-std::numbers::pi, std::numbers::pi)};
  if (num_samples_ % kGoalHeadingPeriod == 0) {
    pose.yaw_rad = goal_.yaw_rad + uniform(-kGoalHeadingRad, kGoalHeadingRad);
  }
  return pose;
}

int CertifiedTree::nearest(const Pose2& pose) const {
  int best = 0;
  double best_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Pose2& p = nodes_[i].pose;
    const double distance_m =
        std::hypot(p.x_m - pose.x_m, p.y_m - pose.y_m) +
        settings_.yaw_weight_m_rad * std::abs(wrap_angle(p.yaw_rad - pose.yaw_rad));
    if (distance_m < best_m) {
      best_m = distance_m;
      best = static_cast<int>(i);
    }
  }
  return best;
}

DrivePath CertifiedTree::admitted_part(const Pose2& from, const Pose2& to, double max_length_m,
                                       bool& reaches) const {
  DrivePath part;
  double left_m = max_length_m;
  reaches = true;
  for (const PathSegment& segment : reeds_shepp_path(from, to, settings_.turning_radius_m)) {
    const double length_m = std::min(std::abs(segment.length_m), left_m);
    const int steps =
        std::max(1, static_cast<int>(std::ceil(length_m / settings_.subnode_spacing_m)));
    const double sign = segment.length_m < 0.0 ? -1.0 : 1.0;
    int good = -1;
    while (good < steps &&
           certifier_->admits(pose_along(segment, sign * length_m * (good + 1) / steps),
                              segment.curvature_1_m) != Certifier::Admission::kRefused) {
      ++good;
    }
    if (good > 0) {
      part.push_back({segment.start, segment.curvature_1_m, sign * length_m * good / steps});
    }
    left_m -= length_m;
    if (good < steps || length_m < std::abs(segment.length_m)) {
      reaches = false;
      break;
    }
  }
  return part;
}

std::optional<int> CertifiedTree::extend(int from, const Pose2& to, double max_length_m,
                                         bool must_reach) {
  bool reaches = false;
  const Node& begin = nodes_[static_cast<std::size_t>(from)];
  const DrivePath path = admitted_part(begin.pose, to, max_length_m, reaches);
  if (path.empty() || path_length_m(path) < kShortestEdgeM) return std::nullopt;
  std::optional<CertifiedSequence> edge =
      certifier_->certify_prefix(path, kShortestEdgeM, begin.base);
  if (!edge) return std::nullopt;
  const Pose2 end = edge->stations[edge->states.back().station].pose;
  const bool at_goal = must_reach && reaches &&
                       std::hypot(end.x_m - to.x_m, end.y_m - to.y_m) < 1e-3 &&
                       std::abs(wrap_angle(end.yaw_rad - to.yaw_rad)) < 1e-3;
  if (!at_goal) {
    for (const Node& node : nodes_) {
      if (std::hypot(node.pose.x_m - end.x_m, node.pose.y_m - end.y_m) < kSameDistanceM &&
          std::abs(wrap_angle(node.pose.yaw_rad - end.yaw_rad)) < kSameYawRad) {
        return std::nullopt;
      }
    }
  }
  const BaseCoordinates base = edge->states.back().base;
  nodes_.push_back({end, base, from, *std::move(edge)});
  return at_goal ? std::optional<int>(static_cast<int>(nodes_.size()) - 1) : std::nullopt;
}

CertifiedSequence CertifiedTree::sequence_to(int node) const {
  std::vector<int> chain;
  for (int i = node; nodes_[static_cast<std::size_t>(i)].parent >= 0;
       i = nodes_[static_cast<std::size_t>(i)].parent) {
    chain.push_back(i);
  }
  CertifiedSequence sequence;
  for (auto i = chain.rbegin(); i != chain.rend(); ++i) {
    append_sequence(sequence, nodes_[static_cast<std::size_t>(*i)].edge);
  }
  return sequence;
}

std::optional<CertifiedSequence> CertifiedTree::grow() {
  ++num_samples_;
  const Pose2 target = sample();
  const std::size_t before = nodes_.size();
  (void)extend(nearest(target), target, settings_.range_m, false);
  if (nodes_.size() == before) return std::nullopt;
  const int newest = static_cast<int>(nodes_.size()) - 1;
  const Pose2& pose = nodes_.back().pose;
  if (std::hypot(pose.x_m - goal_.x_m, pose.y_m - goal_.y_m) > kGoalEdgeM) return std::nullopt;
  const std::optional<int> goal = extend(newest, goal_, kGoalEdgeM, true);
  return goal ? std::optional(sequence_to(*goal)) : std::nullopt;
}

}  // namespace wex
