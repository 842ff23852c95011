#include <gtest/gtest.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <iostream>
#include <thread>

#include "hw_interface/electronics/electronics.hpp"
#include "hw_interface/socketcan/socketcan_machine.hpp"
#include "tests/support/fake_plant.hpp"
#include "tools/wex/stop_signal.hpp"

// The host's control thread, the electronics' thread and one that stops the program by a signal, in
// real time over a pair of kernel sockets. ThreadSanitizer judges: it ends the program with an
// error if two of them touch the same memory.

namespace wex::can {
namespace {

using std::chrono::milliseconds;

/// One end of a pair of packet sockets.
class PacketPort final : public FramePort {
 public:
  explicit PacketPort(int descriptor) : descriptor_(descriptor) {}
  PacketPort(const PacketPort&) = delete;
  PacketPort& operator=(const PacketPort&) = delete;
  ~PacketPort() override { close(descriptor_); }

  SocketStatus send(const CanFrame& frame) noexcept override {
    const ssize_t sent = ::send(descriptor_, &frame, sizeof(frame), MSG_DONTWAIT | MSG_NOSIGNAL);
    return sent == sizeof(frame) ? SocketStatus::kOk : SocketStatus::kWouldBlock;
  }
  SocketStatus receive(CanFrame& frame) noexcept override {
    const ssize_t received = ::recv(descriptor_, &frame, sizeof(frame), MSG_DONTWAIT);
    return received == sizeof(frame) ? SocketStatus::kOk : SocketStatus::kWouldBlock;
  }
  SocketStatus wait_readable(double timeout_s) noexcept override {
    pollfd readable{descriptor_, POLLIN, 0};
    const auto timeout_ms = static_cast<int>(1e3 * timeout_s) + 1;
    return poll(&readable, 1, timeout_ms) > 0 ? SocketStatus::kOk : SocketStatus::kWouldBlock;
  }
  SocketStatus reopen() noexcept override { return SocketStatus::kOk; }
  bool purge() noexcept override { return false; }
  std::uint32_t dropped() const noexcept override { return 0; }

 private:
  int descriptor_;
};

struct Shared {
  std::atomic<bool> end{false}, driving{false};
  std::atomic<long> machine_enabled_periods{0}, machine_frames{0};
};

void run_electronics(const MachineModel& machine, PacketPort& port, Shared& shared) {
  FakePlant plant(machine);
  SeededRandom random(1);
  auto electronics = Electronics::create(machine, plant, port, random).value();
  SystemClock clock;
  std::int64_t next_ms = clock.now_ns() / 1'000'000;
  while (!shared.end) {
    next_ms += 10;
    for (std::int64_t now_ms = 0; (now_ms = clock.now_ns() / 1'000'000) < next_ms;) {
      port.wait_readable(1e-3 * static_cast<double>(next_ms - now_ms));
      electronics->receive(clock.now_ns() / 1'000'000);
    }
    electronics->tick(clock.now_ns() / 1'000'000);
    shared.machine_enabled_periods += electronics->automaton().mode() == MachineMode::kEnabled;
    shared.machine_frames = electronics->counters().frames;
  }
}

struct HostResult {
  bool opened = false, activated = false, stopped_at_the_end = false;
  long cycles = 0, writes_taken = 0;
};

/// Drives until the signal, then stops and goes on for half a second.
HostResult run_host(const MachineModel& machine, PacketPort& port, Shared& shared) {
  HostResult result;
  SystemClock clock;
  SocketCanSettings settings;
  settings.pace = SocketCanSettings::Pace::kRealTime;
  auto opened = SocketCanMachine::open_on(port, clock, machine, {0.0, 0.0}, settings);
  if (!opened) return result;
  result.opened = true;
  SocketCanMachine& host = **opened;
  for (int i = 0; i < 10 && !result.activated; ++i) {  // a loaded machine may be too late for one
    result.activated = host.activate().has_value();
  }
  const std::atomic<bool>& stop = app::stop_on_signals();
  shared.driving = true;
  int cycles_after_stop = 0;
  while (cycles_after_stop < 50) {
    const MachineState state = host.read();
    JointCommand command;
    command.num_joints = machine.num_joints();
    command.rate[machine.arm->coordinates[0] - kNumBaseCoordinates] = 0.1;
    command.valid_until_s = state.t_s + state.age_s + 0.1;
    if (stop) {
      host.stop();
      ++cycles_after_stop;
    }
    result.writes_taken += taken(host.write(command));
    host.wait_until(state.t_s + state.age_s + 0.01);
    ++result.cycles;
  }
  result.stopped_at_the_end = host.write(JointCommand{}) != WriteOutcome::kAccepted;
  host.deactivate();
  return result;
}

TEST(BothEnds, ShareNothingButTheBusAndTheStop) {
  const Result<MachineModel> host_model = load_machine(), machine_model = load_machine();
  ASSERT_TRUE(host_model && machine_model);
  int ends[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends), 0);
  PacketPort host_port(ends[0]), machine_port(ends[1]);
  Shared shared;
  HostResult result;
  static_cast<void>(app::stop_on_signals());  // before any thread may be signalled
  std::thread machine([&] { run_electronics(*machine_model, machine_port, shared); });
  std::thread host([&] { result = run_host(*host_model, host_port, shared); });
  std::thread stopper([&] {
    for (int i = 0; i < 1000 && !shared.driving; ++i) std::this_thread::sleep_for(milliseconds(10));
    std::this_thread::sleep_for(milliseconds(2000));
    kill(getpid(), SIGTERM);
  });
  stopper.join();
  host.join();
  shared.end = true;
  machine.join();
  std::cout << result.cycles << " cycles of the host, " << result.writes_taken
            << " commands taken, " << shared.machine_frames << " frames at the machine, "
            << shared.machine_enabled_periods << " periods enabled, then stopped by a signal\n";
  EXPECT_TRUE(result.opened);
  EXPECT_TRUE(result.activated);
  EXPECT_GT(result.writes_taken, 0);
  EXPECT_GT(shared.machine_enabled_periods, 0);
  EXPECT_TRUE(result.stopped_at_the_end);
}

}  // namespace
}  // namespace wex::can
