#pragma once

#include <stdexcept>
#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace wex {

/// What the world can say no with. One code per reaction of the caller; the message is one sentence
/// for a person that names the file, line or field and what was expected.
enum class ErrorCode {
  kBadInput,          ///< a file, option or value given by the user is unusable (exit code 2)
  kNoPlan,            ///< the initializer found no feasible plan (exit code 3)
  kRefinementFailed,  ///< the optimizer did not reach a feasible trajectory (exit code 4)
  kStoppedSafely,     ///< a run was ended with the machine standing (exit code 5)
  kOutOfLimits,       ///< the machine tipped or left its limits (exit code 6)
  kInternal           ///< a third-party library or the system failed (exit code 1)
};

struct Error {
  ErrorCode code = ErrorCode::kInternal;
  std::string message;
};

template <typename T, typename E = Error>
using Result = tl::expected<T, E>;

[[nodiscard]] inline tl::unexpected<Error> fail(ErrorCode code, std::string message) {
  return tl::unexpected<Error>(Error{code, std::move(message)});
}

}  // namespace wex

/// Contract check for caller bugs: always on, throws std::logic_error.
#define WEX_EXPECTS(condition)                                                       \
  do {                                                                               \
    if (!(condition)) throw std::logic_error("wex: contract violated: " #condition); \
  } while (false)
