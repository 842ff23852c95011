#pragma once

#include <array>
#include <cstdint>

#include "hw_interface/socketcan/codec.hpp"

namespace wex::can {

/// How long something took, in fixed bins. Allocation-free.
class LatencyHistogram {
 public:
  /// Upper edges of the bins; the last bin has none.
  static constexpr std::array<double, 14> kEdges_ms{0.1, 0.2, 0.5, 1,  2,  3,  5,
                                                    8,   10,  15,  20, 30, 50, 100};
  static constexpr int kNumBins = static_cast<int>(kEdges_ms.size()) + 1;

  void add(double duration_s) noexcept;
  [[nodiscard]] long count() const noexcept { return count_; }
  [[nodiscard]] const std::array<long, kNumBins>& bins() const noexcept { return bins_; }
  [[nodiscard]] double max_ms() const noexcept { return max_ms_; }
  /// Upper edge of the bin that a share of 0..1 of all durations stays below (max_ms in the last).
  [[nodiscard]] double percentile_ms(double share) const noexcept;

 private:
  std::array<long, kNumBins> bins_{};
  long count_ = 0;
  double max_ms_ = 0.0;
};

/// Time that a frame occupies the bus, worst case of stuff bits: 11-bit id, 500 kbit/s and for the
/// data of FD frames 2 Mbit/s.
[[nodiscard]] double bus_time_s(const CanFrame& frame) noexcept;

inline constexpr int kNumMessageKinds = static_cast<int>(MessageKind::kUnknown) + 1;
/// For reports and logs.
[[nodiscard]] const char* name_of(MessageKind kind) noexcept;

/// What the host saw of the bus, for reports. Plain values.
struct BusStatistics {
  struct Message {
    long sent = 0, received = 0;
    long lost = 0;  ///< missing by counter
  };
  std::array<Message, kNumMessageKinds> messages{};  ///< by MessageKind
  long repeated = 0, wrong_sequence = 0, crc_errors = 0, malformed = 0, unknown = 0;
  long own_ids = 0, error_frames = 0;
  long receive_overflows = 0;  ///< frames the kernel dropped for want of room
  long not_taken = 0;          ///< send calls refused for want of room
  long stalls = 0, purges = 0, reopens = 0;
  long holds = 0;  ///< within a session that nobody asked for: false ones on a healthy bus
  long faults = 0, rates_limited = 0, refused_by_codec = 0;
  double busy_s = 0.0;        ///< time that all frames occupied the bus, likewise an estimate
  double bus_load = 0.0;      ///< mean share of the time; an estimate, worst case of stuff bits
  double max_bus_load = 0.0;  ///< busiest second
  double max_feedback_age_s = 0.0, max_status_age_s = 0.0;  ///< within a session
  /// Command given to the bus -> the machine's report that it was accepted, as received here.
  LatencyHistogram command_to_report;

  [[nodiscard]] Message& of(MessageKind kind) noexcept {
    return messages[static_cast<std::size_t>(kind)];
  }
  [[nodiscard]] const Message& of(MessageKind kind) const noexcept {
    return messages[static_cast<std::size_t>(kind)];
  }
  [[nodiscard]] long frames_sent() const noexcept;
  [[nodiscard]] long frames_received() const noexcept;
  [[nodiscard]] long frames_lost() const noexcept;
};

}  // namespace wex::can
