#include "initializer/stepping/layered_graph.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wex {
namespace {

constexpr int kMaxRounds = 40;
constexpr int kSubPoses = 4;            // checked between two states
constexpr double kEnoughMarginM = 0.5;  // the best arm posture is looked for later

constexpr double kStartOffCost = 0.5;    // per metre of height
constexpr double kNearBucketCost = 2.0;  // per metre driven and metre closer than wanted

bool later(const auto& a, const auto& b) {
  if (a.estimate != b.estimate) return a.estimate > b.estimate;
  if (a.cost != b.cost) return a.cost < b.cost;
  return a.node > b.node;
}

std::uint64_t edge_key(std::int32_t from_pose, std::int32_t to_pose, std::size_t support_class) {
  return static_cast<std::uint64_t>(from_pose) << 34U | static_cast<std::uint64_t>(to_pose) << 4U |
         support_class;
}

}  // namespace

LayeredGraph::LayeredGraph(const StanceCheck& check, const PathGrid& grid, const PlanSettings& plan,
                           const CertificateSettings& settings)
    : check_(&check),
      grid_(&grid),
      settings_(settings),
      plain_{{plan.min_signed_distance_m, StanceClearances{}.swing_m, plan.belly_clearance_m},
             plan.min_stability_margin_m},
      inflated_{plain_.clearances.inflated(settings.inflation_m),
                plain_.margin_m + settings.inflation_m},
      last_layer_(grid.layers.size() - 1) {
  const PathLayer& last = grid.layers.back();
  record_of_pose_.assign(last.first_pose + last.num_poses(), -1);
  records_.reserve(4096);
  nodes_.reserve(1U << 16U);
}

std::int32_t LayeredGraph::record_at(std::size_t layer, int z, int pitch) {
  const PathLayer& at = grid_->layers[layer];
  const int i = z - at.first_z, j = pitch - at.first_pitch;
  if (i < 0 || j < 0 || i >= at.num_z || j >= at.num_pitch) return -1;
  std::int32_t& record =
      record_of_pose_[at.first_pose + static_cast<std::size_t>(i * at.num_pitch + j)];
  if (record < 0) {
    record = static_cast<std::int32_t>(records_.size());
    Record made{};
    made.layer = static_cast<std::int32_t>(layer);
    made.pose = static_cast<std::int32_t>(&record - record_of_pose_.data());
    made.z = static_cast<std::int16_t>(z);
    made.pitch = static_cast<std::int16_t>(pitch);
    made.first_node.fill(-1);
    records_.push_back(made);
  }
  return record;
}

std::int32_t LayeredGraph::node_at(std::int32_t record, std::size_t support_class, int bucket) {
  Record& at = records_[static_cast<std::size_t>(record)];
  const int side = kSupportClasses[support_class].bucket_side;
  constexpr std::int32_t kWithoutBucket = 5;
  std::int32_t& first = at.first_node[static_cast<std::size_t>(side + 1)];
  const PathLayer& layer = grid_->layers[static_cast<std::size_t>(at.layer)];
  std::int32_t offset = static_cast<std::int32_t>(support_class);
  std::int32_t count = kWithoutBucket;
  if (side >= 0) {
    const std::vector<int>& usable = layer.buckets[static_cast<std::size_t>(side)];
    const auto found = std::lower_bound(usable.begin(), usable.end(), bucket);
    if (found == usable.end() || *found != bucket) return -1;
    offset = static_cast<std::int32_t>(found - usable.begin());
    count = static_cast<std::int32_t>(usable.size());
  }
  if (first < 0) {
    first = static_cast<std::int32_t>(nodes_.size());
    for (std::int32_t k = 0; k < count; ++k) {
      const std::int32_t slot = side < 0 ? k : kWithoutBucket + (side << 10) + k;
      nodes_.push_back({kNever, -1, record, static_cast<std::int16_t>(slot), -1, false});
    }
  }
  return first + offset;
}

std::size_t LayeredGraph::class_of(const Node& node) const {
  constexpr int kWithoutBucket = 5;
  if (node.slot < kWithoutBucket) return static_cast<std::size_t>(node.slot);
  return kWithoutBucket + static_cast<std::size_t>((node.slot - kWithoutBucket) >> 10);
}

int LayeredGraph::bucket_of(const Node& node) const {
  constexpr int kWithoutBucket = 5;
  if (node.slot < kWithoutBucket) return -1;
  const int side = (node.slot - kWithoutBucket) >> 10, k = (node.slot - kWithoutBucket) & 1023;
  const Record& record = records_[static_cast<std::size_t>(node.record)];
  return grid_->layers[static_cast<std::size_t>(record.layer)]
      .buckets[static_cast<std::size_t>(side)][static_cast<std::size_t>(k)];
}

BaseFrame LayeredGraph::frame_of(const Record& record) const {
  return BaseFrame::from(
      grid_->base(grid_->layers[static_cast<std::size_t>(record.layer)], record.z, record.pitch));
}

const Stance& LayeredGraph::stance_of(std::int32_t index) {
  Record& record = records_[static_cast<std::size_t>(index)];
  if (!record.judged) {
    const PathLayer& layer = grid_->layers[static_cast<std::size_t>(record.layer)];
    record.stance = check_->stance(frame_of(record), check_->steering(layer.curvature_1_m),
                                   demand_at(record.layer).clearances);
    record.judged = true;
    ++num_stances_;
  }
  return record.stance;
}

double LayeredGraph::margin_m(const BaseFrame& base, const Stance& stance,
                              const SupportClass& support, int bucket, double enough_m) const {
  if (support.bucket_side >= 0) {
    const Eigen::Vector3d& point = grid_->bucket_points[static_cast<std::size_t>(bucket)];
    return check_->margin_on_bucket(base, stance, support.lifted, point, enough_m, -2.0).margin_m;
  }
  return support.lifted != 0
             ? check_->margin_with_counter_weight(base, stance, support.lifted).margin_m
             : check_->margin_on_wheels(base, stance);
}

void LayeredGraph::ban(const GraphState& state, bool bucket) {
  const std::int32_t at = record_at(state.layer, state.z, state.pitch);
  const bool whole_point = bucket && state.bucket >= 0;
  if (whole_point) {
    banned_buckets_.emplace_back(state.support_class, state.bucket);
  } else {
    records_[static_cast<std::size_t>(at)].banned |=
        static_cast<std::uint16_t>(1U << state.support_class);
  }
  for (Node& node : nodes_) {
    if (class_of(node) != state.support_class) continue;
    if (whole_point ? bucket_of(node) == state.bucket : node.record == at) node.feasible = 0;
  }
}

bool LayeredGraph::is_banned(const Node& node) const {
  const std::size_t support = class_of(node);
  if ((records_[static_cast<std::size_t>(node.record)].banned >> support & 1U) != 0) return true;
  const int bucket = bucket_of(node);
  return std::any_of(banned_buckets_.begin(), banned_buckets_.end(), [&](const auto& banned) {
    return banned.first == support && banned.second == bucket;
  });
}

bool LayeredGraph::feasible(std::int32_t index) {
  Node& node = nodes_[static_cast<std::size_t>(index)];
  if (node.feasible >= 0) return node.feasible != 0;
  const Stance& stance = stance_of(node.record);
  const Record& record = records_[static_cast<std::size_t>(node.record)];
  const SupportClass& support = kSupportClasses[class_of(node)];
  const double wanted_m = demand_at(record.layer).margin_m;
  const bool ok =
      stance.allows(support.lifted) && !is_banned(node) &&
      margin_m(frame_of(record), stance, support, bucket_of(node), wanted_m) >= wanted_m;
  node.feasible = ok ? 1 : 0;
  return ok;
}

// Four wheels and the arm already, or still, stretched to the bucket point.
bool LayeredGraph::stretched_feasible(std::int32_t index, std::size_t support_class, int bucket) {
  const Stance& stance = stance_of(index);
  const Record& record = records_[static_cast<std::size_t>(index)];
  const SupportClass& support = kSupportClasses[support_class];
  if (!stance.may_lift(support.lifted)) return false;
  const double wanted_m = demand_at(record.layer).margin_m;
  const auto on_bucket = check_->margin_on_bucket(
      frame_of(record), stance, support.lifted,
      grid_->bucket_points[static_cast<std::size_t>(bucket)], wanted_m, wanted_m);
  return on_bucket.margin_m >= wanted_m;
}

void LayeredGraph::push(std::int32_t index, float cost, std::int32_t parent, bool support_change) {
  Node& node = nodes_[static_cast<std::size_t>(index)];
  if (node.closed || node.feasible == 0) return;
  // Changes of support may turn out to be forbidden: they must not hide a dearer way.
  if (!support_change) {
    if (cost >= node.cost - kTolerance) return;
    node.cost = cost;
  }
  if (!banned_.empty() && parent >= 0 && banned_.count(edge_between(parent, index)) != 0) return;
  const Record& record = records_[static_cast<std::size_t>(node.record)];
  const float rest = rest_cost_[static_cast<std::size_t>(record.pose)][class_of(node)];
  if (rest == kNever) return;
  queue_.push_back({cost + rest, cost, index, parent});
  std::push_heap(queue_.begin(), queue_.end(), later<Entry, Entry>);
}

void LayeredGraph::push_start(bool from_nominal) {
  const PathLayer& first = grid_->layers.front();
  if (!from_nominal) {
    const std::int32_t record = record_at(0, 0, 0);
    if (record >= 0) push(node_at(record, 0, -1), 0.0F, -1, false);
    return;
  }
  for (int z = first.first_z; z < first.first_z + first.num_z; ++z) {
    for (int p = first.first_pitch; p < first.first_pitch + first.num_pitch; ++p) {
      const std::int32_t record = record_at(0, z, p);
      const double off = kStartOffCost * grid_->z_step_m * std::abs(z - first.nominal_z) +
                         QuietCosts::kPitchChange * std::abs(p - first.nominal_pitch);
      push(node_at(record, 0, -1), static_cast<float>(off), -1, false);
    }
  }
}

void LayeredGraph::expand(std::int32_t index) {
  const Node node = nodes_[static_cast<std::size_t>(index)];
  const Record record = records_[static_cast<std::size_t>(node.record)];
  const auto k = static_cast<std::size_t>(record.layer);
  const std::size_t support = class_of(node);
  const int bucket = bucket_of(node);
  const double share = support == 0 ? 1.0 : 1.0 + settings_.stepping_share;
  for (std::size_t next = k; next <= std::min(k + 1, last_layer_); ++next) {
    const double step_m = next > k ? grid_->layers[next].step_m : 0.0;
    double along = step_m * (share + off_nominal_cost(grid_->layers[k], record.z, record.pitch));
    if (bucket >= 0) {
      const Eigen::Vector2d at = bucket_in_heading(
          grid_->layers[k].pose, grid_->bucket_points[static_cast<std::size_t>(bucket)]);
      along += step_m * kNearBucketCost *
               std::max(0.0, settings_.min_bucket_distance_m - std::abs(at.x()));
    }
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dp = -1; dp <= 1; ++dp) {
        if (next == k && dz == 0 && dp == 0) continue;
        const std::int32_t to = record_at(next, record.z + dz, record.pitch + dp);
        if (to < 0) continue;
        const std::int32_t neighbour = node_at(to, support, bucket);
        if (neighbour < 0) continue;
        const double cost = along + QuietCosts::kHeightChange * std::abs(dz) +
                            QuietCosts::kPitchChange * std::abs(dp);
        push(neighbour, node.cost + static_cast<float>(cost), index, false);
      }
    }
  }
  const Stance& stance = stance_of(node.record);
  if (support != 0) {
    if (!stance.may_lift(kSupportClasses[support].lifted)) return;
    if (bucket >= 0 && !stretched_feasible(node.record, support, bucket)) return;
    push(node_at(node.record, 0, -1), node.cost + static_cast<float>(settings_.lift_cost_m), index,
         false);
    return;
  }
  for (std::size_t c = 1; c < kNumSupportClasses; ++c) {
    if (!stance.may_lift(kSupportClasses[c].lifted)) continue;
    const int side = kSupportClasses[c].bucket_side;
    if (side < 0) {
      push(node_at(node.record, c, -1), node.cost + static_cast<float>(settings_.lift_cost_m),
           index, false);
      continue;
    }
    for (const int j : grid_->layers[k].buckets[static_cast<std::size_t>(side)]) {
      push(node_at(node.record, c, j), node.cost + static_cast<float>(settings_.bucket_cost_m),
           index, true);
    }
  }
}

// The node where the search ended, -1 if nowhere.
std::int32_t LayeredGraph::run(bool from_nominal, bool or_furthest, Answer& answer) {
  for (Node& node : nodes_) {
    node.cost = kNever;
    node.parent = -1;
    node.closed = false;
  }
  queue_.clear();
  push_start(from_nominal);
  std::int32_t furthest = -1;
  while (!queue_.empty()) {
    std::pop_heap(queue_.begin(), queue_.end(), later<Entry, Entry>);
    const Entry entry = queue_.back();
    queue_.pop_back();
    Node& node = nodes_[static_cast<std::size_t>(entry.node)];
    if (node.closed || !feasible(entry.node)) continue;
    const std::size_t support = class_of(node);
    const bool lands_bucket = entry.parent >= 0 && kSupportClasses[support].bucket_side >= 0 &&
                              nodes_[static_cast<std::size_t>(entry.parent)].slot == 0;
    if (lands_bucket && !stretched_feasible(node.record, support, bucket_of(node))) continue;
    node.closed = true;
    node.cost = entry.cost;
    node.parent = entry.parent;
    ++num_expanded_;
    const auto layer =
        static_cast<std::size_t>(records_[static_cast<std::size_t>(node.record)].layer);
    answer.furthest_layer = std::max(answer.furthest_layer, layer);
    if (node.slot == 0) {
      if (layer == last_layer_) return entry.node;
      const auto layer_of = [&](std::int32_t n) {
        return records_[static_cast<std::size_t>(nodes_[static_cast<std::size_t>(n)].record)].layer;
      };
      if (furthest < 0 || layer > static_cast<std::size_t>(layer_of(furthest)))
        furthest = entry.node;
    }
    expand(entry.node);
  }
  return or_furthest ? furthest : -1;
}

// Poses of a bad edge are bad whatever the bucket point.
std::uint64_t LayeredGraph::edge_between(std::int32_t from, std::int32_t to) const {
  const Node& a = nodes_[static_cast<std::size_t>(from)];
  const Node& b = nodes_[static_cast<std::size_t>(to)];
  return edge_key(records_[static_cast<std::size_t>(a.record)].pose,
                  records_[static_cast<std::size_t>(b.record)].pose, class_of(b));
}

// Poses between two states of one support, with the plain clearances.
bool LayeredGraph::edge_is_good(const Node& from, const Node& to) const {
  if (from.slot == 0 ? to.slot != 0 : class_of(from) != class_of(to)) return true;
  const Record& a = records_[static_cast<std::size_t>(from.record)];
  const Record& b = records_[static_cast<std::size_t>(to.record)];
  const PathLayer& layer_a = grid_->layers[static_cast<std::size_t>(a.layer)];
  const PathLayer& layer_b = grid_->layers[static_cast<std::size_t>(b.layer)];
  const BaseCoordinates base_a = grid_->base(layer_a, a.z, a.pitch);
  BaseCoordinates change = grid_->base(layer_b, b.z, b.pitch) - base_a;
  change[kBaseYaw] = wrap_angle(change[kBaseYaw]);
  const SupportClass& support = kSupportClasses[class_of(from)];
  for (int k = 1; k <= kSubPoses; ++k) {
    const double share = static_cast<double>(k) / (kSubPoses + 1);
    const BaseFrame base = BaseFrame::from(base_a + share * change);
    const double curvature_1_m = std::lerp(layer_a.curvature_1_m, layer_b.curvature_1_m, share);
    const Stance stance = check_->stance(base, check_->steering(curvature_1_m), plain_.clearances);
    if (!stance.allows(support.lifted) || !check_->tyres_rest(stance, support.lifted) ||
        margin_m(base, stance, support, bucket_of(from), plain_.margin_m) < plain_.margin_m) {
      return false;
    }
  }
  return true;
}

// On rough ground the rest of a wheel as a disc, which stances are made of, may be an error.
int LayeredGraph::ban_tyres_off_the_ground(std::int32_t end) {
  int num_banned = 0;
  for (std::int32_t n = end; n >= 0; n = nodes_[static_cast<std::size_t>(n)].parent) {
    Node& node = nodes_[static_cast<std::size_t>(n)];
    const std::size_t support = class_of(node);
    if (check_->tyres_rest(stance_of(node.record), kSupportClasses[support].lifted)) continue;
    records_[static_cast<std::size_t>(node.record)].banned |=
        static_cast<std::uint16_t>(1U << support);
    node.feasible = 0;
    ++num_banned;
  }
  return num_banned;
}

LayeredGraph::Answer LayeredGraph::search(bool from_nominal, bool or_furthest) {
  Answer answer;
  estimate_costs(true);
  const PathLayer& first = grid_->layers.front();
  const auto begin = rest_cost_.begin() + static_cast<std::ptrdiff_t>(first.first_pose);
  const bool hopeless = std::all_of(begin, begin + static_cast<std::ptrdiff_t>(first.num_poses()),
                                    [](const auto& costs) { return costs[0] == kNever; });
  if (hopeless) {
    // No way even for the legs alone.
    answer.furthest_layer = dead_layer_ > 0 ? dead_layer_ - 1 : 0;
    answer.num_stances = num_stances_;
    answer.hopeless = true;
    if (!or_furthest) return answer;
    answer.furthest_layer = 0;
    estimate_costs(false);
  }
  for (int round = 1; round <= kMaxRounds; ++round) {
    answer.num_rounds = round;
    const std::int32_t end = run(from_nominal, or_furthest, answer);
    answer.num_stances = num_stances_;
    answer.num_expanded = num_expanded_;
    if (end < 0) return answer;
    bool all_good = ban_tyres_off_the_ground(end) == 0;
    for (std::int32_t n = end; nodes_[static_cast<std::size_t>(n)].parent >= 0;) {
      const std::int32_t parent = nodes_[static_cast<std::size_t>(n)].parent;
      if (!edge_is_good(nodes_[static_cast<std::size_t>(parent)],
                        nodes_[static_cast<std::size_t>(n)])) {
        banned_.insert(edge_between(parent, n));
        all_good = false;
      }
      n = parent;
    }
    if (!all_good) continue;
    answer.cost = nodes_[static_cast<std::size_t>(end)].cost;
    for (std::int32_t n = end; n >= 0; n = nodes_[static_cast<std::size_t>(n)].parent) {
      const Node& node = nodes_[static_cast<std::size_t>(n)];
      const Record& record = records_[static_cast<std::size_t>(node.record)];
      answer.states.push_back({static_cast<std::size_t>(record.layer), record.z, record.pitch,
                               class_of(node), bucket_of(node)});
    }
    std::reverse(answer.states.begin(), answer.states.end());
    return answer;
  }
  return answer;
}

std::string LayeredGraph::why_not_beyond(std::size_t layer) {
  // The best stance of the next layer, by how many wheels it can stand or lift.
  const std::size_t next = std::min(layer + 1, last_layer_);
  const PathLayer& at = grid_->layers[next];
  if (at.num_poses() == 0) return "no wheel has ground to stand on";
  int best_count = -1;
  Stance best;
  for (int z = at.first_z; z < at.first_z + at.num_z; ++z) {
    for (int p = at.first_pitch; p < at.first_pitch + at.num_pitch; ++p) {
      const Stance& stance = stance_of(record_at(next, z, p));
      if (!stance.belly_clear) continue;
      for (const SupportClass& support : kSupportClasses) {
        if (stance.allows(support.lifted)) {
          return support.lifted == 0
                     ? "the base cannot get there from where it can stand"
                     : "no place to change support or too little stability with wheels lifted";
        }
      }
      int count = 0;
      for (unsigned i = 0; i < kNumWheels; ++i) count += (stance.grounded >> i & 1) != 0 ? 1 : 0;
      if (count > best_count) {
        best_count = count;
        best = stance;
      }
    }
  }
  if (best_count < 0) return "the chassis would touch the ground";
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    if ((best.grounded >> i & 1U) != 0) continue;
    const std::string wheel = "wheel " + std::string(kLimbNames[i]);
    switch (best.fault[i]) {
      case LegFault::kNoGround:
        return wheel + " would be off the map, over unknown ground or inside a rise";
      case LegFault::kTooLow:
        return wheel + " would be out of reach of the ground";
      case LegFault::kEdge:
        return wheel + " would stand too close to an edge";
      default:
        return "the beams of leg " + std::string(kLimbNames[i]) + " would touch the ground";
    }
  }
  return "wheels cannot be lifted clear of the ground";
}

}  // namespace wex
