#pragma once

#include <vector>

#include "models/types/plan.hpp"
#include "mpc/nlp/trajectory_problem.hpp"

namespace wex {

/// Full whole-body nodes of an optimized trajectory: held coordinates from the setup, wheel spin
/// integrated from the wheels' travel (rolling: d spin = d travel / r minus the carrier's own turn
/// about the axle), starting from the spin in q_held[0]. first_time_s is the time of node 0.
[[nodiscard]] std::vector<WholeBodyNode> whole_body_nodes(const TrajectorySetup& setup,
                                                          const std::vector<NodeVector>& nodes,
                                                          double first_time_s);

}  // namespace wex
