#pragma once

#include <ostream>

namespace wex::app {

/// The whole program but for process start: parses, dispatches, reports.
///   out, err  results and help; progress and the one sentence of an error
///   returns   the exit code (decisions: 0 goal reached ... 6 tipped)
[[nodiscard]] int run_cli(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

}  // namespace wex::app
