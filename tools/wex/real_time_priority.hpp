#pragma once

namespace wex::app {

/// Real-time priorities, below the kernel's interrupt threads (50). Where a simulated machine
/// shares a core with the host it goes after the control loop: when a step of its contacts takes
/// long, it must not keep back the commands for which its own time-out runs.
inline constexpr int kControlPriority = 41, kSimulationPriority = 40;

/// While it lives, this thread goes before all that have no deadline (SCHED_FIFO): the control loop
/// must serve the bus every 10 ms, whatever the optimizer's thread does. Threads started meanwhile
/// do not inherit it. Needs CAP_SYS_NICE or an rtprio limit; without them nothing changes.
class RealTimePriority {
 public:
  explicit RealTimePriority(int priority = kControlPriority) noexcept;
  RealTimePriority(const RealTimePriority&) = delete;
  RealTimePriority& operator=(const RealTimePriority&) = delete;
  ~RealTimePriority();
  [[nodiscard]] bool granted() const noexcept { return granted_; }

 private:
  int policy_ = 0;  ///< as before
  bool granted_ = false;
};

}  // namespace wex::app
