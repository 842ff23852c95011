#include "tools/bench/can_faults/rig.hpp"

#include <signal.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cstdlib>
#include <stdexcept>

#include "hw_interface/socketcan/can_socket.hpp"
#include "hw_interface/socketcan/codec.hpp"

namespace wex::can_faults {
namespace {

template <typename Body>
pid_t start(Body body) {
  const pid_t pid = fork();
  if (pid < 0) throw std::runtime_error("no process could be started");
  if (pid == 0) {
    int code = 1;
    try {
      code = body();
    } catch (const std::exception&) {
      code = 1;  // the driver sees that it ended
    }
    _exit(code);
  }
  return pid;
}

void reap(pid_t& pid) {
  if (pid > 0) waitpid(pid, nullptr, 0);
  pid = -1;
}

/// Gives it half a second to end by itself.
void end(pid_t& pid) {
  if (pid > 0 && !wait_for(0.5, [&] { return waitpid(pid, nullptr, WNOHANG) == pid; })) {
    kill(pid, SIGKILL);
    waitpid(pid, nullptr, 0);
  }
  pid = -1;
}

}  // namespace

void shell(const std::string& command_line) {
  if (std::system(command_line.c_str()) != 0) {
    throw std::runtime_error("'" + command_line + "' failed");
  }
}

std::int64_t now_ns() {
  can::SystemClock clock;
  return clock.now_ns();
}

void sleep_s(double duration_s) {
  const auto duration_ns = static_cast<long>(1e9 * duration_s);
  timespec left{duration_ns / 1'000'000'000, duration_ns % 1'000'000'000};
  while (nanosleep(&left, &left) != 0) {
  }
}

bool wait_for(double patience_s, const std::function<bool()>& condition) {
  const std::int64_t end_ns = now_ns() + static_cast<std::int64_t>(1e9 * patience_s);
  while (!condition()) {
    if (now_ns() > end_ns) return false;
    sleep_s(0.004);
  }
  return true;
}

void make_bus() {
  shell(
      "ip link del vxcan0 2>/dev/null; ip link add dev vxcan0 type vxcan peer name vxcan1 && "
      "for i in vxcan0 vxcan1; do ip link set $i mtu 72 txqueuelen 1000 up || exit 1; done");
}

Rig::Rig(Scene& scene, const HostOptions& options)
    : scene_(scene), options_(options), board_(make_blackboard()) {
  make_bus();
  machine_ = start([&] { return run_machine(scene_, "vxcan1", *board_); });
  if (!wait_for(5.0, [&] { return board_->machine_runs.load(); })) {
    throw std::runtime_error("the machine does not start");
  }
  start_host();
}

Rig::~Rig() {
  board_->end_host = board_->end_machine = true;
  if (host_ > 0) kill(host_, SIGCONT);
  if (machine_ > 0) kill(machine_, SIGCONT);
  end(host_);
  end(machine_);
}

void Rig::start_host() {
  board_->end_host = board_->host_connected = false;
  host_ = start([&] { return run_host(scene_, "vxcan0", options_, *board_); });
  if (!wait_for(8.0, [&] { return board_->host_connected.load(); })) {
    throw std::runtime_error("the host does not hear the machine");
  }
}

void Rig::end_host() {
  board_->end_host = true;
  end(host_);
}

void Rig::kill_machine() {
  kill(machine_, SIGKILL);
  reap(machine_);
}

void Rig::signal_host(int signal) {
  kill(host_, signal);
  if (signal == SIGKILL) reap(host_);
}

void Rig::signal_machine(int signal) { kill(machine_, signal); }

can::MachineMode Rig::mode() const {
  const std::size_t n = board_->machine.size();
  return n == 0 ? can::MachineMode::kInit : board_->machine[n - 1].mode;
}

Lifecycle Rig::lifecycle() const {
  const std::size_t n = board_->host.size();
  return n == 0 ? Lifecycle::kUnconfigured : board_->host[n - 1].lifecycle;
}

void Rig::enable() {
  // A process that is late by 100 ms ends a handshake, as it should: then it is asked for again.
  constexpr int kAttempts = 3;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (attempt > 0) ++enabled_again_;
    ++board_->activations;
    if (wait_for(6.0, [&] {
          return mode() == can::MachineMode::kEnabled && lifecycle() == Lifecycle::kActive;
        })) {
      return;
    }
  }
  throw std::runtime_error("the machine is not enabled: mode " +
                           std::to_string(static_cast<int>(mode())));
}

void Rig::drive(Motion motion) {
  enable();
  board_->motion = motion;
  sleep_s(1.5);
  if (motion == Motion::kSteady) wait_for_motion();
}

double Rig::wait_for_motion() {
  constexpr float kUnderWay = 0.05F;
  const auto speed = [&] { return board_->machine[board_->machine.size() - 1].fastest_joint; };
  static_cast<void>(
      wait_for(10.0, [&] { return mode() == can::MachineMode::kEnabled && speed() > kUnderWay; }));
  return speed();
}

void Rig::operator_does(can::OperatorAction action) {
  auto socket = can::CanSocket::open("vxcan0");
  if (!socket) throw std::runtime_error(socket.error().message);
  can::SendContext context;
  // A terminal may begin its counter anywhere; this one never repeats itself.
  static std::uint8_t counter = 0;
  context.counter = counter++;
  can::CanFrame frame;
  if (!can::encode(can::OperatorCommand{action}, context, frame)) {
    throw std::runtime_error("an operator's frame cannot be encoded");
  }
  if (socket->send(frame) != can::SocketStatus::kOk) {
    throw std::runtime_error("an operator's frame is not taken");
  }
}

void Rig::operator_reset() {
  operator_does(can::OperatorAction::kNone);
  sleep_s(0.02);
  operator_does(can::OperatorAction::kReset);
  sleep_s(0.02);
  operator_does(can::OperatorAction::kNone);
}

}  // namespace wex::can_faults
