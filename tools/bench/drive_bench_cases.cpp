#include "tools/bench/drive_bench_cases.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "initializer/make_plan.hpp"
#include "models/terrain/raster_io.hpp"
#include "models/terrain/synthetic.hpp"

namespace wex {
namespace {

struct SyntheticCase {
  const char* name;
  const char* kind;
  double difficulty;
  bool half_circle = false;  ///< at the minimum radius, instead of the terrain's own task
};

/// Asked for by name only: it measures side slip, the others count successes.
constexpr SyntheticCase kCurveCase{"flat_curve", "flat", 0.0, true};

constexpr SyntheticCase kSyntheticCases[] = {
    {"flat", "flat", 0.0}, {"rough_0", "rough", 0.0},         {"rough_0.15", "rough", 0.15},
    {"ramp", "ramp", 0.0}, {"side_slope", "side_slope", 0.0}, kCurveCase};

std::vector<std::filesystem::path> real_maps(const DriveBenchOptions& options) {
  if (!options.real_maps.empty()) return options.real_maps;
  return {std::filesystem::path(WEX_SCENARIOS_DIR) / "real_minnesota.tif"};
}

/// Start and goal drawn over a real map: anywhere the machine can stand, far enough apart.
class TaskDraw {
 public:
  TaskDraw(const TerrainMap& terrain, const MachineModel& machine, int seed)
      : terrain_(terrain), machine_(machine), random_(static_cast<std::uint64_t>(seed)) {}

  Result<Task> draw() {
    for (int attempt = 0; attempt < kMaxDraws; ++attempt) {
      const Pose2 start = pose(), goal = pose();
      if (std::hypot(goal.x_m - start.x_m, goal.y_m - start.y_m) < kLeastDistanceM) continue;
      if (stands(start) && stands(goal)) return Task{start, goal};
      ++rejected_;
    }
    return fail(ErrorCode::kBadInput, "no pair of poses the machine can stand at was found in " +
                                          std::to_string(kMaxDraws) + " draws over the map");
  }
  [[nodiscard]] int rejected() const noexcept { return rejected_; }

 private:
  static constexpr double kEdgeM = 4.0, kLeastDistanceM = 10.0;
  static constexpr int kMaxDraws = 10000;

  Pose2 pose() {
    const Eigen::Vector2d lo = terrain_.min_corner_m(), hi = terrain_.max_corner_m();
    const auto uniform = [this](double a, double b) {
      return std::uniform_real_distribution<double>(a, b)(random_);
    };
    const double x = uniform(lo.x() + kEdgeM, hi.x() - kEdgeM);
    const double y = uniform(lo.y() + kEdgeM, hi.y() - kEdgeM);
    return {x, y, uniform(-std::numbers::pi, std::numbers::pi)};
  }
  bool stands(const Pose2& pose) const {
    return terrain_.traversable_at({pose.x_m, pose.y_m}) &&
           standing_posture(terrain_, machine_, pose).has_value();
  }

  const TerrainMap& terrain_;
  const MachineModel& machine_;
  std::mt19937_64 random_;
  int rejected_ = 0;
};

/// A half circle at the machine's minimum radius over the middle of a 30 x 16 m map; the seed
/// varies place and heading a little, so that the way there differs.
Task half_circle_task(double radius_m, int seed) {
  std::mt19937_64 random(static_cast<std::uint64_t>(seed));
  std::uniform_real_distribution<double> place_m(-0.5, 0.5), yaw_rad(-0.05, 0.05);
  const double x = 13.0 + place_m(random);
  return {{x, 8.0 - radius_m, yaw_rad(random)},
          {x + place_m(random), 8.0 + radius_m, std::numbers::pi + yaw_rad(random)}};
}

std::filesystem::path run_folder(const DriveBenchOptions& options, const std::string& name,
                                 int seed) {
  return options.out / name / ("seed_" + std::to_string(seed));
}

Result<void> add_synthetic(const SyntheticCase& c, const DriveBenchOptions& options, int seeds,
                           std::vector<DriveBenchRun>& runs) {
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto terrain =
        make_synthetic_terrain(c.kind, c.difficulty, static_cast<std::uint64_t>(seed));
    if (!terrain) return tl::unexpected(terrain.error());
    const auto map = options.out / c.name / ("map_" + std::to_string(seed) + ".asc");
    if (auto written = write_esri_ascii(terrain->raster, map); !written) return written;
    const Task task =
        c.half_circle ? half_circle_task(MachineModel().min_turning_radius_m, seed) : terrain->task;
    runs.push_back({c.name, seed, map, task, 0, run_folder(options, c.name, seed)});
  }
  return {};
}

Result<void> add_real(const std::filesystem::path& map, const DriveBenchOptions& options, int seeds,
                      std::vector<DriveBenchRun>& runs) {
  Result<Raster> raster = read_raster(map);
  if (!raster) return tl::unexpected(raster.error());
  const auto terrain = TerrainMap::build(std::move(raster->elevation), {}, raster->map_origin_m);
  if (!terrain) return tl::unexpected(terrain.error());
  const auto machine = load_machine();
  if (!machine) return tl::unexpected(machine.error());
  const std::string name = map.stem().string();
  const Eigen::Vector2d origin = terrain->map_origin_m();
  const auto in_map_frame = [&](const Pose2& pose) {
    return Pose2{pose.x_m + origin.x(), pose.y_m + origin.y(), pose.yaw_rad};
  };
  for (int seed = 1; seed <= seeds; ++seed) {
    TaskDraw draw(*terrain, *machine, seed);
    const Result<Task> task = draw.draw();
    if (!task) return fail(task.error().code, map.string() + ": " + task.error().message);
    runs.push_back({name,
                    seed,
                    map,
                    {in_map_frame(task->start), in_map_frame(task->goal)},
                    draw.rejected(),
                    run_folder(options, name, seed)});
  }
  return {};
}

}  // namespace

std::string pose_text(const Pose2& pose) {
  char text[96];
  std::snprintf(text, sizeof(text), "%.4f,%.4f,%.5f", pose.x_m, pose.y_m, pose.yaw_rad);
  return text;
}

std::vector<std::string> run_words(const DriveBenchRun& run, const DriveBenchOptions& options) {
  std::vector<std::string> words{"run",
                                 run.map.string(),
                                 "--goal=" + pose_text(run.task_map.goal),
                                 "--seed=" + std::to_string(run.seed),
                                 "--out=" + run.folder.string(),
                                 "--frames=0"};
  if (!options.solve_delay.empty()) words.push_back("--solve-delay=" + options.solve_delay);
  return words;
}

std::vector<std::string> drive_bench_case_names(const DriveBenchOptions& options) {
  std::vector<std::string> names;
  for (const SyntheticCase& c : kSyntheticCases) names.emplace_back(c.name);
  for (const auto& map : real_maps(options)) names.push_back(map.stem().string());
  return names;
}

Result<std::vector<DriveBenchRun>> prepare_drive_bench(const DriveBenchOptions& options) {
  const std::vector<std::string> known = drive_bench_case_names(options);
  std::vector<std::string> asked = options.cases;
  if (asked.empty()) {
    asked = options.quick ? std::vector<std::string>{"flat", "rough_0"} : known;
    std::erase(asked, kCurveCase.name);
  }
  for (const std::string& name : asked) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    std::string list;
    for (const std::string& k : known) list += (list.empty() ? "" : ", ") + k;
    return fail(ErrorCode::kBadInput, "there is no case '" + name + "', only " + list);
  }
  const auto is_asked = [&](const std::string& name) {
    return std::find(asked.begin(), asked.end(), name) != asked.end();
  };
  const int seeds = options.quick ? 1 : options.seeds;
  for (const std::string& name : asked) {
    std::error_code error;
    std::filesystem::create_directories(options.out / name, error);
    if (error) {
      return fail(ErrorCode::kBadInput, "output folder " + options.out.string() +
                                            " cannot be written: " + error.message());
    }
  }
  std::vector<DriveBenchRun> runs;
  for (const SyntheticCase& c : kSyntheticCases) {
    if (!is_asked(c.name)) continue;
    if (const auto added = add_synthetic(c, options, seeds, runs); !added) {
      return tl::unexpected(added.error());
    }
  }
  for (const auto& map : real_maps(options)) {
    if (!is_asked(map.stem().string())) continue;
    if (const auto added = add_real(map, options, seeds, runs); !added) {
      return tl::unexpected(added.error());
    }
  }
  return runs;
}

}  // namespace wex
