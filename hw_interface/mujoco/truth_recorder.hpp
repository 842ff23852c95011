#pragma once

#include <mujoco/mujoco.h>

#include <array>
#include <vector>

#include "hw_interface/mujoco/simulated_plant.hpp"

namespace wex {

/// Collects the GroundTruth of a simulation, step by step. Loads are means over a control period:
/// a rigid wheel on a rigid height field loses its contact for single steps, which says nothing of
/// the machine. Allocation-free after construction.
class TruthRecorder {
 public:
  TruthRecorder(const MachineModel& machine, const mjModel* model);

  /// Forgets everything integrated so far.
  void reset() noexcept;
  /// After each mj_step of dt_s: contacts and velocities of that step.
  void observe(const mjModel* model, const mjData* data, double dt_s) noexcept;
  /// After the last step of a control period.
  void end_period(double period_s) noexcept;
  /// base: filled in by the owner, who keeps yaw unwrapped.
  [[nodiscard]] GroundTruth truth(const mjData* data) const;

 private:
  struct Wheel {
    int body = -1, site = -1, tyre_qpos = -1, wheel_dof = -1;
    double radius_m = 0.0;
  };
  /// Contact of one wheel.
  struct Patch {
    double load_n = 0.0;
    double penetration_m = 0.0;
    std::array<double, 3> moment{};  ///< load times position
    [[nodiscard]] std::array<double, 3> centre() const {
      return {moment[0] / load_n, moment[1] / load_n, moment[2] / load_n};
    }
    void add(const Patch& other) noexcept;
  };
  using Patches = std::array<Patch, kNumWheels>;

  [[nodiscard]] Patches contacts(const mjModel* model, const mjData* data) noexcept;

  std::array<Wheel, kNumWheels> wheels_{};
  std::vector<int> wheel_of_geom_;  ///< -1: none
  Patches patches_{};               ///< means over the last whole period, penetration its largest
  Patches period_sum_{};            ///< of the period under way
  int steps_in_period_ = 0;
  std::array<double, kNumWheels> side_slip_m_{}, travel_m_{}, airborne_s_{};
  bool body_contact_ = false;
};

}  // namespace wex
