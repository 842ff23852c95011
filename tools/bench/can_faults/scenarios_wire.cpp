#include <cmath>
#include <stdexcept>
#include <vector>

#include "tools/bench/can_faults/figures.hpp"
#include "tools/bench/can_faults/rig.hpp"
#include "tools/bench/can_faults/scenarios.hpp"

// Frames that get lost, late, altered or stuck on the way: netem and tbf on the vxcan pair. On a
// plain vcan they would do nothing, as other local sockets get the frame before the queue.

namespace wex::can_faults {
namespace {

constexpr double kMaxMotion_ms = 150.0;

void shape_both_ends(const std::string& discipline) {
  shell("tc qdisc replace dev vxcan0 root " + discipline);
  shell("tc qdisc replace dev vxcan1 root " + discipline);
}

/// Longest time between two good commands of one zone [ms].
double longest_gap_ms(const Blackboard& board, std::int64_t begin_ns) {
  double longest_ms = 0.0;
  std::int64_t last_ns = begin_ns;
  for (const CommandRecord& command : board.received) {
    if (!command.accepted || command.id != 0x080 || command.time_ns < begin_ns) continue;
    longest_ms = std::max(longest_ms, 1e-6 * static_cast<double>(command.time_ns - last_ns));
    last_ns = command.time_ns;
  }
  return longest_ms;
}

/// The queue stays full for 2 s, then the bus takes frames again.
void stall(Scene& scene, bool purge) {
  HostOptions options;
  options.purge = purge;
  Rig rig(scene, options);
  rig.drive();
  shell("tc qdisc replace dev vxcan0 root tbf rate 8bit burst 100 limit 100000");
  const std::int64_t begin_ns = now_ns();
  sleep_s(2.0);
  shell("tc qdisc change dev vxcan0 root tbf rate 100mbit burst 100000 limit 100000");
  const std::int64_t recovered_ns = now_ns();
  // A queue looks at its new rate when the next frame comes; the host's send buffer is full.
  rig.operator_does(can::OperatorAction::kNone);
  sleep_s(2.0);
  const CommandCheck check = check_commands(rig.board(), begin_ns);
  const Motion_ms motion = longest_motion_without_command(rig.board(), begin_ns);
  const bool resumed = ever(rig.board(), can::MachineMode::kEnabled, recovered_ns);
  print_figure(
      "T9", text("stall of 2 s, then recovery; %s", purge ? "purge by link flap" : "no purge"),
      text("%ld old frames on the wire, %ld of them accepted; moved %.0f ms after the last "
           "command; host: %ld sends refused, %ld purges; enabled again by itself: %s",
           check.old_received, check.old_accepted + check.altered, motion.driven,
           rig.board().statistics.not_taken, rig.board().statistics.purges, resumed ? "yes" : "no"),
      purge ? "<= 5 old, 0 accepted, <= 150 ms" : "0 accepted, <= 150 ms",
      check.old_accepted == 0 && check.altered == 0 && check.twice == 0 &&
          (check.old_received <= 5 || !purge) && motion.by_itself() <= kMaxMotion_ms &&
          rig.board().statistics.not_taken > 0);
}

}  // namespace

void lose_frames(Scene& scene, bool full) {
  const double duration_s = full ? 60.0 : 4.0;
  for (const int percent : {0, 1, 5, 10, 20, 50}) {
    Rig rig(scene);
    rig.drive(Motion::kSine);
    const std::int64_t begin_ns = now_ns();
    shape_both_ends(text("netem loss %d%%", percent));
    sleep_s(duration_s);
    const Blackboard& board = rig.board();
    const int holds = entries(board, can::MachineMode::kHold, begin_ns);
    const int faults = entries(board, can::MachineMode::kFault, begin_ns);
    const double enabled = enabled_s(board, begin_ns);
    const Motion_ms motion = longest_motion_without_command(board, begin_ns);
    // Five frames lost in a row are 50 ms of silence: the machine holds. Six streams of commands,
    // six of feedback and the pose, 100 Hz each; only time enabled counts. The count of a rare
    // event scatters by its root.
    const double p = percent / 100.0;
    const double expected = 13.0 * enabled * 100.0 * std::pow(p, 5) * (1.0 - p);
    const CommandCheck check = check_commands(board, begin_ns);
    const bool holds_as_expected = percent == 0
                                       ? unexcused_holds(board, begin_ns) == 0
                                       : holds <= 2.0 * expected + 6.0 * std::sqrt(expected) + 3.0;
    const bool holds_in_time = percent < 50 || (holds > 0 && enabled < 1.0 + 0.2 * duration_s);
    print_figure(
        "T6", text("loss of %d %% both ways, %.0f s", percent, duration_s),
        text("%.1f %% of commands lost, longest gap %.0f ms, enabled %.1f s, holds %d (5 lost in a "
             "row, expected: %.1f), faults %d, moved %.0f ms after a command",
             check.sent > 0 ? 100.0 * static_cast<double>(check.sent - check.received) /
                                  static_cast<double>(check.sent)
                            : 0.0,
             longest_gap_ms(board, begin_ns), enabled, holds, expected, faults, motion.driven),
        percent == 0    ? "no hold, no fault, <= 150 ms"
        : percent <= 5  ? "no fault, holds as expected, <= 150 ms"
        : percent <= 20 ? "holds as expected, <= 150 ms"
                        : "holds, <= 150 ms",
        motion.by_itself() <= kMaxMotion_ms && (percent > 5 || faults == 0) &&
            (percent > 20 || holds_as_expected) && holds_in_time &&
            check.altered + check.twice == 0 && check.accepted > 0);
  }
}

void disturb_frames(Scene& scene, bool full) {
  const double duration_s = full ? 30.0 : 3.0;
  const std::vector<std::pair<std::string, std::string>> disturbances = {
      {"delay 5 +- 2 ms", "netem delay 5ms 2ms"},
      {"delay 20 +- 10 ms", "netem delay 20ms 10ms"},
      {"a quarter reordered by 15 ms", "netem delay 15ms reorder 75%"},
      {"5 % duplicated", "netem duplicate 5%"},
      {"5 % with a flipped bit", "netem corrupt 5%"},
      {"all of it at once", "netem delay 5ms 2ms loss 2% duplicate 5% corrupt 1%"}};
  for (const auto& [what, discipline] : disturbances) {
    Rig rig(scene);
    rig.drive(Motion::kSine);
    shape_both_ends(discipline);
    const std::int64_t begin_ns = now_ns();
    sleep_s(duration_s);
    const Blackboard& board = rig.board();
    const CommandCheck check = check_commands(board, begin_ns);
    const Motion_ms motion = longest_motion_without_command(board, begin_ns);
    print_figure(
        "T7", text("%s, %.0f s", what.c_str(), duration_s),
        text("%ld of %ld commands accepted: altered %ld, twice %ld, oldest %.0f ms; holds %d, "
             "faults %d, moved %.0f ms after a command",
             check.accepted, check.received, check.altered, check.twice, check.oldest_accepted_ms,
             entries(board, can::MachineMode::kHold, begin_ns),
             entries(board, can::MachineMode::kFault, begin_ns), motion.driven),
        "0 altered, 0 twice, <= 60 ms old, <= 150 ms",
        check.altered == 0 && check.twice == 0 &&
            check.oldest_accepted_ms <= 60.0 + check.late_ms &&
            motion.by_itself() <= kMaxMotion_ms);
  }
}

void stall_and_recover(Scene& scene, bool) {
  stall(scene, true);
  stall(scene, false);
}

void refuse_frames(Scene& scene, bool full) {
  const double duration_s = full ? 60.0 : 5.0;
  Rig rig(scene);
  rig.drive();
  const auto cycles_ms = [](const auto& samples, std::int64_t begin_ns) {
    std::vector<double> cycles;
    for (std::size_t i = 1; i < samples.size(); ++i) {
      const std::int64_t last_ns = samples[i - 1].time_ns;
      if (last_ns < begin_ns) continue;
      cycles.push_back(1e-6 * static_cast<double>(samples[i].time_ns - last_ns));
    }
    return cycles;
  };
  sleep_s(1.0);
  auto healthy_ms = cycles_ms(rig.board().host, now_ns() - 1'000'000'000);
  const long resident_kb = rig.board().host_resident_kb;
  // A queue of one frame that leaves ten a second: nearly every send is refused with ENOBUFS.
  shell("tc qdisc replace dev vxcan0 root tbf rate 6kbit burst 100 limit 100");
  const std::int64_t begin_ns = now_ns();
  sleep_s(duration_s);
  auto storm_ms = cycles_ms(rig.board().host, begin_ns);
  auto machine_ms =
      cycles_ms(rig.board().machine, begin_ns);  // sends freely: late with its kernel only
  const long growth_kb = rig.board().host_resident_kb - resident_kb;
  const double healthy_p99_ms = percentile(healthy_ms, 0.99);
  const double storm_p99_ms = percentile(storm_ms, 0.99);
  const double machine_p99_ms = percentile(machine_ms, 0.99);
  const Motion_ms motion = longest_motion_without_command(rig.board(), begin_ns);
  print_figure(
      "T10", text("queue full for %.0f s (ENOBUFS)", duration_s),
      text("%ld sends refused; cycle p99 %.1f ms (healthy %.1f, the machine's %.1f); memory "
           "+%ld kB; moved %.0f ms after the last command",
           rig.board().statistics.not_taken, storm_p99_ms, healthy_p99_ms, machine_p99_ms,
           growth_kb, motion.driven),
      "cycle p99 <= 15 ms over the machine's, <= 500 kB, <= 150 ms",
      rig.board().statistics.not_taken > 50 && storm_p99_ms <= machine_p99_ms + 15.0 &&
          growth_kb <= 500 && motion.by_itself() <= kMaxMotion_ms);
}

}  // namespace wex::can_faults
