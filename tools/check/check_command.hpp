#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>

#include "tools/check/plan_checker.hpp"

namespace wex::check {

/// What the user asks of `wex check`.
struct CheckOptions {
  std::filesystem::path folder, map, json;  ///< json: file to write, empty: none
  std::string what = "plan";                ///< plan, refined or executed
  bool all = false;                         ///< also rules that nothing was subject to
};

/// For people: one line per rule with its worst value, limit and place.
[[nodiscard]] std::string check_table(const CheckReport& report, bool all = false);

/// For programs, schema wex-check-1 (README).
[[nodiscard]] std::string check_json(const CheckReport& report);

/// Prints the table and writes the JSON.
///   returns  exit code: 0 accepted, 5 violations
///   errors   kBadInput naming file and line, column or key
[[nodiscard]] Result<int> run_check(const CheckOptions& options, std::ostream& out);

}  // namespace wex::check
