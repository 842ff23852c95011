#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hw_interface/socketcan/candump_log.hpp"

namespace wex::can {

struct RecorderSettings {
  double duration_s = 60.0;
  double max_frames_per_s = 3000.0;  ///< the bus's own limit is about there
};

/// The last frames of the bus, sent and received, in a ring that is laid out once. Recording is
/// noexcept and allocation-free; writing the log is not real-time code.
class FrameRecorder {
 public:
  explicit FrameRecorder(const RecorderSettings& settings = {});

  /// time_ns: realtime; the kernel's stamp of a received frame.
  void record(const CanFrame& frame, std::int64_t time_ns) noexcept;
  /// Keeps what is there: on a fault, so that what led to it is not overwritten.
  void freeze() noexcept { frozen_ = true; }
  void thaw() noexcept { frozen_ = false; }
  [[nodiscard]] bool frozen() const noexcept { return frozen_; }
  [[nodiscard]] std::size_t size() const noexcept;

  /// The last duration_s as a candump log, oldest frame first.
  ///   errors  kBadInput: the file cannot be written
  [[nodiscard]] Result<void> write(const std::string& file_name,
                                   const std::string& interface_name = "can0") const;

 private:
  std::int64_t duration_ns_;
  std::vector<LoggedFrame> ring_;
  std::size_t next_ = 0;
  bool full_ = false, frozen_ = false;
};

}  // namespace wex::can
