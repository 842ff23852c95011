#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "hw_interface/socketcan/socketcan_machine.hpp"

namespace wex::app {

/// What a run saw of the bus between opening the interface and leaving the machine.
struct BusReport {
  std::string interface_name;
  bool lock_step = false;  ///< the machine's clock waited for the program
  std::string end_state;   ///< of the host's automaton: "inactive", "fault", ...
  std::string cause;       ///< why it is in that state; empty: nothing to say
  can::BusStatistics statistics;
  double machine_s = 0.0;  ///< machine time that passed meanwhile; 0: not known
  std::string log;         ///< file in the output folder with the last frames; empty: none written
};

/// For a person: "inactive", "active", "fault" ...
[[nodiscard]] const char* name_of(can::HostPhase phase) noexcept;

/// The present state of a machine; lock_step as it was when the interface was opened.
[[nodiscard]] BusReport bus_report(const std::string& interface_name, bool lock_step,
                                   const can::SocketCanMachine& machine);

/// The object "bus" of result.json (fields: tools/wex/README.md).
[[nodiscard]] nlohmann::ordered_json bus_json(const BusReport& report);

}  // namespace wex::app
