#pragma once

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "models/types/result.hpp"

namespace wex {

struct DriveBenchOptions {
  int seeds = 5;       ///< per case
  bool quick = false;  ///< one seed of flat and of rough 0
  std::filesystem::path out = "out/drive_bench";
  int jobs = 2;                                  ///< runs at a time, each a process of its own
  bool resume = false;                           ///< keep runs whose result.json is there
  std::vector<std::string> cases;                ///< only these; empty: all
  std::vector<std::filesystem::path> real_maps;  ///< empty: the bundled one
};

/// Runs the main job over synthetic terrains and a real map, several seeds each, as processes of
/// this program, and prints a row of successes and worst figures per case. Every run keeps its
/// folder out/CASE/seed_N; out/drive_bench.csv has one row per run.
///   returns  0 if every run reached its goal, else 5
///   errors   kBadInput: unknown case, unreadable map, unwritable folder; kInternal: no process
[[nodiscard]] Result<int> bench_drive(const DriveBenchOptions& options, std::ostream& out,
                                      std::ostream& err);

}  // namespace wex
