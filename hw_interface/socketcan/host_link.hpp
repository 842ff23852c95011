#pragma once

#include <array>
#include <cstdint>

#include "hw_interface/socketcan/bus_statistics.hpp"
#include "hw_interface/socketcan/frame_port.hpp"
#include "hw_interface/socketcan/frame_recorder.hpp"
#include "hw_interface/socketcan/host_feedback.hpp"
#include "hw_interface/socketcan/host_mailbox.hpp"

namespace wex::can {

struct LinkSettings {
  int stalled_after_cycles = 3;  ///< cycles in a row whose frames were not all taken
  double reopen_after_s = 0.1;   ///< doubled with every failure
  double max_reopen_after_s = 2.0;
  double purge_every_s = 1.0;      ///< supervised restart: no more often
  int max_purges = 5;              ///< until the bus is well again
  bool purge_by_link_flap = true;  ///< needs CAP_NET_ADMIN; without it nothing happens
  double error_memory_s = 1.0;     ///< how long an error frame counts
  double overflow_window_s = 1.0;  ///< two losses within it make the machine hold
  RecorderSettings recorder;
};

/// The host's end of the wire: sends the mailbox, takes what comes, keeps the port alive, counts,
/// records. Knows nothing of modes. All times are of the monotonic clock. Control-rate calls are
/// noexcept and allocation-free.
class HostLink {
 public:
  /// The port must live longer.
  HostLink(FramePort& port, const LinkSettings& settings);

  /// Takes a batch of frames off the port; true: there may be more.
  bool collect() noexcept;
  /// Uses what was collected. The clock is read after collecting: a frame dated before it came
  /// would make the machine's clock seem ahead, and all its feedback old for minutes.
  void receive(HostFeedback& feedback, std::int64_t now_ns) noexcept;
  /// Sends what is in the mailbox; what is not taken waits for a newer value or the next call.
  void send(std::int64_t now_ns) noexcept;
  /// Ends a cycle of 10 ms: counts stalls, purges, reopens.
  void end_cycle(std::int64_t now_ns) noexcept;
  void wait(double timeout_s) noexcept { port_->wait_readable(timeout_s); }

  [[nodiscard]] HostMailbox& mailbox() noexcept { return mailbox_; }
  [[nodiscard]] bool stalled() const noexcept {
    return blocked_cycles_ >= settings_.stalled_after_cycles;
  }
  /// The interface went down or away since the last call.
  [[nodiscard]] bool take_lost() noexcept;
  [[nodiscard]] bool bus_off_reported(std::int64_t now_ns) const noexcept;
  [[nodiscard]] bool overflowed(std::int64_t now_ns) const noexcept;
  /// Errors or losses within the last second.
  [[nodiscard]] bool degraded(std::int64_t now_ns) const noexcept;
  /// Nothing is sent while the machine must not hear from us, or a restart is to be tried.
  void restart_controller(std::int64_t now_ns) noexcept { try_purge(now_ns); }

  [[nodiscard]] const BusStatistics& statistics() const noexcept { return statistics_; }
  [[nodiscard]] BusStatistics& statistics() noexcept { return statistics_; }
  [[nodiscard]] FrameRecorder& recorder() noexcept { return recorder_; }
  [[nodiscard]] const FrameRecorder& recorder() const noexcept { return recorder_; }

 private:
  static constexpr std::int64_t kNever_ns = -1'000'000'000'000'000;
  static constexpr std::size_t kBatch = 64;

  void on_received(const CanFrame& frame, HostFeedback& feedback, std::int64_t now_ns) noexcept;
  void on_status(const HostFeedback& feedback, int zone, std::int64_t now_ns) noexcept;
  void on_error_frame(const CanFrame& frame, std::int64_t now_ns) noexcept;
  void on_lost(std::int64_t now_ns) noexcept;
  void on_bus_time(const CanFrame& frame, std::int64_t now_ns) noexcept;
  void on_sent(int slot, const CanFrame& frame, std::int64_t now_ns) noexcept;
  void try_purge(std::int64_t now_ns) noexcept;
  [[nodiscard]] std::int64_t realtime_ns(std::int64_t now_ns) const noexcept;

  FramePort* port_;
  LinkSettings settings_;
  HostMailbox mailbox_;
  BusStatistics statistics_;
  FrameRecorder recorder_;
  std::int64_t realtime_offset_ns_ = 0;  ///< taken once: logs do not jump with the wall clock

  std::array<CanFrame, kBatch> batch_{};
  std::size_t collected_ = 0;
  SocketStatus collect_status_ = SocketStatus::kWouldBlock;

  bool usable_ = true, lost_ = false, lost_event_ = false, blocked_ = false;
  int blocked_cycles_ = 0, purges_in_a_row_ = 0;
  std::int64_t reopen_at_ns_ = 0, purged_ns_ = kNever_ns;
  double backoff_s_ = 0.0;
  std::int64_t bus_off_ns_ = kNever_ns, trouble_ns_ = kNever_ns, ill_ns_ = kNever_ns;
  std::uint32_t dropped_ = 0;
  std::int64_t overflow_ns_ = kNever_ns, overflow_before_ns_ = kNever_ns;

  std::int64_t first_ns_ = 0, second_begin_ns_ = 0;
  bool first_ = true;
  double busy_this_second_s_ = 0.0;
  std::array<std::array<std::int64_t, 256>, kNumZones> sent_ns_{};  ///< by counter
  std::array<int, kNumZones> last_reported_{};
};

}  // namespace wex::can
