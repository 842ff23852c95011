#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/bench/can_faults/blackboard.hpp"

namespace wex::can_faults {

/// One row of the bench's table, on stdout with tabs in between:
///   FIGURE test what figure gate pass|fail
/// `wex bench can` reads it.
void print_figure(const std::string& test, const std::string& what, const std::string& figure,
                  const std::string& gate, bool passed);

/// printf into a string.
[[gnu::format(printf, 1, 2)]] std::string text(const char* format, ...);

/// Slower than this a joint stands [rad/s or m/s]; the sensors' noise and the swinging of the
/// structure stay below it.
inline constexpr float kStanding = 0.02F;

/// p in 0..1 of the values, which are reordered; 0 if there are none.
[[nodiscard]] double percentile(std::vector<double>& values, double p);

/// When valves have shut and while the wheels ramp down, the oil columns let the structure swing
/// for that long [ms]: motion that follows a standstill within it was not driven.
inline constexpr double kSwing_ms = 1500.0;

/// How late the machine's or the host's periods of 10 ms were at most within a time [ms]: a kernel
/// that lets its processes wait makes every reaction later by as much, whatever they do.
[[nodiscard]] double lateness_ms(const Blackboard& board, std::int64_t begin_ns,
                                 std::int64_t end_ns);

/// How the machine came to stand.
struct StopFigures {
  double hold_ms = 0.0;    ///< last accepted command -> mode is not kEnabled any more
  double joints_ms = 0.0;  ///< -> all joints but the wheels stand (and only swing back from then)
  double wheels_ms = 0.0;  ///< -> the wheels, with their brakes
  double bucket_m = 0.0;   ///< way of the bucket, as seen from the base
  double base_m = 0.0;     ///< way that the fastest wheel rolled
  double late_ms = 0.0;    ///< by how much periods were late meanwhile, together
  bool stood = false;
};
/// From the last command that was accepted before `until_ns` to the end of the record.
[[nodiscard]] StopFigures stop_figures(const Blackboard& board, std::int64_t until_ns);

struct Motion_ms {
  double driven = 0.0;  ///< after the last command in force
  double late = 0.0;    ///< by how much the machine's periods were late meanwhile, together
  [[nodiscard]] double by_itself() const { return driven - late; }
};
/// Longest time that a joint other than a wheel was driven after the last command, from begin_ns
/// on.
[[nodiscard]] Motion_ms longest_motion_without_command(const Blackboard& board,
                                                       std::int64_t begin_ns);
/// Holds from begin_ns on that began when no process had been late by 30 ms just before.
[[nodiscard]] int unexcused_holds(const Blackboard& board, std::int64_t begin_ns);
/// Time enabled, from begin_ns on.
[[nodiscard]] double enabled_s(const Blackboard& board, std::int64_t begin_ns);
/// Times that the machine went into a mode, from begin_ns on.
[[nodiscard]] int entries(const Blackboard& board, can::MachineMode mode, std::int64_t begin_ns);
[[nodiscard]] bool ever(const Blackboard& board, can::MachineMode mode, std::int64_t begin_ns);

/// What the machine accepted against what the host has sent, from the traces.
struct CommandCheck {
  long sent = 0, received = 0, accepted = 0;
  long altered = 0;       ///< accepted, but never sent like that
  long twice = 0;         ///< accepted although accepted before
  long old_received = 0;  ///< arrived more than 100 ms after they were sent
  long old_accepted = 0;  ///< among the accepted ones
  double oldest_accepted_ms = 0.0;
  double late_ms = 0.0;  ///< the machine's periods, at most
};
[[nodiscard]] CommandCheck check_commands(const Blackboard& board, std::int64_t begin_ns);

}  // namespace wex::can_faults
