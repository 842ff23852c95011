#pragma once

#include <string>

#include "models/types/machine_io_types.hpp"
#include "models/types/result.hpp"

namespace wex {

/// Where a machine stands between "never heard of" and "follows commands".
///   kUnconfigured -> kInactive -> kActive; any -> kFault, kEStop (latched: a person leaves them)
enum class Lifecycle {
  kUnconfigured,  ///< not heard of completely yet
  kInactive,      ///< reads work, writes are rejected, nothing moves
  kActive,        ///< writes move the machine; health() tells whether it holds for the moment
  kFault,         ///< left by a person's reset only
  kEStop          ///< the e-stop chain is or was open; left by a person's reset only
};

enum class WriteOutcome {
  kAccepted,
  kRejectedNotFinite,  ///< NaN or infinity in the command: nothing is applied, motion stops
  kRejectedExpired,    ///< valid_until already past
  kRejectedWrongSize,
  kRejectedStopped,    ///< stop() is in force
  kRejectedNotActive,  ///< lifecycle() is not kActive
  kRejectedRange,      ///< far beyond the joint's limits: nothing is applied, motion stops
  kRejectedStale,      ///< the machine's feedback is too old to command it
  kBusStalled,         ///< the bus does not take frames: the machine holds
  kClamped             ///< taken, but brought into the joint's limits first
};

/// True if the command moves the machine.
[[nodiscard]] constexpr bool taken(WriteOutcome outcome) noexcept {
  return outcome == WriteOutcome::kAccepted || outcome == WriteOutcome::kClamped;
}

enum class HealthLevel { kOk, kHolding, kFault };

/// Counters and level of a machine, for reports and decisions. No allocation.
struct MachineHealth {
  HealthLevel level = HealthLevel::kOk;
  long commands_accepted = 0, commands_rejected = 0;
  long commands_clamped = 0;  ///< among the accepted ones
  long expiries = 0;          ///< times a command ran out and the machine held by itself
  long stall_stops = 0;       ///< wheel drives stopped on stall
  long holds = 0;             ///< times it held without being asked to (never in a simulation)
  bool degraded = false;      ///< works, but loses frames or hears errors
};

/// The machine, simulated or real. One thread at a time. Control-rate calls (read, write, stop,
/// health, lifecycle) are noexcept and allocation-free; wait_until may block (bus) or simulate
/// (MuJoCo). Defaults are those of a machine that is always ready.
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

  [[nodiscard]] virtual Lifecycle lifecycle() const noexcept { return Lifecycle::kActive; }
  /// Makes writes count, without any motion of its own (commands of before are forgotten). Not at
  /// control rate: machine time passes. Does nothing when active.
  ///   errors  kStoppedSafely: the machine refuses or does not answer, with the reason
  [[nodiscard]] virtual Result<void> activate() { return {}; }
  /// Controlled stop, then kInactive. Does nothing in any other state than kActive.
  virtual void deactivate() noexcept { stop(); }
};

}  // namespace wex
