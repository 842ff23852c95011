#pragma once

#include <array>
#include <cstdint>

#include "hw_interface/socketcan/messages.hpp"

namespace wex::can {

/// Keeps the newest accepted command of every zone (never a queue) until it runs out.
class CommandWatchdog {
 public:
  /// now_ms: when it was received; it lasts until its echo time plus valid_for_ms.
  void accept(const ZoneCommand& command, std::int64_t now_ms) noexcept {
    // The echo is at most milliseconds old (judged before); 32 bits wrap, differences do not.
    const auto age_ms =
        static_cast<std::int32_t>(static_cast<std::uint32_t>(now_ms) - command.echo_time_ms);
    Entry& entry = entries_[static_cast<std::size_t>(command.zone)];
    entry = {command, now_ms - age_ms + command.valid_for_ms, true};
  }
  /// The command in force; nullptr: none, the zone holds.
  [[nodiscard]] const ZoneCommand* in_force(int zone, std::int64_t now_ms) const noexcept {
    const Entry& entry = entries_[static_cast<std::size_t>(zone)];
    return entry.given && now_ms <= entry.until_ms ? &entry.command : nullptr;
  }
  void clear() noexcept { entries_.fill(Entry{}); }

 private:
  struct Entry {
    ZoneCommand command;
    std::int64_t until_ms = 0;
    bool given = false;
  };
  std::array<Entry, kNumZones> entries_{};
};

}  // namespace wex::can
