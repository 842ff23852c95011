#pragma once

#include <memory>
#include <string>

#include "hw_interface/mujoco/simulated_plant.hpp"
#include "models/excavator/machine_model.hpp"
#include "tools/bench/can_faults/blackboard.hpp"

namespace wex::can_faults {

/// Machine on flat ground, settled once; every process that is forked drives its own copy of it.
struct Scene {
  MachineModel machine;
  std::unique_ptr<SimulatedPlant> plant;
};
[[nodiscard]] Result<Scene> make_scene();

struct HostOptions {
  bool purge = true;  ///< empty the send queue of a stalled bus by a link flap
  /// Interface whose controller reports the errors of the bus; empty: the host's own.
  std::string error_interface;
};

/// The electronics and the plant behind them in real time, until the blackboard says so. Exit code
/// 0, or 1 with a sentence on stderr.
[[nodiscard]] int run_machine(Scene& scene, const std::string& interface_name, Blackboard& board);
/// A program that drives: commands as the blackboard wishes, activates when told to.
[[nodiscard]] int run_host(const Scene& scene, const std::string& interface_name,
                           const HostOptions& options, Blackboard& board);

}  // namespace wex::can_faults
