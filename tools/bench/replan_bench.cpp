#include "tools/bench/replan_bench.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "initializer/found_plan.hpp"
#include "initializer/replan/replan.hpp"
#include "models/terrain/synthetic.hpp"
#include "models/types/cpu_clock.hpp"
#include "tools/bench/uniform.hpp"
#include "tools/check/plan_checker.hpp"

namespace wex {
namespace {

constexpr double kAreaM2 = 10.0;
constexpr double kFartherM = 4.0;  // start and goal, than usual: there are stretches to drive
constexpr double kBesideM = 5.8, kAlongM = 6.0;
constexpr double kHeightM = 0.3;
constexpr double kSparedM = 3.6;  // around start and goal
constexpr double kGoalRatio = 3.0;
constexpr int kRepeats = 3;  // the best of them counts

struct Ground {
  const char* kind;
  double difficulty;
};
constexpr std::array<Ground, 4> kGrounds{
    {{"gap", 0.5}, {"step", 0.5}, {"wall", 0.0}, {"rough", 0.5}}};
/// Drawn at random between start and goal, and three that are chosen.
constexpr std::array<const char*, 4> kPlaces{"anywhere", "beside the way", "driven stretch",
                                             "where it lands"};
constexpr int kDraws = 4;           // of places anywhere, each raised and lowered
constexpr double kSidewaysM = 6.0;  // how far from the line from start to goal they may be

struct Row {
  double scratch_s = 0.0, replan_s = 0.0, scratch_cost = 0.0, replan_cost = 0.0;
  bool scratch_found = false, scratch_accepted = false, found = false, accepted = false;
  ReplanOutcome outcome = ReplanOutcome::kUntouched;
  std::size_t touched = 0, unsound = 0, replaced = 0, nodes = 0;
  std::string why;
};

void print(std::ostream& out, const char* format, ...) {
  char line[400];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  out << line << std::flush;
}

double median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Eigen::Vector2d left_of(const WholeBodyNode& node) {
  return {-std::sin(node.q[kBaseYaw]), std::cos(node.q[kBaseYaw])};
}

/// The middle of the change. Start and goal stay as they are.
Eigen::Vector2d centre_of(std::size_t place, const MachineModel& machine, const Plan& plan,
                          std::mt19937_64& random) {
  const auto& nodes = plan.nodes;
  const Eigen::Vector2d start = nodes.front().q.head<2>();
  if (place == 0) {
    const Eigen::Vector2d way = nodes.back().q.head<2>() - start;
    const Eigen::Vector2d left = Eigen::Vector2d(-way.y(), way.x()).normalized();
    const double kept_m = (kSparedM + 0.5 * std::sqrt(kAreaM2)) / way.norm();
    const double along = kept_m + (1.0 - 2.0 * kept_m) * uniform(random);
    return start + along * way + kSidewaysM * (2.0 * uniform(random) - 1.0) * left;
  }
  if (place == 1) {
    const WholeBodyNode& middle = nodes[nodes.size() / 2];
    const double side = middle.q[kBaseY] > 0.0 ? -1.0 : 1.0;  // the map's middle is at y = 0
    return Eigen::Vector2d(middle.q.head<2>()) + side * kBesideM * left_of(middle);
  }
  if (place == 3) {
    for (std::size_t i = 1; i < nodes.size(); ++i) {
      for (std::size_t k = 0; k < kNumWheels; ++k) {
        if (nodes[i - 1].contacts[k] || !nodes[i].contacts[k]) continue;
        KinematicTree::Workspace w = machine.tree.make_workspace();
        machine.tree.update(nodes[i].q, w);
        const WheeledLeg& leg = machine.legs[k];
        return machine.tree.position(w, leg.carrier_body, leg.p_carrier_wheel).head<2>();
      }
    }
    return nodes[nodes.size() / 2].q.head<2>();
  }
  const auto driven = std::find_if(nodes.begin(), nodes.end(), [&](const WholeBodyNode& node) {
    return (node.q.head<2>() - start).norm() >= kAlongM;
  });
  return (driven == nodes.end() ? nodes.back() : *driven).q.head<2>();
}

GroundRect change_ground(Grid& elevation, const Eigen::Vector2d& centre, double by_m) {
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(0.5 * std::sqrt(kAreaM2));
  const GroundRect rect{centre - half, centre + half};
  for (int j = 0; j < elevation.size_y; ++j) {
    for (int i = 0; i < elevation.size_x; ++i) {
      const Eigen::Vector2d p = elevation.origin_m + elevation.cell_m * Eigen::Vector2d(i, j);
      if ((p.array() >= rect.min_m.array()).all() && (p.array() <= rect.max_m.array()).all()) {
        elevation.at(i, j) += static_cast<float>(by_m);
      }
    }
  }
  return rect;
}

/// From scratch to the first plan.
Result<Plan> first_plan(const TerrainMap& terrain, const MachineModel& machine, const Task& task,
                        const PlanSettings& settings) {
  const double begin_s = thread_cpu_time_s();
  const auto check = PoseCheck::build(terrain, machine, settings);
  if (!check) return tl::unexpected<Error>(check.error());
  SearchAids aids;
  aids.first_will_do = true;
  auto found = find_plan(terrain, machine, task, settings, *check, std::move(aids), {}, begin_s);
  if (!found) return tl::unexpected<Error>(found.error());
  return std::move(found->plan);
}

bool accepted(const MachineModel& machine, const Raster& raster, const Plan& plan,
              std::string& why) {
  const auto report = check::check_plan(machine, raster, plan);
  if (report && report->accepted) return true;
  why = report ? report->verdict() : report.error().message;
  return false;
}

Result<Row> bench_change(const MachineModel& machine, const PlanMemory& memory, Raster raster,
                         const Eigen::Vector2d& centre, double by_m, const PlanSettings& settings) {
  const Task& task = memory.plan.task;
  const GroundRect rect = change_ground(raster.elevation, centre, by_m);
  const auto terrain = TerrainMap::build(raster.elevation, {}, raster.map_origin_m);
  if (!terrain) return tl::unexpected<Error>(terrain.error());
  Row row;
  row.scratch_s = row.replan_s = 1e9;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    const double begin_s = thread_cpu_time_s();
    const auto scratch = first_plan(*terrain, machine, task, settings);
    const double middle_s = thread_cpu_time_s();
    const auto replanned = replan(memory, *terrain, machine, settings, rect);
    const double end_s = thread_cpu_time_s();
    row.scratch_s = std::min(row.scratch_s, middle_s - begin_s);
    row.replan_s = std::min(row.replan_s, end_s - middle_s);
    if (repeat > 0) continue;
    row.nodes = memory.plan.nodes.size();
    if ((row.scratch_found = scratch.has_value())) {
      row.scratch_cost = scratch->cost;
      row.scratch_accepted = accepted(machine, raster, *scratch, row.why);
    }
    if (!replanned) row.why = replanned.error().message;
    if ((row.found = replanned.has_value())) {
      row.outcome = replanned->outcome;
      row.touched = replanned->num_touched;
      row.unsound = replanned->num_unsound;
      row.replaced = replanned->num_replaced;
      row.replan_cost = replanned->memory.plan.cost;
      row.accepted = accepted(machine, raster, replanned->memory.plan, row.why);
    }
    if (middle_s - begin_s > 0.5 || end_s - middle_s > 0.5) break;  // no point in repeating
  }
  return row;
}

void print_row(std::ostream& out, const char* name, const char* place, const Row& row) {
  print(out,
        "  %s, %s: %.2f ms from scratch (cost %.1f%s), %.2f ms (cost %.1f%s) %s, %zu of %zu "
        "nodes touched, %zu unsound, %zu replaced %s\n",
        name, place, 1e3 * row.scratch_s, row.scratch_cost,
        !row.scratch_found     ? ", none"
        : row.scratch_accepted ? ""
                               : ", refused",
        1e3 * row.replan_s, row.replan_cost,
        !row.found     ? ", none"
        : row.accepted ? ""
                       : ", refused",
        name_of(row.outcome), row.touched, row.nodes, row.unsound, row.replaced, row.why.c_str());
}

/// Both found: times; else what happened.
void print_summary(std::ostream& out, const std::string& name, const std::vector<Row>& rows) {
  std::vector<double> scratch_ms, replan_ms, ratio, dearer;
  std::map<ReplanOutcome, int> outcomes;
  int found = 0, scratch_found = 0, accepted = 0, scratch_accepted = 0;
  for (const Row& row : rows) {
    found += row.found;
    scratch_found += row.scratch_found;
    accepted += row.accepted;
    scratch_accepted += row.scratch_accepted;
    if (row.found) ++outcomes[row.outcome];
    if (!row.found || !row.scratch_found) continue;
    scratch_ms.push_back(1e3 * row.scratch_s);
    replan_ms.push_back(1e3 * row.replan_s);
    ratio.push_back(row.scratch_s / row.replan_s);
    dearer.push_back(row.replan_cost / row.scratch_cost);
  }
  print(out, "%-24s %9.2f %9.2f %8.1f  %s %6.2f   %2d of %-2d  %2d of %-2d  ", name.c_str(),
        median(scratch_ms), median(replan_ms), median(ratio),
        median(ratio) >= kGoalRatio ? "    " : "less", median(dearer), scratch_accepted,
        scratch_found, accepted, found);
  for (const auto& [outcome, count] : outcomes) print(out, "%d %s; ", count, name_of(outcome));
  print(out, "\n");
}

}  // namespace

Result<void> bench_replan(const ReplanBenchOptions& options, std::ostream& out) {
  const auto machine = load_machine();
  if (!machine) return tl::unexpected<Error>(machine.error());
  print(out,
        "a change of %.0f m2 by +-%.1f m; thread CPU time [ms], medians; cost: of the new plan "
        "over that from scratch\n%-24s %9s %9s %8s %11s  %8s  %8s\n",
        kAreaM2, kHeightM, "", "scratch", "replan", "ratio", "cost", "accepted", "accepted");
  std::map<std::size_t, std::vector<Row>> by_place;
  for (const Ground& ground : kGrounds) {
    std::array<std::vector<Row>, kPlaces.size()> rows;
    for (int seed = 1; seed <= options.seeds; ++seed) {
      auto synthetic =
          make_synthetic_terrain(ground.kind, ground.difficulty, static_cast<std::uint64_t>(seed));
      if (!synthetic) return tl::unexpected<Error>(synthetic.error());
      const Raster& raster = synthetic->raster;
      const auto terrain = TerrainMap::build(raster.elevation, {}, raster.map_origin_m);
      if (!terrain) return tl::unexpected<Error>(terrain.error());
      Task task = synthetic->task;
      for (Pose2* pose : {&task.start, &task.goal}) {
        pose->x_m -= raster.map_origin_m.x();
        pose->y_m -= raster.map_origin_m.y();
      }
      task.start.x_m -= kFartherM;
      task.goal.x_m += kFartherM;
      PlanSettings settings = options.plan;
      settings.seed = static_cast<std::uint64_t>(seed);
      const auto memory = plan_and_remember(*terrain, *machine, task, settings);
      if (!memory) {
        print(out, "%s seed %d: %s\n", ground.kind, seed, memory.error().message.c_str());
        continue;
      }
      std::mt19937_64 random(static_cast<std::uint64_t>(seed));
      for (std::size_t place = 0; place < kPlaces.size(); ++place) {
        for (int draw = 0; draw < (place == 0 ? kDraws : 1); ++draw) {
          const Eigen::Vector2d centre = centre_of(place, *machine, memory->plan, random);
          for (const double by_m : {kHeightM, -kHeightM}) {
            auto row = bench_change(*machine, *memory, raster, centre, by_m, settings);
            if (!row) return tl::unexpected<Error>(row.error());
            if (options.verbose) {
              char name[64];
              std::snprintf(name, sizeof name, "%s seed %d %+.1f m", ground.kind, seed, by_m);
              print_row(out, name, kPlaces[place], *row);
            }
            rows[place].push_back(*row);
            by_place[place].push_back(*std::move(row));
          }
        }
      }
    }
    for (std::size_t place = 0; place < kPlaces.size(); ++place) {
      print_summary(out, std::string(ground.kind) + ", " + kPlaces[place], rows[place]);
    }
  }
  for (const auto& [place, rows] : by_place) {
    print_summary(out, "all, " + std::string(kPlaces[place]), rows);
  }
  return {};
}

}  // namespace wex
