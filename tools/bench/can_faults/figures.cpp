#include "tools/bench/can_faults/figures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <map>
#include <utility>

#include "hw_interface/socketcan/frame_port.hpp"

namespace wex::can_faults {
namespace {

constexpr double kMillisecond_ns = 1e6;
constexpr double kOld_ms = 100.0;

double ms_between(std::int64_t from_ns, std::int64_t to_ns) {
  return static_cast<double>(to_ns - from_ns) / kMillisecond_ns;
}

/// Tells driven motion from the swing after it, sample by sample.
class MotionWatch {
 public:
  /// Milliseconds since the last accepted command if a joint is driven, else 0.
  double update(const MachineSample& sample) {
    const double since_ms = ms_between(sample.accepted_ns, sample.time_ns);
    if (sample.accepted_ns != accepted_ns_) stood_ = false;
    accepted_ns_ = sample.accepted_ns;
    if (sample.fastest_joint <= kStanding) {
      stood_ = true;
      return 0.0;
    }
    return stood_ && since_ms <= kSwing_ms ? 0.0 : since_ms;
  }

 private:
  std::int64_t accepted_ns_ = 0;
  bool stood_ = false;
};

}  // namespace

std::string text(const char* format, ...) {
  char buffer[512];
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(buffer, sizeof(buffer), format, arguments);
  va_end(arguments);
  return buffer;
}

void print_figure(const std::string& test, const std::string& what, const std::string& figure,
                  const std::string& gate, bool passed) {
  std::printf("FIGURE\t%s\t%s\t%s\t%s\t%s\n", test.c_str(), what.c_str(), figure.c_str(),
              gate.c_str(), passed ? "pass" : "fail");
  std::fflush(stdout);  // what follows may be killed
}

double percentile(std::vector<double>& values, double p) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<std::size_t>(p * static_cast<double>(values.size() - 1) + 0.5);
  return values[rank];
}

StopFigures stop_figures(const Blackboard& board, std::int64_t until_ns) {
  StopFigures figures;
  std::int64_t last_ns = 0;
  for (const CommandRecord& command : board.received) {
    if (command.accepted && command.time_ns <= until_ns) last_ns = command.time_ns;
  }
  const MachineSample* begin = board.machine.begin();
  const MachineSample* const end = board.machine.end();
  while (begin != end && begin->time_ns < last_ns) ++begin;
  if (last_ns == 0 || begin == end) return figures;
  const auto p_begin = begin->p_base_bucket_m;
  constexpr double kPeriod_s = 0.01;
  MotionWatch watch;
  for (const MachineSample* s = begin; s != end; ++s) {
    const double since_ms = ms_between(last_ns, s->time_ns);
    if (s->mode == can::MachineMode::kEnabled) figures.hold_ms = since_ms;
    figures.joints_ms = std::max(figures.joints_ms, watch.update(*s));
    figures.base_m += kPeriod_s * static_cast<double>(s->fastest_wheel_m_s);
    if (s->fastest_wheel_m_s > kStanding) figures.wheels_ms = since_ms;
    const auto p = s->p_base_bucket_m;
    const double way = std::hypot(p[0] - p_begin[0], p[1] - p_begin[1], p[2] - p_begin[2]);
    figures.bucket_m = std::max(figures.bucket_m, way);
  }
  figures.stood = end[-1].fastest_joint <= kStanding && end[-1].fastest_wheel_m_s <= kStanding &&
                  end[-1].mode != can::MachineMode::kEnabled;
  return figures;
}

double longest_motion_without_command_ms(const Blackboard& board, std::int64_t begin_ns) {
  double longest_ms = 0.0;
  MotionWatch watch;
  for (const MachineSample& sample : board.machine) {
    const double driven_ms = watch.update(sample);
    if (sample.time_ns >= begin_ns) longest_ms = std::max(longest_ms, driven_ms);
  }
  return longest_ms;
}

int entries(const Blackboard& board, can::MachineMode mode, std::int64_t begin_ns) {
  int count = 0;
  for (std::size_t i = 1; i < board.machine.size(); ++i) {
    const MachineSample& sample = board.machine[i];
    count += sample.time_ns >= begin_ns && sample.mode == mode && board.machine[i - 1].mode != mode;
  }
  return count;
}

bool ever(const Blackboard& board, can::MachineMode mode, std::int64_t begin_ns) {
  return std::any_of(board.machine.begin(), board.machine.end(), [&](const MachineSample& sample) {
    return sample.time_ns >= begin_ns && sample.mode == mode;
  });
}

CommandCheck check_commands(const Blackboard& board, std::int64_t begin_ns) {
  CommandCheck check;
  // Both sides go on while we read: what has just been sent may not stand in the record yet.
  constexpr std::int64_t kSettled_ns = 50'000'000;
  can::SystemClock clock;
  const std::int64_t end_ns = clock.now_ns() - kSettled_ns;
  struct Sent {
    std::int64_t time_ns = 0;
    bool accepted = false;
  };
  using Key = std::pair<std::uint32_t, std::array<std::uint8_t, 24>>;
  std::map<Key, Sent> sent;  // session, counter, echo and CRC make every command unique
  for (const CommandRecord& command : board.sent) {
    sent[{command.id, command.data}] = {command.time_ns, false};
    check.sent += command.time_ns >= begin_ns && command.time_ns <= end_ns;
  }
  for (const CommandRecord& command : board.received) {
    if (command.time_ns > end_ns) break;
    const auto entry = sent.find({command.id, command.data});
    const bool known = entry != sent.end();
    const double age_ms = known ? ms_between(entry->second.time_ns, command.time_ns) : 0.0;
    const bool counts = command.time_ns >= begin_ns;
    check.received += counts;
    check.old_received += counts && age_ms > kOld_ms;
    if (!command.accepted) continue;
    check.accepted += counts;
    check.altered += !known;
    check.old_accepted += age_ms > kOld_ms;
    if (!known) continue;
    check.twice += entry->second.accepted;
    entry->second.accepted = true;
    check.oldest_accepted_ms = std::max(check.oldest_accepted_ms, age_ms);
  }
  return check;
}

}  // namespace wex::can_faults
