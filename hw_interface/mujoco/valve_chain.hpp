#pragma once

#include <array>

#include "models/excavator/machine_model.hpp"
#include "models/types/machine_io_types.hpp"

namespace wex {

/// What happens between a valve command and the cylinder's rate on the machine: dead band of the
/// spool, dead time (pilot stage, hoses), first-order lag. The plant of the simulation, not known
/// to any controller. Allocation-free after construction.
class ValveChain {
 public:
  /// Dead times are rounded to whole periods, at most kMaxDeadTimePeriods of them (contract).
  ValveChain(const MachineModel& machine, double period_s, double dead_band);

  /// One control period: spool openings in [-1, 1] in, joint rates out (rad/s or m/s). Entries of
  /// wheels pass through the same dead time and lag as a rate, without spool.
  ///   released  false: pilot pressure is vented and springs shut the valves, within 50 ms and
  ///             whatever was on its way; the brake valves at the wheels' motors follow their rate
  ///             without the pilot's delay
  ///   braked    wheels: so does a closed parking brake
  std::array<double, kMaxJoints> update(const std::array<double, kMaxJoints>& spool,
                                        const std::array<double, kMaxJoints>& wheel_rate,
                                        bool released = true,
                                        const std::array<bool, kMaxJoints>& braked = {}) noexcept;

 private:
  static constexpr int kMaxDeadTimePeriods = 127;

  struct Valve {
    double max_rate = 0.0;
    double blend = 1.0;  ///< share of the way to the input gone in one period
    int dead_time_periods = 0;
    bool wheel = false;
    double rate = 0.0;
  };

  int num_joints_ = 0;
  double period_s_ = 0.0, dead_band_ = 0.0;
  std::array<Valve, kMaxJoints> valves_{};
  std::array<std::array<double, kMaxDeadTimePeriods + 1>, kMaxJoints> history_{};  ///< ring
  int head_ = 0;
};

}  // namespace wex
