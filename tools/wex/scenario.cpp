#include "tools/wex/scenario.hpp"

#include <cmath>
#include <cstdio>

#include "models/terrain/raster_io.hpp"
#include "models/terrain/synthetic.hpp"

namespace wex::app {
namespace {

/// Start and goal in the map frame: options first, the JSON beside the map for what is missing.
Result<Task> task_in_map_frame(const RunOptions& options, bool start_is_measured) {
  if (start_is_measured && options.goal) return Task{{}, *options.goal};
  if (options.start && options.goal) return Task{*options.start, *options.goal};
  const std::filesystem::path json_file =
      std::filesystem::path(options.map).replace_extension("json");
  std::error_code ignored;
  if (!std::filesystem::exists(json_file, ignored)) {
    const std::string missing = options.start || start_is_measured ? "no goal: give --goal X,Y,YAW"
                                : options.goal
                                    ? "no start: give --start X,Y,YAW"
                                    : "no start and goal: give --start X,Y,YAW and --goal X,Y,YAW";
    return fail(ErrorCode::kBadInput, missing + " (map frame, metres, radians) or write " +
                                          json_file.string() + " with \"start\" and \"goal\"");
  }
  Result<Task> task = read_task(json_file);
  if (!task) return task;
  if (options.start) task->start = *options.start;
  if (options.goal) task->goal = *options.goal;
  return task;
}

Result<void> check_on_map(const char* name, const Pose2& pose_map, const TerrainMap& terrain) {
  if (!std::isfinite(pose_map.x_m) || !std::isfinite(pose_map.y_m) ||
      !std::isfinite(pose_map.yaw_rad)) {
    return fail(ErrorCode::kBadInput,
                std::string(name) + " has a value that is not a finite number");
  }
  const Eigen::Vector2d p_map(pose_map.x_m, pose_map.y_m);
  if (terrain.contains(p_map - terrain.map_origin_m())) return {};
  const Eigen::Vector2d lo = terrain.min_corner_m() + terrain.map_origin_m();
  const Eigen::Vector2d hi = terrain.max_corner_m() + terrain.map_origin_m();
  char text[256];
  std::snprintf(text, sizeof(text),
                "%s (%.2f, %.2f) is off the map, which covers x %.2f to %.2f and y %.2f to %.2f",
                name, p_map.x(), p_map.y(), lo.x(), hi.x(), lo.y(), hi.y());
  return fail(ErrorCode::kBadInput, text);
}

}  // namespace

Pose2 local_from_map(const Pose2& pose_map, const TerrainMap& terrain) {
  const Eigen::Vector2d origin = terrain.map_origin_m();
  return {pose_map.x_m - origin.x(), pose_map.y_m - origin.y(), pose_map.yaw_rad};
}

Pose2 map_from_local(const Pose2& pose_local, const TerrainMap& terrain) {
  const Eigen::Vector2d origin = terrain.map_origin_m();
  return {pose_local.x_m + origin.x(), pose_local.y_m + origin.y(), pose_local.yaw_rad};
}

Result<Scenario> load_scenario(const RunOptions& options, const MeasureStart& measure_start) {
  Result<Raster> raster = read_raster(options.map);
  if (!raster) return tl::unexpected(raster.error());
  Result<Task> task_map = task_in_map_frame(options, measure_start != nullptr);
  if (!task_map) return tl::unexpected(task_map.error());
  Result<TerrainMap> terrain =
      TerrainMap::build(std::move(raster->elevation), {}, raster->map_origin_m);
  if (!terrain) {
    return fail(terrain.error().code, options.map.string() + ": " + terrain.error().message);
  }
  Result<MachineModel> machine = load_machine(options.machine);
  if (!machine) return tl::unexpected(machine.error());
  if (measure_start) {
    const Result<Pose2> measured = measure_start(*terrain, *machine);
    if (!measured) return tl::unexpected(measured.error());
    task_map->start = map_from_local(*measured, *terrain);
  }
  for (const auto& [name, pose] : {std::pair{"start", task_map->start}, {"goal", task_map->goal}}) {
    if (const auto on_map = check_on_map(name, pose, *terrain); !on_map) {
      return tl::unexpected(on_map.error());
    }
  }
  constexpr double kSamePlaceM = 0.01, kSameYawRad = 0.01;
  const Pose2& a = task_map->start;
  const Pose2& b = task_map->goal;
  if (std::hypot(a.x_m - b.x_m, a.y_m - b.y_m) < kSamePlaceM &&
      std::abs(wrap_angle(a.yaw_rad - b.yaw_rad)) < kSameYawRad) {
    return fail(
        ErrorCode::kBadInput,
        "start and goal are the same pose (to 1 cm and 0.01 rad): there is nothing to drive");
  }
  const Task task{local_from_map(task_map->start, *terrain),
                  local_from_map(task_map->goal, *terrain)};
  return Scenario{std::move(*terrain), std::move(*machine), task};
}

}  // namespace wex::app
