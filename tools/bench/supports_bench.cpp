#include "tools/bench/supports_bench.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <random>

#include "initializer/stepping/path_layers.hpp"
#include "initializer/stepping/stance_projection.hpp"
#include "models/excavator/machine_model.hpp"
#include "models/terrain/synthetic.hpp"
#include "tools/bench/uniform.hpp"

namespace wex {
namespace {

struct Case {
  const char* kind;
  double difficulty;
  double yaw_rad;  ///< either way; NaN: any
};
constexpr double kAnyYaw = std::numeric_limits<double>::quiet_NaN();
constexpr double kQuarterRad = 0.5 * std::numbers::pi;
constexpr std::array<Case, 12> kCases{{{"gap", 0.25, 0.0},
                                       {"gap", 0.25, 0.5},
                                       {"gap", 0.25, 0.8},
                                       {"gap", 0.75, 0.5},
                                       {"step", 0.25, 0.5},
                                       {"hole", 0.0, 0.3},
                                       {"hole", 0.0, kQuarterRad},
                                       {"bridge", 0.0, 0.0},
                                       {"side_slope", 0.0, 0.0},
                                       {"rough", 0.5, kAnyYaw},
                                       {"rough", 0.75, kAnyYaw},
                                       {"rough", 1.0, kAnyYaw}}};
constexpr double kSidewaysM = 3.0;

enum Outcome {
  kFourWheels,
  kOfTheGraph,
  kThreeAndBucket,
  kDiagonal,
  kSide,
  kNowhere,
  kNumOutcomes
};

class Supports {
 public:
  Supports(const StanceCheck& check, const PlanSettings& plan) : check_(check), plan_(plan) {}

  [[nodiscard]] Outcome of(const Pose2& pose) const {
    switch (project_stance(check_, plan_, certificate_, pose, 0.0)) {
      case Certifier::Admission::kOnFourWheels:
        return kFourWheels;
      case Certifier::Admission::kNeedsStepping:
        return kOfTheGraph;
      case Certifier::Admission::kRefused:
        break;
    }
    Outcome best = kNowhere;
    for_each_stance(pose, [&](const BaseFrame& base, const Stance& stance) {
      const auto try_these = [&](Outcome outcome, std::initializer_list<std::uint8_t> lifted) {
        if (outcome >= best) return;
        for (const std::uint8_t wheels : lifted) {
          if (stance.allows(wheels) && bucket_helps(pose, base, stance, wheels)) best = outcome;
        }
      };
      try_these(kThreeAndBucket, {0b0001, 0b0010, 0b0100, 0b1000});
      try_these(kDiagonal, {0b1001, 0b0110});
      try_these(kSide, {0b0101, 0b1010});
    });
    return best;
  }

 private:
  // The heights and pitches that the graph would look at.
  template <typename Judge>
  void for_each_stance(const Pose2& pose, const Judge& judge) const {
    const GroundUnder under = ground_under(check_, pose);
    if (!under.any || std::abs(under.roll_rad) > plan_.max_tilt_rad) return;
    const StanceClearances plain{plan_.min_signed_distance_m, StanceClearances{}.swing_m,
                                 plan_.belly_clearance_m};
    const double pitch_0 = std::min(0.0, under.pitch_rad) - certificate_.max_pitch_offset_rad;
    const double pitch_1 = std::max(0.0, under.pitch_rad) + certificate_.max_pitch_offset_rad;
    for (double z = under.lowest_base_m; z <= under.highest_base_m;
         z += certificate_.height_step_m) {
      for (double pitch = pitch_0; pitch <= pitch_1; pitch += certificate_.pitch_step_rad) {
        if (std::abs(pitch) > plan_.max_tilt_rad) continue;
        BaseCoordinates q;
        q << pose.x_m, pose.y_m, z, pose.yaw_rad, pitch, under.roll_rad;
        const BaseFrame base = BaseFrame::from(q);
        const Stance stance = check_.stance(base, check_.steering(0.0), plain);
        if (stance.belly_clear) judge(base, stance);
      }
    }
  }

  [[nodiscard]] bool bucket_helps(const Pose2& pose, const BaseFrame& base, const Stance& stance,
                                  std::uint8_t lifted) const {
    constexpr int kDirections = 16;
    constexpr double kFirstM = 3.0, kStepM = 0.4;
    for (int k = 0; k < kDirections; ++k) {
      const double yaw = pose.yaw_rad + 2.0 * std::numbers::pi * k / kDirections;
      for (double d = kFirstM; d <= check_.tables().arm.max_reach_m() + kStepM; d += kStepM) {
        const double x = pose.x_m + d * std::cos(yaw), y = pose.y_m + d * std::sin(yaw);
        if (!check_.bucket_spot(x, y, yaw, plan_.min_signed_distance_m)) continue;
        const double margin_m =
            check_
                .margin_on_bucket(base, stance, lifted, {x, y, check_.ground().height_m(x, y)},
                                  plan_.min_stability_margin_m, -2.0)
                .margin_m;
        if (margin_m >= plan_.min_stability_margin_m) return true;
      }
    }
    return false;
  }

  const StanceCheck& check_;
  const PlanSettings& plan_;
  CertificateSettings certificate_;
};

}  // namespace

Result<void> bench_supports(const SupportsBenchOptions& options, std::ostream& out) {
  const auto machine = load_machine();
  if (!machine) return tl::unexpected<Error>(machine.error());
  const auto tables = StanceTables::build(*machine);
  if (!tables) return tl::unexpected<Error>(tables.error());
  const PlanSettings plan;
  out << "random poses between start and goal, up to " << kSidewaysM
      << " m beside the middle; where the machine can stand, % of " << options.seeds << " x "
      << options.poses << ", seeds from 1\n"
      << "ground             heading  four wheels  graph's supports |  only: 3 + bucket  diagonal"
         "      side   nowhere\n";
  for (const Case& ground : kCases) {
    std::array<int, kNumOutcomes> count{};
    for (int seed = 1; seed <= options.seeds; ++seed) {
      const auto made =
          make_synthetic_terrain(ground.kind, ground.difficulty, static_cast<std::uint64_t>(seed));
      if (!made) return tl::unexpected<Error>(made.error());
      const Eigen::Vector2d origin = made->raster.map_origin_m;
      const auto map = TerrainMap::build(made->raster.elevation, {}, origin);
      if (!map) return tl::unexpected<Error>(map.error());
      const StanceGround stance_ground(*map);
      const StanceCheck check(stance_ground, *tables);
      const Supports supports(check, plan);
      std::mt19937_64 random(static_cast<std::uint64_t>(seed));
      const Pose2 &start = made->task.start, &goal = made->task.goal;
      const double middle_m = 0.5 * (map->min_corner_m().y() + map->max_corner_m().y());
      for (int k = 0; k < options.poses; ++k) {
        Pose2 pose;
        pose.x_m = std::lerp(start.x_m, goal.x_m, uniform(random)) - origin.x();
        pose.y_m = middle_m + kSidewaysM * (2.0 * uniform(random) - 1.0);
        const double turn = uniform(random);
        pose.yaw_rad = std::isnan(ground.yaw_rad) ? 2.0 * std::numbers::pi * turn
                       : turn < 0.5               ? ground.yaw_rad
                                                  : -ground.yaw_rad;
        ++count[supports.of(pose)];
      }
    }
    const double per_cent = 100.0 / (options.seeds * options.poses);
    char heading[16] = "any", line[200];
    if (!std::isnan(ground.yaw_rad)) {
      std::snprintf(heading, sizeof heading, "%.0f deg", ground.yaw_rad * 180.0 / std::numbers::pi);
    }
    std::snprintf(line, sizeof line,
                  "%-12s %.2f  %8s  %11.1f  %16.1f | %16.2f  %8.2f  %8.2f  %8.1f\n", ground.kind,
                  ground.difficulty, heading, per_cent * count[kFourWheels],
                  per_cent * count[kOfTheGraph], per_cent * count[kThreeAndBucket],
                  per_cent * count[kDiagonal], per_cent * count[kSide], per_cent * count[kNowhere]);
    out << line << std::flush;
  }
  return {};
}

}  // namespace wex
