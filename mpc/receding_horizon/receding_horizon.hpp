#pragma once

#include <array>
#include <memory>

#include "models/excavator/machine_model.hpp"
#include "models/terrain/terrain_map.hpp"
#include "models/types/plan.hpp"
#include "models/types/result.hpp"

namespace wex {

struct RecedingHorizonSettings {
  int num_intervals = 20;
  double dt_s = 0.25;  ///< horizon = num_intervals * dt_s, 5 s
  double min_stability_margin_m = 0.25;
  double min_signed_distance_m = 0.15;
  double max_tilt_rad = 0.3490658503988659;
  double rate_fraction = 0.95;
  int max_iterations = 40;
  double max_cpu_time_s = 0.5;
};

/// Where the machine is and what it is to track, at the moment the result will be applied.
struct HorizonInput {
  double t_s = 0.0;               ///< machine time of q
  Eigen::VectorXd q;              ///< predicted whole-body coordinates at t_s
  Eigen::VectorXd qdot;           ///< predicted rates at t_s
  double reference_time_s = 0.0;  ///< time on the refined trajectory that belongs to t_s
  std::array<double, kNumWheels> height_bias_m{};  ///< wheel centre above the model's, estimated
};

/// A trajectory from t_s on. nodes[0] is the input state; absolute machine time in t_s.
struct HorizonResult {
  std::vector<WholeBodyNode> nodes;
  SolveReport report;   ///< feasible = hard rows met and soft rows within tolerance
  bool usable = false;  ///< finite and within limits: may be executed
};

/// Receding-horizon optimizer that tracks one refined trajectory; keeps its warm start between
/// calls. Not real-time code: one solve per call on the caller's thread. Not thread-safe.
class RecedingHorizon {
 public:
  RecedingHorizon(const TerrainMap& terrain, const MachineModel& machine,
                  RefinedTrajectory reference, const RecedingHorizonSettings& settings = {});
  ~RecedingHorizon();
  RecedingHorizon(RecedingHorizon&&) noexcept;
  RecedingHorizon& operator=(RecedingHorizon&&) noexcept;

  [[nodiscard]] HorizonResult solve(const HorizonInput& input);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wex
