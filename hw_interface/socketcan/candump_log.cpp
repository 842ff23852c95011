#include "hw_interface/socketcan/candump_log.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <string_view>

namespace wex::can {
namespace {

constexpr std::uint32_t kMaxStandardId = 0x7FF;
constexpr std::uint32_t kErrorFlag = 0x20000000;  // as in the log, with 8 digits
constexpr std::size_t kMaxClassicBytes = 8;
constexpr int kBitRateSwitch = 1;
constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

int hex_value(char digit) {
  if (digit >= '0' && digit <= '9') return digit - '0';
  if (digit >= 'A' && digit <= 'F') return digit - 'A' + 10;
  if (digit >= 'a' && digit <= 'f') return digit - 'a' + 10;
  return -1;
}

bool parse_number(std::string_view text, int base, std::int64_t& value) {
  value = 0;
  for (const char c : text) {
    const int digit = hex_value(c);
    if (digit < 0 || digit >= base) return false;
    value = value * base + digit;
  }
  return !text.empty() && text.size() <= 15;
}

bool parse_data(std::string_view text, CanFrame& frame, std::size_t max_bytes) {
  if (text.size() % 2 != 0 || text.size() / 2 > max_bytes) return false;
  frame.length = static_cast<std::uint8_t>(text.size() / 2);
  for (std::size_t i = 0; i < frame.length; ++i) {
    const int high = hex_value(text[2 * i]), low = hex_value(text[2 * i + 1]);
    if (high < 0 || low < 0) return false;
    frame.data[i] = static_cast<std::uint8_t>(16 * high + low);
  }
  return true;
}

bool parse_time(std::string_view text, std::int64_t& time_ns) {
  const std::size_t point = text.find('.');
  std::int64_t seconds = 0, micro = 0;
  constexpr std::size_t kMicroDigits = 6;
  if (point == std::string_view::npos || text.size() - point - 1 != kMicroDigits ||
      !parse_number(text.substr(0, point), 10, seconds) ||
      !parse_number(text.substr(point + 1), 10, micro) || point > 10) {
    return false;
  }
  time_ns = seconds * kNanosecondsPerSecond + micro * 1000;
  return true;
}

/// ID#DATA, ID#R or ID##<flags>DATA.
bool parse_frame(std::string_view text, CanFrame& frame) {
  const std::size_t mark = text.find('#');
  std::int64_t id = 0;
  if ((mark != 3 && mark != 8) || !parse_number(text.substr(0, mark), 16, id)) return false;
  frame.extended = mark == 8 && (id & kErrorFlag) == 0;
  frame.error = mark == 8 && (id & kErrorFlag) != 0;
  frame.id = static_cast<std::uint32_t>(id) & 0x1FFFFFFF;
  if (mark == 3 && frame.id > kMaxStandardId) return false;
  std::string_view rest = text.substr(mark + 1);
  if (!rest.empty() && rest.front() == '#') {
    if (rest.size() < 2 || hex_value(rest[1]) < 0) return false;
    frame.fd = true;
    return parse_data(rest.substr(2), frame, kMaxPayloadBytes);
  }
  if (!rest.empty() && rest.front() == 'R') {
    frame.remote = true;
    return rest.size() == 1 || (rest.size() == 2 && hex_value(rest[1]) >= 0);
  }
  return parse_data(rest, frame, kMaxClassicBytes);
}

}  // namespace

void append_line(const LoggedFrame& logged, const std::string& interface_name, std::string& text) {
  const CanFrame& frame = logged.frame;
  char buffer[48];
  std::snprintf(buffer, sizeof(buffer), "(%010lld.%06lld) ",
                static_cast<long long>(logged.time_ns / kNanosecondsPerSecond),
                static_cast<long long>(logged.time_ns % kNanosecondsPerSecond / 1000));
  text += buffer;
  text += interface_name;
  const bool wide = frame.extended || frame.error;
  std::snprintf(buffer, sizeof(buffer), wide ? " %08X#" : " %03X#",
                frame.id | (frame.error ? kErrorFlag : 0U));
  text += buffer;
  if (frame.fd) {
    text += '#';
    text += static_cast<char>('0' + kBitRateSwitch);
  }
  if (frame.remote) {
    text += 'R';
  } else {
    constexpr char kDigits[] = "0123456789ABCDEF";
    for (int i = 0; i < frame.length; ++i) {
      text += kDigits[frame.data[i] >> 4];
      text += kDigits[frame.data[i] & 0xF];
    }
  }
  text += '\n';
}

Result<LoggedFrame, std::string> parse_line(const std::string& line) {
  const auto refuse = [](const char* what) { return tl::unexpected<std::string>(what); };
  std::string_view rest = line;
  while (!rest.empty() && (rest.back() == '\r' || rest.back() == ' ')) rest.remove_suffix(1);
  // candump may add a direction (R or T) as a last word.
  if (rest.size() > 2 && rest[rest.size() - 2] == ' ' &&
      (rest.back() == 'R' || rest.back() == 'T')) {
    rest.remove_suffix(2);
  }
  LoggedFrame logged;
  const std::size_t close = rest.find(") ");
  if (rest.empty() || rest.front() != '(' || close == std::string_view::npos ||
      !parse_time(rest.substr(1, close - 1), logged.time_ns)) {
    return refuse("expected a time such as (1700000000.123456)");
  }
  rest.remove_prefix(close + 2);
  const std::size_t space = rest.find(' ');
  if (space == 0 || space == std::string_view::npos) return refuse("expected an interface name");
  if (!parse_frame(rest.substr(space + 1), logged.frame)) {
    return refuse("expected a frame such as 123#00FF or 123##100FF");
  }
  logged.frame.kernel_time_ns = logged.time_ns;
  return logged;
}

Result<std::vector<LoggedFrame>> read_candump_log(const std::string& file_name) {
  std::ifstream file(file_name);
  if (!file) return fail(ErrorCode::kBadInput, "cannot read the log '" + file_name + "'");
  std::vector<LoggedFrame> frames;
  std::string line;
  for (long number = 1; std::getline(file, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    auto logged = parse_line(line);
    if (!logged) {
      return fail(ErrorCode::kBadInput,
                  file_name + ", line " + std::to_string(number) + ": " + logged.error());
    }
    frames.push_back(*logged);
  }
  if (frames.empty()) {
    return fail(ErrorCode::kBadInput, "the log '" + file_name + "' holds no frame");
  }
  return frames;
}

}  // namespace wex::can
