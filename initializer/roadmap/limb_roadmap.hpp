#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "models/excavator/collision_model.hpp"
#include "models/excavator/machine_model.hpp"
#include "models/types/result.hpp"

namespace wex {

/// Sizes and reaches of the paper (section on offline computation).
struct RoadmapSettings {
  int leg_vertices = 300, arm_vertices = 3000;
  int neighbours = 10;
  double max_leg_edge_m = 0.3, max_arm_edge_m = 1.0;  ///< in operational space
  double self_collision_m = 0.10;
  std::uint64_t seed = 1;
  bool operator==(const RoadmapSettings&) const = default;
};

/// Probabilistic roadmap of one limb in the base frame. Vertices are sorted by distance of their
/// configuration from the default posture, nearest first.
struct LimbRoadmap {
  struct Edge {
    int a = 0, b = 0;
    double length_m = 0.0;  ///< between the contact points
  };
  Limb limb{};
  std::vector<int> coordinates;           ///< of q, which a vertex gives values for
  Eigen::MatrixXd q;                      ///< coordinates x vertices, SI
  Eigen::Matrix3Xd p_base_contact;        ///< wheel centre, or bucket contact point [m]
  Eigen::Matrix3Xd moment_base;           ///< mass times centre of mass of the limb [kg m]
  Eigen::VectorXd distance_from_default;  ///< weighted, what the vertices are sorted by
  std::vector<Edge> edges;                ///< a < b, checked for self-collision along the way
  std::vector<int> first_edge,
      neighbours;  ///< compressed adjacency: of v in [first[v], first[v+1])
};

struct Roadmaps {
  RoadmapSettings settings;
  std::vector<LimbRoadmap> limbs;  ///< in Limb order; the arm last, if there is one
};

/// One thread; deterministic in the seed.
[[nodiscard]] Roadmaps build_roadmaps(const MachineModel& machine, const CollisionModel& collision,
                                      const RoadmapSettings& settings = {});

/// Read from the cache folder (default: $XDG_CACHE_HOME/wex or ~/.cache/wex), or built and written
/// there. A damaged or foreign file is refused and rebuilt.
///   rebuilt_because  if given, filled with the reason a file was refused, empty if none was
[[nodiscard]] Result<Roadmaps> load_or_build_roadmaps(const MachineModel& machine,
                                                      const RoadmapSettings& settings = {},
                                                      const std::filesystem::path& folder = {});

}  // namespace wex
