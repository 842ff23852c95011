#pragma once

#include <vector>

#include "initializer/drive_path.hpp"
#include "models/excavator/machine_model.hpp"
#include "models/types/plan.hpp"

namespace wex {

struct TimingSettings {
  double nominal_speed_m_s = 0.6;
  double max_acceleration_m_s2 = 0.3;  ///< of the base along its path
  double rate_fraction = 0.8;          ///< of every joint's rate limit
};

/// Fills in t_s: as fast as nominal speed, acceleration and joint rates (hip, steering and wheels
/// alike) allow, at rest at every stop. First node at t = 0, times strictly increasing.
///   nodes  one per station (contract)
void assign_times(const MachineModel& machine, const std::vector<Station>& stations,
                  const TimingSettings& settings, std::vector<WholeBodyNode>& nodes);

}  // namespace wex
