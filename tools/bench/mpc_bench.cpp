#include "tools/bench/mpc_bench.hpp"

#include <algorithm>
#include <cstdio>
#include <random>
#include <vector>

#include "initializer/make_plan.hpp"
#include "models/terrain/synthetic.hpp"
#include "mpc/receding_horizon/receding_horizon.hpp"
#include "mpc/refinement/refine.hpp"

namespace wex {
namespace {

constexpr double kPeriod_s = 0.1;
constexpr int kSteps = 80;

double percentile(std::vector<double> values, double fraction) {
  std::sort(values.begin(), values.end());
  const double index = fraction * static_cast<double>(values.size() - 1);
  return values[static_cast<std::size_t>(index + 0.5)];
}

void print_row(const char* name, const std::vector<double>& times_s, double baseline_s,
               double mean_iterations) {
  const double median = percentile(times_s, 0.5);
  std::printf("%-34s %7.2f %7.2f %7.2f %7.2f %7.2f  %5.1f  %5.2f\n", name,
              1e3 * percentile(times_s, 0.0), 1e3 * median, 1e3 * percentile(times_s, 0.95),
              1e3 * percentile(times_s, 0.99), 1e3 * percentile(times_s, 1.0), mean_iterations,
              median / baseline_s);
}

struct LoopTimes {
  std::vector<double> warm_s, cold_s;
  double warm_iterations = 0.0, cold_iterations = 0.0;
  int unusable = 0;
};

// The model is executed with 1 mm / 1 mrad of noise; every state is solved by the warm-started
// optimizer and by a fresh one.
LoopTimes run_loop(const TerrainMap& terrain, const MachineModel& machine,
                   const RefinedTrajectory& reference) {
  LoopTimes times;
  RecedingHorizon horizon(terrain, machine, reference);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 1e-3);
  HorizonInput input;
  input.q = reference.nodes.front().q;
  input.qdot = Eigen::VectorXd::Zero(input.q.size());
  for (int step = 0; step < kSteps; ++step) {
    const HorizonResult warm = horizon.solve(input);
    RecedingHorizon fresh(terrain, machine, reference);
    const HorizonResult cold = fresh.solve(input);
    times.warm_s.push_back(warm.report.cpu_time_s);
    times.cold_s.push_back(cold.report.cpu_time_s);
    times.warm_iterations += static_cast<double>(warm.report.iterations) / kSteps;
    times.cold_iterations += static_cast<double>(cold.report.iterations) / kSteps;
    if (!warm.usable) {
      ++times.unusable;
      continue;
    }
    const Eigen::VectorXd q = sample(warm.nodes, input.t_s + kPeriod_s).q;
    input.qdot = (q - input.q) / kPeriod_s;
    input.q = q;
    for (double& value : input.q) value += noise(random);
    input.t_s += kPeriod_s;
    input.reference_time_s = input.t_s;
  }
  return times;
}

}  // namespace

int bench_mpc() {
  const Result<MachineModel> machine = load_machine();
  if (!machine) return std::fprintf(stderr, "wex: %s\n", machine.error().message.c_str()), 1;
  std::printf("one thread, thread CPU time in ms; terrain rough, difficulty 0.15, seeds 1 to 3\n");
  std::printf("%-34s %7s %7s %7s %7s %7s  %5s  %5s\n", "", "min", "median", "p95", "p99", "max",
              "iter", "ratio");
  std::vector<double> refinement_s;
  LoopTimes all;
  double refinement_iterations = 0.0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Result<SyntheticTerrain> synthetic = make_synthetic_terrain("rough", 0.15, seed);
    if (!synthetic) return std::fprintf(stderr, "wex: %s\n", synthetic.error().message.c_str()), 1;
    const Eigen::Vector2d origin = synthetic->raster.map_origin_m;
    const Result<TerrainMap> terrain = TerrainMap::build(synthetic->raster.elevation, {}, origin);
    if (!terrain) return std::fprintf(stderr, "wex: %s\n", terrain.error().message.c_str()), 1;
    const auto local = [&](const Pose2& pose) {
      return Pose2{pose.x_m - origin.x(), pose.y_m - origin.y(), pose.yaw_rad};
    };
    PlanSettings settings;
    settings.seed = seed;
    const Result<Plan> plan = make_plan(
        *terrain, *machine, {local(synthetic->task.start), local(synthetic->task.goal)}, settings);
    if (!plan) return std::fprintf(stderr, "wex: %s\n", plan.error().message.c_str()), 3;
    const Result<RefinedTrajectory> refined = refine(*terrain, *machine, *plan);
    if (!refined) return std::fprintf(stderr, "wex: %s\n", refined.error().message.c_str()), 4;
    refinement_s.push_back(refined->report.cpu_time_s);
    refinement_iterations += refined->report.iterations / 3.0;
    const LoopTimes times = run_loop(*terrain, *machine, *refined);
    all.warm_s.insert(all.warm_s.end(), times.warm_s.begin(), times.warm_s.end());
    all.cold_s.insert(all.cold_s.end(), times.cold_s.begin(), times.cold_s.end());
    all.warm_iterations += times.warm_iterations / 3.0;
    all.cold_iterations += times.cold_iterations / 3.0;
    all.unusable += times.unusable;
  }
  const double baseline_s = percentile(all.cold_s, 0.5);
  print_row("refinement of a 15 m plan", refinement_s, baseline_s, refinement_iterations);
  print_row("receding horizon, 5 s, warm", all.warm_s, baseline_s, all.warm_iterations);
  print_row("receding horizon, 5 s, cold (1.00)", all.cold_s, baseline_s, all.cold_iterations);
  std::printf("%d of %zu warm results unusable\n", all.unusable, all.warm_s.size());
  return 0;
}

}  // namespace wex
