#pragma once

#include <memory>
#include <string>

#include "hw_interface/machine_io.hpp"
#include "models/excavator/machine_model.hpp"

namespace wex {

/// What the program wrote now against what the host had sent when the log was made. Rates of active
/// joints; an inactive joint counts as zero.
struct ReplayReport {
  long frames = 0;                   ///< of the log, used so far
  long frames_refused = 0;           ///< wrong CRC, counter, length or id
  long commands_compared = 0;        ///< ZoneCommands
  long commands_differing = 0;       ///< by more than one step of the bus's resolution
  long commands_unreadable = 0;      ///< of a session that the log does not name
  double max_rate_difference = 0.0;  ///< rad/s or m/s
  std::string worst_joint;
};

/// A recorded bus (candump -L) as a machine that cannot be influenced: the same decoder as live,
/// time from the machine's stamps, so two replays give the same states bit for bit. Commands pass
/// the same checks, joint loop and limits as live, are compared with the recorded ones and never
/// sent anywhere.
///   lifecycle  what the recorded electronics report; kInactive when the log is over
class ReplayMachine final : public MachineIo {
 public:
  /// Plays until the machine is heard completely.
  ///   errors  kBadInput: file or line, or a log in which not all of the machine is heard
  [[nodiscard]] static Result<std::unique_ptr<ReplayMachine>> open(
      const std::string& log_file, const MachineModel& machine,
      const Eigen::Vector2d& map_origin_m);
  ~ReplayMachine() override;

  MachineState read() noexcept override;
  /// Outcomes as of a machine that does what was recorded.
  WriteOutcome write(const JointCommand& command) noexcept override;
  void stop() noexcept override;
  void release() noexcept override;
  MachineHealth health() const noexcept override;
  void wait_until(double t_s) override;
  Lifecycle lifecycle() const noexcept override;
  /// Waits for the moment at which the recorded machine was enabled.
  Result<void> activate() override;
  /// Writes are rejected from now on.
  void deactivate() noexcept override;

  [[nodiscard]] bool finished() const noexcept;  ///< the log is over
  [[nodiscard]] ReplayReport report() const;

 private:
  struct Impl;
  explicit ReplayMachine(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace wex
