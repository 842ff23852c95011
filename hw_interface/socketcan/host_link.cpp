#include "hw_interface/socketcan/host_link.hpp"

#include <linux/can/error.h>
#include <time.h>

#include <algorithm>
#include <utility>

namespace wex::can {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr double kWellAfterPurges = 3.0;  ///< periods of purging without trouble

std::int64_t nanoseconds(double duration_s) noexcept {
  return static_cast<std::int64_t>(1e9 * duration_s);
}

}  // namespace

HostLink::HostLink(FramePort& port, const LinkSettings& settings)
    : port_(&port),
      settings_(settings),
      recorder_(settings.recorder),
      backoff_s_(settings.reopen_after_s) {
  last_reported_.fill(-1);
}

std::int64_t HostLink::realtime_ns(std::int64_t now_ns) const noexcept {
  return now_ns + realtime_offset_ns_;
}

void HostLink::on_bus_time(const CanFrame& frame, std::int64_t now_ns) noexcept {
  if (first_) {
    timespec wall{};
    clock_gettime(CLOCK_REALTIME, &wall);
    realtime_offset_ns_ = std::int64_t{wall.tv_sec} * kSecond_ns + wall.tv_nsec - now_ns;
    first_ns_ = second_begin_ns_ = now_ns;
    first_ = false;
  }
  if (now_ns - second_begin_ns_ >= kSecond_ns) {
    const double seconds = 1e-9 * static_cast<double>(now_ns - second_begin_ns_);
    statistics_.max_bus_load = std::max(statistics_.max_bus_load, busy_this_second_s_ / seconds);
    busy_this_second_s_ = 0.0;
    second_begin_ns_ = now_ns;
  }
  const double time_s = bus_time_s(frame);
  statistics_.busy_s += time_s;
  busy_this_second_s_ += time_s;
  if (now_ns > first_ns_) {
    statistics_.bus_load = statistics_.busy_s / (1e-9 * static_cast<double>(now_ns - first_ns_));
  }
}

void HostLink::on_error_frame(const CanFrame& frame, std::int64_t now_ns) noexcept {
  ++statistics_.error_frames;
  trouble_ns_ = now_ns;
  if ((frame.id & CAN_ERR_BUSOFF) != 0) bus_off_ns_ = now_ns;
  if ((frame.id & CAN_ERR_RESTARTED) != 0) bus_off_ns_ = kNever_ns;
}

void HostLink::on_status(const HostFeedback& feedback, int zone, std::int64_t now_ns) noexcept {
  const int counter = feedback.status(zone).last_accepted_counter;
  if (feedback.status(zone).session == 0 || counter == last_reported_[zone]) return;
  // The first report of a session may be about a counter from long ago.
  std::int64_t& sent_ns = sent_ns_[zone][static_cast<std::size_t>(counter)];
  if (last_reported_[zone] >= 0 && sent_ns > 0) {
    statistics_.command_to_report.add(1e-9 * static_cast<double>(now_ns - sent_ns));
  }
  last_reported_[zone] = counter;
}

void HostLink::on_received(const CanFrame& frame, HostFeedback& feedback,
                           std::int64_t now_ns) noexcept {
  on_bus_time(frame, now_ns);
  recorder_.record(frame, frame.kernel_time_ns != 0 ? frame.kernel_time_ns : realtime_ns(now_ns));
  const MessageKind kind = frame.error ? MessageKind::kUnknown : kind_of(frame);
  const FrameVerdict verdict = feedback.take(frame, now_ns);
  switch (verdict) {
    case FrameVerdict::kUsed:
      if (kind == MessageKind::kZoneStatus) on_status(feedback, zone_of(frame), now_ns);
      break;
    case FrameVerdict::kRepeated:
      ++statistics_.repeated;
      break;
    case FrameVerdict::kWrongSequence:
      ++statistics_.wrong_sequence;
      break;
    case FrameVerdict::kBadCrc:
      ++statistics_.crc_errors;
      break;
    case FrameVerdict::kMalformed:
      ++statistics_.malformed;
      break;
    case FrameVerdict::kUnknown:
      ++statistics_.unknown;
      break;
    case FrameVerdict::kOwnId:
      ++statistics_.own_ids;
      break;
    case FrameVerdict::kError:
      on_error_frame(frame, now_ns);
      return;
  }
  if (verdict != FrameVerdict::kUsed) trouble_ns_ = now_ns;
  ++statistics_.of(kind).received;
}

void HostLink::on_lost(std::int64_t now_ns) noexcept {
  usable_ = false;
  if (!lost_) lost_event_ = true;
  lost_ = true;
  mailbox_.clear();
  reopen_at_ns_ = now_ns + nanoseconds(backoff_s_);
  backoff_s_ = std::min(2.0 * backoff_s_, settings_.max_reopen_after_s);
}

bool HostLink::collect() noexcept {
  while (collected_ < kBatch) {
    collect_status_ = port_->receive(batch_[collected_]);
    if (collect_status_ != SocketStatus::kOk) return false;
    ++collected_;
  }
  return true;
}

void HostLink::receive(HostFeedback& feedback, std::int64_t now_ns) noexcept {
  const std::size_t count = std::exchange(collected_, 0);
  const SocketStatus status = std::exchange(collect_status_, SocketStatus::kWouldBlock);
  // Nothing counts before the port is opened anew; left unread, it would end every wait at once.
  if (!usable_) return;
  for (std::size_t i = 0; i < count; ++i) {
    on_received(batch_[i], feedback, now_ns);
    if (!batch_[i].error) {  // the bus is back
      lost_ = false;
      backoff_s_ = settings_.reopen_after_s;
    }
  }
  if (status != SocketStatus::kOk && status != SocketStatus::kWouldBlock) {
    on_lost(now_ns);
    return;
  }
  const std::uint32_t dropped = port_->dropped();
  if (dropped != dropped_) {
    statistics_.receive_overflows += static_cast<long>(dropped - dropped_);
    dropped_ = dropped;
    overflow_before_ns_ = overflow_ns_;
    overflow_ns_ = trouble_ns_ = now_ns;
  }
  for (int kind = 0; kind < kNumMessageKinds; ++kind) {
    const auto which = static_cast<MessageKind>(kind);
    statistics_.of(which).lost = feedback.lost_frames(which);
  }
}

void HostLink::on_sent(int slot, const CanFrame& frame, std::int64_t now_ns) noexcept {
  on_bus_time(frame, now_ns);
  recorder_.record(frame, realtime_ns(now_ns));
  ++statistics_.of(kind_of(frame)).sent;
  const int zone = slot - HostMailbox::kCommand;
  if (zone < 0 || zone >= kNumZones) return;
  sent_ns_[zone][mailbox_.sent_counter(slot)] = now_ns;
}

void HostLink::send(std::int64_t now_ns) noexcept {
  if (!usable_) {
    mailbox_.clear();
    return;
  }
  const SocketStatus status = mailbox_.flush(
      *port_, [&](int slot, const CanFrame& frame) { on_sent(slot, frame, now_ns); });
  if (status == SocketStatus::kWouldBlock) {
    ++statistics_.not_taken;
    blocked_ = true;
    trouble_ns_ = now_ns;
  } else if (status != SocketStatus::kOk) {
    on_lost(now_ns);
  }
}

void HostLink::try_purge(std::int64_t now_ns) noexcept {
  mailbox_.clear();
  if (!settings_.purge_by_link_flap || purges_in_a_row_ >= settings_.max_purges ||
      now_ns - purged_ns_ < nanoseconds(settings_.purge_every_s)) {
    return;
  }
  purged_ns_ = now_ns;
  ++purges_in_a_row_;
  if (port_->purge()) ++statistics_.purges;
}

void HostLink::end_cycle(std::int64_t now_ns) noexcept {
  const bool was_stalled = stalled();
  blocked_cycles_ = blocked_ ? blocked_cycles_ + 1 : 0;
  blocked_ = false;
  if (stalled() && !was_stalled) ++statistics_.stalls;
  if (stalled()) try_purge(now_ns);
  // Right after a purge the queue takes frames even if the bus does not: that is not "well again".
  if (stalled() || lost_ || bus_off_reported(now_ns)) ill_ns_ = now_ns;
  if (now_ns - ill_ns_ > nanoseconds(kWellAfterPurges * settings_.purge_every_s)) {
    purges_in_a_row_ = 0;
  }
  if (usable_ || now_ns < reopen_at_ns_) return;
  if (port_->reopen() == SocketStatus::kOk) {
    usable_ = true;
    ++statistics_.reopens;
  } else {
    on_lost(now_ns);
  }
}

bool HostLink::take_lost() noexcept { return std::exchange(lost_event_, false); }

bool HostLink::bus_off_reported(std::int64_t now_ns) const noexcept {
  return now_ns - bus_off_ns_ < nanoseconds(settings_.error_memory_s);
}

bool HostLink::overflowed(std::int64_t now_ns) const noexcept {
  const std::int64_t window_ns = nanoseconds(settings_.overflow_window_s);
  return overflow_ns_ - overflow_before_ns_ < window_ns && now_ns - overflow_ns_ < window_ns;
}

bool HostLink::degraded(std::int64_t now_ns) const noexcept {
  return lost_ || now_ns - trouble_ns_ < nanoseconds(settings_.error_memory_s);
}

}  // namespace wex::can
