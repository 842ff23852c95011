#include "tools/wex/machine_command.hpp"

#include <cstdio>
#include <memory>

#include "hw_interface/electronics/electronics.hpp"
#include "hw_interface/mujoco/simulated_plant.hpp"
#include "hw_interface/socketcan/can_socket.hpp"
#include "initializer/make_plan.hpp"
#include "models/terrain/raster_io.hpp"
#include "models/terrain/synthetic.hpp"
#include "tools/wex/machine_log.hpp"
#include "tools/wex/machine_runner.hpp"
#include "tools/wex/real_time_priority.hpp"
#include "tools/wex/scenario.hpp"
#include "tools/wex/stop_signal.hpp"

namespace wex::app {
namespace {

constexpr double kFlatGround_m = 40.0;  ///< edge of the ground without a map

Result<TerrainMap> flat_ground() {
  Grid grid;
  grid.size_x = grid.size_y = static_cast<int>(kFlatGround_m / grid.cell_m) + 1;
  grid.origin_m.setConstant(-0.5 * kFlatGround_m);
  grid.values.assign(static_cast<std::size_t>(grid.size_x) * grid.size_y, 0.0F);
  return TerrainMap::build(std::move(grid));
}

Result<TerrainMap> ground_of(const MachineOptions& options) {
  if (options.map.empty()) return flat_ground();
  Result<Raster> raster = read_raster(options.map);
  if (!raster) return tl::unexpected(raster.error());
  return TerrainMap::build(std::move(raster->elevation), {}, raster->map_origin_m);
}

/// In the map frame: the option, or the JSON beside the map, or the origin of the flat ground.
Result<Pose2> start_of(const MachineOptions& options) {
  if (options.start) return *options.start;
  if (options.map.empty()) return Pose2{};
  const Result<Task> task = read_task(std::filesystem::path(options.map).replace_extension("json"));
  if (!task) {
    return fail(task.error().code, task.error().message + "; or give --start X,Y,YAW");
  }
  return task->start;
}

std::string summary(const can::Electronics& electronics, std::int64_t now_ms) {
  const can::ElectronicsCounters& counters = electronics.counters();
  char text[320];
  std::snprintf(text, sizeof(text),
                "wex machine: %.2f s, mode %s, commands accepted %ld rejected %ld, holds %ld, "
                "frames received %ld sent %ld not taken %ld\n",
                1e-3 * static_cast<double>(now_ms), name_of(electronics.automaton().mode()),
                counters.commands_accepted, counters.commands_rejected(),
                electronics.automaton().holds(), counters.frames,
                electronics.publisher().frames_sent(), electronics.publisher().frames_not_taken());
  return text;
}

}  // namespace

Result<void> run_machine(const MachineOptions& options, std::ostream& out) {
  const std::atomic<bool>& stop_requested = stop_on_signals();
  const Result<MachineModel> machine = load_machine(options.machine);
  if (!machine) return tl::unexpected(machine.error());
  const Result<TerrainMap> terrain = ground_of(options);
  if (!terrain) return tl::unexpected(terrain.error());
  const Result<Pose2> start = start_of(options);
  if (!start) return tl::unexpected(start.error());
  // The interface first: it is what most often is not there.
  Result<can::CanSocket> socket = can::CanSocket::open(options.can_interface);
  if (!socket) return tl::unexpected(socket.error());

  const Result<Eigen::VectorXd> q =
      standing_posture(*terrain, *machine, local_from_map(*start, *terrain));
  if (!q) return tl::unexpected(q.error());
  auto plant = SimulatedPlant::create(*machine, *terrain, *q);
  if (!plant) return tl::unexpected(plant.error());
  if (const auto settled = (*plant)->settle(); !settled) return settled;

  std::unique_ptr<can::RandomSource> random = std::make_unique<can::SystemRandom>();
  if (options.seed) random = std::make_unique<can::SeededRandom>(*options.seed);
  can::ElectronicsSettings settings;
  settings.map_origin_m = terrain->map_origin_m();
  settings.lock_step = options.lock_step;
  auto electronics = can::Electronics::create(*machine, **plant, *socket, *random, settings);
  if (!electronics) return tl::unexpected(electronics.error());

  std::optional<MachineLog> log;
  if (!options.log.empty()) {
    Result<MachineLog> opened = MachineLog::open(options.log, *machine, settings.map_origin_m);
    if (!opened) return tl::unexpected(opened.error());
    log = std::move(*opened);
  }
  SystemPacer pacer;
  MachineRunner runner(**electronics, *socket, pacer,
                       {.lock_step = options.lock_step,
                        .estop_after_s = options.estop_after_s,
                        .exit_after_s = options.exit_after_s,
                        .free_run_in_session_after_s = options.patience_s},
                       [&](std::int64_t now_ms) {
                         if (log) log->row(now_ms, **electronics, **plant);
                       });
  out << "wex machine: " << machine->name << " on " << options.can_interface << ", "
      << (options.lock_step ? "lock step" : "real time") << std::endl;
  {
    std::optional<RealTimePriority> priority;
    if (!options.lock_step) priority.emplace(kSimulationPriority);
    runner.run(stop_requested);
  }
  out << summary(**electronics, runner.now_ms()) << std::flush;
  if (log) return log->close();
  return {};
}

}  // namespace wex::app
