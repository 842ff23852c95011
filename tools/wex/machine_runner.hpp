#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>

#include "hw_interface/electronics/electronics.hpp"
#include "hw_interface/socketcan/frame_port.hpp"

namespace wex::app {

/// Wall time of the machine's process, or a test's.
class Pacer {
 public:
  virtual ~Pacer() = default;
  [[nodiscard]] virtual std::int64_t now_ns() noexcept = 0;
  virtual void sleep_until(std::int64_t time_ns) noexcept = 0;
};

/// CLOCK_MONOTONIC with absolute sleeps; a signal ends a sleep early.
class SystemPacer final : public Pacer {
 public:
  [[nodiscard]] std::int64_t now_ns() noexcept override;
  void sleep_until(std::int64_t time_ns) noexcept override;
};

struct MachineRunnerSettings {
  bool lock_step = false;
  std::optional<double> estop_after_s = std::nullopt,
                        exit_after_s = std::nullopt;  ///< machine time
  // Wall time without LockStep until the clock runs by itself. Within a session the host may be
  // busy with a long solve on a loaded computer, or dead: only time tells.
  double free_run_after_s = 1.0, free_run_in_session_after_s = 10.0;
  double forget_after_s = 0.1;    ///< later than that, periods are left out, not caught up
  double max_lock_step_s = 10.0;  ///< what one LockStep frame may ask for
  double reopen_after_s = 0.1;    ///< a lost interface; doubled with every failure
  double max_reopen_after_s = 2.0;
};

/// Runs a machine's electronics at 100 Hz until it is stopped: in real time, or as LockStep frames
/// let its clock go on; when they stay away the clock runs by itself, so that time-outs bite.
class MachineRunner {
 public:
  /// All must live longer. on_tick: after every period, with machine time in ms.
  MachineRunner(can::Electronics& electronics, can::FramePort& port, Pacer& pacer,
                const MachineRunnerSettings& settings,
                std::function<void(std::int64_t now_ms)> on_tick);

  /// Returns when `stop` is set or exit_after_s is over.
  void run(const std::atomic<bool>& stop);
  [[nodiscard]] std::int64_t now_ms() const noexcept { return now_ms_; }

 private:
  static constexpr std::int64_t kPeriod_ms = 10;

  void tick_until(std::int64_t until_ms);
  void tick_real_time();
  void wait_for_lock_step();
  void keep_port_open();
  [[nodiscard]] bool over() const noexcept;
  [[nodiscard]] std::int64_t patience_ns() const noexcept;

  can::Electronics* electronics_;
  can::FramePort* port_;
  Pacer* pacer_;
  MachineRunnerSettings settings_;
  std::function<void(std::int64_t)> on_tick_;
  std::int64_t now_ms_ = 0;
  std::int64_t next_tick_ns_ = 0;
  bool free_running_ = true;  ///< lock step: until a LockStep is heard, and when they stay away
  std::int64_t lock_step_heard_ns_ = 0;
  std::int64_t reopen_at_ns_ = 0;
  double backoff_s_ = 0.0;
};

}  // namespace wex::app
