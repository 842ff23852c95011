#include "initializer/roadmap/limb_roadmap.hpp"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "initializer/roadmap/internal/limb_motion.hpp"
#include "initializer/roadmap/internal/random_numbers.hpp"

namespace wex {
namespace {

using Part = CollisionModel::Part;

constexpr double kEdgeStep = 0.05;  ///< rad or m between configurations checked on an edge
constexpr int kAttemptsPerVertex = 1000;
/// Axes within the arm's plane do not move the bucket across the reach.
constexpr double kAcrossPlane = 0.9;

std::bitset<CollisionModel::kNumParts> bits(std::initializer_list<Part> parts) {
  std::bitset<CollisionModel::kNumParts> set;
  for (const Part part : parts) set.set(static_cast<std::size_t>(part));
  return set;
}

/// The body below the base that carries the limb.
int root_body(const MachineModel& machine, int body) {
  const auto& bodies = machine.tree.bodies();
  while (bodies[body].parent > 0) body = bodies[body].parent;
  return body;
}

class RoadmapBuilder {
 public:
  RoadmapBuilder(const MachineModel& machine, const CollisionModel& collision, Limb limb,
                 const RoadmapSettings& settings)
      : machine_(machine),
        collision_(collision),
        settings_(settings),
        arm_(limb == Limb::kArm),
        motion_(machine, limb_coordinates(machine, limb)),
        workspace_(machine.tree.make_workspace()),
        q_(Eigen::VectorXd::Zero(machine.num_coordinates())),
        random_(settings.seed, static_cast<std::uint64_t>(limb)) {
    q_.tail(machine.num_joints()) = machine.default_posture();
    map_.limb = limb;
    map_.coordinates = motion_.coordinates();
    if (arm_) {
      contact_body_ = machine.arm->contact_body;
      p_body_contact_ = machine.arm->p_body_contact;
    } else {
      const WheeledLeg& leg = machine.legs[static_cast<std::size_t>(limb)];
      contact_body_ = leg.carrier_body;
      p_body_contact_ = leg.p_carrier_wheel;
    }
    root_body_ = root_body(machine, contact_body_);
  }

  LimbRoadmap build() && {
    add_vertices(arm_ ? settings_.arm_vertices : settings_.leg_vertices);
    add_edges(arm_ ? settings_.max_arm_edge_m : settings_.max_leg_edge_m);
    if (arm_) add_joint_neighbours();
    return std::move(map_);
  }

 private:
  /// Leaves the workspace at the configuration.
  bool clear(const Eigen::VectorXd& configuration) {
    motion_.write(configuration, q_);
    machine_.tree.update(q_, workspace_);
    if (arm_) {
      return collision_.clear(workspace_, Part::kArm,
                              bits({Part::kChassis, Part::kCabin, Part::kArm}),
                              settings_.self_collision_m);
    }
    const auto part = static_cast<Part>(static_cast<int>(Part::kLF) + static_cast<int>(map_.limb));
    return collision_.clear(workspace_, part, bits({Part::kChassis}), settings_.self_collision_m);
  }

  /// The default posture, and random ones until there are enough.
  void add_vertices(int count) {
    const Eigen::VectorXd standing = motion_.read(q_);
    const std::vector<bool> sampled = sampled_joints();
    std::vector<Eigen::VectorXd> found;
    if (clear(standing)) found.push_back(standing);
    Eigen::VectorXd configuration = standing;
    for (std::int64_t attempts = 0; std::ssize(found) < count; ++attempts) {
      if (attempts >= std::int64_t{kAttemptsPerVertex} * count) break;
      for (Eigen::Index i = 0; i < configuration.size(); ++i) {
        if (!sampled[i]) continue;
        const auto [lower, upper] = motion_.limits(i);
        configuration[i] = random_.between(lower, upper);
      }
      if (clear(configuration)) found.push_back(configuration);
    }
    sort_and_keep(found, standing);
  }

  void sort_and_keep(const std::vector<Eigen::VectorXd>& found, const Eigen::VectorXd& standing) {
    const auto n = static_cast<Eigen::Index>(found.size());
    std::vector<double> distance(found.size());
    for (std::size_t v = 0; v < found.size(); ++v) {
      distance[v] = motion_.distance_s(standing, found[v]);
    }
    std::vector<std::size_t> order(found.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return distance[a] < distance[b]; });
    map_.q.resize(motion_.size(), n);
    map_.p_base_contact.resize(3, n);
    map_.moment_base.resize(3, n);
    map_.distance_from_default.resize(n);
    for (Eigen::Index v = 0; v < n; ++v) {
      map_.q.col(v) = found[order[v]];
      map_.distance_from_default[v] = distance[order[v]];
      motion_.write(map_.q.col(v), q_);
      machine_.tree.update(q_, workspace_);
      map_.p_base_contact.col(v) =
          machine_.tree.position(workspace_, contact_body_, p_body_contact_);
      map_.moment_base.col(v) = workspace_.subtree_mass_times_com[root_body_];
    }
  }

  /// All of a leg; of the arm the first joint (the cabin), and those that move within its plane.
  std::vector<bool> sampled_joints() {
    std::vector<bool> sampled(motion_.size(), true);
    if (!arm_ || motion_.size() < 2) return sampled;
    machine_.tree.update(q_, workspace_);
    const auto axis = [&](Eigen::Index i) -> const Eigen::Vector3d& {
      return workspace_.axis_world[motion_.joint(i).body];
    };
    for (Eigen::Index i = 1; i < motion_.size(); ++i) {
      const double across = std::abs(axis(i).dot(axis(1)));
      sampled[i] = motion_.joint(i).prismatic ? across < 1.0 - kAcrossPlane : across > kAcrossPlane;
    }
    return sampled;
  }

  using Pairs = std::vector<std::pair<int, int>>;

  /// Pairs (a < b), sorted, of which one is among the `count` nearest of the other.
  ///   distance  of two vertices, infinite if too far
  template <typename Distance>
  Pairs nearest_pairs(int count, const Distance& distance) const {
    const int n = map_.num_vertices();
    Pairs pairs;
    std::vector<std::pair<double, int>> near;
    for (int a = 0; a < n; ++a) {
      near.clear();
      for (int b = 0; b < n; ++b) {
        const double d = distance(a, b);
        if (b != a && std::isfinite(d)) near.emplace_back(d, b);
      }
      const auto last = near.begin() + std::min<std::ptrdiff_t>(count, std::ssize(near));
      std::partial_sort(near.begin(), last, near.end());
      for (auto it = near.begin(); it != last; ++it) {
        pairs.emplace_back(std::min(a, it->second), std::max(a, it->second));
      }
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
  }

  void keep_clear(Pairs& pairs) {
    std::erase_if(pairs, [&](const auto& pair) {
      return !clear_between(map_.q.col(pair.first), map_.q.col(pair.second));
    });
  }

  void add_edges(double max_edge_m) {
    const auto length_m = [&](int a, int b) {
      return (map_.p_base_contact.col(a) - map_.p_base_contact.col(b)).norm();
    };
    Pairs pairs = nearest_pairs(settings_.neighbours, [&](int a, int b) {
      const double length = length_m(a, b);
      return length <= max_edge_m ? length : std::numeric_limits<double>::infinity();
    });
    keep_clear(pairs);
    for (const auto& [a, b] : pairs) map_.edges.push_back({a, b, length_m(a, b)});
    compress(pairs, map_.first_edge, map_.neighbours);
  }

  void add_joint_neighbours() {
    Pairs pairs = nearest_pairs(settings_.joint_neighbours, [&](int a, int b) {
      return motion_.distance_s(map_.q.col(a), map_.q.col(b));
    });
    keep_clear(pairs);
    compress(pairs, map_.first_joint_neighbour, map_.joint_neighbours);
  }

  bool clear_between(const Eigen::VectorXd& from, const Eigen::VectorXd& to) {
    return motion_.holds_between(from, to, kEdgeStep,
                                 [&](const Eigen::VectorXd& q) { return clear(q); });
  }

  void compress(const Pairs& pairs, std::vector<int>& first, std::vector<int>& neighbours) const {
    first.assign(static_cast<std::size_t>(map_.num_vertices()) + 1, 0);
    for (const auto& [a, b] : pairs) {
      ++first[a + 1];
      ++first[b + 1];
    }
    std::partial_sum(first.begin(), first.end(), first.begin());
    neighbours.resize(2 * pairs.size());
    std::vector<int> next(first.begin(), first.end() - 1);
    for (const auto& [a, b] : pairs) {
      neighbours[next[a]++] = b;
      neighbours[next[b]++] = a;
    }
  }

  const MachineModel& machine_;
  const CollisionModel& collision_;
  const RoadmapSettings& settings_;
  bool arm_;
  LimbMotion motion_;
  KinematicTree::Workspace workspace_;
  Eigen::VectorXd q_;
  RandomNumbers random_;
  int contact_body_ = -1, root_body_ = -1;
  Eigen::Vector3d p_body_contact_;
  LimbRoadmap map_;
};

void expect_usable(const RoadmapSettings& settings) {
  WEX_EXPECTS(settings.leg_vertices > 0 && settings.arm_vertices > 0 && settings.neighbours > 0 &&
              settings.joint_neighbours > 0);
  WEX_EXPECTS(settings.max_leg_edge_m > 0.0 && settings.max_arm_edge_m > 0.0);
  WEX_EXPECTS(std::isfinite(settings.self_collision_m));
}

}  // namespace

double joint_distance_s(const MachineModel& machine, const std::vector<int>& coordinates,
                        const Eigen::Ref<const Eigen::VectorXd>& from,
                        const Eigen::Ref<const Eigen::VectorXd>& to) {
  return LimbMotion(machine, coordinates).distance_s(from, to);
}

LimbRoadmap build_roadmap(const MachineModel& machine, const CollisionModel& collision, Limb limb,
                          const RoadmapSettings& settings) {
  expect_usable(settings);
  WEX_EXPECTS(limb != Limb::kArm || machine.arm);
  return RoadmapBuilder(machine, collision, limb, settings).build();
}

Roadmaps build_roadmaps(const MachineModel& machine, const CollisionModel& collision,
                        const RoadmapSettings& settings) {
  Roadmaps roadmaps{settings, {}};
  for (int limb = 0; limb < (machine.arm ? kNumLimbs : kNumWheels); ++limb) {
    roadmaps.limbs.push_back(build_roadmap(machine, collision, static_cast<Limb>(limb), settings));
  }
  return roadmaps;
}

}  // namespace wex
