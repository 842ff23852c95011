#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "models/excavator/kinematic_tree.hpp"
#include "models/excavator/machine_model.hpp"

namespace wex {

/// The machine's shape for distance queries: capsules (spheres are capsules of no length) fixed to
/// bodies of the kinematic tree. They contain every collision shape of the machine's URDF, wheels
/// and bucket included. Immutable; concurrent queries are safe.
class CollisionModel {
 public:
  enum class Part { kChassis, kCabin, kLF, kRF, kLH, kRH, kArm };
  struct Capsule {
    std::string name;
    int body = -1;
    Part part{};
    Eigen::Vector3d p_body_a, p_body_b;  ///< ends of the axis [m]
    double radius_m = 0.0;
    bool load_bearing = false;  ///< wheel or bucket: may touch the ground
  };
  /// Distance between two capsules of different parts that may collide.
  struct Pair {
    int first = -1, second = -1;  ///< capsules
  };
  struct Proximity {
    double distance_m = 0.0;  ///< between surfaces; negative: overlapping
    int pair = -1;
  };

  [[nodiscard]] static CollisionModel build(const MachineModel& machine);

  [[nodiscard]] const std::vector<Capsule>& capsules() const noexcept { return capsules_; }
  /// Neighbouring links and pairs that touch in the default posture are left out.
  [[nodiscard]] const std::vector<Pair>& pairs() const noexcept { return pairs_; }

  /// The smallest distance of all pairs (those of one part against the rest, if given). Stops early
  /// once it is below `stop_below_m`. No allocation.
  [[nodiscard]] Proximity nearest(const KinematicTree::Workspace& w,
                                  double stop_below_m = -1e9) const noexcept;
  [[nodiscard]] Proximity nearest(const KinematicTree::Workspace& w, Part part,
                                  double stop_below_m = -1e9) const noexcept;

  /// Distance of one pair and its exact gradient by q (num_coordinates, overwritten); at parallel
  /// axes one of the subgradients.
  [[nodiscard]] double distance(const KinematicTree& tree, const KinematicTree::Workspace& w,
                                const Pair& pair, Eigen::Ref<Eigen::VectorXd> gradient) const;

  /// Height of the lowest points of a capsule above ground given as a function of xy: smallest of
  /// samples at most `spacing_m` apart along its axis [m].
  template <typename Ground>
  [[nodiscard]] double ground_clearance_m(const KinematicTree::Workspace& w, int capsule,
                                          double spacing_m, const Ground& height_at) const;

 private:
  std::vector<Capsule> capsules_;
  std::vector<Pair> pairs_;
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
