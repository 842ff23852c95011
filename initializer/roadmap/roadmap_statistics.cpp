#include "initializer/roadmap/roadmap_statistics.hpp"

#include <algorithm>
#include <vector>

namespace wex {

RoadmapStatistics statistics(const LimbRoadmap& map) {
  RoadmapStatistics result;
  result.vertices = map.num_vertices();
  result.edges = static_cast<int>(map.edges.size());
  result.lowest.setZero();
  result.highest.setZero();
  if (result.vertices == 0) return result;
  result.lowest = map.p_base_contact.rowwise().minCoeff();
  result.highest = map.p_base_contact.rowwise().maxCoeff();
  result.mean_degree = 2.0 * result.edges / result.vertices;
  for (const LimbRoadmap::Edge& edge : map.edges) {
    result.mean_edge_m += edge.length_m / result.edges;
  }
  std::vector<bool> seen(map.first_edge.size() - 1, false);
  std::vector<int> open;
  for (int root = 0; root < result.vertices; ++root) {
    if (seen[root]) continue;
    ++result.components;
    int size = 0;
    seen[root] = true;
    open.push_back(root);
    while (!open.empty()) {
      const int v = open.back();
      open.pop_back();
      ++size;
      for (int i = map.first_edge[v]; i < map.first_edge[v + 1]; ++i) {
        const int next = map.neighbours[i];
        if (seen[next]) continue;
        seen[next] = true;
        open.push_back(next);
      }
    }
    result.largest_component = std::max(result.largest_component, size);
  }
  return result;
}

}  // namespace wex
