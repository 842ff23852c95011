#pragma once

#include <cstdint>
#include <optional>
#include <random>

#include "hw_interface/joint_loop.hpp"
#include "hw_interface/machine_io.hpp"
#include "hw_interface/socketcan/host_automaton.hpp"
#include "hw_interface/socketcan/host_feedback.hpp"
#include "hw_interface/socketcan/host_limits.hpp"
#include "hw_interface/socketcan/host_link.hpp"

namespace wex::can {

struct HostSettings {
  double period_s = 0.01;         ///< ZoneCommands; every second one with a heartbeat
  double command_valid_s = 0.06;  ///< on the bus, from the feedback that it was computed from
  bool load_balance = true;
  HostTimes times;
  FeedbackSettings feedback;
  HostLimitsSettings limits;
  LinkSettings link;
};

/// The host's side of the bus, cycle by cycle: feedback -> automaton -> joint loop -> limits ->
/// frames. Has no clock of its own and never waits. Noexcept, allocation-free after construction.
class HostSession {
 public:
  /// The port must live longer.
  HostSession(FramePort& port, const MachineModel& machine, HostFeedback feedback,
              const HostSettings& settings);

  /// Takes a batch of frames off the port; true: there may be more.
  bool collect() noexcept { return link_.collect(); }
  /// Uses what was collected; now_ns is read after collecting (HostLink).
  void receive(std::int64_t now_ns) noexcept;
  /// Uses what was collected, decides, sends: once per period of machine time.
  void cycle(std::int64_t now_ns) noexcept;
  /// Lets a machine in lock step run until its clock shows this.
  void send_lock_step(std::uint32_t until_ms) noexcept;

  WriteOutcome write(const JointCommand& command) noexcept;
  void forget_command() noexcept { has_command_ = false; }
  void stop() noexcept;
  void release() noexcept { stopped_ = false; }
  void request_enable() noexcept { enable_ = true; }
  void request_disable() noexcept { disable_ = true; }
  /// The machine's clock does not go on although it was asked to.
  void report_lock_step_lost() noexcept { lock_step_lost_ = true; }

  [[nodiscard]] MachineState state() const noexcept;
  [[nodiscard]] MachineHealth health() const noexcept;
  [[nodiscard]] const HostState& automaton() const noexcept { return automaton_; }
  [[nodiscard]] bool stopped() const noexcept { return stopped_; }
  [[nodiscard]] bool request_pending() const noexcept { return enable_ || disable_; }
  [[nodiscard]] bool stands(double standing_rate) const noexcept;
  [[nodiscard]] double now_s() const noexcept { return feedback_.now_s(now_ns_); }
  [[nodiscard]] HostFeedback& feedback() noexcept { return feedback_; }
  [[nodiscard]] const HostFeedback& feedback() const noexcept { return feedback_; }
  [[nodiscard]] HostLink& link() noexcept { return link_; }
  [[nodiscard]] const HostLink& link() const noexcept { return link_; }

 private:
  [[nodiscard]] HostInputs inputs() noexcept;
  void follow_phase(const HostState& before, const HostInputs& in) noexcept;
  [[nodiscard]] WriteOutcome judge(const JointCommand& wanted) noexcept;
  template <typename Message>
  void put(int slot, const Message& message, std::uint32_t session) noexcept;
  void put_stop(bool active) noexcept;
  void put_heartbeat(const HostOutputs& out) noexcept;
  void put_commands(const HostOutputs& out, bool live, ActuatorCommand& wanted,
                    const JointMeasurement& measured) noexcept;

  MachineModel machine_;
  HostSettings settings_;
  HostFeedback feedback_;
  HostLink link_;
  JointLoop loop_;
  HostLimits limits_;
  std::minstd_rand random_;

  HostState automaton_;
  JointCommand command_;
  bool has_command_ = false, stopped_ = false, enable_ = false, disable_ = false;
  bool neutral_sent_ = false, lock_step_lost_ = false;
  HostHeartbeat heartbeat_;
  bool stop_was_active_ = false;
  int stop_burst_ = 0, release_burst_ = 0;
  long cycles_ = 0;
  std::int64_t now_ns_ = 0;
  std::optional<std::int64_t> freeze_at_ns_;
  MachineHealth health_;
};

}  // namespace wex::can
