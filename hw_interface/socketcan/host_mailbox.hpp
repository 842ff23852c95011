#pragma once

#include <array>
#include <cstdint>

#include "hw_interface/socketcan/codec.hpp"
#include "hw_interface/socketcan/frame_port.hpp"

namespace wex::can {

/// What the host has to say, by id: a newer value replaces one that was not taken yet, so nothing
/// old ever waits for the bus (no queue). Counters go up only with frames that were taken.
/// Noexcept, allocation-free.
class HostMailbox {
 public:
  /// Places, most urgent id first.
  enum Slot { kStop = 0, kHeartbeat = 1, kCommand = 2, kStep = kCommand + kNumZones, kNumSlots };

  /// Encodes with the counter that is due; on error the older value, if any, is dropped as well.
  template <typename Message>
  [[nodiscard]] Result<void, CodecError> put(int slot, const Message& message,
                                             std::uint32_t session) noexcept {
    Entry& entry = entries_[slot];
    SendContext context{session, entry.counter};
    const auto encoded = encode(message, context, entry.frame);
    entry.pending = encoded.has_value();
    entry.next_counter = context.counter;
    return encoded;
  }

  /// Sends in order of urgency until the port takes no more; `on_sent(slot, frame)` for each.
  template <typename OnSent>
  SocketStatus flush(FramePort& port, OnSent on_sent) noexcept {
    for (int slot = 0; slot < kNumSlots; ++slot) {
      Entry& entry = entries_[slot];
      if (!entry.pending) continue;
      const SocketStatus status = port.send(entry.frame);
      if (status != SocketStatus::kOk) return status;
      entry.pending = false;
      entry.sent_counter = entry.counter;
      entry.counter = entry.next_counter;
      on_sent(slot, entry.frame);
    }
    return SocketStatus::kOk;
  }

  /// Forgets what was not taken.
  void clear() noexcept {
    for (Entry& entry : entries_) entry.pending = false;
  }
  /// Of the last frame that was taken.
  [[nodiscard]] std::uint8_t sent_counter(int slot) const noexcept {
    return entries_[slot].sent_counter;
  }

 private:
  struct Entry {
    CanFrame frame;
    bool pending = false;
    std::uint8_t counter = 0, next_counter = 0, sent_counter = 0;
  };
  std::array<Entry, kNumSlots> entries_{};
};

}  // namespace wex::can
