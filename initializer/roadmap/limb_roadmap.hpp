#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "models/excavator/collision_model.hpp"
#include "models/excavator/machine_model.hpp"
#include "models/types/result.hpp"

namespace wex {

/// Sizes and reaches of the paper (section on offline computation).
struct RoadmapSettings {
  int leg_vertices = 300, arm_vertices = 3000;
  int neighbours = 10;        ///< nearest in operational space
  int joint_neighbours = 10;  ///< nearest in joint space, of the arm; not in the paper
  double max_leg_edge_m = 0.3, max_arm_edge_m = 1.0;  ///< in operational space
  double self_collision_m = 0.10;
  std::uint64_t seed = 1;
  bool operator==(const RoadmapSettings&) const = default;
};

/// Probabilistic roadmap of one limb in the base frame. Vertices are sorted by distance of their
/// configuration from the default posture, nearest first; the first is the default posture itself.
struct LimbRoadmap {
  struct Edge {
    int a = 0, b = 0;
    double length_m = 0.0;  ///< between the contact points
    bool operator==(const Edge&) const = default;
  };
  Limb limb{};
  std::vector<int> coordinates;     ///< of q, which a vertex gives values for
  Eigen::MatrixXd q;                ///< coordinates x vertices, SI; continuous joints in (-pi, pi]
  Eigen::Matrix3Xd p_base_contact;  ///< wheel centre, or bucket contact point [m]
  Eigen::Matrix3Xd moment_base;  ///< mass times centre of mass of the limb [kg m]; the arm's with
                                 ///< the cabin
  /// What the vertices are sorted by: joint_distance_s from the default posture.
  Eigen::VectorXd distance_from_default;
  std::vector<Edge> edges;  ///< a < b, checked for self-collision along the way
  std::vector<int> first_edge,
      neighbours;  ///< compressed adjacency: of v in [first[v], first[v+1])
  /// The same for the nearest in joint space, both ways, as well checked along the way: motions
  /// less than half as long as the edges', which searches get through clutter with. Empty for legs.
  std::vector<int> first_joint_neighbour, joint_neighbours;

  [[nodiscard]] int num_vertices() const noexcept { return static_cast<int>(q.cols()); }
};

struct Roadmaps {
  RoadmapSettings settings;
  std::vector<LimbRoadmap> limbs;  ///< in Limb order; the arm last, if there is one
};

/// How far two configurations of a limb are apart: root of summed squares of the times [s] its
/// joints need between them at their fastest; a continuous joint goes the shorter way round.
[[nodiscard]] double joint_distance_s(const MachineModel& machine,
                                      const std::vector<int>& coordinates,
                                      const Eigen::Ref<const Eigen::VectorXd>& from,
                                      const Eigen::Ref<const Eigen::VectorXd>& to);

/// Vertices are sampled evenly over the joints' limits. Of a leg: its joints but the wheel's; of
/// the arm: those that turn the cabin or move within the arm's plane, the others stay in default
/// posture. Vertices and edges keep `self_collision_m` from what stands in the same place whatever
/// the other limbs do: the chassis, for the arm also the cabin and the arm itself. An edge is
/// straight in joint space. One thread; deterministic in the seed.
///   settings  positive counts and reaches (contract)
[[nodiscard]] Roadmaps build_roadmaps(const MachineModel& machine, const CollisionModel& collision,
                                      const RoadmapSettings& settings = {});
/// The roadmap of one limb; the arm's only if the machine has one (contract).
[[nodiscard]] LimbRoadmap build_roadmap(const MachineModel& machine,
                                        const CollisionModel& collision, Limb limb,
                                        const RoadmapSettings& settings = {});

/// Read from the cache folder (default: $XDG_CACHE_HOME/wex or ~/.cache/wex), or built and written
/// there. The file is named after machine, its two files' content and the settings, so that another
/// machine or other settings have their own. A damaged or foreign file is refused and rebuilt.
///   remark  if given: why a file was refused, or not kept in the default folder; empty if neither
///   errors  kBadInput: a machine file is gone, the given folder cannot be written
[[nodiscard]] Result<Roadmaps> load_or_build_roadmaps(const MachineModel& machine,
                                                      const RoadmapSettings& settings = {},
                                                      const std::filesystem::path& folder = {},
                                                      std::string* remark = nullptr);

/// The file load_or_build_roadmaps uses.
[[nodiscard]] Result<std::filesystem::path> roadmap_file(const MachineModel& machine,
                                                         const RoadmapSettings& settings = {},
                                                         const std::filesystem::path& folder = {});

}  // namespace wex
