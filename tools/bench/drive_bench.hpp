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
  std::string can_interface;  ///< a machine of its own process on this bus; empty: the simulation
  std::string solve_delay;    ///< of wex run, such as "30"; empty: measured
  bool real_time = false;     ///< on the bus: the machine's clock does not wait
};

/// Runs the main job over synthetic terrains and a real map, several seeds each, as processes of
/// this program, and prints a row of successes and worst figures per case. Every run keeps its
/// folder out/CASE/seed_N; out/drive_bench.csv has one row per run. On a CAN bus each run is two
/// processes, one run at a time, and the machine's own log has the last word.
///   returns  0 if every run reached its goal, else 5
///   errors   kBadInput: unknown case, unreadable map, unwritable folder; kInternal: no process
[[nodiscard]] Result<int> bench_drive(const DriveBenchOptions& options, std::ostream& out,
                                      std::ostream& err);

}  // namespace wex
