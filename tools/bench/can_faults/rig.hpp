#pragma once

#include <sys/types.h>

#include <functional>
#include <string>

#include "tools/bench/can_faults/peers.hpp"

namespace wex::can_faults {

/// Runs a command line of ip or tc; throws std::runtime_error naming it if it fails.
void shell(const std::string& command_line);
[[nodiscard]] std::int64_t now_ns();
void sleep_s(double duration_s);
/// Looks every 4 ms; false if it does not come true in time.
[[nodiscard]] bool wait_for(double patience_s, const std::function<bool()>& condition);

/// The pair vxcan0 (host's end) / vxcan1 (machine's end), fresh: no queueing discipline, empty.
void make_bus();

/// A host at one end of a fresh bus and a machine at the other, each a process of its own. The
/// destructor ends both, whatever they are doing. Throws std::runtime_error if one does not start.
class Rig {
 public:
  explicit Rig(Scene& scene, const HostOptions& options = {});
  Rig(const Rig&) = delete;
  Rig& operator=(const Rig&) = delete;
  ~Rig();

  /// Lets the host activate the machine, up to three times; throws if it is not enabled then.
  void enable();
  /// Enabled and moving steadily (or as a sine), for long enough to be at speed.
  void drive(Motion motion = Motion::kSteady);
  /// Speed of the fastest joint [rad/s, m/s] once it is well under way, at most 10 s later: on a
  /// loaded machine false holds begin it anew.
  double wait_for_motion();
  /// The operator's terminal: at first nothing, then the reset. A rising edge.
  void operator_reset();
  /// One frame of the operator's terminal.
  void operator_does(can::OperatorAction action);
  void start_host();
  void end_host();
  void kill_machine();
  void signal_host(int signal);
  void signal_machine(int signal);

  [[nodiscard]] Blackboard& board() { return *board_; }
  [[nodiscard]] pid_t host() const { return host_; }
  /// Activations that had to be repeated.
  [[nodiscard]] int enabled_again() const { return enabled_again_; }
  [[nodiscard]] can::MachineMode mode() const;
  [[nodiscard]] Lifecycle lifecycle() const;

 private:
  Scene& scene_;
  HostOptions options_;
  SharedBlackboard board_;
  pid_t host_ = -1, machine_ = -1;
  int enabled_again_ = 0;
};

}  // namespace wex::can_faults
