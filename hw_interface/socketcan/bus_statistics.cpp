#include "hw_interface/socketcan/bus_statistics.hpp"

#include <algorithm>
#include <cmath>

namespace wex::can {

void LatencyHistogram::add(double duration_s) noexcept {
  const double duration_ms = 1e3 * duration_s;
  const auto* edge = std::lower_bound(kEdges_ms.begin(), kEdges_ms.end(), duration_ms);
  ++bins_[static_cast<std::size_t>(edge - kEdges_ms.begin())];
  ++count_;
  max_ms_ = std::max(max_ms_, duration_ms);
}

double LatencyHistogram::percentile_ms(double share) const noexcept {
  const double wanted = share * static_cast<double>(count_);
  long below = 0;
  for (std::size_t i = 0; i < kEdges_ms.size(); ++i) {
    below += bins_[i];
    if (static_cast<double>(below) >= wanted) return std::min(kEdges_ms[i], max_ms_);
  }
  return max_ms_;
}

double bus_time_s(const CanFrame& frame) noexcept {
  constexpr double kArbitrationBit_s = 1.0 / 500e3, kDataBit_s = 1.0 / 2e6;
  const double payload_bits = 8.0 * frame.length;
  if (!frame.fd) {
    // 34 + data bits are subject to stuffing (one in four after the first), 13 are not.
    const double stuffed = 34.0 + (frame.remote ? 0.0 : payload_bits);
    return (stuffed + std::floor((stuffed - 1.0) / 4.0) + 13.0) * kArbitrationBit_s;
  }
  // Slow: start, id, flags up to the rate switch (17 with at most 4 stuff bits), then CRC
  // delimiter, acknowledge, end of frame and the gap (13). Fast: error state and length (5), data
  // with their stuff bits, stuff count (4), CRC with its fixed stuff bits.
  constexpr double kSlowBits = 17.0 + 4.0 + 13.0;
  const double crc_bits = frame.length > 16 ? 21.0 + 6.0 : 17.0 + 5.0;
  const double fast_bits = (5.0 + payload_bits) * 1.25 + 4.0 + crc_bits;
  return kSlowBits * kArbitrationBit_s + fast_bits * kDataBit_s;
}

const char* name_of(MessageKind kind) noexcept {
  switch (kind) {
    case MessageKind::kEStopState:
      return "EStopState";
    case MessageKind::kHostStop:
      return "HostStop";
    case MessageKind::kOperatorCommand:
      return "OperatorCommand";
    case MessageKind::kHostHeartbeat:
      return "HostHeartbeat";
    case MessageKind::kZoneCommand:
      return "ZoneCommand";
    case MessageKind::kZoneFeedback:
      return "ZoneFeedback";
    case MessageKind::kZonePressure:
      return "ZonePressure";
    case MessageKind::kImu:
      return "Imu";
    case MessageKind::kBasePose:
      return "BasePose";
    case MessageKind::kZoneStatus:
      return "ZoneStatus";
    case MessageKind::kLockStep:
      return "LockStep";
    case MessageKind::kUnknown:
      break;
  }
  return "unknown";
}

long BusStatistics::frames_sent() const noexcept {
  long sum = 0;
  for (const Message& message : messages) sum += message.sent;
  return sum;
}
long BusStatistics::frames_received() const noexcept {
  long sum = 0;
  for (const Message& message : messages) sum += message.received;
  return sum;
}
long BusStatistics::frames_lost() const noexcept {
  long sum = 0;
  for (const Message& message : messages) sum += message.lost;
  return sum;
}

}  // namespace wex::can
