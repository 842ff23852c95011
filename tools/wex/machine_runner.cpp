#include "tools/wex/machine_runner.hpp"

#include <time.h>

#include <algorithm>

namespace wex::app {
namespace {

constexpr std::int64_t kNanosecondsPerMs = 1'000'000;
constexpr std::int64_t kPauseWhileGone_ns = 5'000'000;
constexpr double kLongestWait_s = 0.02;  ///< for LockStep: a stop signal is noticed that soon

std::int64_t nanoseconds(double duration_s) { return static_cast<std::int64_t>(1e9 * duration_s); }

}  // namespace

std::int64_t SystemPacer::now_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

void SystemPacer::sleep_until(std::int64_t time_ns) noexcept {
  const timespec until{static_cast<time_t>(time_ns / 1'000'000'000), time_ns % 1'000'000'000};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
}

MachineRunner::MachineRunner(can::Electronics& electronics, can::FramePort& port, Pacer& pacer,
                             const MachineRunnerSettings& settings,
                             std::function<void(std::int64_t)> on_tick)
    : electronics_(&electronics),
      port_(&port),
      pacer_(&pacer),
      settings_(settings),
      on_tick_(std::move(on_tick)),
      backoff_s_(settings.reopen_after_s) {}

bool MachineRunner::over() const noexcept {
  return settings_.exit_after_s && static_cast<double>(now_ms_) >= 1e3 * *settings_.exit_after_s;
}

void MachineRunner::tick_until(std::int64_t until_ms) {
  while (now_ms_ < until_ms && !over()) {
    now_ms_ += kPeriod_ms;
    if (settings_.estop_after_s && static_cast<double>(now_ms_) >= 1e3 * *settings_.estop_after_s) {
      electronics_->set_estop_chain(true);
    }
    electronics_->tick(now_ms_);
    on_tick_(now_ms_);
  }
}

void MachineRunner::tick_real_time() {
  pacer_->sleep_until(next_tick_ns_);
  const std::int64_t now_ns = pacer_->now_ns();
  if (now_ns < next_tick_ns_) return;  // woken by a signal
  const std::int64_t late_ns = now_ns - next_tick_ns_;
  if (late_ns > nanoseconds(settings_.forget_after_s)) {
    // The process was stopped or starved: the clock goes on as it should, the periods are lost.
    const std::int64_t lost = late_ns / (kPeriod_ms * kNanosecondsPerMs);
    now_ms_ += lost * kPeriod_ms;
    next_tick_ns_ += lost * kPeriod_ms * kNanosecondsPerMs;
  }
  next_tick_ns_ += kPeriod_ms * kNanosecondsPerMs;
  tick_until(now_ms_ + kPeriod_ms);
}

std::int64_t MachineRunner::patience_ns() const noexcept {
  const bool in_session = electronics_->automaton().session() != 0;
  return nanoseconds(in_session ? settings_.free_run_in_session_after_s
                                : settings_.free_run_after_s);
}

void MachineRunner::wait_for_lock_step() {
  electronics_->receive(now_ms_);
  if (const auto until = electronics_->take_lock_step()) {
    free_running_ = false;
    lock_step_heard_ns_ = pacer_->now_ns();
    // 32 bits of milliseconds wrap; their difference does not.
    const auto ahead_ms = static_cast<std::int32_t>(*until - static_cast<std::uint32_t>(now_ms_));
    const auto most_ms = static_cast<std::int32_t>(1e3 * settings_.max_lock_step_s);
    tick_until(now_ms_ + std::min(ahead_ms, most_ms));
    return;
  }
  const std::int64_t now_ns = pacer_->now_ns();
  double wait_s = kLongestWait_s;
  if (!free_running_ && now_ns - lock_step_heard_ns_ >= patience_ns()) {
    free_running_ = true;
    next_tick_ns_ = now_ns;
  }
  if (free_running_) {
    if (now_ns >= next_tick_ns_) {
      tick_real_time();
      return;
    }
    wait_s = std::min(wait_s, 1e-9 * static_cast<double>(next_tick_ns_ - now_ns));
  }
  port_->wait_readable(wait_s);
}

void MachineRunner::keep_port_open() {
  const bool gone = electronics_->receive_status() == can::SocketStatus::kGone ||
                    electronics_->publisher().port_status() == can::SocketStatus::kGone;
  if (!gone) {
    backoff_s_ = settings_.reopen_after_s;
    return;
  }
  const std::int64_t now_ns = pacer_->now_ns();
  if (now_ns < reopen_at_ns_) {
    // Waiting at a port that is gone returns at once.
    if (settings_.lock_step) pacer_->sleep_until(now_ns + kPauseWhileGone_ns);
    return;
  }
  reopen_at_ns_ = now_ns + nanoseconds(backoff_s_);
  backoff_s_ = std::min(2.0 * backoff_s_, settings_.max_reopen_after_s);
  port_->reopen();
}

void MachineRunner::run(const std::atomic<bool>& stop) {
  // In lock step, too, the clock first runs by itself: a host must be able to hear the machine.
  next_tick_ns_ = pacer_->now_ns() + kPeriod_ms * kNanosecondsPerMs;
  free_running_ = true;
  while (!stop && !over()) {
    if (settings_.lock_step) {
      wait_for_lock_step();
    } else {
      tick_real_time();
    }
    keep_port_open();
  }
}

}  // namespace wex::app
