#pragma once

#include "tools/bench/can_faults/peers.hpp"

namespace wex::can_faults {

/// Faults of a real kernel's bus between a host and a machine in real time. Each prints its figures
/// (print_figure). `full`: long; else the form for CI. They throw std::runtime_error when the
/// faults cannot be had or the machine cannot be enabled in health.
void lose_frames(Scene& scene, bool full);        // T6
void disturb_frames(Scene& scene, bool full);     // T7
void go_bus_off(Scene& scene, bool full);         // T8
void stall_and_recover(Scene& scene, bool full);  // T9
void refuse_frames(Scene& scene, bool full);      // T10
void flap_the_link(Scene& scene, bool full);      // T11
void end_processes(Scene& scene, bool full);      // T12
void open_the_estop(Scene& scene, bool full);     // T13
void masquerade(Scene& scene, bool full);         // T15
void lose_one_zone(Scene& scene, bool full);      // T17
void soak(Scene& scene, bool full);               // T18
void jump_the_clock(Scene& scene, bool full);     // T22

}  // namespace wex::can_faults
