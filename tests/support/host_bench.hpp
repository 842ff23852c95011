#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "hw_interface/electronics/electronics.hpp"
#include "hw_interface/fault_injection/faulty_port.hpp"
#include "hw_interface/socketcan/frame_pipe.hpp"
#include "hw_interface/socketcan/socketcan_machine.hpp"
#include "models/excavator/machine_model.hpp"
#include "tests/support/fake_plant.hpp"

namespace wex::can {

/// A clock that goes on when a test says so.
class ManualClock final : public MonotonicClock {
 public:
  std::int64_t now_ns() noexcept override { return time_ns; }
  std::int64_t time_ns = 1'000'000'000'000;  ///< no relation to the machine's clock
};

/// Electronics with a plant at the far end of a pipe; the wall clock goes on while the host waits.
/// Real time: a period every 10 ms of wall time. Lock step: as far as the host lets it run; free
/// again after a second without a word, as the simulated machine does.
class FarEnd {
 public:
  FarEnd(const MachineModel& machine, Plant& plant, FramePipe& pipe, ManualClock& clock,
         bool lock_step, std::uint64_t seed, const Eigen::Vector2d& map_origin_m = {0.0, 0.0})
      : pipe_(pipe), clock_(clock), random_(seed), lock_step_(lock_step) {
    ElectronicsSettings settings;
    settings.lock_step = lock_step;
    settings.map_origin_m = map_origin_m;
    electronics_ = Electronics::create(machine, plant, pipe.machine(), random_, settings).value();
    last_word_ns_ = clock.time_ns;
    next_tick_ns_ = clock.time_ns;
    pipe.host().on_wait = [this](double timeout_s) { live(timeout_s); };
  }

  Electronics& electronics() { return *electronics_; }
  std::int64_t now_ms() const { return now_ms_; }
  MachineMode mode() const { return electronics_->automaton().mode(); }
  /// Nothing is received, nothing is sent: switched off or stopped by a debugger.
  void set_frozen(bool frozen) { frozen_ = frozen; }
  /// A frame from somebody else on the bus, heard by both ends.
  void inject(const CanFrame& frame) {
    pipe_.machine().send(frame);
    pipe_.host().send(frame);
  }
  std::function<void()> on_tick;  ///< after every period of the machine

 private:
  static constexpr std::int64_t kPeriod_ms = 10, kPeriod_ns = 10'000'000;
  static constexpr std::int64_t kSilence_ns = 1'000'000'000;
  static constexpr std::int64_t kAnswer_ns = 200'000;  ///< wall time that a period takes

  void tick() {
    now_ms_ += kPeriod_ms;
    electronics_->tick(now_ms_);
    if (on_tick) on_tick();
  }

  void live(double timeout_s) {
    const auto wait_ns = static_cast<std::int64_t>(1e9 * timeout_s);
    if (frozen_) {
      clock_.time_ns += std::max<std::int64_t>(wait_ns, 1);
      return;
    }
    if (lock_step_) {
      electronics_->receive(now_ms_);
      if (const auto until = electronics_->take_lock_step()) {
        last_word_ns_ = clock_.time_ns;
        while (static_cast<std::int32_t>(*until - static_cast<std::uint32_t>(now_ms_)) >= 10) {
          tick();
          clock_.time_ns += kAnswer_ns;
        }
        next_tick_ns_ = clock_.time_ns;
        return;
      }
      if (clock_.time_ns - last_word_ns_ < kSilence_ns) {
        clock_.time_ns += std::max<std::int64_t>(wait_ns, 1);
        next_tick_ns_ = clock_.time_ns;
        return;
      }
    }
    const std::int64_t end_ns = clock_.time_ns + std::max<std::int64_t>(wait_ns, 1);
    if (next_tick_ns_ > end_ns) {
      clock_.time_ns = end_ns;
      return;
    }
    clock_.time_ns = std::max(clock_.time_ns, next_tick_ns_);
    next_tick_ns_ = clock_.time_ns + kPeriod_ns;
    tick();
  }

  FramePipe& pipe_;
  ManualClock& clock_;
  SeededRandom random_;
  std::unique_ptr<Electronics> electronics_;
  bool lock_step_ = false, frozen_ = false;
  std::int64_t now_ms_ = 5000, last_word_ns_ = 0, next_tick_ns_ = 0;
};

inline const MachineModel& bench_machine() {
  static const MachineModel machine = load_machine().value();
  return machine;
}

/// Host and machine in one process, with a port between them that can do harm.
class HostBench {
 public:
  explicit HostBench(bool lock_step = true, std::uint64_t seed = 1,
                     const SocketCanSettings& settings = {})
      : plant(bench_machine()),
        far(bench_machine(), plant, pipe, clock, lock_step, seed),
        port(pipe.host(), clock, seed),
        settings_(settings) {}

  /// Opens only.
  void connect() {
    auto opened = SocketCanMachine::open_on(port, clock, bench_machine(), {0.0, 0.0}, settings_);
    ASSERT_TRUE(opened) << opened.error().message;
    host = std::move(*opened);
  }
  void activate() {
    connect();
    const auto activated = host->activate();
    ASSERT_TRUE(activated) << activated.error().message;
    ASSERT_EQ(far.mode(), MachineMode::kEnabled);
  }
  void wait(double duration_s) {
    const MachineState state = host->read();
    host->wait_until(state.t_s + state.age_s + duration_s);
  }

  int wheel(int leg) const { return bench_machine().legs[leg].wheel - kNumBaseCoordinates; }
  JointCommand drive_command(double wheel_rate_rad_s, double valid_s = 100.0) {
    JointCommand command;
    command.num_joints = bench_machine().num_joints();
    const MachineState state = host->read();
    command.valid_until_s = state.t_s + state.age_s + valid_s;
    for (int leg = 0; leg < kNumWheels; ++leg) {
      command.rate[wheel(leg)] = bench_machine().legs[leg].wheel_sign * wheel_rate_rad_s;
    }
    return command;
  }
  /// Driving at 0.8 rad/s.
  void drive() {
    activate();
    ASSERT_EQ(host->write(drive_command(0.8)), WriteOutcome::kAccepted);
    wait(1.5);
    ASSERT_GT(plant.fastest_rate(), 0.5);
  }
  /// Machine time until everything stands, at most patience_s; negative if it does not.
  double time_to_stand(double patience_s) {
    const std::int64_t begin_ms = far.now_ms();
    while (plant.fastest_rate() > 0.02) {
      if (1e-3 * static_cast<double>(far.now_ms() - begin_ms) > patience_s) return -1.0;
      wait_one();
    }
    return 1e-3 * static_cast<double>(far.now_ms() - begin_ms);
  }
  /// One period of whatever clock the host has.
  void wait_one() { wait(0.01); }
  void operator_does(OperatorAction action) {
    CanFrame frame;
    ASSERT_TRUE(encode(OperatorCommand{action}, operator_context, frame));
    far.inject(frame);
    wait_one();
  }
  void operator_resets() {
    operator_does(OperatorAction::kNone);
    operator_does(OperatorAction::kReset);
  }

  ManualClock clock;
  FramePipe pipe;
  FakePlant plant;
  FarEnd far;
  FaultyPort port;
  SendContext operator_context;
  std::unique_ptr<SocketCanMachine> host;

 private:
  SocketCanSettings settings_;
};

}  // namespace wex::can
