#pragma once

#include <string>
#include <vector>

#include "tools/bench/can_bench_parts.hpp"

namespace wex {

struct CanBenchRow {
  std::string test, what, figure, gate;
  bool passed = false;
};

/// The rows that a program's output and exit code make. A test that the program should have spoken
/// of and did not is a failed row "not run: why".
[[nodiscard]] std::vector<CanBenchRow> can_bench_rows(const CanBenchPart& part,
                                                      const std::string& output, int exit_code);

/// For a terminal: one block per row, the figure wrapped below what was measured.
[[nodiscard]] std::string can_bench_table(const std::vector<CanBenchRow>& rows);
[[nodiscard]] std::string can_bench_csv(const std::vector<CanBenchRow>& rows);
/// What can_bench_csv wrote; lines of anything else are left out.
[[nodiscard]] std::vector<CanBenchRow> can_bench_rows_of_csv(const std::string& csv);
/// T1 to T22; rows of one test stay in their order.
void sort_by_test(std::vector<CanBenchRow>& rows);

}  // namespace wex
