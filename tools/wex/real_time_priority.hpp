#pragma once

namespace wex::app {

/// While it lives, this thread goes before all that have no deadline (SCHED_FIFO): the control loop
/// must serve the bus every 10 ms, whatever the optimizer's thread does. Threads started meanwhile
/// do not inherit it. Needs CAP_SYS_NICE or an rtprio limit; without them nothing changes.
class RealTimePriority {
 public:
  RealTimePriority() noexcept;
  RealTimePriority(const RealTimePriority&) = delete;
  RealTimePriority& operator=(const RealTimePriority&) = delete;
  ~RealTimePriority();
  [[nodiscard]] bool granted() const noexcept { return granted_; }

 private:
  int policy_ = 0;  ///< as before
  bool granted_ = false;
};

}  // namespace wex::app
