#pragma once

#include <ctime>

namespace wex {

/// CPU seconds of the calling thread: what every reported time is measured in, as machines are
/// noisy.
[[nodiscard]] inline double thread_cpu_time_s() noexcept {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace wex
