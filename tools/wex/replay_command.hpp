#pragma once

#include <filesystem>
#include <ostream>
#include <string>

#include "models/types/result.hpp"

namespace wex::app {

/// What the user asks of `wex replay`.
struct ReplayOptions {
  std::filesystem::path log;  ///< candump -L, such as bus.log of a run
  std::filesystem::path map;  ///< checks that the machine stands on it; empty: none
  std::filesystem::path out;  ///< folder for executed.csv; empty: none
  std::string machine = "m545";
};

/// Feeds a recorded bus through the decoder of a live one and tells what the machine did.
///   errors  kBadInput: file, line, a log without the whole machine, a machine off the map
[[nodiscard]] Result<void> run_replay(const ReplayOptions& options, std::ostream& out);

}  // namespace wex::app
