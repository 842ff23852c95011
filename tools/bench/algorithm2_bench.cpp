#include "tools/bench/algorithm2_bench.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "initializer/paper/paper_check.hpp"
#include "models/terrain/synthetic.hpp"
#include "models/types/cpu_clock.hpp"

namespace wex {
namespace {

constexpr double kGoalPerS = 400e3, kGoalRatio = 5.0;
constexpr double kTouchM = 0.05;
constexpr int kMinTouching = 3;
constexpr double kInsetM = 4.0;  // of base poses from the map's edge

struct Case {
  const char* name;
  const char* kind;
  double difficulty;
};
constexpr std::array<Case, 3> kCases{
    {{"rough +-0.5 m", "rough", 0.142857}, {"gap 2 m", "gap", 0.4}, {"flat", "flat", 0.0}}};

double bilinear(const Grid& grid, double x, double y) {
  const double u = (x - grid.origin_m.x()) / grid.cell_m;
  const double v = (y - grid.origin_m.y()) / grid.cell_m;
  if (!(u >= 0.0 && v >= 0.0 && u < grid.size_x - 1 && v < grid.size_y - 1)) return std::nan("");
  const int i = static_cast<int>(u), j = static_cast<int>(v);
  const double s = u - i, t = v - j;
  const double a = grid.at(i, j), b = grid.at(i + 1, j), c = grid.at(i, j + 1),
               d = grid.at(i + 1, j + 1);
  return (1.0 - t) * ((1.0 - s) * a + s * b) + t * ((1.0 - s) * c + s * d);
}

/// The loop as one would write it down: double precision, every vertex of every leg, the cheapest
/// one that touches. Nothing else of Algorithm 2.
class PlainLoop {
 public:
  PlainLoop(const TerrainMap& terrain, const MachineModel& machine, const Roadmaps& roadmaps,
            double min_distance_m)
      : terrain_(terrain), machine_(machine), roadmaps_(roadmaps), least_m_(min_distance_m) {}

  [[nodiscard]] std::array<int, kNumWheels> ground_legs(const BaseCoordinates& base) const {
    const Eigen::Isometry3d T_world_base = T_world_base_from(base);
    std::array<int, kNumWheels> best{};
    for (std::size_t leg = 0; leg < kNumWheels; ++leg) {
      const LimbRoadmap& map = roadmaps_.limbs[leg];
      const double radius_m = machine_.legs[leg].radius_m;
      int touching = 0, cheapest = -1;
      for (int v = 0; v < map.num_vertices(); ++v) {
        const Eigen::Vector3d p = T_world_base * map.p_base_contact.col(v);
        const double ground_m = bilinear(terrain_.dilated_height(), p.x(), p.y());
        if (!(std::abs(p.z() - radius_m - ground_m) <= kTouchM)) continue;
        if (!(bilinear(terrain_.signed_distance(), p.x(), p.y()) >= least_m_)) continue;
        ++touching;
        if (cheapest < 0 || map.distance_from_default[v] < map.distance_from_default[cheapest]) {
          cheapest = v;
        }
      }
      best[leg] = touching >= kMinTouching ? cheapest : -1;
    }
    return best;
  }

 private:
  const TerrainMap& terrain_;
  const MachineModel& machine_;
  const Roadmaps& roadmaps_;
  double least_m_;
};

struct Rate {
  double best_us = 0.0, median_us = 0.0;
};

template <typename Call>
Rate time_per_pose(const Algorithm2BenchOptions& options, std::size_t poses, const Call& call) {
  std::vector<double> us;
  for (int i = 0; i < options.repeats; ++i) {
    const double begin_s = thread_cpu_time_s();
    for (std::size_t k = 0; k < poses; ++k) call(k);
    us.push_back(1e6 * (thread_cpu_time_s() - begin_s) / static_cast<double>(poses));
  }
  std::sort(us.begin(), us.end());
  return {us.front(), us[us.size() / 2]};
}

template <typename... Values>
void print(std::ostream& out, const char* pattern, Values... values) {
  std::array<char, 320> line{};
  std::snprintf(line.data(), line.size(), pattern, values...);
  out << line.data();
}

void print_rate(std::ostream& out, const char* what, const Rate& rate, const Rate& plain) {
  print(out, "  %-46s %8.3f %8.3f %10.0f %8.1f\n", what, rate.best_us, rate.median_us,
        1e6 / rate.median_us, plain.median_us / rate.median_us);
}

Result<void> bench_case(const Algorithm2BenchOptions& options, const Case& what,
                        const MachineModel& machine, const Roadmaps& roadmaps, std::ostream& out) {
  const auto synthetic = make_synthetic_terrain(what.kind, what.difficulty, 1);
  if (!synthetic) return tl::unexpected(synthetic.error());
  const Raster& raster = synthetic->raster;
  const auto terrain = TerrainMap::build(raster.elevation, {}, raster.map_origin_m);
  if (!terrain) return tl::unexpected(terrain.error());
  const PlanSettings settings;
  const auto check = PaperCheck::build(*terrain, machine, roadmaps, settings);
  if (!check) return tl::unexpected(check.error());
  const PlainLoop plain(*terrain, machine, roadmaps, settings.min_signed_distance_m);

  std::mt19937_64 generator(1);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * 0x1p-53 * static_cast<double>(generator() >> 11);
  };
  const Eigen::Vector2d low = terrain->min_corner_m(), high = terrain->max_corner_m();
  std::vector<Pose2> poses;
  std::vector<BaseCoordinates> bases;
  while (std::ssize(poses) < options.poses) {
    const Pose2 pose{uniform(low.x() + kInsetM, high.x() - kInsetM),
                     uniform(low.y() + kInsetM, high.y() - kInsetM), uniform(-M_PI, M_PI)};
    poses.push_back(pose);
    bases.push_back(check->base_at(pose));
  }

  int disagreements = 0;
  std::array<int, 5> by_contacts{};
  std::array<int, kNumPaperRejections> rejections{};
  for (const BaseCoordinates& base : bases) {
    const auto fast = check->ground_legs(base), slow = plain.ground_legs(base);
    for (std::size_t i = 0; i < kNumWheels; ++i) disagreements += fast[i] != slow[i];
    const PaperStance stance = check->stand(base);
    ++rejections[static_cast<std::size_t>(stance.rejection)];
    if (stance.ok()) {
      ++by_contacts[static_cast<std::size_t>(
          std::count(stance.contacts.begin(), stance.contacts.begin() + kNumWheels, true))];
    }
  }

  int sink = 0;  // so that nothing is optimised away
  const Rate plain_rate = time_per_pose(
      options, bases.size(), [&](std::size_t k) { sink += plain.ground_legs(bases[k])[0]; });
  const Rate legs_rate = time_per_pose(
      options, bases.size(), [&](std::size_t k) { sink += check->ground_legs(bases[k])[0]; });
  const Rate whole_rate = time_per_pose(
      options, bases.size(), [&](std::size_t k) { sink += check->stand(bases[k]).ok(); });
  const Rate both_rate = time_per_pose(options, poses.size(),
                                       [&](std::size_t k) { sink += check->stand(poses[k]).ok(); });

  print(out, "%s (%d poses by Algorithm 1, %d repeats%s)\n", what.name, options.poses,
        options.repeats, sink == -1 ? " " : "");
  print_rate(out, "plain loop: double, bilinear, all leg vertices", plain_rate, plain_rate);
  print_rate(out, "the same by blocks, with an early stop", legs_rate, plain_rate);
  print_rate(out, "Algorithm 2", whole_rate, plain_rate);
  print_rate(out, "Algorithms 1 and 2", both_rate, plain_rate);
  print(out, "  stands on 4 / 3 / 2 wheels: %d / %d / %d; refused:", by_contacts[4], by_contacts[3],
        by_contacts[2]);
  for (std::size_t i = 1; i < rejections.size(); ++i) {
    if (rejections[i] > 0) {
      print(out, " %d %s;", rejections[i], describe(static_cast<PaperRejection>(i)));
    }
  }
  print(out, "\n  legs grounded differently from the plain loop: %d of %d\n", disagreements,
        kNumWheels * options.poses);
  if (what.kind == std::string("rough")) {
    const double ratio = plain_rate.median_us / whole_rate.median_us;
    print(out, "  goal %.0f checks/s and %.0f times the plain loop: %s\n", kGoalPerS, kGoalRatio,
          1e6 / whole_rate.median_us >= kGoalPerS && ratio >= kGoalRatio ? "met" : "missed");
  }
  // Single precision may tip a vertex that touches by a hair.
  if (disagreements * 500 > kNumWheels * options.poses) {
    return fail(ErrorCode::kInternal, "the fast loop and the plain loop ground different legs");
  }
  return {};
}

}  // namespace

Result<void> bench_algorithm2(const Algorithm2BenchOptions& options, std::ostream& out) {
  const auto machine = load_machine();
  if (!machine) return tl::unexpected(machine.error());
  const auto roadmaps = load_or_build_roadmaps(*machine);
  if (!roadmaps) return tl::unexpected(roadmaps.error());
  print(out, "thread CPU time per check [us]\n  %-46s %8s %8s %10s %8s\n", "", "best", "median",
        "checks/s", "ratio");
  for (const Case& what : kCases) {
    if (auto done = bench_case(options, what, *machine, *roadmaps, out); !done) return done;
  }
  return {};
}

}  // namespace wex
