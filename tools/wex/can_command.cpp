#include "tools/wex/can_command.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <thread>

#include "hw_interface/socketcan/can_socket.hpp"
#include "tools/wex/bus_monitor.hpp"
#include "tools/wex/bus_report.hpp"
#include "tools/wex/real_time_priority.hpp"
#include "tools/wex/stop_signal.hpp"

namespace wex::app {
namespace {

constexpr double kWait_s = 0.02;  // a stop signal is noticed that soon

double seconds_since(std::int64_t begin_ns, can::MonotonicClock& clock) {
  return 1e-9 * static_cast<double>(clock.now_ns() - begin_ns);
}

/// Columns of the terminal on stdout; nothing if it is none.
std::optional<std::size_t> terminal_width() {
  winsize size{};
  if (isatty(STDOUT_FILENO) != 1) return std::nullopt;
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0) return std::nullopt;
  return size.ws_col;
}

/// The mode of every zone, as a bystander hears it.
class ZoneModes {
 public:
  void take(const can::CanFrame& frame) {
    can::ZoneStatus status;
    if (can::decode(frame, 0, status)) modes_[status.zone] = status.mode;
  }
  void forget() { modes_.fill(std::nullopt); }
  [[nodiscard]] bool heard() const {
    return std::any_of(modes_.begin(), modes_.end(), [](const auto& mode) { return mode; });
  }
  /// All zones report a mode for which `condition` holds.
  template <typename Condition>
  [[nodiscard]] bool all(Condition condition) const {
    return std::all_of(modes_.begin(), modes_.end(),
                       [&](const auto& mode) { return mode && condition(*mode); });
  }
  /// Of the first zone that was heard.
  [[nodiscard]] can::MachineMode mode() const {
    const auto first =
        std::find_if(modes_.begin(), modes_.end(), [](const auto& mode) { return mode; });
    return first == modes_.end() ? can::MachineMode::kInit : **first;
  }

 private:
  std::array<std::optional<can::MachineMode>, can::kNumZones> modes_{};
};

bool latched(can::MachineMode mode) {
  return mode == can::MachineMode::kFault || mode == can::MachineMode::kEStop;
}

void listen(can::FramePort& port, can::MonotonicClock& clock, double duration_s, ZoneModes& modes) {
  const std::int64_t begin_ns = clock.now_ns();
  can::CanFrame frame;
  while (seconds_since(begin_ns, clock) < duration_s) {
    while (port.receive(frame) == can::SocketStatus::kOk) modes.take(frame);
    port.wait_readable(kWait_s);
  }
}

}  // namespace

Result<can::MachineMode> operate(can::FramePort& port, can::MonotonicClock& clock,
                                 can::OperatorAction action) {
  WEX_EXPECTS(action != can::OperatorAction::kNone);
  // The receiver trusts a sender that it has not heard for long after three frames, and a reset
  // counts on its edge: first without action, then with it, at last without.
  constexpr int kIdleFrames = 5, kActionFrames = 5;
  constexpr double kGap_s = 0.03, kHear_s = 2.0, kPatience_s = 2.0;
  const auto nobody = [](const char* sent) {
    return fail(ErrorCode::kBadInput, std::string("no machine is heard on the bus") + sent +
                                          ": is it switched on, and are the bit rates equal?");
  };
  ZoneModes modes;
  if (action == can::OperatorAction::kReset) {  // a stop goes out at once
    const std::int64_t begin_ns = clock.now_ns();
    while (!modes.heard() && seconds_since(begin_ns, clock) < kHear_s) {
      listen(port, clock, kGap_s, modes);
    }
    if (!modes.heard()) return nobody("");
  }
  can::SendContext context;
  const auto send = [&](can::OperatorAction what, int times) {
    for (int i = 0; i < times; ++i) {
      can::CanFrame frame;
      if (can::encode(can::OperatorCommand{what}, context, frame)) (void)port.send(frame);
      listen(port, clock, kGap_s, modes);
    }
  };
  if (action == can::OperatorAction::kReset) send(can::OperatorAction::kNone, kIdleFrames);
  send(action, kActionFrames);
  modes.forget();  // only what is reported from now on confirms
  send(can::OperatorAction::kNone, 1);
  const auto confirmed = [&] {
    return modes.all([&](can::MachineMode mode) {
      return action == can::OperatorAction::kStop ? mode == can::MachineMode::kEStop
                                                  : !latched(mode);
    });
  };
  const std::int64_t begin_ns = clock.now_ns();
  while (!confirmed() && seconds_since(begin_ns, clock) < kPatience_s) {
    listen(port, clock, kGap_s, modes);
  }
  if (confirmed()) return modes.mode();
  if (action == can::OperatorAction::kStop && !modes.heard()) return nobody(", the stop was sent");
  const std::string mode =
      modes.heard() ? std::string("reports ") + can::to_string(modes.mode()) : "is silent";
  return fail(ErrorCode::kStoppedSafely,
              action == can::OperatorAction::kStop
                  ? "the stop is not confirmed by all zones: the machine " + mode
                  : "the reset is not confirmed by all zones: the machine " + mode +
                        " (is the e-stop chain closed, and the cause gone?)");
}

Result<void> monitor_bus(can::FramePort& port, can::MonotonicClock& clock,
                         const CanOptions& options, std::optional<std::size_t> max_width,
                         std::ostream& out, const std::atomic<bool>& stop) {
  constexpr double kPeriod_s = 1.0, kReopen_s = 0.5;
  const std::int64_t begin_ns = clock.now_ns();
  const std::optional<double> duration_s =
      options.once ? options.duration_s.value_or(kPeriod_s + kWait_s) : options.duration_s;
  const auto over = [&] {
    return stop || (duration_s && seconds_since(begin_ns, clock) >= *duration_s);
  };
  BusMonitor monitor;
  const auto show = [&] {
    if (max_width && !options.json) out << "\033[H\033[2J";  // home, clear
    out << (options.json ? monitor.json(clock.now_ns(), port.dropped())
                         : monitor.table(clock.now_ns(), port.dropped(), max_width.value_or(0)))
        << std::flush;
  };
  std::int64_t shown_ns = begin_ns, reopened_ns = begin_ns;
  bool lost = false;
  while (!over()) {
    can::CanFrame frame;
    can::SocketStatus status = can::SocketStatus::kOk;
    while ((status = port.receive(frame)) == can::SocketStatus::kOk && !over()) {
      monitor.take(frame, clock.now_ns());
    }
    if (status == can::SocketStatus::kGone || lost) {
      if (!lost) out << "the interface is gone, waiting for it\n" << std::flush;
      lost = true;
      if (seconds_since(reopened_ns, clock) >= kReopen_s) {
        reopened_ns = clock.now_ns();
        lost = port.reopen() != can::SocketStatus::kOk;
      }
      std::this_thread::sleep_for(std::chrono::duration<double>(kWait_s));
    } else {
      port.wait_readable(kWait_s);
    }
    if (!options.once && seconds_since(shown_ns, clock) >= kPeriod_s) {
      shown_ns = clock.now_ns();
      show();
    }
  }
  if (options.once) show();
  if (monitor.frames() > 0) return {};
  return fail(ErrorCode::kBadInput, "no frame was heard on the bus");
}

Result<void> keep_enabled(can::SocketCanMachine& machine, std::optional<double> duration_s,
                          std::ostream& out, const std::atomic<bool>& stop) {
  constexpr double kPeriod_s = 0.01;
  can::SystemClock clock;
  const std::int64_t begin_ns = clock.now_ns();
  const auto time_s = [&] { return seconds_since(begin_ns, clock); };
  const auto tell = [&] {
    char line[200];
    std::snprintf(line, sizeof(line), "[%8.2f s] %s%s%s\n", time_s(), name_of(machine.phase()),
                  machine.cause() == can::HostCause::kNone ? "" : ": ",
                  machine.cause() == can::HostCause::kNone ? "" : can::describe(machine.cause()));
    out << line << std::flush;
  };
  tell();
  const Result<void> activated = machine.activate();
  tell();
  if (!activated) return activated;
  can::HostPhase phase = machine.phase();
  double machine_s = machine.read().t_s;
  while (!stop && machine.lifecycle() == Lifecycle::kActive &&
         !(duration_s && time_s() >= *duration_s)) {
    machine_s = std::max(machine_s + kPeriod_s, machine.read().t_s);
    machine.wait_until(machine_s);
    // In lock step the machine's clock would run as fast as it can.
    if (machine.lock_step()) std::this_thread::sleep_for(std::chrono::duration<double>(kPeriod_s));
    if (machine.phase() != phase) tell();
    phase = machine.phase();
  }
  if (machine.lifecycle() != Lifecycle::kActive) {
    return fail(ErrorCode::kStoppedSafely,
                std::string("the machine did not stay enabled: ") + can::describe(machine.cause()));
  }
  machine.deactivate();
  tell();
  return {};
}

Result<void> run_can(const CanOptions& options, std::ostream& out) {
  const std::atomic<bool>& stop = stop_on_signals();
  if (options.action == CanAction::kEnable) {
    const Result<MachineModel> model = load_machine(options.machine);
    if (!model) return tl::unexpected(model.error());
    auto machine = can::SocketCanMachine::open(options.can_interface, *model, {0.0, 0.0});
    if (!machine) return tl::unexpected(machine.error());
    std::optional<RealTimePriority> priority;
    if (!(*machine)->lock_step()) priority.emplace();
    return keep_enabled(**machine, options.duration_s, out, stop);
  }
  Result<can::CanSocket> socket = can::CanSocket::open(options.can_interface);
  if (!socket) return tl::unexpected(socket.error());
  can::SystemClock clock;
  if (options.action == CanAction::kMonitor) {
    return monitor_bus(*socket, clock, options, terminal_width(), out, stop);
  }
  const Result<can::MachineMode> mode =
      operate(*socket, clock,
              options.action == CanAction::kStop ? can::OperatorAction::kStop
                                                 : can::OperatorAction::kReset);
  if (!mode) return tl::unexpected(mode.error());
  out << "the machine reports " << can::to_string(*mode) << "\n";
  return {};
}

}  // namespace wex::app
