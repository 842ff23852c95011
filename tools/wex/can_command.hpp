#pragma once

#include <atomic>
#include <optional>
#include <ostream>
#include <string>

#include "hw_interface/socketcan/frame_port.hpp"
#include "hw_interface/socketcan/messages.hpp"
#include "hw_interface/socketcan/socketcan_machine.hpp"
#include "models/types/result.hpp"

namespace wex::app {

enum class CanAction { kMonitor, kEnable, kStop, kReset };

/// What the user asks of `wex can`.
struct CanOptions {
  CanAction action = CanAction::kMonitor;
  std::string can_interface;
  bool once = false;                 ///< monitor: one table, after duration_s or a second
  bool json = false;                 ///< monitor: one JSON object per line
  std::optional<double> duration_s;  ///< monitor, enable: wall time; empty: until Ctrl-C
  std::string machine = "m545";
};

/// A person's tool at the bus.
///   out     what is seen and what happens
///   errors  kBadInput: no such interface, nobody heard; kStoppedSafely: the machine was not
///           enabled, did not stay enabled or did not confirm
[[nodiscard]] Result<void> run_can(const CanOptions& options, std::ostream& out);

/// What is heard on a port, until `stop` or the duration is over. A table every second.
///   max_width  of a terminal, where the table is refreshed in place; nothing: plain lines
[[nodiscard]] Result<void> monitor_bus(can::FramePort& port, can::MonotonicClock& clock,
                                       const CanOptions& options,
                                       std::optional<std::size_t> max_width, std::ostream& out,
                                       const std::atomic<bool>& stop);

/// Sends a person's stop or reset with the edge that it needs and waits for all zones to confirm.
///   action   not kNone (contract)
///   returns  the mode that followed
///   errors   kBadInput: no machine is heard; kStoppedSafely: not confirmed, with the mode
[[nodiscard]] Result<can::MachineMode> operate(can::FramePort& port, can::MonotonicClock& clock,
                                               can::OperatorAction action);

/// Enables the machine and keeps it so with neutral commands: the check on the bench, without
/// hydraulics. Every change of state is told with its cause.
///   errors  kStoppedSafely: it was not enabled, or ended otherwise than by us
[[nodiscard]] Result<void> keep_enabled(can::SocketCanMachine& machine,
                                        std::optional<double> duration_s, std::ostream& out,
                                        const std::atomic<bool>& stop);

}  // namespace wex::app
