#include "tools/wex/progress.hpp"

#include <cstdio>

namespace wex::app {

Progress::Progress(std::ostream& stream, bool quiet)
    : stream_(&stream),
      quiet_(quiet),
      run_begin_(Clock::now()),
      stage_begin_(run_begin_),
      last_line_(run_begin_) {}

void Progress::begin(const std::string& stage) {
  stage_ = stage;
  stage_begin_ = last_line_ = Clock::now();
}

void Progress::update(const std::string& text) {
  if (Clock::now() - last_line_ >= kPeriod) line(text);
}

void Progress::end(const std::string& text) {
  if (Clock::now() - stage_begin_ >= kPeriod) line(text);
}

void Progress::line(const std::string& text) {
  last_line_ = Clock::now();
  if (quiet_) return;
  char clock[32];
  std::snprintf(clock, sizeof(clock), "[%5.0f s] ",
                std::chrono::duration<double>(last_line_ - run_begin_).count());
  *stream_ << clock << stage_ << ": " << text << std::endl;
}

}  // namespace wex::app
