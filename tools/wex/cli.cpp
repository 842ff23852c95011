#include "tools/wex/cli.hpp"

#include <CLI/CLI.hpp>

#include "models/excavator/mjcf.hpp"
#include "models/terrain/synthetic.hpp"
#include "tools/check/check_command.hpp"
#include "tools/wex/can_command.hpp"
#include "tools/wex/cli_bench.hpp"
#include "tools/wex/cli_options.hpp"
#include "tools/wex/machine_command.hpp"
#include "tools/wex/output_folder.hpp"
#include "tools/wex/pipeline.hpp"
#include "tools/wex/replay_command.hpp"
#include "tools/wex/roadmap_command.hpp"

namespace wex::app {
namespace {

struct TerrainOptions {
  std::string kind;
  double difficulty = 0.0;
  std::uint64_t seed = 1;
  std::filesystem::path out;
};

struct ModelOptions {
  std::filesystem::path mjcf;
  std::string machine = "m545";
};

/// Everything the parser fills.
struct Options {
  RunOptions run;
  bool quiet = false;
  TerrainOptions terrain;
  ModelOptions model;
  BenchOptions bench;
  MachineOptions can_machine;
  CanOptions can;
  ReplayOptions replay;
  check::CheckOptions check;
  RoadmapOptions roadmap;
};

void add_pose(CLI::App& command, const char* name, std::optional<Pose2>& pose, const char* help) {
  command
      .add_option_function<std::string>(
          name, [&pose](const std::string& text) { pose = *parse_pose(text); }, help)
      ->check(parsed_by(parse_pose))
      ->type_name("X,Y,YAW");
}

void add_planning(CLI::App& command, Options& options) {
  RunOptions& run = options.run;
  command
      .add_option("map", run.map,
                  "Elevation map: ESRI ASCII grid, GeoTIFF or what else GDAL reads; metres, no CRS "
                  "or a metric one")
      ->type_name("MAP")
      ->required();
  add_pose(command, "--start", run.start,
           "Start of the base in the map's frame: metres, metres, radians [the JSON beside MAP]");
  add_pose(command, "--goal", run.goal, "Goal, likewise [the JSON beside MAP]");
  command.add_option("--seed", run.seed, "Seed of the planner")
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--out", run.out, "Folder for results and pictures")
      ->type_name("DIR")
      ->capture_default_str();
  command
      .add_option_function<int>(
          "--iterations", [&run](int n) { run.iterations = n; },
          "Planner iterations instead of a time budget: the same seed gives the same plan")
      ->check(CLI::Range(1, 100'000'000))
      ->type_name("N");
  command.add_option("--time-budget", run.time_budget_s, "CPU seconds for the planner's search")
      ->check(CLI::Range(0.01, 3600.0))
      ->type_name("S")
      ->capture_default_str();
  add_machine(command, run.machine);
  command.add_flag("--quiet", options.quiet, "No progress on stderr");
}

void add_run(CLI::App& app, Options& options) {
  CLI::App& command =
      *app.add_subcommand("run", "Plan, refine, drive in the simulation and report");
  command.footer(
      "Writes result.json, plan.csv, refined.csv, executed.csv, model.xml, overview.png,\n"
      "timeline.png and frames/ to DIR. Exit codes: 0 goal reached, 1 internal error, 2 bad "
      "input,\n"
      "3 no plan, 4 refinement failed, 5 stopped safely, 6 tipped or out of limits.");
  add_planning(command, options);
  RunOptions& run = options.run;
  command
      .add_option_function<std::string>(
          "--solve-delay",
          [&run](const std::string& text) { run.solve_delay_s = *parse_solve_delay(text); },
          "Delay after which an optimizer's result takes effect: 'measured' CPU time, or "
          "milliseconds for a repeatable run [measured]")
      ->check(parsed_by(parse_solve_delay))
      ->type_name("measured|MS");
  command.add_option("--frames", run.frames, "Pictures rendered off screen, evenly over the drive")
      ->check(CLI::Range(0, 99))
      ->type_name("N")
      ->capture_default_str();
  CLI::Option& can = *command.add_option("--can", run.can_interface,
                                         "Drive the machine on this CAN interface, from where it "
                                         "stands, instead of the simulation");
  can.type_name("IFACE")->check(parsed_by(check_interface_name));
  const auto add_pace = [&](const char* name, CanPace pace, const char* help) {
    return command.add_flag_callback(
                      name, [&run, pace] { run.can_pace = pace; }, help)
        ->needs(&can);
  };
  CLI::Option* lock_step = add_pace("--lock-step", CanPace::kLockStep,
                                    "The machine's clock waits [as the machine announces]");
  add_pace("--real-time", CanPace::kRealTime, "The machine's clock does not wait")
      ->excludes(lock_step);
}

void add_plan(CLI::App& app, Options& options) {
  CLI::App& command = *app.add_subcommand("plan", "Plan only: plan.csv, overview.png, result.json");
  command.footer("Exit codes: 0 plan made, 1 internal error, 2 bad input, 3 no plan.");
  add_planning(command, options);
  add_plan_settings(command, options.run.planning);
}

void add_terrain(CLI::App& app, TerrainOptions& terrain) {
  CLI::App& command = *app.add_subcommand(
      "terrain", "Write a synthetic terrain and, beside it, the JSON with start and goal");
  std::string kinds;
  for (const std::string& kind : synthetic_kinds()) kinds += (kinds.empty() ? "" : ", ") + kind;
  command.add_option("kind", terrain.kind, "One of " + kinds)->type_name("KIND")->required();
  command
      .add_option("--difficulty", terrain.difficulty,
                  "0 to 1: rough +-0.25 to +-2 m, gap 1 to 3.5 m, step 0.5 to 1.5 m; the others "
                  "have one level")
      ->type_name("D")
      ->capture_default_str();
  command.add_option("--seed", terrain.seed, "Seed of terrain, start and goal")
      ->type_name("S")
      ->capture_default_str();
  command.add_option("--out", terrain.out, "ESRI ASCII grid to write")
      ->type_name("FILE")
      ->required();
}

void add_model(CLI::App& app, ModelOptions& model) {
  CLI::App& command =
      *app.add_subcommand("model", "Write the machine's MuJoCo model (the machine alone)");
  command.add_option("--mjcf", model.mjcf, "File to write")->type_name("FILE")->required();
  add_machine(command, model.machine);
}

void add_can_machine(CLI::App& app, MachineOptions& machine) {
  CLI::App& command = *app.add_subcommand(
      "machine", "Be the machine at the other end of a CAN bus (simulated), until it is ended");
  command.footer(
      "Speaks wex.dbc from the electronics' side: own automaton, limits and time-outs, MuJoCo "
      "behind\nthem. --log is the truth by which a run is judged. Ended by SIGTERM or Ctrl-C.");
  command.add_option("map", machine.map, "Elevation map to stand on [flat ground]")
      ->type_name("MAP");
  command.add_option("--can", machine.can_interface, "CAN interface, such as vcan0")
      ->type_name("IFACE")
      ->required();
  add_pose(command, "--start", machine.start,
           "Where it stands, in the map's frame [the JSON beside MAP; 0,0,0 on flat ground]");
  CLI::Option* lock_step =
      command.add_flag("--lock-step", machine.lock_step,
                       "The clock goes on as the host's LockStep frames let it (functional tests)");
  command
      .add_option("--patience", machine.patience_s,
                  "How long the clock of an enabled machine waits for LockStep frames before it "
                  "runs by itself, so that time-outs bite")
      ->needs(lock_step)
      ->check(CLI::Range(0.1, 600.0))
      ->type_name("S")
      ->capture_default_str();
  command.add_option("--log", machine.log, "CSV of the machine's own truth, 100 Hz")
      ->type_name("FILE");
  command
      .add_option_function<double>(
          "--estop-after", [&machine](double s) { machine.estop_after_s = s; },
          "Open the e-stop chain after S seconds of machine time")
      ->check(CLI::NonNegativeNumber)
      ->type_name("S");
  command
      .add_option_function<double>(
          "--exit-after", [&machine](double s) { machine.exit_after_s = s; },
          "End after S seconds of machine time")
      ->check(CLI::NonNegativeNumber)
      ->type_name("S");
  command
      .add_option_function<std::uint64_t>(
          "--seed", [&machine](std::uint64_t seed) { machine.seed = seed; },
          "Seed of challenges and sessions, for repeatable runs [the kernel's generator]")
      ->type_name("N");
  add_machine(command, machine.machine);
}

void add_can(CLI::App& app, CanOptions& can) {
  CLI::App& command = *app.add_subcommand("can", "A person's tools at the machine's CAN bus");
  command.require_subcommand(1);
  const auto add = [&](const char* name, CanAction action, const char* help) {
    CLI::App* tool = command.add_subcommand(name, help);
    tool->add_option("iface", can.can_interface, "CAN interface, such as can0")
        ->check(parsed_by(check_interface_name))
        ->type_name("IFACE")
        ->required();
    tool->callback([&can, action] { can.action = action; });
    return tool;
  };
  const auto add_duration = [&can](CLI::App* tool) {
    tool->add_option_function<double>(
            "--duration", [&can](double s) { can.duration_s = s; }, "End after S seconds [Ctrl-C]")
        ->check(CLI::Range(0.1, 1e6))
        ->type_name("S");
  };
  CLI::App* monitor =
      add("monitor", CanAction::kMonitor, "Decoded frames with rates, ages, losses; sends nothing");
  monitor->add_flag("--once", can.once, "One table after a second (or --duration)");
  monitor->add_flag("--json", can.json, "One JSON object per line");
  add_duration(monitor);
  CLI::App* enable =
      add("enable", CanAction::kEnable,
          "Enable the machine and keep it so without any motion, until Ctrl-C; exit code 5 if it "
          "does not stay enabled");
  add_duration(enable);
  add_machine(*enable, can.machine);
  add("stop", CanAction::kStop,
      "Emergency stop by the bus (never the only way to stop); exit code 0 only if confirmed");
  add("reset", CanAction::kReset,
      "Leave fault or emergency stop; exit code 0 only if confirmed. Enables nothing");
}

void add_replay(CLI::App& app, ReplayOptions& replay) {
  CLI::App& command =
      *app.add_subcommand("replay", "Tell what a recorded bus says, decoded as live");
  command.add_option("log", replay.log, "Log of candump -L, such as bus.log of a run")
      ->type_name("LOG")
      ->required();
  command.add_option("map", replay.map, "Map that the machine must have stood on")
      ->type_name("MAP");
  command.add_option("--out", replay.out, "Folder for executed.csv [none]")->type_name("DIR");
  add_machine(command, replay.machine);
}

void add_roadmap(CLI::App& app, RoadmapOptions& roadmap) {
  CLI::App& command = *app.add_subcommand(
      "roadmap", "Build, keep and draw the limb roadmaps: roadmap_side.png, roadmap_top.png");
  command.add_option("--out", roadmap.out, "Folder for the pictures")
      ->type_name("DIR")
      ->capture_default_str();
  command.add_option("--cache", roadmap.cache, "Folder they are kept in [the system's cache]")
      ->type_name("DIR");
  RoadmapSettings& settings = roadmap.settings;
  const auto add_count = [&](const char* name, int& count, const char* help) {
    command.add_option(name, count, help)
        ->check(CLI::Range(1, 100000))
        ->type_name("N")
        ->capture_default_str();
  };
  add_count("--leg-vertices", settings.leg_vertices, "Vertices of each leg");
  add_count("--arm-vertices", settings.arm_vertices, "Vertices of the arm");
  command.add_option("--seed", settings.seed, "Seed of the samples")
      ->type_name("N")
      ->capture_default_str();
  add_machine(command, roadmap.machine);
}

void add_check(CLI::App& app, check::CheckOptions& check) {
  CLI::App& command = *app.add_subcommand(
      "check", "Judge a motion by its files alone, apart from the code that planned it");
  command.footer(
      "Reads model.xml, result.json and the CSV in DIR. Exit codes: 0 accepted, 2 bad input,\n"
      "5 violations.");
  command.add_option("dir", check.folder, "Folder that wex plan or wex run wrote")
      ->type_name("DIR")
      ->required();
  command.add_option("map", check.map, "Elevation map it was made for")
      ->type_name("MAP")
      ->required();
  command.add_option("--what", check.what, "plan, refined or executed: which CSV")
      ->type_name("KIND")
      ->capture_default_str();
  command.add_option("--json", check.json, "Write the findings here too")->type_name("FILE");
  command.add_flag("--all", check.all, "List also rules that nothing was subject to");
}

int run_command(const Options& options, std::ostream& out, std::ostream& err) {
  Progress progress(err, options.quiet);
  const Result<RunReport> report = run_pipeline(options.run, progress);
  if (!report) return refuse(err, report.error());
  out << summary_table(*report);
  if (report->failure) err << "wex: " << report->failure->message << "\n";
  return exit_code(*report);
}

int terrain_command(const TerrainOptions& options, std::ostream& out, std::ostream& err) {
  const Result<SyntheticTerrain> terrain =
      make_synthetic_terrain(options.kind, options.difficulty, options.seed);
  if (!terrain) return refuse(err, terrain.error());
  const std::filesystem::path json_file =
      std::filesystem::path(options.out).replace_extension("json");
  if (json_file == options.out) {
    return refuse(err, {ErrorCode::kBadInput, "--out " + options.out.string() +
                                                  " is the name of the JSON beside it: "
                                                  "expected a map name such as map.asc"});
  }
  if (const auto written = write_esri_ascii(terrain->raster, options.out); !written) {
    return refuse(err, written.error());
  }
  if (const auto written = write_task(terrain->task, json_file); !written) {
    return refuse(err, written.error());
  }
  out << options.out.string() << "\n" << json_file.string() << "\n";
  return 0;
}

int model_command(const ModelOptions& options, std::ostream& out, std::ostream& err) {
  const Result<MachineModel> machine = load_machine(options.machine);
  if (!machine) return refuse(err, machine.error());
  const Result<std::string> text = machine_mjcf(*machine);
  if (!text) return refuse(err, text.error());
  if (const auto written = write_text_file(options.mjcf, *text); !written) {
    return refuse(err, written.error());
  }
  out << options.mjcf.string() << "\n";
  return 0;
}

/// Help of the deepest command named.
std::string help_text(const CLI::App& app, const std::string& path = "") {
  const std::vector<CLI::App*> commands = app.get_subcommands();
  if (commands.empty()) return app.help(path);
  return help_text(*commands.front(), path.empty() ? app.get_name() : path + " " + app.get_name());
}

/// CLI11 only says that a command is missing; the word that is none helps more.
std::optional<std::string> unknown_command(const CLI::App& app, int argc, const char* const* argv) {
  const CLI::App* level = &app;
  for (int i = 1; i < argc && level->get_require_subcommand_min() > 0; ++i) {
    const std::string word = argv[i];
    if (word.starts_with("-")) return std::nullopt;
    std::string names;
    const CLI::App* next = nullptr;
    for (const CLI::App* known : level->get_subcommands([](const CLI::App*) { return true; })) {
      if (known->get_name() == word) next = known;
      names += names.empty() ? known->get_name() : ", " + known->get_name();
    }
    if (next) {
      level = next;
      continue;
    }
    return "there is no command '" + word + "', only " + names;
  }
  return std::nullopt;
}

/// What went wrong with the arguments, on one line.
int refuse_arguments(const CLI::App& app, const CLI::ParseError& error, std::ostream& err) {
  std::string text = error.what();
  for (char& c : text) c = c == '\n' ? ' ' : c;
  std::string command = "wex";
  for (const CLI::App* level = &app; !level->get_subcommands().empty();) {
    level = level->get_subcommands().front();
    command += " " + level->get_name();
  }
  err << "wex: " << text << " (see " << command << " --help)\n";
  return 2;
}

}  // namespace

int run_cli(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  Options options;
  CLI::App app{
      "wex: planning and driving of a walking excavator over rough ground.\n"
      "An elevation map and a goal in, a machine that has driven there (in MuJoCo) out.",
      "wex"};
  app.set_version_flag("--version", "wex " WEX_VERSION);
  app.require_subcommand(1);
  add_run(app, options);
  add_plan(app, options);
  add_terrain(app, options.terrain);
  add_model(app, options.model);
  add_bench(app, options.bench);
  add_can_machine(app, options.can_machine);
  add_can(app, options.can);
  add_replay(app, options.replay);
  add_check(app, options.check);
  add_roadmap(app, options.roadmap);
  if (const auto problem = unknown_command(app, argc, argv)) {
    return refuse(err, {ErrorCode::kBadInput, *problem + " (see wex --help)"});
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    out << help_text(app);
    return 0;
  } catch (const CLI::CallForVersion& version) {
    out << version.what() << "\n";
    return 0;
  } catch (const CLI::ParseError& error) {
    return refuse_arguments(app, error, err);
  }
  const CLI::App& command = *app.get_subcommands().front();
  const std::string name = command.get_name();
  if (name == "terrain") return terrain_command(options.terrain, out, err);
  if (name == "model") return model_command(options.model, out, err);
  if (name == "bench") return bench_command(command, options.bench, out, err);
  if (name == "check") {
    const Result<int> code = check::run_check(options.check, out);
    return code ? *code : refuse(err, code.error());
  }
  if (name == "can") {
    const Result<void> done = run_can(options.can, out);
    return done ? 0 : refuse(err, done.error());
  }
  if (name == "roadmap") {
    const Result<void> done = run_roadmap(options.roadmap, out);
    return done ? 0 : refuse(err, done.error());
  }
  if (name == "replay") {
    const Result<void> replayed = run_replay(options.replay, out);
    return replayed ? 0 : refuse(err, replayed.error());
  }
  if (name == "machine") {
    const Result<void> ran = run_machine(options.can_machine, out);
    return ran ? 0 : refuse(err, ran.error());
  }
  options.run.depth = name == "plan" ? Depth::kPlanOnly : Depth::kDrive;
  return run_command(options, out, err);
}

}  // namespace wex::app
