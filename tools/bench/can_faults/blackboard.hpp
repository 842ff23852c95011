#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>

#include "hw_interface/machine_io.hpp"
#include "hw_interface/socketcan/bus_statistics.hpp"
#include "hw_interface/socketcan/can_frame.hpp"
#include "hw_interface/socketcan/messages.hpp"

// What the processes of a fault scenario share: the driver's wishes, and what each saw. It lies in
// shared memory, so it outlasts a process that is killed. Times are of CLOCK_MONOTONIC.

namespace wex::can_faults {

/// Record of one process that others read: appended to, never changed. All zero is an empty one.
template <typename Record, std::size_t kCapacity>
class Trace {
 public:
  void append(const Record& record) noexcept {
    const std::size_t n = size_.load(std::memory_order_relaxed);
    if (n == kCapacity) return;
    records_[n] = record;
    size_.store(n + 1, std::memory_order_release);
  }
  [[nodiscard]] std::size_t size() const noexcept { return size_.load(std::memory_order_acquire); }
  [[nodiscard]] bool full() const noexcept { return size() == kCapacity; }
  [[nodiscard]] const Record& operator[](std::size_t i) const noexcept { return records_[i]; }
  [[nodiscard]] const Record* begin() const noexcept { return records_.data(); }
  [[nodiscard]] const Record* end() const noexcept { return records_.data() + size(); }

 private:
  std::atomic<std::size_t> size_;
  std::array<Record, kCapacity> records_;
};

/// The machine after one period of 10 ms.
struct MachineSample {
  std::int64_t time_ns = 0;
  std::int64_t commanded_ns = 0;  ///< when the last ZoneCommand was put in force
  can::MachineMode mode = {};
  float turn_rad_s = 0.0F;         ///< of the joint that is driven, with its sign
  float fastest_joint = 0.0F;      ///< rad/s or m/s, all joints but the wheels
  float fastest_wheel_m_s = 0.0F;  ///< at the circumference
  std::array<float, 3> p_base_bucket_m{};
};

/// The host after one cycle.
struct HostSample {
  std::int64_t time_ns = 0;
  std::int32_t busy_us = 0;  ///< read, decide, write, send
  Lifecycle lifecycle = {};
  std::uint8_t phase = 0, cause = 0;
  bool holding = false, turn_stale = false;
  float feedback_age_s = 0.0F;  ///< of the state read
};

/// A ZoneCommand as it left the host or reached the machine.
struct CommandRecord {
  std::int64_t time_ns = 0;
  std::uint32_t id = 0;
  bool accepted = false;  ///< the electronics put it in force or counted it as good
  std::array<std::uint8_t, 24> data{};
};

enum class Motion : int { kNone = 0, kSteady = 1, kSine = 2 };

struct Blackboard {
  // Wishes of the driver.
  std::atomic<bool> end_host, end_machine;
  std::atomic<std::int64_t> estop_open_from_ns;  ///< the hardwired chain; 0: closed
  std::atomic<int> activations;  ///< the host activates once for every increment, never by itself
  std::atomic<Motion> motion;
  std::atomic<int> muted_zone;  ///< 1 + the zone whose feedback is lost on the way; 0: none
  std::atomic<std::int64_t> last_arm_sample_ns;  ///< the last one of zone 4 that was sent

  // What the others say.
  std::atomic<bool> host_connected, machine_runs;
  std::atomic<int> activations_done;
  std::atomic<std::int64_t> estop_reported_ns;  ///< first report of an open chain; 0: none
  can::BusStatistics statistics;                ///< the host's, of its last cycle
  std::atomic<long> host_resident_kb, machine_resident_kb;
  Trace<MachineSample, 250'000> machine;  ///< 40 minutes
  Trace<HostSample, 250'000> host;
  Trace<CommandRecord, 100'000> sent, received;  ///< the first 160 s
};

/// Shared with all processes that are forked from here on.
using SharedBlackboard = std::unique_ptr<Blackboard, void (*)(Blackboard*)>;
[[nodiscard]] SharedBlackboard make_blackboard();

}  // namespace wex::can_faults
