#pragma once

#include <array>
#include <cstdint>

namespace wex::can {

inline constexpr int kMaxPayloadBytes = 64;

/// One frame as it stands on the bus, classic or FD. Plain value. FD frames are sent with bit rate
/// switch (the load table of wex.dbc counts on it).
struct CanFrame {
  std::uint32_t id = 0;  ///< 11 or 29 bits, without flags
  bool extended = false, remote = false, error = false, fd = false;
  std::uint8_t length = 0;  ///< payload bytes, 0..64
  std::array<std::uint8_t, kMaxPayloadBytes> data{};
  std::int64_t kernel_time_ns = 0;  ///< receive time stamp (realtime clock); only differences count
};

}  // namespace wex::can
