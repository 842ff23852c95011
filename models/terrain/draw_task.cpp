#include "models/terrain/draw_task.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include "models/terrain/internal/gradient_noise.hpp"

namespace wex {

Result<Task> draw_task(const TerrainMap& terrain, std::uint64_t seed,
                       const DrawSettings& settings) {
  constexpr std::uint64_t kStream = 3;
  terrain_internal::RandomStream random(seed, kStream);
  const Eigen::Vector2d low = terrain.min_corner_m();
  const Eigen::Vector2d high = terrain.max_corner_m();
  const auto draw_pose = [&] {
    const double x_m = random.uniform(low.x(), high.x());
    const double y_m = random.uniform(low.y(), high.y());
    return Pose2{x_m, y_m, random.uniform(-std::numbers::pi, std::numbers::pi)};
  };
  const auto has_clearance = [&](const Pose2& pose) {
    return terrain.signed_distance_m({pose.x_m, pose.y_m}) >= settings.clearance_m;
  };
  for (int tries = 0; tries < settings.max_tries; ++tries) {
    const Task task{draw_pose(), draw_pose()};
    const double distance_m =
        std::hypot(task.goal.x_m - task.start.x_m, task.goal.y_m - task.start.y_m);
    if (distance_m >= settings.min_distance_m && has_clearance(task.start) &&
        has_clearance(task.goal)) {
      return task;
    }
  }
  return fail(ErrorCode::kBadInput, "the map has no room for a start and a goal " +
                                        std::to_string(settings.min_distance_m) + " m apart with " +
                                        std::to_string(settings.clearance_m) +
                                        " m of traversable ground around each");
}

}  // namespace wex
