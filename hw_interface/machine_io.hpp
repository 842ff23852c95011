#pragma once

#include <string>

#include "models/types/machine_io_types.hpp"

namespace wex {

enum class WriteOutcome {
  kAccepted,
  kRejectedNotFinite,  ///< NaN or infinity in the command: nothing is applied, motion stops
  kRejectedExpired,    ///< valid_until already past
  kRejectedWrongSize,
  kRejectedStopped  ///< stop() is in force
};

enum class HealthLevel { kOk, kHolding, kFault };

/// Counters and level of a machine, for reports and decisions. No allocation.
struct MachineHealth {
  HealthLevel level = HealthLevel::kOk;
  long commands_accepted = 0, commands_rejected = 0;
  long expiries = 0;     ///< times a command ran out and the machine held by itself
  long stall_stops = 0;  ///< wheel drives stopped on stall
};

/// The machine, simulated or real. One thread at a time. Control-rate calls (read, write, stop,
/// health) are noexcept and allocation-free; wait_until may block (bus) or simulate (MuJoCo).
class MachineIo {
 public:
  virtual ~MachineIo() = default;
  [[nodiscard]] virtual MachineState read() noexcept = 0;
  virtual WriteOutcome write(const JointCommand& command) noexcept = 0;
  /// Stops all motion and holds (brakes latched); stays so until release().
  virtual void stop() noexcept = 0;
  virtual void release() noexcept = 0;
  [[nodiscard]] virtual MachineHealth health() const noexcept = 0;
  /// Returns when machine time has reached t_s (at once if it has already).
  virtual void wait_until(double t_s) = 0;
};

}  // namespace wex
