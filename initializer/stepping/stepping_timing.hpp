#pragma once

#include <vector>

#include "models/excavator/machine_model.hpp"
#include "models/types/plan.hpp"

namespace wex {

/// A node of a motion that is not timed yet.
struct MotionNode {
  Eigen::VectorXd q;
  ContactFlags contacts = kDrivingContacts;
  bool stop = false;            ///< at rest here
  double min_duration_s = 0.0;  ///< of the interval from here to the next node
  double base_speed_m_s = 0.6;  ///< at most, in that interval
  std::size_t state = 0;        ///< of the sequence, for messages
};

struct SteppingTimingSettings {
  double rate_fraction = 0.8;  ///< of every joint's rate limit
  double max_base_acceleration_m_s2 = 0.3;
  double max_base_turn_acceleration_rad_s2 = 0.3;
};

/// Times of the nodes, from zero, strictly increasing: as fast as joint rates and accelerations,
/// base speed and acceleration, and the pump's flow allow; at rest at stops. Rates are those of
/// linear interpolation, accelerations those between successive intervals.
///   nodes  not empty (contract)
[[nodiscard]] std::vector<double> node_times_s(const MachineModel& machine,
                                               const std::vector<MotionNode>& nodes,
                                               const SteppingTimingSettings& settings);

/// Shortest duration of a move by rates and pump flow alone.
[[nodiscard]] double shortest_duration_s(const MachineModel& machine, const Eigen::VectorXd& from,
                                         const Eigen::VectorXd& to, double rate_fraction);

}  // namespace wex
