#pragma once

#include <chrono>
#include <ostream>
#include <string>

namespace wex::app {

/// Progress for a person on a stream (stderr): a line every `kPeriod` while a stage lasts, and one
/// at its end if it lasted that long. Short stages and quiet runs say nothing.
class Progress {
 public:
  Progress(std::ostream& stream, bool quiet);
  void begin(const std::string& stage);
  void update(const std::string& text);
  void end(const std::string& text);

 private:
  static constexpr std::chrono::seconds kPeriod{2};
  using Clock = std::chrono::steady_clock;
  void line(const std::string& text);

  std::ostream* stream_;
  bool quiet_;
  std::string stage_;
  Clock::time_point run_begin_, stage_begin_, last_line_;
};

}  // namespace wex::app
