#pragma once

#include <optional>
#include <vector>

#include "models/excavator/machine_model.hpp"
#include "models/types/machine_io_types.hpp"
#include "models/types/plan.hpp"

namespace wex::app {

/// Coordinates of a measured state, and its rates (base rates as Euler angle rates).
[[nodiscard]] Eigen::VectorXd coordinates(const MachineModel& machine, const MachineState& state);

/// Rates of the coordinates on a trajectory at t_s: slope of the segment that holds t_s, zero
/// outside.
///   nodes  sorted by time, not empty (contract)
[[nodiscard]] Eigen::VectorXd rates(const std::vector<WholeBodyNode>& nodes, double t_s);

/// The command that makes the machine follow `nodes` (absolute machine time) at t_s. Each joint's
/// rate is taken ahead by its dead time and lag, so that it takes effect when it is due; the
/// position target is where the joint should be now. Wheels and TURN get rates only.
[[nodiscard]] JointCommand command_at(const MachineModel& machine,
                                      const std::vector<WholeBodyNode>& nodes, double t_s,
                                      double valid_for_s);

/// Coordinates at t_s + delay_s: the measurement plus what the trajectory under way adds until
/// then, its planar motion turned by the present heading error. No trajectory: the measurement.
[[nodiscard]] Eigen::VectorXd predict(const Eigen::VectorXd& q_measured,
                                      const std::vector<WholeBodyNode>& nodes, double t_s,
                                      double delay_s);

}  // namespace wex::app
