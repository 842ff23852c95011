#include "tools/wex/cli_bench.hpp"

#include <map>

#include "tools/bench/kinematics_bench.hpp"
#include "tools/bench/mpc_bench.hpp"
#include "tools/bench/terrain_bench.hpp"
#include "tools/wex/bridge_bench_picture.hpp"
#include "tools/wex/cli_options.hpp"
#include "tools/wex/initializer_bench_picture.hpp"
#include "tools/wex/options.hpp"
#include "tools/wex/output_folder.hpp"

namespace wex::app {
namespace {

void add_initializer_bench(CLI::App& bench, InitializerBenchOptions& options,
                           InitializerComparison& comparison) {
  CLI::App& command = *bench.add_subcommand(
      "initializer",
      "Plans over the twenty cells of terrain and difficulty, checked by others' eyes");
  static const std::map<std::string, InitializerBenchSet> kSets{
      {"cells", InitializerBenchSet::kCells},
      {"hard", InitializerBenchSet::kHard},
      {"beyond", InitializerBenchSet::kBeyond}};
  command
      .add_option("--set", options.set,
                  "cells: the twenty and the side slope; hard: start and goal within 3 m and 90 "
                  "degrees; beyond: larger obstacles than the paper's")
      ->transform(CLI::CheckedTransformer(kSets))
      ->type_name("SET")
      ->default_str("cells");
  static const std::map<std::string, InitializerComparison> kComparisons{
      {"modes", InitializerComparison::kModes}, {"mechanisms", InitializerComparison::kMechanisms}};
  command
      .add_option("--compare", comparison,
                  "Side by side: modes: the default and the paper's; mechanisms: both, whole and "
                  "without each of their mechanisms")
      ->transform(CLI::CheckedTransformer(kComparisons))
      ->type_name("WHAT");
  command.add_option("--seeds", options.seeds, "Seeds per cell")
      ->check(CLI::Range(1, 1000))
      ->type_name("N")
      ->capture_default_str();
  command.add_flag("--quick", options.quick, "Two seeds, one second each");
  command.add_option("--jobs", options.jobs, "Processes")
      ->check(CLI::Range(1, 64))
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--cell", options.cells, "Only cells whose names begin so (repeatable) [all]")
      ->type_name("NAME");
  command.add_option("--out", options.out, "Folder for initializer_bench.csv and pictures")
      ->type_name("DIR")
      ->capture_default_str();
  command.add_option("--time-budget", options.plan.time_budget_s, "CPU seconds per plan")
      ->check(CLI::Range(0.01, 3600.0))
      ->type_name("S")
      ->capture_default_str();
  add_plan_settings(command, options.plan);
}

void add_bridge_bench(CLI::App& bench, BridgeBenchOptions& options) {
  CLI::App& command = *bench.add_subcommand(
      "bridge", "Plans over a gap with a narrow bridge, without and with the stepping penalty");
  command.add_option("--seeds", options.seeds, "Seeds")
      ->check(CLI::Range(1, 1000))
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--stepping-penalty", options.stepping_penalty, "Of the plans that have one")
      ->check(CLI::Range(0.001, 1000.0))
      ->type_name("F")
      ->capture_default_str();
  command.add_option("--time-budget", options.time_budget_s, "CPU seconds per plan")
      ->check(CLI::Range(0.01, 3600.0))
      ->type_name("S")
      ->capture_default_str();
  command.add_option("--out", options.out, "Folder for the plots of the contact schedules")
      ->type_name("DIR")
      ->capture_default_str();
}

int bridge_bench_command(const BridgeBenchOptions& options, std::ostream& out, std::ostream& err) {
  const Result<OutputFolder> folder = OutputFolder::open(options.out);
  if (!folder) return refuse(err, folder.error());
  const Result<BridgeBenchOutcome> outcome = bench_bridge(options, out);
  if (!outcome) return refuse(err, outcome.error());
  if (const auto drawn = draw_bridge_bench(*outcome, options.out); !drawn) {
    return refuse(err, drawn.error());
  }
  return outcome->holds ? 0 : 5;
}

void add_replan_bench(CLI::App& bench, ReplanBenchOptions& options) {
  CLI::App& command = *bench.add_subcommand(
      "replan", "Planning again after 10 m2 of ground changed, beside planning from scratch");
  command.add_option("--seeds", options.seeds, "Seeds per terrain")
      ->check(CLI::Range(1, 1000))
      ->type_name("N")
      ->capture_default_str();
  command.add_flag("--verbose", options.verbose, "A line for every change");
  command.add_option("--time-budget", options.plan.time_budget_s, "CPU seconds per plan")
      ->check(CLI::Range(0.01, 3600.0))
      ->type_name("S")
      ->capture_default_str();
}

int initializer_bench_command(const InitializerBenchOptions& options,
                              InitializerComparison comparison, std::ostream& out,
                              std::ostream& err) {
  if (comparison != InitializerComparison::kNone) {
    const Result<void> compared = compare_initializers(options, comparison, out, err);
    return compared ? 0 : refuse(err, compared.error());
  }
  const Result<InitializerBenchOutcome> outcome = bench_initializer(options, out, err);
  if (!outcome) return refuse(err, outcome.error());
  if (const auto drawn = draw_initializer_bench(*outcome, options.out); !drawn) {
    return refuse(err, drawn.error());
  }
  return outcome->rates_hold ? 0 : 5;
}

}  // namespace

void add_bench(CLI::App& app, BenchOptions& options) {
  DriveBenchOptions& drive = options.drive;
  CanBenchOptions& can = options.can;
  CLI::App& command = *app.add_subcommand("bench", "Measure: medians and percentiles on stdout");
  command.require_subcommand(1);
  command.add_subcommand("terrain", "Terrain layers and queries");
  command.add_subcommand("kinematics", "Kinematics with first and second derivatives");
  command.add_subcommand("mpc", "Refinement and receding-horizon solves");
  CLI::App& bus = *command.add_subcommand(
      "can",
      "The bus: every test of protocol, interface and electronics, with faults, in one table");
  bus.add_flag("--full", can.full, "All of it, about 75 minutes [under 6 minutes]");
  bus.add_option("--only", can.only, "Only these tests (repeatable), the others' rows as they were")
      ->type_name("T1..T22");
  bus.add_option("--out", can.out, "Folder for can_bench.csv and the log")
      ->type_name("DIR")
      ->capture_default_str();
  add_initializer_bench(command, options.initializer, options.comparison);
  add_bridge_bench(command, options.bridge);
  CLI::App& supports = *command.add_subcommand(
      "supports", "Where the machine could only stand on supports that are not planned");
  supports.add_option("--seeds", options.supports.seeds, "Seeds per ground")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  CLI::App& algorithm2 = *command.add_subcommand(
      "algorithm2", "Checks per second of the paper's Algorithm 2, beside the plain loop");
  algorithm2.add_option("--repeats", options.algorithm2.repeats, "Repeats of each")
      ->check(CLI::Range(1, 1000))
      ->type_name("N")
      ->capture_default_str();
  add_replan_bench(command, options.replan);
  CLI::App& roadmaps =
      *command.add_subcommand("roadmap", "Building and loading of limb roadmaps, arm motions");
  roadmaps.add_option("--repeats", options.roadmap.repeats, "Repeats of each")
      ->check(CLI::Range(1, 1000))
      ->type_name("N")
      ->capture_default_str();
  add_machine(roadmaps, options.roadmap.machine);
  CLI::App& drives = *command.add_subcommand(
      "drive", "Whole runs over several terrains and seeds: success counts and worst figures");
  drives.add_option("--seeds", drive.seeds, "Seeds per terrain")
      ->check(CLI::Range(1, 1000))
      ->type_name("N")
      ->capture_default_str();
  drives.add_flag("--quick", drive.quick, "One seed of flat and rough only");
  drives.add_option("--out", drive.out, "Folder for the runs and drive_bench.csv")
      ->type_name("DIR")
      ->capture_default_str();
  drives.add_option("--jobs", drive.jobs, "Runs at a time")
      ->check(CLI::Range(1, 64))
      ->type_name("N")
      ->capture_default_str();
  drives.add_option("--case", drive.cases, "Only these cases (repeatable) [all]")
      ->type_name("NAME");
  drives.add_flag("--resume", drive.resume, "Keep runs whose result.json is there");
  drives.add_option("--map", drive.real_maps, "Real maps instead of the bundled ones (repeatable)")
      ->type_name("MAP");
  drives
      .add_option("--solve-delay", drive.solve_delay,
                  "As in wex run; on a loaded computer, inside User-Mode Linux, milliseconds stand "
                  "for a free one [measured]")
      ->check(parsed_by(parse_solve_delay))
      ->type_name("measured|MS");
  CLI::Option& interface = *drives.add_option(
      "--can", drive.can_interface,
      "Each run as two processes over this CAN interface, one run at a time: judged by the "
      "machine's own log");
  interface.type_name("IFACE")->check(parsed_by(check_interface_name));
  drives.add_flag("--real-time", drive.real_time, "On the bus: the machine's clock does not wait")
      ->needs(&interface);
}

int bench_command(const CLI::App& command, const BenchOptions& options, std::ostream& out,
                  std::ostream& err) {
  const std::string name = command.get_subcommands().front()->get_name();
  if (name == "terrain") return bench_terrain();
  if (name == "kinematics") return bench_kinematics();
  if (name == "mpc") return bench_mpc();
  if (name == "initializer") {
    return initializer_bench_command(options.initializer, options.comparison, out, err);
  }
  if (name == "bridge") return bridge_bench_command(options.bridge, out, err);
  if (name == "supports") {
    const Result<void> done = bench_supports(options.supports, out);
    return done ? 0 : refuse(err, done.error());
  }
  if (name == "algorithm2") {
    const Result<void> done = bench_algorithm2(options.algorithm2, out);
    return done ? 0 : refuse(err, done.error());
  }
  if (name == "replan") {
    const Result<void> done = bench_replan(options.replan, out);
    return done ? 0 : refuse(err, done.error());
  }
  if (name == "roadmap") {
    const Result<void> done = bench_roadmap(options.roadmap, out);
    return done ? 0 : refuse(err, done.error());
  }
  const Result<int> code =
      name == "can" ? bench_can(options.can, out, err) : bench_drive(options.drive, out, err);
  return code ? *code : refuse(err, code.error());
}

}  // namespace wex::app
