#pragma once

#include <atomic>

namespace wex::app {

/// From now on SIGINT and SIGTERM set this flag instead of ending the process; sleeps end at once.
/// Cleared by every call. Process-wide.
[[nodiscard]] const std::atomic<bool>& stop_on_signals();

}  // namespace wex::app
