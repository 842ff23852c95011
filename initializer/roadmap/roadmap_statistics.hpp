#pragma once

#include <Eigen/Core>

#include "initializer/roadmap/limb_roadmap.hpp"

namespace wex {

struct RoadmapStatistics {
  int vertices = 0, edges = 0;
  double mean_degree = 0.0;
  int components = 0;
  int largest_component = 0;        ///< vertices of it
  double mean_edge_m = 0.0;         ///< between contact points
  Eigen::Vector3d lowest, highest;  ///< box around the contact points, base frame [m]
};

[[nodiscard]] RoadmapStatistics statistics(const LimbRoadmap& map);

}  // namespace wex
