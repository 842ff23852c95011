#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <ostream>
#include <string>

#include "models/types/pose.hpp"
#include "models/types/result.hpp"

namespace wex::app {

/// What the user asks of `wex machine`.
struct MachineOptions {
  std::string can_interface;
  std::filesystem::path map;   ///< empty: flat ground
  std::optional<Pose2> start;  ///< map frame; default: the JSON beside the map, or the origin
  bool lock_step = false;
  double patience_s = 10.0;  ///< lock step: wall time an enabled machine's clock waits for the host
  std::filesystem::path log;                          ///< empty: none
  std::optional<double> estop_after_s, exit_after_s;  ///< machine time
  std::optional<std::uint64_t> seed;  ///< of challenges and sessions; empty: the kernel's generator
  std::string machine = "m545";
};

/// The simulated machine at the other end of the bus, until SIGTERM, SIGINT or exit_after_s.
///   out     one line once the machine is on the bus, one at the end
///   errors  kBadInput: no such interface, map or start; kInternal: the simulation does not stand
[[nodiscard]] Result<void> run_machine(const MachineOptions& options, std::ostream& out);

}  // namespace wex::app
