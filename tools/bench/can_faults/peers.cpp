#include "tools/bench/can_faults/peers.hpp"

#include <sys/mman.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iostream>
#include <new>
#include <numbers>

#include "hw_interface/electronics/electronics.hpp"
#include "hw_interface/socketcan/can_socket.hpp"
#include "hw_interface/socketcan/socketcan_machine.hpp"
#include "models/terrain/terrain_map.hpp"
#include "tools/bench/can_faults/tap_port.hpp"

namespace wex::can_faults {
namespace {

constexpr std::int64_t kPeriod_ns = 10'000'000;
constexpr std::int64_t kMillisecond_ns = 1'000'000;

int complain(const char* who, const Error& error) {
  std::cerr << who << ": " << error.message << "\n";
  return 1;
}

CommandRecord record_of(const can::CanFrame& frame, std::int64_t now_ns) {
  CommandRecord record;
  record.time_ns = now_ns;
  record.id = frame.id;
  std::memcpy(record.data.data(), frame.data.data(), record.data.size());
  return record;
}

bool is_command(const can::CanFrame& frame) {
  return can::kind_of(frame) == can::MessageKind::kZoneCommand;
}

void sleep_until(std::int64_t time_ns) {
  const timespec when{time_ns / 1'000'000'000, time_ns % 1'000'000'000};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &when, nullptr) != 0) {
  }
}

/// Fastest joint, fastest wheel, place of the bucket.
class Observer {
 public:
  explicit Observer(const MachineModel& machine)
      : machine_(machine),
        workspace_(machine.tree.make_workspace()),
        q_(machine.num_coordinates()) {}

  MachineSample sample(const can::PlantState& state) {
    MachineSample sample;
    const int turn = machine_.arm->coordinates[0] - kNumBaseCoordinates;
    sample.turn_rad_s = static_cast<float>(state.rate[turn]);
    q_.setZero();  // the bucket as seen from the base
    for (int j = 0; j < machine_.num_joints(); ++j) {
      q_[kNumBaseCoordinates + j] = state.position[j];
      const bool is_wheel = machine_.joints[j].role == JointRole::kWheel;
      const auto rate = static_cast<float>(std::abs(state.rate[j]));
      float& fastest = is_wheel ? sample.fastest_wheel_m_s : sample.fastest_joint;
      const float radius = is_wheel ? static_cast<float>(machine_.legs[0].radius_m) : 1.0F;
      fastest = std::max(fastest, rate * radius);
    }
    machine_.tree.update(q_, workspace_);
    const Eigen::Vector3f p =
        machine_.tree.position(workspace_, machine_.arm->contact_body, machine_.arm->p_body_contact)
            .cast<float>();
    sample.p_base_bucket_m = {p.x(), p.y(), p.z()};
    return sample;
  }

 private:
  const MachineModel& machine_;
  KinematicTree::Workspace workspace_;
  Eigen::VectorXd q_;
};

/// Turns the cabin and drives, well within all limits.
JointCommand command_of(const MachineModel& machine, Motion motion, double t_s) {
  constexpr double kTurn_rad_s = 0.2, kWheel_rad_s = 0.5, kSinePeriod_s = 8.0;
  double share = 0.0;
  if (motion == Motion::kSteady) share = 1.0;
  if (motion == Motion::kSine) share = std::sin(2.0 * std::numbers::pi * t_s / kSinePeriod_s);
  JointCommand command;
  command.num_joints = machine.num_joints();
  command.rate[machine.arm->coordinates[0] - kNumBaseCoordinates] = share * kTurn_rad_s;
  for (const WheeledLeg& leg : machine.legs) {
    command.rate[leg.wheel - kNumBaseCoordinates] = share * kWheel_rad_s * leg.wheel_sign;
  }
  command.valid_until_s = t_s + 0.1;
  return command;
}

/// Memory of the process's own; the blackboard is shared and grows as it is written.
long resident_kb() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    long kilobytes = 0;
    if (word == "RssAnon:" && status >> kilobytes) return kilobytes;
  }
  return 0;
}

}  // namespace

SharedBlackboard make_blackboard() {
  void* memory = mmap(nullptr, sizeof(Blackboard), PROT_READ | PROT_WRITE,
                      MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  // The kernel's zeros are the initial state; touching all of it would cost a second.
  return {static_cast<Blackboard*>(memory),
          [](Blackboard* board) { munmap(board, sizeof(Blackboard)); }};
}

Result<Scene> make_scene() {
  auto machine = load_machine();
  if (!machine) return tl::unexpected(machine.error());
  Grid grid;  // 40 x 20 m, flat
  grid.size_x = 401;
  grid.size_y = 201;
  grid.origin_m = {-20.0, -10.0};
  grid.values.assign(static_cast<std::size_t>(grid.size_x) * grid.size_y, 0.0F);
  auto terrain = TerrainMap::build(std::move(grid));
  if (!terrain) return tl::unexpected(terrain.error());
  Eigen::VectorXd q = Eigen::VectorXd::Zero(machine->num_coordinates());
  q.tail(machine->num_joints()) = machine->transport_posture();
  q[2] = machine->default_base_height_m;
  auto plant = SimulatedPlant::create(*machine, *terrain, q);
  if (!plant) return tl::unexpected(plant.error());
  if (const auto settled = (*plant)->settle(); !settled) return tl::unexpected(settled.error());
  return Scene{std::move(*machine), std::move(*plant)};
}

int run_machine(Scene& scene, const std::string& interface_name, Blackboard& board) {
  auto socket = can::CanSocket::open(interface_name);
  if (!socket) return complain("machine", socket.error());
  TapPort port(*socket);
  can::SystemRandom random;
  auto created = can::Electronics::create(scene.machine, *scene.plant, port, random);
  if (!created) return complain("machine", created.error());
  can::Electronics& electronics = **created;
  can::SystemClock clock;

  // What became of a command shows in the counters when the next frame is asked for.
  CommandRecord pending;
  long good_before = 0, in_force_before = 0;
  std::int64_t commanded_ns = 0;
  port.before_receive = [&] {
    if (pending.time_ns == 0) return;
    const long good =
        electronics.counters().commands_accepted + electronics.counters().commands_bumpless;
    pending.accepted = good > good_before;
    good_before = good;
    if (electronics.counters().commands_accepted > in_force_before) commanded_ns = pending.time_ns;
    in_force_before = electronics.counters().commands_accepted;
    board.received.append(pending);
    pending.time_ns = 0;
  };
  port.on_received = [&](const can::CanFrame& frame) {
    if (is_command(frame)) pending = record_of(frame, clock.now_ns());
  };
  port.on_send = [&](const can::CanFrame& frame) {
    const int muted = board.muted_zone;
    return muted == 0 || can::kind_of(frame) != can::MessageKind::kZoneFeedback ||
           can::zone_of(frame) != muted - 1;
  };
  port.on_sent = [&](const can::CanFrame& frame) {
    can::ZoneFeedback feedback;
    if (can::kind_of(frame) == can::MessageKind::kZoneFeedback && can::zone_of(frame) == 4 &&
        can::decode(frame, 0, feedback)) {
      const std::int64_t now_ms = clock.now_ns() / kMillisecond_ns;  // the stamp has 32 bits of it
      const auto age_ms = static_cast<std::uint32_t>(now_ms) - feedback.sample_time_ms;
      board.last_arm_sample_ns = (now_ms - age_ms) * kMillisecond_ns;
    }
    can::EStopState estop;
    if (can::kind_of(frame) == can::MessageKind::kEStopState && can::decode(frame, 0, estop) &&
        estop.chain_open && board.estop_reported_ns == 0) {
      board.estop_reported_ns = clock.now_ns();
    }
  };

  Observer observer(scene.machine);
  std::int64_t next_ns = clock.now_ns();
  std::int64_t reopen_ns = 0;
  while (!board.end_machine) {
    next_ns = std::max(next_ns + kPeriod_ns, clock.now_ns());
    for (std::int64_t now_ns = clock.now_ns(); now_ns < next_ns; now_ns = clock.now_ns()) {
      const can::SocketStatus status = electronics.receive_status();
      if (status == can::SocketStatus::kInterfaceDown || status == can::SocketStatus::kGone) {
        if (now_ns > reopen_ns) port.reopen();
        if (now_ns > reopen_ns) reopen_ns = now_ns + 10 * kPeriod_ns;
        sleep_until(next_ns);
      } else {
        port.wait_readable(1e-9 * static_cast<double>(next_ns - now_ns));
      }
      electronics.receive(clock.now_ns() / kMillisecond_ns);
    }
    const std::int64_t open_ns = board.estop_open_from_ns;
    electronics.set_estop_chain(open_ns != 0 && clock.now_ns() >= open_ns);
    electronics.tick(clock.now_ns() / kMillisecond_ns);
    MachineSample sample = observer.sample(electronics.plant_state());
    sample.time_ns = clock.now_ns();
    sample.commanded_ns = commanded_ns;
    sample.mode = electronics.automaton().mode();
    board.machine.append(sample);
    if (board.machine.size() % 100 == 0) board.machine_resident_kb = resident_kb();
    board.machine_runs = true;
  }
  return 0;
}

int run_host(const Scene& scene, const std::string& interface_name, const HostOptions& options,
             Blackboard& board) {
  auto socket = can::CanSocket::open(interface_name);
  if (!socket) return complain("host", socket.error());
  can::SystemClock clock;
  TapPort tap(*socket);
  tap.on_sent = [&](const can::CanFrame& frame) {
    if (is_command(frame)) board.sent.append(record_of(frame, clock.now_ns()));
  };
  can::FramePort* port = &tap;
  std::optional<can::CanSocket> errors;
  std::optional<ControllerPort> controller;
  if (!options.error_interface.empty()) {
    auto opened = can::CanSocket::open(options.error_interface);
    if (!opened) return complain("host", opened.error());
    errors.emplace(std::move(*opened));
    port = &controller.emplace(tap, *errors);
  }
  can::SocketCanSettings settings;
  settings.pace = can::SocketCanSettings::Pace::kRealTime;
  settings.host.link.purge_by_link_flap = options.purge;
  auto opened = can::SocketCanMachine::open_on(*port, clock, scene.machine, {0.0, 0.0}, settings);
  if (!opened) return complain("host", opened.error());
  can::SocketCanMachine& machine = **opened;
  const int turn = scene.machine.arm->coordinates[0] - kNumBaseCoordinates;
  board.host_connected = true;

  while (!board.end_host) {
    if (board.activations_done < board.activations) {
      if (const auto activated = machine.activate(); !activated) {
        std::cerr << "host: " << activated.error().message << "\n";
      }
      ++board.activations_done;
    }
    const std::int64_t begin_ns = clock.now_ns();
    const MachineState state = machine.read();
    const double now_s = state.t_s + state.age_s;
    if (machine.lifecycle() == Lifecycle::kActive) {
      machine.write(command_of(scene.machine, board.motion, now_s));
    }
    const std::int64_t written_ns = clock.now_ns();
    machine.wait_until(now_s + 1e-9 * static_cast<double>(kPeriod_ns));
    HostSample sample;
    sample.time_ns = begin_ns;
    sample.busy_us = static_cast<std::int32_t>((written_ns - begin_ns) / 1000);
    sample.lifecycle = machine.lifecycle();
    sample.phase = static_cast<std::uint8_t>(machine.phase());
    sample.cause = static_cast<std::uint8_t>(machine.cause());
    sample.holding = machine.health().level != HealthLevel::kOk;
    sample.turn_stale = state.joint_quality[turn] != SignalQuality::kOk;
    sample.feedback_age_s = static_cast<float>(state.age_s);
    board.host.append(sample);
    board.statistics = machine.statistics();
    if (board.host.size() % 100 == 0) board.host_resident_kb = resident_kb();
  }
  machine.deactivate();
  return 0;
}

}  // namespace wex::can_faults
