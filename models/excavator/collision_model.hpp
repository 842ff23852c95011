#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <bitset>
#include <string>
#include <vector>

#include "models/excavator/kinematic_tree.hpp"
#include "models/excavator/machine_model.hpp"

namespace wex {

/// The machine's shape for distance queries: capsules (spheres are capsules of no length) fixed to
/// bodies of the kinematic tree. They contain every shape of the machine that takes up space, those
/// that collide in its MuJoCo model among them; wheels are fixed to what carries them, as turning
/// does not move a disc. Immutable; concurrent queries are safe.
class CollisionModel {
 public:
  enum class Part { kChassis, kCabin, kLF, kRF, kLH, kRH, kArm };
  static constexpr int kNumParts = 7;
  struct Capsule {
    std::string name;
    int body = -1;
    Part part{};
    Eigen::Vector3d p_body_a, p_body_b;  ///< ends of the axis [m]
    double radius_m = 0.0;
    bool load_bearing = false;  ///< wheel or bucket: may touch the ground
  };
  /// Two capsules that may collide: of different parts, or far enough apart along the arm.
  struct Pair {
    int first = -1, second = -1;  ///< capsules
  };
  struct Proximity {
    double distance_m = 0.0;  ///< between surfaces; negative: overlapping
    int pair = -1;
  };

  [[nodiscard]] static CollisionModel build(const MachineModel& machine);

  [[nodiscard]] const std::vector<Capsule>& capsules() const noexcept { return capsules_; }
  /// Neighbouring links and shapes that touch in the default posture are left out.
  [[nodiscard]] const std::vector<Pair>& pairs() const noexcept { return pairs_; }

  /// The smallest distance of all pairs (those of one part against the rest, if given). Stops early
  /// once it is below `stop_below_m`. No allocation.
  [[nodiscard]] Proximity nearest(const KinematicTree::Workspace& w,
                                  double stop_below_m = -1e9) const noexcept;
  [[nodiscard]] Proximity nearest(const KinematicTree::Workspace& w, Part part,
                                  double stop_below_m = -1e9) const noexcept;

  /// Whether every distance is at least `margin_m`: faster than nearest, as what is farther is
  /// never looked at. No allocation.
  [[nodiscard]] bool clear(const KinematicTree::Workspace& w, double margin_m) const noexcept;
  [[nodiscard]] bool clear(const KinematicTree::Workspace& w, Part part,
                           double margin_m) const noexcept;
  /// One part against some, bit i standing for Part i.
  [[nodiscard]] bool clear(const KinematicTree::Workspace& w, Part part,
                           std::bitset<kNumParts> others, double margin_m) const noexcept;

  /// Distance of one pair, without and with its exact gradient by q (num_coordinates, overwritten);
  /// at parallel axes one of the subgradients, zero where axes cross. No allocation.
  [[nodiscard]] double distance(const KinematicTree::Workspace& w, const Pair& pair) const noexcept;
  [[nodiscard]] double distance(const KinematicTree& tree, const KinematicTree::Workspace& w,
                                const Pair& pair, Eigen::Ref<Eigen::VectorXd> gradient) const;

  /// Height of the lowest points of a capsule above ground given as a function of xy: smallest of
  /// samples at most `spacing_m` apart along its axis [m].
  template <typename Ground>
  [[nodiscard]] double ground_clearance_m(const KinematicTree::Workspace& w, int capsule,
                                          double spacing_m, const Ground& height_at) const;

 private:
  /// Capsules of one shape, within a ball.
  struct Shape {
    int body = -1;
    Part part{};
    int first = 0, last = 0;  ///< capsules
    Eigen::Vector3d p_body_centre;
    double radius_m = 0.0;
  };
  struct ShapePair {
    int first = -1, second = -1;  ///< shapes
    int first_pair = 0;           ///< of pairs_; the rest follow, second's capsules fastest
  };
  class Query;

  void add_shapes(const MachineModel& machine);
  void add_pairs(const MachineModel& machine);

  std::vector<Capsule> capsules_;
  std::vector<Pair> pairs_;
  std::vector<Shape> shapes_;
  std::vector<ShapePair> shape_pairs_;
};

template <typename Ground>
double CollisionModel::ground_clearance_m(const KinematicTree::Workspace& w, int capsule,
                                          double spacing_m, const Ground& height_at) const {
  const Capsule& c = capsules_[static_cast<std::size_t>(capsule)];
  const Eigen::Isometry3d& T = w.T_world_body[static_cast<std::size_t>(c.body)];
  const Eigen::Vector3d a = T * c.p_body_a, b = T * c.p_body_b;
  const int steps = static_cast<int>((b - a).norm() / spacing_m) + 1;
  double clearance = 1e9;
  for (int k = 0; k <= steps; ++k) {
    const Eigen::Vector3d p = a + (b - a) * (static_cast<double>(k) / steps);
    clearance = std::min(clearance, p.z() - c.radius_m - height_at(p.template head<2>()));
  }
  return clearance;
}

}  // namespace wex
