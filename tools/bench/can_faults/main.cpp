#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <string>

#include "tools/bench/can_faults/figures.hpp"
#include "tools/bench/can_faults/scenarios.hpp"

// can_faults [--full] [TEST...]: the fault scenarios of the bus, to be run by
// `tools/with_vcan --faults`. Exit code 1 if one of them could not run; `wex bench can` reads the
// verdicts.

namespace {

using wex::can_faults::Scene;

struct Scenario {
  const char* test;
  void (*run)(Scene& scene, bool full);
};

constexpr Scenario kScenarios[] = {
    {"T6", wex::can_faults::lose_frames},    {"T7", wex::can_faults::disturb_frames},
    {"T8", wex::can_faults::go_bus_off},     {"T9", wex::can_faults::stall_and_recover},
    {"T10", wex::can_faults::refuse_frames}, {"T11", wex::can_faults::flap_the_link},
    {"T12", wex::can_faults::end_processes}, {"T13", wex::can_faults::open_the_estop},
    {"T15", wex::can_faults::masquerade},    {"T17", wex::can_faults::lose_one_zone},
    {"T18", wex::can_faults::soak},          {"T22", wex::can_faults::jump_the_clock},
};

bool wanted(const char* test, int argc, char** argv) {
  bool any_named = false;
  for (int i = 1; i < argc; ++i) {
    if (argv[i][0] == '-') continue;
    if (std::strcmp(argv[i], test) == 0) return true;
    any_named = true;
  }
  return !any_named;
}

}  // namespace

int main(int argc, char** argv) {
  const bool full = argc > 1 && std::strcmp(argv[1], "--full") == 0;
  if (std::getenv("WITH_VCAN_INSIDE") == nullptr) {
    std::cerr << "can_faults: run this by tools/with_vcan --faults, it takes interfaces down\n";
    return 1;
  }
  try {
    auto scene = wex::can_faults::make_scene();
    if (!scene) {
      std::cerr << "can_faults: " << scene.error().message << "\n";
      return 1;
    }
    int code = 0;
    for (const Scenario& scenario : kScenarios) {
      if (!wanted(scenario.test, argc, argv)) continue;
      try {
        scenario.run(*scene, full);
      } catch (const std::exception& exception) {
        wex::can_faults::print_figure(scenario.test, "not run", exception.what(), "", false);
        code = 1;
      }
    }
    return code;
  } catch (const std::exception& exception) {
    std::cerr << "can_faults: " << exception.what() << "\n";
    return 1;
  }
}
