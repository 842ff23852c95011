#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace wex {

/// How what a program prints becomes rows of the table.
enum class CanBenchOutput {
  kFigures,     ///< FIGURE lines (tools/bench/can_faults/figures.hpp), one row each
  kGoogleTest,  ///< one row: its own lines, or how many tests passed
  kScript       ///< one row: its last line, judged by the exit code
};

/// One program of the bench.
struct CanBenchPart {
  std::string test;  ///< "T4"; of kFigures: all that it must speak of, "T6 T7"
  std::string what, gate;
  CanBenchOutput output = CanBenchOutput::kGoogleTest;
  std::vector<std::string> command;
  std::vector<std::string> environment;  ///< NAME=value
  int timeout_s = 300;
};

struct CanBenchSetting {
  bool full = false;
  bool real_time = true;          ///< real-time priority may be had
  std::vector<std::string> only;  ///< "T6"; empty: all
  std::filesystem::path build;    ///< folder with the tests' programs below
  std::filesystem::path source;   ///< of the tree
};

/// What the bench consists of.
[[nodiscard]] std::vector<CanBenchPart> can_bench_parts(const CanBenchSetting& setting);

}  // namespace wex
