#include "mpc/nlp/tracking_cost.hpp"

namespace wex {

NodeVector expand(const CoordinateWeights& weights, const MachineModel& machine,
                  const NlpLayout& layout) {
  NodeVector expanded(layout.node_size());
  expanded.head<kNumBaseCoordinates>() << weights.base_xy, weights.base_xy, weights.base_z,
      weights.yaw, weights.tilt, weights.tilt;
  for (int i = kNumBaseCoordinates; i < layout.node_size(); ++i) {
    const JointRole role = machine.joints[layout.coordinates[i] - kNumBaseCoordinates].role;
    expanded[i] = role == JointRole::kHipAbduction ? weights.haa
                  : role == JointRole::kHipFlexion ? weights.hfe
                                                   : weights.steer;
  }
  return expanded;
}

double TrackingCost::value(const std::vector<NodeVector>& nodes,
                           const std::vector<NodeVector>& reference) const {
  double sum = 0.0;
  for (std::size_t k = 1; k < nodes.size(); ++k) {
    const double deviation = weights_.dot((nodes[k] - reference[k]).cwiseAbs2());
    sum += duration_s(k + 1 == nodes.size()) * deviation;
  }
  return 0.5 * sum;
}

void TrackingCost::add_gradient(const std::vector<NodeVector>& nodes,
                                const std::vector<NodeVector>& reference,
                                Eigen::Ref<Eigen::VectorXd> gradient) const {
  const Eigen::Index n = weights_.size();
  for (std::size_t k = 1; k < nodes.size(); ++k) {
    gradient.segment(static_cast<Eigen::Index>(k - 1) * n, n) +=
        duration_s(k + 1 == nodes.size()) * weights_.cwiseProduct(nodes[k] - reference[k]);
  }
}

}  // namespace wex
