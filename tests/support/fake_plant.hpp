#pragma once

#include <algorithm>
#include <cmath>

#include "hw_interface/electronics/plant.hpp"
#include "models/excavator/machine_model.hpp"

namespace wex::can {

/// A machine without mechanics for tests of the electronics: every joint follows its input with a
/// first-order lag, valves shut within 50 ms once motion is not released.
class FakePlant final : public Plant {
 public:
  static constexpr double kPeriod_s = 0.01, kLag_s = 0.05, kShut_s = 0.05;

  explicit FakePlant(const MachineModel& machine) : machine_(machine) {
    state_.sensors_valid = state_.base_pose_valid = true;
    const Eigen::VectorXd posture = machine.transport_posture();
    for (int i = 0; i < machine.num_joints(); ++i) state_.position[i] = posture[i];
    state_.base[kBaseZ] = machine.default_base_height_m;
  }

  PlantState sense() noexcept override { return state_; }

  void act(const PlantInput& input) noexcept override {
    last_input = input;
    constexpr double kBlend = kPeriod_s / kLag_s;
    for (int i = 0; i < machine_.num_joints(); ++i) {
      const Joint& joint = machine_.joints[i];
      const bool wheel = joint.role == JointRole::kWheel;
      double& rate = state_.rate[i];
      if (wheel) {
        rate += (input.motion_released && !input.braked[i] ? kBlend : 1.0) *
                (input.wheel_rate[i] - rate);
      } else if (input.motion_released) {
        const double open = std::max(0.0, std::abs(input.spool[i]) - machine_.valve_dead_band);
        const double wanted = open / (1.0 - machine_.valve_dead_band) * joint.max_rate;
        rate += kBlend * (std::copysign(wanted, input.spool[i]) - rate);
      } else {
        const double slower = std::abs(rate) - joint.max_rate * kPeriod_s / kShut_s;
        rate = std::copysign(std::max(0.0, slower), rate);
      }
      state_.position[i] += state_.rate[i] * kPeriod_s;
    }
  }

  PlantState& state() { return state_; }
  [[nodiscard]] double fastest_rate() const {
    double fastest = 0.0;
    for (const double rate : state_.rate) fastest = std::max(fastest, std::abs(rate));
    return fastest;
  }

  PlantInput last_input;

 private:
  const MachineModel& machine_;
  PlantState state_;
};

}  // namespace wex::can
