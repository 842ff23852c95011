#pragma once

#include <functional>
#include <memory>
#include <string>

#include "models/types/result.hpp"
#include "mpc/nlp/trajectory_problem.hpp"

namespace wex {

struct IpoptSettings {
  int max_iterations = 200;
  double max_cpu_time_s = 60.0;
  double tolerance = 1e-3;             ///< scaled optimality
  double constraint_tolerance = 1e-4;  ///< rows, in their own units
  double initial_barrier = 1e-2;
};

/// Primal and dual values to start from; empty: only the primal guess is used.
struct WarmStart {
  Eigen::VectorXd lower_multipliers, upper_multipliers, row_multipliers;
  [[nodiscard]] bool empty() const { return row_multipliers.size() == 0; }
};

struct IpoptOutcome {
  Eigen::VectorXd z;
  WarmStart multipliers;
  bool converged = false;  ///< Ipopt's own verdict; callers check the rows themselves
  std::string status;
  int iterations = 0;
  double objective = 0.0;
};

/// Ipopt with MUMPS. Keeps the application (options, linear solver) between solves. Calls of
/// several threads are serialised inside MUMPS. Not thread-safe.
class IpoptSolver {
 public:
  using Observer = std::function<void(int iteration, double objective, double infeasibility)>;

  explicit IpoptSolver(const IpoptSettings& settings);
  ~IpoptSolver();
  IpoptSolver(IpoptSolver&&) noexcept;
  IpoptSolver& operator=(IpoptSolver&&) noexcept;

  /// Never throws; a failure inside Ipopt is a status.
  [[nodiscard]] IpoptOutcome solve(TrajectoryProblem& problem, const Eigen::VectorXd& guess,
                                   const WarmStart& warm_start = {}, const Observer& observer = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wex
