#include <fcntl.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "hw_interface/socketcan/can_socket.hpp"
#include "hw_interface/socketcan/codec.hpp"
#include "tools/bench/can_faults/figures.hpp"
#include "tools/bench/can_faults/rig.hpp"
#include "tools/bench/can_faults/scenarios.hpp"

// Somebody on the bus is not who he seems, says what is not so or says nothing: a controller that
// goes bus-off, a second sender, forged error frames, a zone that falls silent.

namespace wex::can_faults {
namespace {

constexpr double kMaxMotion_ms = 150.0;

/// A serial CAN adapter that is none: a pseudo terminal with the slcan line discipline at its far
/// end, which makes an interface. What we write is what the adapter reports to the kernel's driver.
class SlcanAdapter {
 public:
  SlcanAdapter() {
    terminal_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (terminal_ < 0 || grantpt(terminal_) != 0 || unlockpt(terminal_) != 0) {
      throw std::runtime_error("no pseudo terminal for slcan");
    }
    line_ = open(ptsname(terminal_), O_RDWR | O_NOCTTY);
    termios raw{};
    tcgetattr(line_, &raw);
    cfmakeraw(&raw);
    tcsetattr(line_, TCSANOW, &raw);
    constexpr int kSlcanDiscipline = 17;  // N_SLCAN
    if (line_ < 0 || ioctl(line_, TIOCSETD, &kSlcanDiscipline) != 0) {
      throw std::runtime_error("the kernel has no slcan");
    }
    char name[16] = "";
    if (ioctl(line_, SIOCGIFNAME, name) != 0) throw std::runtime_error("slcan has no interface");
    interface_name_ = name;
    shell("ip link set " + interface_name_ + " up");
    reader_ = std::thread([this] { serve(); });
  }
  SlcanAdapter(const SlcanAdapter&) = delete;
  SlcanAdapter& operator=(const SlcanAdapter&) = delete;
  ~SlcanAdapter() {
    end_ = true;
    reader_.join();
    close(line_);
    close(terminal_);
  }

  void set_bus_off(bool bus_off) {
    bus_off_ = bus_off;
    if (bus_off) report();
  }
  [[nodiscard]] int reports() const { return reports_; }
  [[nodiscard]] const std::string& interface_name() const { return interface_name_; }

 private:
  void report() {
    constexpr char kBusOff[] =
        "sb000255\r";  // state bus-off, receive errors 0, transmit errors 255
    if (write(terminal_, kBusOff, sizeof(kBusOff) - 1) > 0) ++reports_;
  }
  /// The driver opens the channel ("O") when the link comes up: a bus that is still broken takes
  /// the controller down again.
  void serve() {
    char buffer[64];
    while (!end_) {
      const ssize_t bytes = read(terminal_, buffer, sizeof(buffer));
      if (bytes > 0 && bus_off_ && std::memchr(buffer, 'O', static_cast<std::size_t>(bytes))) {
        report();
      }
      if (bytes <= 0) sleep_s(0.002);
    }
  }

  int terminal_ = -1, line_ = -1;
  std::string interface_name_;
  std::atomic<bool> end_{false}, bus_off_{false};
  std::atomic<int> reports_{0};
  std::thread reader_;
};

can::CanSocket open_socket(const char* interface_name) {
  auto socket = can::CanSocket::open(interface_name);
  if (!socket) throw std::runtime_error(socket.error().message);
  return std::move(*socket);
}

/// The newest frame of a kind that passes by.
can::CanFrame overhear(can::CanSocket& socket, can::MessageKind kind) {
  can::CanFrame frame, found;
  bool any = false;
  if (!wait_for(1.0, [&] {
        while (socket.receive(frame) == can::SocketStatus::kOk) {
          if (can::kind_of(frame) != kind) continue;
          found = frame;
          any = true;
        }
        return any;
      })) {
    throw std::runtime_error("nothing to imitate passes by");
  }
  return found;
}

can::CanFrame forged_bus_off() {
  can::CanFrame frame;
  frame.error = true;
  frame.id = 0x40;  // CAN_ERR_BUSOFF
  frame.length = 8;
  return frame;
}

/// A second sender of one of the host's or the machine's frames, taken from the bus as it was.
void imitate(Scene& scene, const char* what, can::MessageKind kind) {
  Rig rig(scene);
  rig.drive();
  can::CanSocket impostor = open_socket("vxcan0");  // the host hears it, and so does the machine
  const can::CanFrame frame = overhear(impostor, kind);
  const std::int64_t begin_ns = now_ns();
  if (impostor.send(frame) != can::SocketStatus::kOk) throw std::runtime_error("not sent");
  sleep_s(1.0);
  const bool host_faults = rig.lifecycle() == Lifecycle::kFault;
  const bool machine_stands = rig.mode() != can::MachineMode::kEnabled;
  const CommandCheck check = check_commands(rig.board(), begin_ns);
  print_figure(
      "T15", what,
      text("host in fault: %s, machine leaves enabled: %s, imitations accepted %ld",
           host_faults ? "yes" : "no", machine_stands ? "yes" : "no", check.altered + check.twice),
      "fault, none accepted", host_faults && machine_stands && check.altered + check.twice == 0);
}

void forge_errors(Scene& scene) {
  Rig rig(scene);
  can::CanSocket liar = open_socket("vxcan0");
  const std::int64_t begin_ns = now_ns();
  const auto lie = [&] {
    for (int i = 0; i < 100; ++i) {
      liar.send(forged_bus_off());
      sleep_s(0.005);
    }
  };
  lie();  // machine ready, nobody asked for motion
  const bool enabled = ever(rig.board(), can::MachineMode::kEnabled, begin_ns);
  rig.drive();
  rig.board().estop_open_from_ns = now_ns();
  sleep_s(0.1);
  rig.board().estop_open_from_ns = 0;
  const std::int64_t stopped_ns = now_ns();
  lie();  // stopped: errors must not undo it
  const bool resumed = ever(rig.board(), can::MachineMode::kEnabled, stopped_ns);
  print_figure("T15", "100 forged bus-off frames, before enabling and in e-stop",
               text("enabled: %s, resumed: %s", enabled ? "yes" : "no", resumed ? "yes" : "no"),
               "neither", !enabled && !resumed);
}

}  // namespace

void go_bus_off(Scene& scene, bool full) {
  for (const double broken_s :
       full ? std::vector<double>{0.3, 3.0, 10.0} : std::vector<double>{1.0}) {
    SlcanAdapter adapter;
    HostOptions options;
    options.error_interface = adapter.interface_name();
    Rig rig(scene, options);
    rig.drive();
    const std::int64_t begin_ns = now_ns();
    adapter.set_bus_off(true);
    sleep_s(broken_s);
    adapter.set_bus_off(false);
    sleep_s(2.0);
    const StopFigures figures = stop_figures(rig.board(), begin_ns + 20'000'000);
    std::int64_t hold_ns = begin_ns;
    for (const MachineSample& sample : rig.board().machine) {
      if (sample.time_ns > begin_ns && sample.mode != can::MachineMode::kEnabled) {
        hold_ns = sample.time_ns;
        break;
      }
    }
    const double hold_ms = 1e-6 * static_cast<double>(hold_ns - begin_ns);
    const int resumed = entries(rig.board(), can::MachineMode::kEnabled, hold_ns);
    const bool lasts = broken_s < 0.5;  // a short one may end within the session
    print_figure(
        "T8", text("controller bus-off for %.1f s (slcan's error states)", broken_s),
        text("%d bus-off reports, %ld error frames at the host; machine holds after %.0f "
             "ms, joints stand %.0f ms after the last command; %ld restarts; enabled by itself "
             "%d times",
             adapter.reports(), rig.board().statistics.error_frames, hold_ms, figures.joints_ms,
             rig.board().statistics.purges, resumed),
        lasts ? "hold <= 75 ms" : "hold <= 75 ms, never enabled by itself",
        adapter.reports() > 0 && rig.board().statistics.error_frames > 0 && hold_ns > begin_ns &&
            hold_ms <= 75.0 + figures.late_ms && resumed == 0 &&
            figures.joints_ms <= kMaxMotion_ms + figures.late_ms);
  }
}

void masquerade(Scene& scene, bool) {
  imitate(scene, "second sender of the host's ZoneCommand (a true one, again)",
          can::MessageKind::kZoneCommand);
  imitate(scene, "second sender of the host's heartbeat", can::MessageKind::kHostHeartbeat);
  imitate(scene, "second sender of the machine's ZoneFeedback", can::MessageKind::kZoneFeedback);
  forge_errors(scene);
}

void lose_one_zone(Scene& scene, bool full) {
  const int times = full ? 200 : 20;
  Rig rig(scene);
  rig.drive(Motion::kSine);
  std::vector<double> stale_ms;
  double latest_ms = 0.0;  // less how late the host was
  for (int i = 0; i < times; ++i) {
    sleep_s(0.1 + 0.0013 * (i % 8));
    if (!wait_for(3.0, [&] {
          const Blackboard& board = rig.board();
          return rig.mode() == can::MachineMode::kEnabled &&
                 !board.host[board.host.size() - 1].turn_stale;
        })) {
      throw std::runtime_error("the machine does not come back from a hold");
    }
    rig.board().muted_zone = 1 + 4;  // turntable and arm
    const std::size_t from = rig.board().host.size();
    sleep_s(0.045);
    const std::int64_t silence_ns = rig.board().last_arm_sample_ns;  // ages count from it
    rig.board().muted_zone = 0;
    sleep_s(0.03);
    double stale = -1.0;
    for (std::size_t k = from; k < rig.board().host.size() && stale < 0.0; ++k) {
      const HostSample& sample = rig.board().host[k];
      if (sample.turn_stale) stale = 1e-6 * static_cast<double>(sample.time_ns - silence_ns);
    }
    stale_ms.push_back(stale);
    latest_ms =
        std::max(latest_ms, stale - lateness_ms(rig.board(), silence_ns, silence_ns + 50'000'000));
  }
  print_figure(
      "T17", text("one zone's feedback lost for 45 ms, %d times", times),
      text("the planner sees STALE after p50 %.0f, min %.0f, max %.0f ms",
           percentile(stale_ms, 0.5), percentile(stale_ms, 0.0), percentile(stale_ms, 1.0)),
      "30 ms +- a period (+2, + late)", percentile(stale_ms, 0.0) >= 20.0 && latest_ms <= 42.0);
}

}  // namespace wex::can_faults
