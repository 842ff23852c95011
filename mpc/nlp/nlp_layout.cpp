#include "mpc/nlp/nlp_layout.hpp"

namespace wex {

NodeVector NlpLayout::gather(const Eigen::VectorXd& q) const {
  NodeVector x(node_size());
  for (int i = 0; i < node_size(); ++i) x[i] = q[coordinates[i]];
  return x;
}

void NlpLayout::scatter(const Eigen::Ref<const NodeVector>& x, Eigen::VectorXd& q) const {
  for (int i = 0; i < node_size(); ++i) q[coordinates[i]] = x[i];
}

std::vector<int> NlpLayout::leg_variables(const WheeledLeg& leg) const {
  std::vector<int> variables;
  for (const int coordinate : {leg.haa, leg.hfe, leg.steer}) {
    if (coordinate >= 0) variables.push_back(node_variable[coordinate]);
  }
  return variables;
}

NlpLayout make_driving_layout(const MachineModel& machine, int num_nodes) {
  NlpLayout layout;
  layout.num_nodes = num_nodes;
  layout.node_variable.assign(machine.num_coordinates(), -1);
  const auto add = [&](int coordinate) {
    if (coordinate < 0) return;
    layout.node_variable[coordinate] = layout.node_size();
    layout.coordinates.push_back(coordinate);
  };
  for (int i = 0; i < kNumBaseCoordinates; ++i) add(i);
  for (const WheeledLeg& leg : machine.legs) {
    add(leg.haa);
    add(leg.hfe);
    add(leg.steer);
  }
  WEX_EXPECTS(layout.node_size() <= kMaxNodeVariables);
  return layout;
}

}  // namespace wex
