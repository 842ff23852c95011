#include "mpc/refinement/refine.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "models/types/cpu_clock.hpp"
#include "mpc/nlp/driving_constraints.hpp"
#include "mpc/nlp/ipopt_solver.hpp"
#include "mpc/nlp/static_stability.hpp"
#include "mpc/nlp/whole_body_trajectory.hpp"

namespace wex {
namespace {

// The plan is a guide: the path may bend where rolling without slip asks for it, the posture is
// what must stay near. Accelerations weigh enough for motion a 0.5 Hz hydraulic joint can follow.
constexpr CoordinateWeights kTracking{
    .base_xy = 1.0, .base_z = 2.0, .yaw = 2.0, .tilt = 4.0, .haa = 0.5, .hfe = 0.2, .steer = 0.05};
constexpr CoordinateWeights kRates{
    .base_xy = 0.2, .base_z = 0.2, .yaw = 0.2, .tilt = 0.5, .haa = 0.2, .hfe = 0.1, .steer = 0.05};
constexpr CoordinateWeights kAccelerations{
    .base_xy = 0.3, .base_z = 0.3, .yaw = 0.5, .tilt = 1.0, .haa = 0.5, .hfe = 0.3, .steer = 0.2};

constexpr double kSettleAtEnd_s = 1.0;  // steering and base come to rest within the trajectory

TrajectorySetup make_setup(const TerrainMap& terrain, const MachineModel& machine, const Plan& plan,
                           const RefinementSettings& settings) {
  const double duration_s = plan.nodes.back().t_s + kSettleAtEnd_s;
  const int num_nodes = static_cast<int>(std::ceil(duration_s / settings.dt_s));
  TrajectorySetup setup;
  setup.machine = &machine;
  setup.layout = make_driving_layout(machine, num_nodes);
  setup.dt_s = settings.dt_s;
  for (int k = 0; k <= num_nodes; ++k) {
    setup.q_held.push_back(sample(plan.nodes, k * settings.dt_s).q);
    setup.reference.push_back(setup.layout.gather(setup.q_held.back()));
  }
  setup.before_first = setup.reference.front();
  setup.max_tilt_rad = settings.max_tilt_rad;
  setup.joint_margin_rad = settings.joint_margin_rad;
  setup.fix_goal = true;
  setup.end_at_rest = true;
  setup.tracking = kTracking;
  setup.rates = kRates;
  setup.accelerations = kAccelerations;
  add_driving_constraints(setup, terrain,
                          {.min_stability_margin_m = settings.min_stability_margin_m,
                           .min_signed_distance_m = settings.min_signed_distance_m,
                           .rate_fraction = settings.rate_fraction});
  return setup;
}

double tolerance_of(const std::string& name, const RefinementSettings& settings) {
  if (name == "side_slip_m_s") return settings.slip_tolerance_m_s;
  return settings.height_tolerance_m;
}

}  // namespace

Result<RefinedTrajectory> refine(const TerrainMap& terrain, const MachineModel& machine,
                                 const Plan& plan, const RefinementSettings& settings,
                                 const std::function<void(const SolveIteration&)>& observer) {
  WEX_EXPECTS(plan.nodes.size() >= 2);
  for (const WholeBodyNode& node : plan.nodes) {
    if (node.contacts != kDrivingContacts) {
      return fail(ErrorCode::kRefinementFailed,
                  "the plan lifts a wheel or uses the arm; the refinement handles driving on four "
                  "wheels only");
    }
  }
  const double start_s = thread_cpu_time_s();
  TrajectoryProblem problem(make_setup(terrain, machine, plan, settings));
  IpoptSolver solver(
      {.max_iterations = settings.max_iterations, .max_cpu_time_s = settings.max_cpu_time_s});
  const IpoptSolver::Observer forward = [&](int iteration, double objective, double infeasibility) {
    if (observer) observer({iteration, objective, infeasibility});
  };
  const IpoptOutcome outcome =
      solver.solve(problem, problem.pack(problem.setup().reference), {}, forward);

  RefinedTrajectory refined;
  refined.dt_s = settings.dt_s;
  refined.report.status = outcome.status;
  refined.report.iterations = outcome.iterations;
  refined.report.objective = outcome.objective;
  if (!outcome.z.allFinite()) {
    return fail(ErrorCode::kRefinementFailed,
                "the refinement ended without finite values (" + outcome.status + ")");
  }
  const std::vector<NodeVector> nodes = problem.unpack(outcome.z);
  refined.report.worst_residual = problem.worst_violation(nodes);
  refined.min_stability_margin_m = std::numeric_limits<double>::infinity();
  for (const NodeKinematics& node : problem.kinematics()) {
    refined.min_stability_margin_m =
        std::min(refined.min_stability_margin_m, stability_margin_m(node));
  }
  refined.nodes = whole_body_nodes(problem.setup(), nodes, 0.0);
  refined.report.cpu_time_s = thread_cpu_time_s() - start_s;
  refined.report.feasible = true;
  for (const auto& [name, residual] : refined.report.worst_residual) {
    if (residual <= tolerance_of(name, settings)) continue;
    refined.report.feasible = false;
    char detail[256];
    std::snprintf(
        detail, sizeof detail,
        "the refinement stopped after %d iterations (%s) with %s off by %.3g, allowed %.3g",
        outcome.iterations, outcome.status.c_str(), name.c_str(), residual,
        tolerance_of(name, settings));
    return fail(ErrorCode::kRefinementFailed, detail);
  }
  return refined;
}

}  // namespace wex
