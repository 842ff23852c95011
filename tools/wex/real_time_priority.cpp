#include "tools/wex/real_time_priority.hpp"

#include <sched.h>

namespace wex::app {

RealTimePriority::RealTimePriority(int priority) noexcept : policy_(sched_getscheduler(0)) {
  // Who was given a real-time priority from outside keeps it.
  if (policy_ != SCHED_OTHER) return;
  const sched_param parameters{.sched_priority = priority};
  granted_ = sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &parameters) == 0;
}

RealTimePriority::~RealTimePriority() {
  if (!granted_) return;
  const sched_param parameters{.sched_priority = 0};
  sched_setscheduler(0, policy_, &parameters);
}

}  // namespace wex::app
