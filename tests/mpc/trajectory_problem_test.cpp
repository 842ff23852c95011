#include "mpc/nlp/trajectory_problem.hpp"

#include <gmock/gmock.h>

#include <random>

#include "mpc/nlp/driving_constraints.hpp"
#include "tests/support/driving_plan.hpp"

namespace wex {
namespace {

class TrajectoryProblemTest : public ::testing::TestWithParam<bool> {
 protected:
  MachineModel machine_ = load_machine().value();
  TerrainMap terrain_ = test::rolling_ground(0.15);

  TrajectoryProblem make_problem(bool end_at_rest) {
    constexpr int kNodes = 5;
    TrajectorySetup setup;
    setup.machine = &machine_;
    setup.layout = make_driving_layout(machine_, kNodes);
    setup.end_at_rest = setup.fix_goal = end_at_rest;
    const Plan plan = test::arc_plan(terrain_, machine_, {3.0, 0.0, 0.1}, 1.0, 0.1);
    for (int k = 0; k <= kNodes; ++k) {
      setup.q_held.push_back(sample(plan.nodes, k * setup.dt_s).q);
      setup.reference.push_back(setup.layout.gather(setup.q_held.back()));
    }
    setup.before_first = setup.reference[0] - 0.1 * (setup.reference[1] - setup.reference[0]);
    setup.tracking = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0};
    setup.tracking_tail_s = 1.5;
    setup.rates = {0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1};
    setup.accelerations = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7};
    add_driving_constraints(setup, terrain_,
                            {.height = {100.0, 2, false}, .stability = {50.0, kNodes, true}});
    return TrajectoryProblem(std::move(setup));
  }

  Eigen::VectorXd random_point(TrajectoryProblem& problem) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> noise(-0.05, 0.05);
    Eigen::VectorXd z = problem.pack(problem.setup().reference);
    for (double& value : z) value += noise(random);
    return z;
  }
};

TEST_P(TrajectoryProblemTest, GradientAndHessianOfTheCostMatchFiniteDifferences) {
  TrajectoryProblem problem = make_problem(GetParam());
  const Eigen::VectorXd z = random_point(problem);
  const int n = problem.num_variables();
  Eigen::VectorXd gradient(n), plus(n), minus(n);
  problem.gradient(z, gradient);
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t e = 0; e < problem.hessian_values().size(); ++e) {
    const int r = problem.hessian_rows()[e], c = problem.hessian_columns()[e];
    ASSERT_GE(r, c) << "only the lower triangle may be listed";
    hessian(r, c) += problem.hessian_values()[e];
    if (r != c) hessian(c, r) += problem.hessian_values()[e];
  }
  constexpr double kStep = 1e-4;
  for (int i = 0; i < n; ++i) {
    Eigen::VectorXd shifted = z;
    shifted[i] += kStep;
    const double cost_plus = problem.cost(shifted);
    problem.gradient(shifted, plus);
    shifted[i] -= 2.0 * kStep;
    const double cost_minus = problem.cost(shifted);
    problem.gradient(shifted, minus);
    EXPECT_NEAR(gradient[i], (cost_plus - cost_minus) / (2.0 * kStep), 1e-5);
    EXPECT_LT((hessian.col(i) - (plus - minus) / (2.0 * kStep)).cwiseAbs().maxCoeff(), 1e-5)
        << "variable " << i;
  }
}

TEST_P(TrajectoryProblemTest, SparseJacobianMatchesFiniteDifferencesOfAllRows) {
  TrajectoryProblem problem = make_problem(GetParam());
  const Eigen::VectorXd z = random_point(problem);
  Eigen::VectorXd values(static_cast<Eigen::Index>(problem.jacobian_rows().size()));
  problem.jacobian(z, values);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(problem.num_rows(), problem.num_variables());
  for (std::size_t e = 0; e < problem.jacobian_rows().size(); ++e) {
    jacobian(problem.jacobian_rows()[e], problem.jacobian_columns()[e]) +=
        values[static_cast<Eigen::Index>(e)];
  }
  constexpr double kStep = 1e-6;
  Eigen::VectorXd plus(problem.num_rows()), minus(problem.num_rows());
  for (int i = 0; i < problem.num_variables(); ++i) {
    Eigen::VectorXd shifted = z;
    shifted[i] += kStep;
    problem.rows(shifted, plus);
    shifted[i] -= 2.0 * kStep;
    problem.rows(shifted, minus);
    const Eigen::VectorXd numeric = (plus - minus) / (2.0 * kStep);
    EXPECT_LT((jacobian.col(i) - numeric).cwiseAbs().maxCoeff(), 2e-4) << "variable " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Ends, TrajectoryProblemTest, ::testing::Bool(), [](const auto& info) {
  return info.param ? std::string("AtRestAtTheGoal") : std::string("OpenEnd");
});

}  // namespace
}  // namespace wex
