#pragma once

#include <memory>
#include <string>

#include "hw_interface/machine_io.hpp"
#include "hw_interface/socketcan/host_session.hpp"
#include "models/excavator/machine_model.hpp"

namespace wex::can {

/// Set in ZoneStatus::fault_bits by a simulated machine whose clock waits for LockStep frames.
inline constexpr std::uint16_t kAnnouncesLockStep = 1 << 15;

struct SocketCanSettings {
  enum class Pace {
    kAsAnnounced,  ///< lock step if the machine announces it
    kRealTime,
    kLockStep
  };
  Pace pace = Pace::kAsAnnounced;
  double period_s = 0.01;             ///< ZoneCommands; every second one with a heartbeat
  double command_valid_s = 0.06;      ///< on the bus, from the feedback that it was computed from
  double connect_patience_s = 5.0;    ///< wall time to hear everything of the machine
  double ready_patience_s = 3.0;      ///< machine time until it is ready to be enabled
  double stop_patience_s = 2.0;       ///< machine time until it stands, when deactivated
  double standing_rate = 0.02;        ///< rad/s or m/s
  double lock_step_repeat_s = 0.05;   ///< wall time without an answer: asked again
  double lock_step_patience_s = 2.0;  ///< wall time: the bus is lost
  double lock_step_quiet_s = 0.01;    ///< wall time without a frame: the rest of a tick was lost
  HostSettings host;
};

/// The machine at the other end of a CAN bus (wex.dbc). Single-threaded on purpose: everything that
/// is sent and received happens inside the calls, on the caller's control thread, so that a program
/// that hangs sends nothing any more and the machine's own time-outs stop it; a sender thread would
/// keep its last command alive. Hence in real time wait_until must be called at least every 50 ms
/// (solve elsewhere); in lock step the machine's clock waits.
///   lifecycle  open(): kUnconfigured until all of the machine is heard; activate(): handshake
///   time       the machine's (its millisecond stamps); ages by its stamps, never by arrival
///   commands   JointLoop and limits here at 100 Hz, rates on the bus, spools in the machine
/// FAULT and e-stop are left by a person's reset on the bus only (wex can reset).
class SocketCanMachine final : public MachineIo {
 public:
  /// Opens the interface and waits until the machine is heard.
  ///   map_origin_m  of the terrain: local world frame = map frame - this
  ///   errors  kBadInput: no such interface, no FD, no machine, another DBC
  [[nodiscard]] static Result<std::unique_ptr<SocketCanMachine>> open(
      const std::string& interface_name, const MachineModel& machine,
      const Eigen::Vector2d& map_origin_m, const SocketCanSettings& settings = {});
  /// The same on any port and clock, which must live longer.
  [[nodiscard]] static Result<std::unique_ptr<SocketCanMachine>> open_on(
      FramePort& port, MonotonicClock& clock, const MachineModel& machine,
      const Eigen::Vector2d& map_origin_m, const SocketCanSettings& settings = {});
  ~SocketCanMachine() override;

  MachineState read() noexcept override;
  WriteOutcome write(const JointCommand& command) noexcept override;
  /// At once: three HostStop frames. Then 100 Hz until release().
  void stop() noexcept override;
  void release() noexcept override;
  MachineHealth health() const noexcept override;
  void wait_until(double t_s) override;
  Lifecycle lifecycle() const noexcept override;
  Result<void> activate() override;
  void deactivate() noexcept override;

  [[nodiscard]] const BusStatistics& statistics() const noexcept;
  [[nodiscard]] HostPhase phase() const noexcept;
  [[nodiscard]] HostCause cause() const noexcept;  ///< why the phase is what it is
  [[nodiscard]] bool lock_step() const noexcept;
  /// The frames of the last 60 s; kept from overwriting a second after a fault.
  [[nodiscard]] const FrameRecorder& recorder() const noexcept;

 private:
  struct Impl;
  explicit SocketCanMachine(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace wex::can
