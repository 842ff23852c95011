#include "models/types/contact_schedule.hpp"

namespace wex {

int num_lifts(const std::vector<WholeBodyNode>& nodes, Limb limb) {
  const auto i = static_cast<std::size_t>(limb);
  int lifts = 0;
  for (std::size_t k = 1; k < nodes.size(); ++k) {
    lifts += nodes[k - 1].contacts[i] && !nodes[k].contacts[i];
  }
  return lifts;
}

int num_wheel_lifts(const std::vector<WholeBodyNode>& nodes) {
  int lifts = 0;
  for (int wheel = 0; wheel < kNumWheels; ++wheel) lifts += num_lifts(nodes, Limb{wheel});
  return lifts;
}

}  // namespace wex
