#include "tools/wex/replay_command.hpp"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "hw_interface/replay/replay_machine.hpp"
#include "models/excavator/mjcf.hpp"
#include "models/terrain/raster_io.hpp"
#include "models/terrain/terrain_map.hpp"
#include "tools/wex/drive_record.hpp"
#include "tools/wex/motion_csv.hpp"
#include "tools/wex/output_folder.hpp"
#include "tools/wex/trajectory_execution.hpp"

namespace wex::app {
namespace {

constexpr double kRowPeriod_s = 0.05;
constexpr double kStep_s = 0.01;

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  char text[240];
  std::snprintf(text, sizeof(text), pattern, values...);
  return text;
}

const char* name_of(Lifecycle lifecycle) {
  switch (lifecycle) {
    case Lifecycle::kUnconfigured:
      return "not heard completely";
    case Lifecycle::kInactive:
      return "inactive";
    case Lifecycle::kActive:
      return "enabled";
    case Lifecycle::kFault:
      return "fault";
    case Lifecycle::kEStop:
      break;
  }
  return "e-stop";
}

/// What a log shows, period by period of the machine's clock.
struct Replayed {
  std::vector<DriveSample> samples;
  std::string changes;  ///< of the lifecycle, one line each
  double duration_s = 0.0, travelled_m = 0.0, max_age_s = 0.0;
};

Replayed play(ReplayMachine& replay, const MachineModel& machine) {
  Replayed result;
  MachineState state = replay.read();
  const double begin_s = state.t_s + state.age_s;
  std::optional<Lifecycle> lifecycle;
  std::optional<Eigen::Vector2d> before;
  double next_row_s = 0.0;
  for (long step = 0;; ++step) {
    const double t_s = kStep_s * static_cast<double>(step);
    replay.wait_until(begin_s + t_s);
    if (replay.finished()) break;
    state = replay.read();
    result.duration_s = t_s;
    result.max_age_s = std::max(result.max_age_s, state.age_s);
    if (replay.lifecycle() != lifecycle) {
      lifecycle = replay.lifecycle();
      result.changes += format("  %8.2f s         %s\n", t_s, name_of(*lifecycle));
    }
    const Eigen::Vector2d here = state.base.head<2>();
    if (before) result.travelled_m += (here - *before).norm();
    before = here;
    if (t_s < next_row_s - 0.5 * kStep_s) continue;
    next_row_s += kRowPeriod_s;
    DriveSample& sample = result.samples.emplace_back();
    sample.t_s = t_s;
    const Eigen::VectorXd q = coordinates(machine, state);
    sample.base = q.head<kNumBaseCoordinates>();
    sample.scalar_joints = scalar_joint_values(machine, q);
    sample.contacts = kDrivingContacts;
  }
  return result;
}

}  // namespace

Result<void> run_replay(const ReplayOptions& options, std::ostream& out) {
  const Result<MachineModel> machine = load_machine(options.machine);
  if (!machine) return tl::unexpected(machine.error());
  std::optional<TerrainMap> terrain;
  if (!options.map.empty()) {
    Result<Raster> raster = read_raster(options.map);
    if (!raster) return tl::unexpected(raster.error());
    Result<TerrainMap> built =
        TerrainMap::build(std::move(raster->elevation), {}, raster->map_origin_m);
    if (!built) return tl::unexpected(built.error());
    terrain = std::move(*built);
  }
  const Eigen::Vector2d origin_m =
      terrain ? terrain->map_origin_m() : Eigen::Vector2d(Eigen::Vector2d::Zero());
  const auto replay = ReplayMachine::open(options.log.string(), *machine, origin_m);
  if (!replay) return tl::unexpected(replay.error());
  const Replayed replayed = play(**replay, *machine);
  if (replayed.samples.empty()) {
    return fail(ErrorCode::kBadInput, "the log '" + options.log.string() +
                                          "' ends as soon as the whole machine is heard");
  }
  const BaseCoordinates& first = replayed.samples.front().base;
  const BaseCoordinates& last = replayed.samples.back().base;
  if (terrain && !(terrain->contains(first.head<2>()) && terrain->contains(last.head<2>()))) {
    return fail(ErrorCode::kBadInput, "the machine of the log does not stand on the map '" +
                                          options.map.string() + "': is it another map's log?");
  }
  const ReplayReport report = (*replay)->report();
  const auto pose = [&](const char* name, const BaseCoordinates& base) {
    out << format("  %-18s (%.2f, %.2f), yaw %.2f\n", name, base[kBaseX] + origin_m.x(),
                  base[kBaseY] + origin_m.y(), wrap_angle(base[kBaseYaw]));
  };
  out << format("  %-18s %ld, %ld refused (CRC, counter, length, id)\n", "frames", report.frames,
                report.frames_refused)
      << format("  %-18s %.2f s of machine time, feedback at most %.0f ms old\n", "duration",
                replayed.duration_s, 1e3 * replayed.max_age_s);
  pose("begins at", first);
  pose("ends at", last);
  out << format("  %-18s %.2f m\n", "travelled", replayed.travelled_m) << replayed.changes;
  if (options.out.empty()) return {};
  const Result<OutputFolder> folder = OutputFolder::open(options.out);
  if (!folder) return tl::unexpected(folder.error());
  const Result<std::vector<std::string>> names = scalar_joint_names(*machine);
  if (!names) return tl::unexpected(names.error());
  out << format("  %-18s %s\n", "executed.csv", (options.out / "executed.csv").c_str());
  return folder->publish_text("executed.csv",
                              executed_motion_csv(*names, replayed.samples, origin_m));
}

}  // namespace wex::app
