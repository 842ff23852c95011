#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/bench/initializer_bench.hpp"

namespace wex {

/// The value below which a share of some values lies, linear between two of them; NaN for none.
[[nodiscard]] double percentile(std::vector<double> values, double share);

[[nodiscard]] std::string initializer_table(const std::vector<InitializerCell>& cells,
                                            const std::vector<InitializerRow>& rows);
[[nodiscard]] std::string initializer_csv(const std::vector<InitializerRow>& rows);
/// A line of the CSV, and back; nullopt if it is none.
[[nodiscard]] std::string csv_line(const InitializerRow& row);
[[nodiscard]] std::optional<InitializerRow> row_of(const std::string& csv_line);

/// Does every demanded rate hold: 95 % pooled, 80 % in each judged cell?
[[nodiscard]] bool rates_hold(const std::vector<InitializerCell>& cells,
                              const std::vector<InitializerRow>& rows);

}  // namespace wex
