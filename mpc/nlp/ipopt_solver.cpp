#include "mpc/nlp/ipopt_solver.hpp"

#include <IpIpoptApplication.hpp>
#include <IpIpoptCalculatedQuantities.hpp>
#include <IpIpoptData.hpp>
#include <IpSolveStatistics.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <exception>

namespace wex {
namespace {

using Ipopt::Index;
using Ipopt::Number;

constexpr Number kIpoptInfinity = 1e20;

void copy_bounds(const Eigen::VectorXd& from, Number* to) {
  for (Eigen::Index i = 0; i < from.size(); ++i) {
    to[i] = std::clamp(from[i], -kIpoptInfinity, kIpoptInfinity);
  }
}

/// Presents a TrajectoryProblem to Ipopt for one solve.
class Adapter final : public Ipopt::TNLP {
 public:
  Adapter(TrajectoryProblem& problem, const Eigen::VectorXd& guess, const WarmStart& warm_start,
          const IpoptSolver::Observer& observer)
      : problem_(problem), warm_start_(warm_start), observer_(observer), z_(guess) {
    outcome.z = guess;
  }

  bool get_nlp_info(Index& n, Index& m, Index& nnz_jac_g, Index& nnz_h_lag,
                    IndexStyleEnum& index_style) override {
    n = problem_.num_variables();
    m = problem_.num_rows();
    nnz_jac_g = static_cast<Index>(problem_.jacobian_rows().size());
    nnz_h_lag = static_cast<Index>(problem_.hessian_rows().size());
    index_style = TNLP::C_STYLE;
    return true;
  }

  bool get_bounds_info(Index, Number* x_l, Number* x_u, Index, Number* g_l, Number* g_u) override {
    copy_bounds(problem_.lower(), x_l);
    copy_bounds(problem_.upper(), x_u);
    copy_bounds(problem_.row_lower(), g_l);
    copy_bounds(problem_.row_upper(), g_u);
    return true;
  }

  bool get_starting_point(Index n, bool init_x, Number* x, bool init_z, Number* z_l, Number* z_u,
                          Index m, bool init_lambda, Number* lambda) override {
    if (init_x) std::copy_n(z_.data(), n, x);
    if (init_z) {
      std::copy_n(warm_start_.lower_multipliers.data(), n, z_l);
      std::copy_n(warm_start_.upper_multipliers.data(), n, z_u);
    }
    if (init_lambda) std::copy_n(warm_start_.row_multipliers.data(), m, lambda);
    return true;
  }

  bool eval_f(Index n, const Number* x, bool, Number& value) override {
    value = problem_.cost(load(n, x));
    return true;
  }

  bool eval_grad_f(Index n, const Number* x, bool, Number* gradient) override {
    problem_.gradient(load(n, x), Eigen::Map<Eigen::VectorXd>(gradient, n));
    return true;
  }

  bool eval_g(Index n, const Number* x, bool, Index m, Number* g) override {
    problem_.rows(load(n, x), Eigen::Map<Eigen::VectorXd>(g, m));
    return true;
  }

  bool eval_jac_g(Index n, const Number* x, bool, Index, Index nnz, Index* rows, Index* columns,
                  Number* values) override {
    if (values == nullptr) {
      std::copy_n(problem_.jacobian_rows().data(), nnz, rows);
      std::copy_n(problem_.jacobian_columns().data(), nnz, columns);
    } else {
      problem_.jacobian(load(n, x), Eigen::Map<Eigen::VectorXd>(values, nnz));
    }
    return true;
  }

  bool eval_h(Index, const Number*, bool, Number objective_factor, Index, const Number*, bool,
              Index nnz, Index* rows, Index* columns, Number* values) override {
    if (values == nullptr) {
      std::copy_n(problem_.hessian_rows().data(), nnz, rows);
      std::copy_n(problem_.hessian_columns().data(), nnz, columns);
    } else {
      for (Index i = 0; i < nnz; ++i) values[i] = objective_factor * problem_.hessian_values()[i];
    }
    return true;
  }

  bool intermediate_callback(Ipopt::AlgorithmMode, Index iteration, Number objective,
                             Number infeasibility, Number, Number, Number, Number, Number, Number,
                             Index, const Ipopt::IpoptData*,
                             Ipopt::IpoptCalculatedQuantities*) override {
    if (observer_) observer_(iteration, objective, infeasibility);
    return true;
  }

  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* x, const Number* z_l,
                         const Number* z_u, Index m, const Number*, const Number* lambda,
                         Number objective, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    outcome.z = Eigen::Map<const Eigen::VectorXd>(x, n);
    outcome.multipliers.lower_multipliers = Eigen::Map<const Eigen::VectorXd>(z_l, n);
    outcome.multipliers.upper_multipliers = Eigen::Map<const Eigen::VectorXd>(z_u, n);
    outcome.multipliers.row_multipliers = Eigen::Map<const Eigen::VectorXd>(lambda, m);
    outcome.objective = objective;
  }

  IpoptOutcome outcome;

 private:
  const Eigen::VectorXd& load(Index n, const Number* x) {
    z_ = Eigen::Map<const Eigen::VectorXd>(x, n);
    return z_;
  }

  TrajectoryProblem& problem_;
  const WarmStart& warm_start_;
  const IpoptSolver::Observer& observer_;
  Eigen::VectorXd z_;
};

std::string describe(Ipopt::ApplicationReturnStatus status) {
  switch (status) {
    case Ipopt::Solve_Succeeded:
      return "solved";
    case Ipopt::Solved_To_Acceptable_Level:
      return "solved to acceptable level";
    case Ipopt::Infeasible_Problem_Detected:
      return "locally infeasible";
    case Ipopt::Search_Direction_Becomes_Too_Small:
      return "search direction too small";
    case Ipopt::Maximum_Iterations_Exceeded:
      return "iteration limit";
    case Ipopt::Maximum_CpuTime_Exceeded:
      return "time limit";
    case Ipopt::Restoration_Failed:
      return "restoration failed";
    case Ipopt::Invalid_Number_Detected:
      return "not a finite number";
    default:
      return "solver error " + std::to_string(static_cast<int>(status));
  }
}

}  // namespace

struct IpoptSolver::Impl {
  Ipopt::SmartPtr<Ipopt::IpoptApplication> application;
  IpoptSettings settings;
};

IpoptSolver::IpoptSolver(const IpoptSettings& settings) : impl_(std::make_unique<Impl>()) {
  impl_->settings = settings;
  impl_->application = new Ipopt::IpoptApplication(false);
  auto options = impl_->application->Options();
  options->SetIntegerValue("print_level", 0);
  options->SetStringValue("sb", "yes");
  options->SetStringValue("linear_solver", "mumps");
  options->SetStringValue("hessian_constant", "yes");
  options->SetStringValue("mu_strategy", "monotone");
  options->SetIntegerValue("max_iter", settings.max_iterations);
  options->SetNumericValue("max_cpu_time", settings.max_cpu_time_s);
  options->SetNumericValue("tol", settings.tolerance);
  options->SetNumericValue("constr_viol_tol", settings.constraint_tolerance);
  options->SetNumericValue("dual_inf_tol", 1e-1);
  options->SetNumericValue("compl_inf_tol", 1e-3);
  options->SetNumericValue("acceptable_tol", 10.0 * settings.tolerance);
  options->SetNumericValue("acceptable_constr_viol_tol", settings.constraint_tolerance);
  options->SetNumericValue("bound_relax_factor", 1e-8);
  impl_->application->Initialize();
}

IpoptSolver::~IpoptSolver() = default;
IpoptSolver::IpoptSolver(IpoptSolver&&) noexcept = default;
IpoptSolver& IpoptSolver::operator=(IpoptSolver&&) noexcept = default;

IpoptOutcome IpoptSolver::solve(TrajectoryProblem& problem, const Eigen::VectorXd& guess,
                                const WarmStart& warm_start, const Observer& observer) {
  auto options = impl_->application->Options();
  const bool warm = !warm_start.empty();
  options->SetStringValue("warm_start_init_point", warm ? "yes" : "no");
  options->SetNumericValue("mu_init", warm ? 1e-3 : impl_->settings.initial_barrier);
  for (const char* push :
       {"warm_start_bound_push", "warm_start_bound_frac", "warm_start_slack_bound_push",
        "warm_start_slack_bound_frac", "warm_start_mult_bound_push"}) {
    options->SetNumericValue(push, 1e-4);
  }
  const Ipopt::SmartPtr<Adapter> adapter = new Adapter(problem, guess, warm_start, observer);
  try {
    const Ipopt::ApplicationReturnStatus status =
        impl_->application->OptimizeTNLP(Ipopt::SmartPtr<Ipopt::TNLP>(GetRawPtr(adapter)));
    adapter->outcome.converged =
        status == Ipopt::Solve_Succeeded || status == Ipopt::Solved_To_Acceptable_Level;
    adapter->outcome.status = describe(status);
    if (IsValid(impl_->application->Statistics())) {
      adapter->outcome.iterations = impl_->application->Statistics()->IterationCount();
    }
  } catch (const std::exception& error) {
    adapter->outcome.status = std::string("solver exception: ") + error.what();
  }
  return adapter->outcome;
}

}  // namespace wex
