#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "hw_interface/socketcan/codec.hpp"
#include "hw_interface/socketcan/protection.hpp"

namespace wex::app {

/// Everything that is heard on a bus, by id: a bystander that takes no side and sends nothing.
/// Times are of one monotonic clock.
class BusMonitor {
 public:
  void take(const can::CanFrame& frame, std::int64_t now_ns);

  [[nodiscard]] long frames() const noexcept { return frames_; }
  /// One head line, then one line per id: name, rate, age, losses, CRC errors, last values.
  ///   dropped    frames that the kernel had no room for
  ///   max_width  longer lines are cut (a terminal's columns); 0: never
  [[nodiscard]] std::string table(std::int64_t now_ns, std::uint32_t dropped,
                                  std::size_t max_width = 0);
  /// The same as one JSON object on one line.
  [[nodiscard]] std::string json(std::int64_t now_ns, std::uint32_t dropped);

 private:
  /// Rate over the last whole second.
  struct Rate {
    double sum = 0.0, last_second = 0.0;
  };
  struct Entry {
    can::CanFrame last;
    std::int64_t last_ns = 0;
    long frames = 0, crc_errors = 0, refused = 0;
    Rate rate;
    can::SequenceCheck sequence{can::SequenceCheck::Settings{}};
  };

  [[nodiscard]] std::uint32_t session_of(const can::CanFrame& frame) const;
  void roll(std::int64_t now_ns);

  std::map<std::uint32_t, Entry> entries_;  ///< by id, 29-bit ones after all others
  std::uint32_t session_ = 0;               ///< that the machine reports
  long frames_ = 0, error_frames_ = 0, foreign_ = 0;
  Rate load_, frame_rate_;
  std::int64_t second_begin_ns_ = 0;
};

}  // namespace wex::app
