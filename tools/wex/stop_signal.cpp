#include "tools/wex/stop_signal.hpp"

#include <csignal>

namespace wex::app {
namespace {

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

extern "C" void request_stop(int) { stop_requested = true; }

}  // namespace

const std::atomic<bool>& stop_on_signals() {
  stop_requested = false;
  struct sigaction action{};
  action.sa_handler = request_stop;  // without SA_RESTART: sleeps end at once
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGINT, &action, nullptr);
  return stop_requested;
}

}  // namespace wex::app
