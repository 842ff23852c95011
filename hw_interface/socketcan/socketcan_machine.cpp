#include "hw_interface/socketcan/socketcan_machine.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hw_interface/socketcan/can_socket.hpp"

namespace wex::can {
namespace {

constexpr double kTimeTolerance_s = 1e-6;
constexpr double kShortWait_s = 0.002;
constexpr int kMaxBatches = 400;         ///< more than the receive buffer holds
constexpr double kHandshakeSteps = 3.0;  ///< of the automaton's patience, with a margin

double seconds(std::int64_t duration_ns) noexcept {
  return 1e-9 * static_cast<double>(duration_ns);
}
std::int64_t nanoseconds(double duration_s) noexcept {
  return static_cast<std::int64_t>(1e9 * duration_s);
}

}  // namespace

struct SocketCanMachine::Impl {
  Impl(FramePort& port, MonotonicClock& clock_in, const MachineModel& machine,
       HostFeedback feedback, const SocketCanSettings& settings_in)
      : settings(settings_in),
        clock(clock_in),
        host(port, machine, std::move(feedback), settings.host) {}

  void receive() noexcept {
    bool more = true;
    for (int batch = 0; more && batch < kMaxBatches; ++batch) {
      more = host.collect();
      now_ns = clock.now_ns();
      host.receive(now_ns);
    }
  }
  double now_s() const noexcept { return host.now_s(); }
  bool in_lock_step() const noexcept {
    return host.feedback().clock().mode() == HostClock::Mode::kLockStep;
  }

  /// Lets the machine's clock run to `until_ms` and takes what it says about it. Lost frames are
  /// not waited for: once the bus is quiet after part of an answer, the rest counts as lost.
  void lock_step_once(std::uint32_t until_ms) noexcept {
    const std::int64_t begin_ns = clock.now_ns();
    std::int64_t asked_ns = begin_ns, heard_ns = begin_ns;
    long heard_frames = host.link().statistics().frames_received();
    host.send_lock_step(until_ms);
    for (;;) {
      receive();
      if (host.feedback().all_zones_reach(until_ms)) return;
      const long frames = host.link().statistics().frames_received();
      if (frames != heard_frames) heard_ns = now_ns;
      heard_frames = frames;
      const std::uint32_t newest_ms = host.feedback().clock().newest_stamp_ms();
      const bool partly = static_cast<std::int32_t>(newest_ms - until_ms) >= 0;
      if (partly && seconds(now_ns - heard_ns) > settings.lock_step_quiet_s) return;
      if (seconds(now_ns - begin_ns) > settings.lock_step_patience_s) {
        // From here on our own clock tells the time, so that ages run.
        host.report_lock_step_lost();
        host.feedback().clock().set_mode(HostClock::Mode::kFreeRunning, now_ns);
        return;
      }
      if (seconds(now_ns - asked_ns) > settings.lock_step_repeat_s) {
        host.send_lock_step(until_ms);
        asked_ns = now_ns;
      }
      host.link().wait(kShortWait_s);
    }
  }

  void advance_lock_step(double t_s) noexcept {
    const auto period_ms = static_cast<std::uint32_t>(std::lround(1e3 * settings.host.period_s));
    while (in_lock_step() && now_s() < t_s - kTimeTolerance_s) {
      receive();
      host.cycle(now_ns);
      const std::uint32_t here_ms = host.feedback().clock().newest_stamp_ms();
      lock_step_once((here_ms / period_ms + 1) * period_ms);
    }
  }

  void advance_real_time(double t_s) noexcept {
    receive();
    // Wall time bounds the wait, so that a machine whose clock jumps does not keep us here.
    const std::int64_t end_ns = now_ns + nanoseconds(std::max(0.0, t_s - now_s()));
    const std::int64_t period_ns = nanoseconds(settings.host.period_s);
    for (;;) {
      if (now_ns >= next_cycle_ns) {
        host.cycle(now_ns);
        next_cycle_ns += period_ns;
        // After a pause the rhythm starts anew: nothing is caught up.
        if (next_cycle_ns <= now_ns) next_cycle_ns = now_ns + period_ns;
      }
      if (now_ns >= end_ns || now_s() >= t_s - kTimeTolerance_s) return;
      host.link().wait(seconds(std::min(end_ns, next_cycle_ns) - now_ns));
      receive();
    }
  }

  void wait_until(double t_s) noexcept {
    if (in_lock_step()) advance_lock_step(t_s);
    if (!in_lock_step()) advance_real_time(t_s);
  }

  template <typename Condition>
  bool wait_for(double patience_s, Condition condition) noexcept {
    const double end_s = now_s() + patience_s;
    while (!condition() && now_s() < end_s) wait_until(now_s() + settings.host.period_s);
    return condition();
  }

  std::unique_ptr<CanSocket> owned_socket;  ///< if opened by name
  std::unique_ptr<MonotonicClock> owned_clock;
  SocketCanSettings settings;
  MonotonicClock& clock;
  HostSession host;
  std::int64_t now_ns = 0, next_cycle_ns = 0;
};

SocketCanMachine::SocketCanMachine(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SocketCanMachine::~SocketCanMachine() = default;

Result<std::unique_ptr<SocketCanMachine>> SocketCanMachine::open_on(
    FramePort& port, MonotonicClock& clock, const MachineModel& machine,
    const Eigen::Vector2d& map_origin_m, const SocketCanSettings& settings) {
  const HostSettings& host = settings.host;
  constexpr double kMaxValidity_s = 0.255;  // one byte of milliseconds
  if (!(host.period_s >= 1e-3 && host.command_valid_s >= host.period_s &&
        host.command_valid_s <= kMaxValidity_s)) {
    return fail(ErrorCode::kBadInput,
                "the period of commands must be at least 1 ms and at most their validity, and "
                "that at most 255 ms");
  }
  auto feedback = HostFeedback::create(machine, map_origin_m, host.feedback);
  if (!feedback) return tl::unexpected(feedback.error());
  auto impl = std::make_unique<Impl>(port, clock, machine, std::move(*feedback), settings);
  impl->now_ns = impl->next_cycle_ns = clock.now_ns();
  const std::int64_t give_up_ns = impl->now_ns + nanoseconds(settings.connect_patience_s);
  const auto heard = [&] { return impl->host.automaton().phase != HostPhase::kUnconfigured; };
  while (!heard() && impl->now_ns < give_up_ns) impl->wait_until(impl->now_s() + host.period_s);

  if (impl->host.automaton().cause == HostCause::kOtherDbc) {
    return fail(ErrorCode::kBadInput,
                "the machine on the bus was built from another wex.dbc: both sides need the same");
  }
  if (!heard()) {
    return fail(ErrorCode::kBadInput,
                impl->host.link().statistics().frames_received() == 0
                    ? "no machine is heard on the bus: is it switched on ('wex machine --can "
                      "IFACE' is the simulated one), and are the bit rates equal?"
                    : "the machine is heard, but not all of it (feedback and status of every zone, "
                      "e-stop report, base pose): is the localisation unit running?");
  }
  const bool announced = (impl->host.feedback().status(0).fault_bits & kAnnouncesLockStep) != 0;
  if (settings.pace == SocketCanSettings::Pace::kLockStep ||
      (settings.pace == SocketCanSettings::Pace::kAsAnnounced && announced)) {
    impl->host.feedback().clock().set_mode(HostClock::Mode::kLockStep, impl->now_ns);
  }
  return std::unique_ptr<SocketCanMachine>(new SocketCanMachine(std::move(impl)));
}

Result<std::unique_ptr<SocketCanMachine>> SocketCanMachine::open(
    const std::string& interface_name, const MachineModel& machine,
    const Eigen::Vector2d& map_origin_m, const SocketCanSettings& settings) {
  auto socket = CanSocket::open(interface_name);
  if (!socket) return tl::unexpected(socket.error());
  if (!socket->takes_fd_frames()) {
    return fail(ErrorCode::kBadInput, "the interface '" + interface_name +
                                          "' is set up for classic CAN: it needs 'dbitrate "
                                          "2000000 fd on' (a virtual one: 'mtu 72')");
  }
  auto owned_socket = std::make_unique<CanSocket>(std::move(*socket));
  auto owned_clock = std::make_unique<SystemClock>();
  auto opened = open_on(*owned_socket, *owned_clock, machine, map_origin_m, settings);
  if (!opened) return opened;
  (*opened)->impl_->owned_socket = std::move(owned_socket);
  (*opened)->impl_->owned_clock = std::move(owned_clock);
  return opened;
}

MachineState SocketCanMachine::read() noexcept {
  impl_->receive();
  return impl_->host.state();
}

WriteOutcome SocketCanMachine::write(const JointCommand& command) noexcept {
  impl_->receive();
  return impl_->host.write(command);
}

void SocketCanMachine::stop() noexcept {
  impl_->receive();
  impl_->host.stop();
}

void SocketCanMachine::release() noexcept { impl_->host.release(); }
MachineHealth SocketCanMachine::health() const noexcept { return impl_->host.health(); }
void SocketCanMachine::wait_until(double t_s) { impl_->wait_until(t_s); }

Lifecycle SocketCanMachine::lifecycle() const noexcept {
  switch (phase()) {
    case HostPhase::kUnconfigured:
      return Lifecycle::kUnconfigured;
    case HostPhase::kInactive:
    case HostPhase::kAsking:
    case HostPhase::kProving:
      return Lifecycle::kInactive;
    case HostPhase::kActive:
    case HostPhase::kHold:
      return Lifecycle::kActive;
    case HostPhase::kFault:
      return Lifecycle::kFault;
    case HostPhase::kEStop:
      break;
  }
  return Lifecycle::kEStop;
}

Result<void> SocketCanMachine::activate() {
  HostSession& host = impl_->host;
  const auto refuse = [&](const std::string& what) {
    return fail(ErrorCode::kStoppedSafely, "the machine was not enabled: " + what);
  };
  const auto hopeless = [&] {
    return lifecycle() == Lifecycle::kFault || lifecycle() == Lifecycle::kEStop;
  };
  if (lifecycle() == Lifecycle::kActive) return {};
  if (host.stopped()) return refuse("a stop is in force, release it first");
  const auto ready = [&] {
    return phase() == HostPhase::kInactive && host.feedback().mode() == MachineMode::kReady;
  };
  impl_->wait_for(impl_->settings.ready_patience_s, [&] { return ready() || hopeless(); });
  if (!ready()) {
    return refuse(cause() == HostCause::kNone ? "it does not report to be ready (sensors, base "
                                                "pose, valves neutral)"
                                              : describe(cause()));
  }
  host.request_enable();
  const auto decided = [&] {
    return !host.request_pending() && phase() != HostPhase::kAsking &&
           phase() != HostPhase::kProving;
  };
  impl_->wait_for(kHandshakeSteps * impl_->settings.host.times.answer_within_s, decided);
  if (phase() == HostPhase::kActive) return {};
  return refuse(describe(cause()));
}

void SocketCanMachine::deactivate() noexcept {
  HostSession& host = impl_->host;
  if (lifecycle() != Lifecycle::kActive) return;
  host.forget_command();
  const double patience_s = impl_->settings.stop_patience_s;
  impl_->wait_for(patience_s, [&] { return host.stands(impl_->settings.standing_rate); });
  host.request_disable();
  impl_->wait_for(patience_s, [&] {
    return !host.request_pending() && host.feedback().session() == 0 &&
           host.feedback().mode() != MachineMode::kEnabled;
  });
}

const BusStatistics& SocketCanMachine::statistics() const noexcept {
  return impl_->host.link().statistics();
}
HostPhase SocketCanMachine::phase() const noexcept { return impl_->host.automaton().phase; }
HostCause SocketCanMachine::cause() const noexcept { return impl_->host.automaton().cause; }
bool SocketCanMachine::lock_step() const noexcept { return impl_->in_lock_step(); }
const FrameRecorder& SocketCanMachine::recorder() const noexcept {
  return impl_->host.link().recorder();
}

}  // namespace wex::can
