#include "hw_interface/socketcan/frame_recorder.hpp"

#include <algorithm>
#include <fstream>

namespace wex::can {

FrameRecorder::FrameRecorder(const RecorderSettings& settings)
    : duration_ns_(static_cast<std::int64_t>(1e9 * settings.duration_s)) {
  WEX_EXPECTS(settings.duration_s > 0.0 && settings.max_frames_per_s > 0.0);
  ring_.resize(static_cast<std::size_t>(settings.duration_s * settings.max_frames_per_s) + 1);
}

void FrameRecorder::record(const CanFrame& frame, std::int64_t time_ns) noexcept {
  if (frozen_) return;
  ring_[next_] = {time_ns, frame};
  if (++next_ == ring_.size()) {
    next_ = 0;
    full_ = true;
  }
}

std::size_t FrameRecorder::size() const noexcept { return full_ ? ring_.size() : next_; }

Result<void> FrameRecorder::write(const std::string& file_name,
                                  const std::string& interface_name) const {
  std::ofstream file(file_name);
  std::string text;
  const std::size_t count = size(), oldest = full_ ? next_ : 0;
  const std::size_t newest = (oldest + count + ring_.size() - 1) % ring_.size();
  for (std::size_t i = 0; i < count; ++i) {
    const LoggedFrame& logged = ring_[(oldest + i) % ring_.size()];
    if (ring_[newest].time_ns - logged.time_ns > duration_ns_) continue;
    text.clear();
    append_line(logged, interface_name, text);
    file << text;
  }
  file.flush();
  if (!file) return fail(ErrorCode::kBadInput, "cannot write the log '" + file_name + "'");
  return {};
}

}  // namespace wex::can
