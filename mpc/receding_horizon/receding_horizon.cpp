#include "mpc/receding_horizon/receding_horizon.hpp"

#include <algorithm>

#include "models/types/cpu_clock.hpp"
#include "mpc/nlp/driving_constraints.hpp"
#include "mpc/nlp/ipopt_solver.hpp"
#include "mpc/nlp/whole_body_trajectory.hpp"

namespace wex {
namespace {

constexpr CoordinateWeights kTracking{
    .base_xy = 8.0, .base_z = 4.0, .yaw = 12.0, .tilt = 8.0, .haa = 1.0, .hfe = 0.2, .steer = 0.1};
constexpr CoordinateWeights kRates{
    .base_xy = 2.0, .base_z = 0.5, .yaw = 2.0, .tilt = 1.0, .haa = 0.3, .hfe = 0.1, .steer = 0.1};
constexpr CoordinateWeights kAccelerations{
    .base_xy = 0.3, .base_z = 0.2, .yaw = 0.3, .tilt = 0.5, .haa = 0.3, .hfe = 0.2, .steer = 0.1};

// Legs that go ahead of the base are a trailer pushed backwards: an error grows with the way,
// e-fold in about 2 m. Within 5 s of slow driving that is so little that it would pay to leave it
// for later, again and again, until a leg lies at its end stops. What is left at the end therefore
// counts as though it stayed: for the way of 2 m and more at a third of the usual speed.
constexpr double kTrackingTailS = 30.0;

// A wheel that is off the ground by the model has this long to come down; price of 1 cm: 0.5.
constexpr int kSoftHeightNodes = 3;
constexpr double kHeightWeight = 1e4;
constexpr double kInequalityWeight = 1e4;  // margins may be short by millimetres, never ignored

constexpr double kSlipTolerance_m_s = 0.02;
constexpr double kHeightTolerance_m = 0.02;
constexpr double kMarginTolerance_m = 0.05;
constexpr double kRateTolerance = 0.01;  // rad/s, m/s

double tolerance_of(const std::string& name) {
  if (name == "side_slip_m_s") return kSlipTolerance_m_s;
  if (name == "wheel_height_m") return kHeightTolerance_m;
  if (name == "joint_rate_rad_s" || name == "wheel_speed_m_s") return kRateTolerance;
  return kMarginTolerance_m;
}

}  // namespace

struct RecedingHorizon::Impl {
  const TerrainMap* terrain;
  const MachineModel* machine;
  RefinedTrajectory reference;
  RecedingHorizonSettings settings;
  NlpLayout layout;
  IpoptSolver solver;
  std::vector<WholeBodyNode> last_nodes;  // previous result, for the guess

  TrajectorySetup make_setup(const HorizonInput& input) const;
  std::vector<NodeVector> guess(const TrajectorySetup& setup, double t_s) const;
};

RecedingHorizon::RecedingHorizon(const TerrainMap& terrain, const MachineModel& machine,
                                 RefinedTrajectory reference,
                                 const RecedingHorizonSettings& settings)
    : impl_(new Impl{&terrain,
                     &machine,
                     std::move(reference),
                     settings,
                     make_driving_layout(machine, settings.num_intervals),
                     IpoptSolver({.max_iterations = settings.max_iterations,
                                  .max_cpu_time_s = settings.max_cpu_time_s}),
                     {}}) {
  WEX_EXPECTS(!impl_->reference.nodes.empty());
}

RecedingHorizon::~RecedingHorizon() = default;
RecedingHorizon::RecedingHorizon(RecedingHorizon&&) noexcept = default;
RecedingHorizon& RecedingHorizon::operator=(RecedingHorizon&&) noexcept = default;

TrajectorySetup RecedingHorizon::Impl::make_setup(const HorizonInput& input) const {
  TrajectorySetup setup;
  setup.machine = machine;
  setup.layout = layout;
  setup.dt_s = settings.dt_s;
  double mean_bias_m = 0.0;  // the base rides as high above the wheels as in the reference
  for (const double bias_m : input.height_bias_m) mean_bias_m += bias_m / kNumWheels;
  for (int k = 0; k <= settings.num_intervals; ++k) {
    Eigen::VectorXd q = sample(reference.nodes, input.reference_time_s + k * settings.dt_s).q;
    q[kBaseZ] += mean_bias_m;
    if (k == 0) q = input.q;
    setup.q_held.push_back(q);
    setup.reference.push_back(layout.gather(q));
  }
  setup.before_first = layout.gather(input.q - settings.dt_s * input.qdot);
  setup.max_tilt_rad = settings.max_tilt_rad;
  setup.tracking = kTracking;
  setup.tracking_tail_s = kTrackingTailS;
  setup.rates = kRates;
  setup.accelerations = kAccelerations;
  add_driving_constraints(setup, *terrain,
                          {.min_stability_margin_m = settings.min_stability_margin_m,
                           .min_signed_distance_m = settings.min_signed_distance_m,
                           .rate_fraction = settings.rate_fraction,
                           .height_bias_m = input.height_bias_m,
                           .height = {kHeightWeight, kSoftHeightNodes, false},
                           .stability = {kInequalityWeight, settings.num_intervals, true},
                           .traversability = {kInequalityWeight, settings.num_intervals, true}});
  return setup;
}

std::vector<NodeVector> RecedingHorizon::Impl::guess(const TrajectorySetup& setup,
                                                     double t_s) const {
  std::vector<NodeVector> nodes = setup.reference;
  if (last_nodes.empty()) return nodes;
  for (int k = 1; k <= settings.num_intervals; ++k) {
    const double t_node_s = t_s + k * settings.dt_s;
    // Past the end of the previous result the reference goes on from where that result was.
    if (t_node_s <= last_nodes.back().t_s) {
      nodes[k] = layout.gather(sample(last_nodes, t_node_s).q);
    } else {
      nodes[k] = nodes[k - 1] + setup.reference[k] - setup.reference[k - 1];
    }
  }
  return nodes;
}

HorizonResult RecedingHorizon::solve(const HorizonInput& input) {
  Impl& m = *impl_;
  WEX_EXPECTS(input.q.size() == m.machine->num_coordinates());
  WEX_EXPECTS(input.qdot.size() == m.machine->num_coordinates());
  HorizonResult result;
  if (!input.q.allFinite() || !input.qdot.allFinite()) {
    result.report.status = "input is not finite";
    return result;
  }
  const double start_s = thread_cpu_time_s();
  TrajectoryProblem problem(m.make_setup(input));
  const IpoptOutcome outcome =
      m.solver.solve(problem, problem.pack(m.guess(problem.setup(), input.t_s)));
  result.report.status = outcome.status;
  result.report.iterations = outcome.iterations;
  result.report.objective = outcome.objective;
  if (outcome.z.allFinite()) {
    const std::vector<NodeVector> nodes = problem.unpack(outcome.z);
    result.report.worst_residual = problem.worst_violation(nodes, kSoftHeightNodes + 1);
    result.nodes = whole_body_nodes(problem.setup(), nodes, input.t_s);
    result.report.feasible =
        std::all_of(result.report.worst_residual.begin(), result.report.worst_residual.end(),
                    [](const auto& row) { return row.second <= tolerance_of(row.first); });
    // The first intervals are what is executed: their rates and slip must hold too.
    const std::map<std::string, double> all = problem.worst_violation(nodes, 1);
    result.usable = result.report.feasible && all.at("joint_rate_rad_s") <= kRateTolerance &&
                    all.at("wheel_speed_m_s") <= kRateTolerance &&
                    all.at("side_slip_m_s") <= kSlipTolerance_m_s;
  }
  if (result.usable) m.last_nodes = result.nodes;
  result.report.cpu_time_s = thread_cpu_time_s() - start_s;
  return result;
}

}  // namespace wex
