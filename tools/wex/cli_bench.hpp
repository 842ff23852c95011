#pragma once

#include <CLI/CLI.hpp>
#include <ostream>

#include "tools/bench/algorithm2_bench.hpp"
#include "tools/bench/bridge_bench.hpp"
#include "tools/bench/can_bench.hpp"
#include "tools/bench/drive_bench.hpp"
#include "tools/bench/initializer_bench.hpp"
#include "tools/bench/initializer_comparison.hpp"
#include "tools/bench/replan_bench.hpp"
#include "tools/bench/roadmap_bench.hpp"
#include "tools/bench/supports_bench.hpp"

namespace wex::app {

/// What the parser fills for `wex bench`.
struct BenchOptions {
  DriveBenchOptions drive;
  CanBenchOptions can;
  InitializerBenchOptions initializer;
  InitializerComparison comparison = InitializerComparison::kNone;
  ReplanBenchOptions replan;
  RoadmapBenchOptions roadmap;
  Algorithm2BenchOptions algorithm2;
  SupportsBenchOptions supports;
  BridgeBenchOptions bridge;
};

/// Adds `bench` and its subcommands.
void add_bench(CLI::App& app, BenchOptions& options);

/// Runs the subcommand that was parsed.
///   returns  the exit code: 5 where a demanded rate is missed
int bench_command(const CLI::App& command, const BenchOptions& options, std::ostream& out,
                  std::ostream& err);

}  // namespace wex::app
