#include "tools/wex/options.hpp"

#include <charconv>
#include <cmath>
#include <vector>

namespace wex::app {
namespace {

/// A finite number that fills the whole text; nullopt for anything else.
std::optional<double> parse_number(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  if (!std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

Result<Pose2> parse_pose(const std::string& text) {
  std::vector<double> values;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const auto value = parse_number(std::string_view(text).substr(begin, end - begin));
    if (!value) {
      return fail(ErrorCode::kBadInput,
                  "'" + text + "' is not X,Y,YAW: three finite numbers in metres, metres, radians");
    }
    values.push_back(*value);
    begin = end + 1;
  }
  if (values.size() != 3) {
    return fail(ErrorCode::kBadInput, "'" + text + "' has " + std::to_string(values.size()) +
                                          " numbers where X,Y,YAW has three");
  }
  return Pose2{values[0], values[1], values[2]};
}

Result<std::optional<double>> parse_solve_delay(const std::string& text) {
  if (text == "measured") return std::optional<double>{};
  const auto milliseconds = parse_number(text);
  if (!milliseconds || *milliseconds < 0.0 || *milliseconds > 2000.0) {
    return fail(ErrorCode::kBadInput,
                "'" + text + "' is neither 'measured' nor milliseconds between 0 and 2000");
  }
  return std::optional<double>{*milliseconds * 1e-3};
}

Result<void> check_interface_name(const std::string& text) {
  constexpr std::size_t kLongest = 15;
  const bool allowed = !text.empty() && text.size() <= kLongest && text != "." && text != ".." &&
                       text.find_first_of("/ \t\n:") == std::string::npos;
  if (allowed) return {};
  return fail(ErrorCode::kBadInput, "'" + text +
                                        "' is no name of a network interface: expected 1 to 15 "
                                        "characters such as can0");
}

int exit_code(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::kBadInput:
      return 2;
    case ErrorCode::kNoPlan:
      return 3;
    case ErrorCode::kRefinementFailed:
      return 4;
    case ErrorCode::kStoppedSafely:
      return 5;
    case ErrorCode::kOutOfLimits:
      return 6;
    case ErrorCode::kInternal:
      return 1;
  }
  return 1;
}

}  // namespace wex::app
