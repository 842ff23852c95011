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

constexpr double kPeriod_ms = 10.0;

/// How late each record is after the one before, at most, among those that end within the time.
template <typename Records>
double longest_delay_ms(const Records& records, std::int64_t begin_ns, std::int64_t end_ns) {
  double longest_ms = 0.0;
  for (std::size_t i = records.size(); i-- > 1 && records[i].time_ns >= begin_ns;) {
    if (records[i - 1].time_ns > end_ns) continue;
    const double delay_ms = ms_between(records[i - 1].time_ns, records[i].time_ns) - kPeriod_ms;
    longest_ms = std::max(longest_ms, delay_ms);
  }
  return longest_ms;
}

/// Tells driven motion from the swing after it, sample by sample.
class MotionWatch {
 public:
  /// Time since the last command in force if a joint is driven, else zeros.
  Motion_ms update(const MachineSample& sample) {
    if (sample.commanded_ns != commanded_ns_) {
      stood_ = false;
      late_ms_ = 0.0;
    }
    if (time_ns_ != 0 && time_ns_ >= sample.commanded_ns) {
      late_ms_ += std::max(ms_between(time_ns_, sample.time_ns) - kPeriod_ms, 0.0);
    }
    commanded_ns_ = sample.commanded_ns;
    time_ns_ = sample.time_ns;
    const double since_ms = ms_between(sample.commanded_ns, sample.time_ns);
    const bool turned_back = sample.turn_rad_s * turn_rad_s_ < 0.0F;  // stood between two samples
    turn_rad_s_ = sample.turn_rad_s;
    stood_ = stood_ || turned_back || sample.fastest_joint <= kStanding;
    if (sample.fastest_joint <= kStanding) return {};
    return stood_ && since_ms <= kSwing_ms ? Motion_ms{} : Motion_ms{since_ms, late_ms_};
  }

 private:
  std::int64_t commanded_ns_ = 0, time_ns_ = 0;
  double late_ms_ = 0.0;
  float turn_rad_s_ = 0.0F;
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

double lateness_ms(const Blackboard& board, std::int64_t begin_ns, std::int64_t end_ns) {
  return std::max(longest_delay_ms(board.machine, begin_ns, end_ns),
                  longest_delay_ms(board.host, begin_ns, end_ns));
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
    const Motion_ms motion = watch.update(*s);
    if (motion.driven > figures.joints_ms) figures.joints_ms = motion.driven;
    if (s != begin &&
        std::max(figures.joints_ms, figures.wheels_ms) + 2.0 * kPeriod_ms > since_ms) {
      figures.late_ms += std::max(ms_between(s[-1].time_ns, s->time_ns) - kPeriod_ms, 0.0);
    }
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

Motion_ms longest_motion_without_command(const Blackboard& board, std::int64_t begin_ns) {
  Motion_ms longest;
  MotionWatch watch;
  for (const MachineSample& sample : board.machine) {
    const Motion_ms motion = watch.update(sample);
    if (sample.time_ns >= begin_ns && motion.by_itself() > longest.by_itself()) longest = motion;
  }
  return longest;
}

int unexcused_holds(const Blackboard& board, std::int64_t begin_ns) {
  constexpr double kExcuse_ms = 30.0;
  constexpr std::int64_t kBefore_ns = 150'000'000;
  int count = 0;
  for (std::size_t i = 1; i < board.machine.size(); ++i) {
    const std::int64_t time_ns = board.machine[i].time_ns;
    const bool begins = board.machine[i].mode == can::MachineMode::kHold &&
                        board.machine[i - 1].mode != can::MachineMode::kHold;
    if (!begins || time_ns < begin_ns) continue;
    count += lateness_ms(board, time_ns - kBefore_ns, time_ns) < kExcuse_ms;
  }
  return count;
}

double enabled_s(const Blackboard& board, std::int64_t begin_ns) {
  double sum_ms = 0.0;
  for (std::size_t i = 1; i < board.machine.size(); ++i) {
    if (board.machine[i].time_ns < begin_ns ||
        board.machine[i].mode != can::MachineMode::kEnabled) {
      continue;
    }
    sum_ms += ms_between(board.machine[i - 1].time_ns, board.machine[i].time_ns);
  }
  return 1e-3 * sum_ms;
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
  check.late_ms = longest_delay_ms(board.machine, begin_ns, end_ns);
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
