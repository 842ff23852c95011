#include "tools/bench/roadmap_bench.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <random>
#include <vector>

#include "initializer/roadmap/arm_path.hpp"
#include "initializer/roadmap/limb_roadmap.hpp"
#include "models/types/cpu_clock.hpp"

namespace wex {
namespace {

namespace fs = std::filesystem;

constexpr int kArmMotions = 200;
constexpr double kSelfCollision_m = 0.10;

struct Spread {
  double least = 0.0, median = 0.0, p95 = 0.0, most = 0.0;
};

Spread spread(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return {values.front(), values[n / 2], values[std::min(n - 1, n * 95 / 100)], values.back()};
}

Spread time_s(int repeats, const std::function<void()>& call) {
  std::vector<double> times_s;
  for (int i = 0; i < repeats; ++i) {
    const double start_s = thread_cpu_time_s();
    call();
    times_s.push_back(thread_cpu_time_s() - start_s);
  }
  return spread(times_s);
}

void print(std::ostream& out, const char* what, const Spread& s, double scale, const char* unit) {
  std::array<char, 160> line{};
  std::snprintf(line.data(), line.size(), "%-34s %10.3f %10.3f %10.3f %10.3f %s\n", what,
                scale * s.least, scale * s.median, scale * s.p95, scale * s.most, unit);
  out << line.data();
}

/// From one vertex to another among all limbs standing, judged against the machine itself.
void bench_arm_motions(const MachineModel& machine, const CollisionModel& collision,
                       const LimbRoadmap& arm, std::ostream& out) {
  KinematicTree::Workspace w = machine.tree.make_workspace();
  Eigen::VectorXd q = Eigen::VectorXd::Zero(machine.num_coordinates());
  q.tail(machine.num_joints()) = machine.default_posture();
  const auto valid = [&](const Eigen::VectorXd& arm_q) {
    for (std::size_t i = 0; i < arm.coordinates.size(); ++i) {
      q[arm.coordinates[i]] = arm_q[static_cast<Eigen::Index>(i)];
    }
    machine.tree.update(q, w);
    return collision.clear(w, CollisionModel::Part::kArm, kSelfCollision_m);
  };
  ArmPathPlanner planner(machine, arm);
  std::mt19937 generator(1);
  std::uniform_int_distribution<int> any(0, arm.num_vertices() - 1);
  std::vector<double> direct_s, searched_s, checks;
  int none = 0;
  while (std::ssize(direct_s) + std::ssize(searched_s) + none < kArmMotions) {
    const Eigen::VectorXd start = arm.q.col(any(generator)), goal = arm.q.col(any(generator));
    if (!valid(start) || !valid(goal)) continue;
    const double start_s = thread_cpu_time_s();
    const auto path = planner.plan(start, goal, valid);
    const double taken_s = thread_cpu_time_s() - start_s;
    if (!path) {
      ++none;
      continue;
    }
    (path->vertices == 0 ? direct_s : searched_s).push_back(taken_s);
    if (path->vertices > 0) checks.push_back(path->checks);
  }
  print(out, ("arm motion, straight (" + std::to_string(direct_s.size()) + ")").c_str(),
        spread(direct_s), 1e3, "ms");
  print(out, ("arm motion, searched (" + std::to_string(searched_s.size()) + ")").c_str(),
        spread(searched_s), 1e3, "ms");
  print(out, "postures looked at when searched", spread(checks), 1.0, "");
  out << "arm motions not found: " << none << " of " << kArmMotions << "\n";
}

}  // namespace

Result<void> bench_roadmap(const RoadmapBenchOptions& options, std::ostream& out) {
  const Result<MachineModel> machine = load_machine(options.machine);
  if (!machine) return tl::unexpected(machine.error());
  const CollisionModel collision = CollisionModel::build(*machine);
  const RoadmapSettings settings;
  std::array<char, 200> line{};
  std::snprintf(line.data(), line.size(),
                "limb roadmaps of %s: %d vertices a leg, %d the arm, %d neighbours; thread CPU "
                "time, %d repeats\n%-34s %10s %10s %10s %10s\n",
                machine->name.c_str(), settings.leg_vertices, settings.arm_vertices,
                settings.neighbours, options.repeats, "", "min", "median", "p95", "max");
  out << line.data();
  double total_s = 0.0;
  for (int limb = 0; limb < (machine->arm ? kNumLimbs : kNumWheels); ++limb) {
    const Spread building = time_s(options.repeats, [&] {
      (void)build_roadmap(*machine, collision, static_cast<Limb>(limb), settings);
    });
    print(out, ("build " + std::string(kLimbNames[limb])).c_str(), building, 1.0, "s");
    total_s += building.median;
  }
  const fs::path folder =
      fs::temp_directory_path() / ("wex_roadmap_bench_" + std::to_string(::getpid()));
  Result<Roadmaps> roadmaps = load_or_build_roadmaps(*machine, settings, folder);
  if (!roadmaps) return tl::unexpected(roadmaps.error());
  print(out, "load from cache",
        time_s(options.repeats,
               [&] { roadmaps = load_or_build_roadmaps(*machine, settings, folder); }),
        1e3, "ms");
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  if (!roadmaps) return tl::unexpected(roadmaps.error());
  if (machine->arm) bench_arm_motions(*machine, collision, roadmaps->limbs.back(), out);
  std::snprintf(line.data(), line.size(), "all limbs: %.2f s (goal: 10 s; the paper: 30 minutes)\n",
                total_s);
  out << line.data();
  return {};
}

}  // namespace wex
