#include "hw_interface/fault_injection/faulty_port.hpp"

#include <algorithm>
#include <utility>

namespace wex::can {
namespace {

/// For heaps whose front is the earliest frame.
constexpr auto kLater = [](const auto& a, const auto& b) {
  return a.due_ns != b.due_ns ? a.due_ns > b.due_ns : a.number > b.number;
};

}  // namespace

FaultyPort::FaultyPort(FramePort& inner, MonotonicClock& clock, std::uint64_t seed)
    : inner_(&inner), clock_(&clock), random_(seed) {
  outbox_.reserve(kMaxWaiting);
  inbox_.reserve(kMaxWaiting);
  stalled_frames_.reserve(kSendQueueFrames);
}

double FaultyPort::uniform() noexcept {
  constexpr double kRange = 18446744073709551616.0;  // 2^64
  return static_cast<double>(random_()) / kRange;
}

void FaultyPort::push(const CanFrame& frame, double delay_s, Queue& queue) noexcept {
  if (queue.size() == kMaxWaiting) {
    ++counters_.lost;
    return;
  }
  queue.push_back({clock_->now_ns() + static_cast<std::int64_t>(1e9 * delay_s), number_++, frame});
  std::push_heap(queue.begin(), queue.end(), kLater);
}

bool FaultyPort::take_due(Queue& queue, std::int64_t now_ns, CanFrame& frame) noexcept {
  if (queue.empty() || queue.front().due_ns > now_ns) return false;
  frame = queue.front().frame;
  std::pop_heap(queue.begin(), queue.end(), kLater);
  queue.pop_back();
  return true;
}

void FaultyPort::corrupt(CanFrame& frame) noexcept {
  if (frame.length == 0) return;
  const std::uint64_t flips = 1 + random_() % 3;
  for (std::uint64_t i = 0; i < flips; ++i) {
    const std::uint64_t bit = random_() % (8U * frame.length);
    frame.data[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
  }
  ++counters_.corrupted;
}

void FaultyPort::freeze(CanFrame& frame) noexcept {
  if (!frozen_slot_ || kind_of(frame) != MessageKind::kZoneFeedback ||
      zone_of(frame) != frozen_slot_->zone) {
    return;
  }
  ZoneFeedback feedback;
  const auto meta = decode(frame, 0, feedback);
  if (!meta) return;
  const int index = frozen_slot_->index;
  if (!frozen_position_) frozen_position_ = feedback.position[index];
  feedback.position[index] = *frozen_position_;
  feedback.rate[index] = 0.0;
  feedback.quality[index] = JointQuality::kStale;
  SendContext context{0, meta->counter};
  if (encode(feedback, context, frame)) ++counters_.frozen;
}

void FaultyPort::enqueue(const CanFrame& original, const FrameFaults& faults,
                         Queue& queue) noexcept {
  if (happens(faults.loss)) {
    ++counters_.lost;
    return;
  }
  CanFrame frame = original;
  if (happens(faults.corrupt)) corrupt(frame);
  double wait_s = std::max(0.0, faults.delay_s + faults.jitter_s * (2.0 * uniform() - 1.0));
  if (happens(faults.reorder)) {
    wait_s += faults.reorder_s;
    ++counters_.reordered;
  }
  push(frame, wait_s, queue);
  if (happens(faults.duplicate)) {
    push(frame, wait_s, queue);
    ++counters_.duplicated;
  }
}

void FaultyPort::set_stalled(bool stalled) noexcept {
  if (stalled_ && !stalled) {
    for (const CanFrame& frame : stalled_frames_) {
      if (inner_->send(frame) == SocketStatus::kOk) ++counters_.replayed_after_stall;
    }
    stalled_frames_.clear();
  }
  stalled_ = stalled;
}

void FaultyPort::set_interface(Interface state) noexcept {
  if (state == interface_) return;
  interface_ = state;
  told_ = false;
  if (state == Interface::kGone) needs_reopen_ = true;
  if (state != Interface::kUp) {  // queues of the interface are emptied with it
    outbox_.clear();
    inbox_.clear();
    stalled_frames_.clear();
  }
}

void FaultyPort::freeze_joint(std::optional<JointSlot> slot) noexcept {
  frozen_slot_ = slot;
  frozen_position_.reset();
}

SocketStatus FaultyPort::deliver() noexcept {
  CanFrame due;
  while (take_due(outbox_, clock_->now_ns(), due)) {
    const SocketStatus status = inner_->send(due);
    if (status != SocketStatus::kOk) return status;
  }
  return SocketStatus::kOk;
}

SocketStatus FaultyPort::send(const CanFrame& frame) noexcept {
  if (interface_ == Interface::kGone || needs_reopen_) return SocketStatus::kGone;
  if (interface_ == Interface::kDown) return SocketStatus::kInterfaceDown;
  if (stalled_) {
    if (stalled_frames_.size() == kSendQueueFrames) return SocketStatus::kWouldBlock;
    stalled_frames_.push_back(frame);
    return SocketStatus::kOk;
  }
  enqueue(frame, sending_, outbox_);
  return deliver();
}

SocketStatus FaultyPort::pull() noexcept {
  CanFrame frame;
  SocketStatus status = inner_->receive(frame);
  for (; status == SocketStatus::kOk; status = inner_->receive(frame)) {
    // A down interface hears nothing; a stalled one does (its receiver is not what is stuck).
    if (interface_ != Interface::kUp || needs_reopen_) continue;
    freeze(frame);
    enqueue(frame, receiving_, inbox_);
  }
  return status;
}

SocketStatus FaultyPort::receive(CanFrame& frame) noexcept {
  const SocketStatus pulled = pull();
  if (interface_ != Interface::kUp || needs_reopen_) {
    // The kernel tells once; then there is silence.
    if (std::exchange(told_, true)) return SocketStatus::kWouldBlock;
    return interface_ == Interface::kDown ? SocketStatus::kInterfaceDown : SocketStatus::kGone;
  }
  if (pulled != SocketStatus::kWouldBlock) return pulled;
  if (const SocketStatus sent = deliver(); sent != SocketStatus::kOk) return sent;
  return take_due(inbox_, clock_->now_ns(), frame) ? SocketStatus::kOk : SocketStatus::kWouldBlock;
}

SocketStatus FaultyPort::wait_readable(double timeout_s) noexcept {
  std::int64_t until_ns = clock_->now_ns() + static_cast<std::int64_t>(1e9 * timeout_s);
  for (const Queue* queue : {&inbox_, &outbox_}) {
    if (!queue->empty()) until_ns = std::min(until_ns, queue->front().due_ns);
  }
  const double wait_s = 1e-9 * static_cast<double>(until_ns - clock_->now_ns());
  return inner_->wait_readable(std::max(0.0, wait_s));
}

SocketStatus FaultyPort::reopen() noexcept {
  if (interface_ == Interface::kGone) return SocketStatus::kGone;
  ++reopens_;
  needs_reopen_ = false;
  inbox_.clear();
  return inner_->reopen();
}

bool FaultyPort::purge() noexcept {
  if (!purge_possible_) return false;
  stalled_frames_.clear();
  outbox_.clear();
  return true;
}

std::uint32_t FaultyPort::dropped() const noexcept { return inner_->dropped() + dropped_; }

}  // namespace wex::can
