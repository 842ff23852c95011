#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hw_interface/socketcan/can_frame.hpp"
#include "models/types/result.hpp"

namespace wex::can {

/// One line of a log as `candump -L` writes it:
///   (1700000000.123456) can0 123##1A0B   FD: two '#', one hex digit of flags, data
///   (1700000000.123456) can0 123#A0B     classic; #R is a remote frame; 8 digits are a 29-bit id
/// Read by canplayer, log2asc and python-can.
struct LoggedFrame {
  std::int64_t time_ns = 0;  ///< realtime clock
  CanFrame frame;
};

/// Appends the line with its end. Microseconds; the interface's name is free.
void append_line(const LoggedFrame& logged, const std::string& interface_name, std::string& text);
/// Error: what is wrong with the line, without its number.
[[nodiscard]] Result<LoggedFrame, std::string> parse_line(const std::string& line);
/// A whole log.
///   errors  kBadInput naming file and line; an empty log too
[[nodiscard]] Result<std::vector<LoggedFrame>> read_candump_log(const std::string& file_name);

}  // namespace wex::can
