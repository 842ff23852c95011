#include "hw_interface/mujoco/simulated_machine.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hw_interface/joint_loop.hpp"
#include "models/types/cpu_clock.hpp"

namespace wex {
namespace {

constexpr double kTimeTolerance_s = 1e-9;
constexpr double kLimitTolerance = 1e-6;      ///< rad/s, rad (m/s, m): rounding of a planner
constexpr double kHardRateFactor = 2.0;       ///< of the joint's largest rate, as on the bus
constexpr double kHardPositionMargin = 0.25;  ///< rad or m beyond an end stop, likewise
constexpr double kStandingRate = 0.02;        ///< rad/s or m/s
constexpr double kStopPatience_s = 2.0;

JointLoopSettings joint_loop_settings(const MachineModel& machine,
                                      const SimulationSettings& settings) {
  JointLoopSettings loop;
  loop.period_s = settings.control_period_s;
  loop.dead_band = machine.valve_dead_band;
  loop.load_balance = settings.load_balance;
  return loop;
}

}  // namespace

struct SimulatedMachine::Impl {
  Impl(const MachineModel& machine_in, const SimulationSettings& settings_in,
       std::unique_ptr<SimulatedPlant> plant_in)
      : machine(machine_in),
        settings(settings_in),
        plant(std::move(plant_in)),
        loop(machine, joint_loop_settings(machine, settings)) {}

  /// One control period: joint loop, then the plant.
  void advance() noexcept {
    if (has_command && plant->time_s() > command.valid_until_s + kTimeTolerance_s) {
      has_command = false;
      ++health.expiries;
    }
    ActuatorCommand wanted;
    if (!plant->broken()) {
      const bool live = has_command && !stopped;
      wanted = loop.update(live ? &command : nullptr, plant->measure());
    }
    plant->tick(wanted);
  }

  /// Rates or targets that no planner's slip explains.
  bool far_beyond_limits(const JointCommand& wanted) const noexcept {
    for (int i = 0; i < machine.num_joints(); ++i) {
      const Joint& joint = machine.joints[i];
      const double target = wanted.position_target[i];
      if (std::abs(wanted.rate[i]) > kHardRateFactor * joint.max_rate ||
          (wanted.has_position_target[i] && (target < joint.lower - kHardPositionMargin ||
                                             target > joint.upper + kHardPositionMargin))) {
        return true;
      }
    }
    return false;
  }

  bool stands() const noexcept {
    const JointMeasurement measured = plant->measure();
    return std::all_of(measured.rate.begin(), measured.rate.begin() + machine.num_joints(),
                       [](double rate) { return std::abs(rate) < kStandingRate; });
  }

  /// Brings the command into the joints' limits; true if it was not.
  bool clamp_command() noexcept {
    bool clamped = false;
    const auto bring_into = [&clamped](double& value, double lower, double upper) {
      const double within = std::clamp(value, lower, upper);
      clamped = clamped || std::abs(within - value) > kLimitTolerance;
      value = within;
    };
    for (int i = 0; i < machine.num_joints(); ++i) {
      const Joint& joint = machine.joints[i];
      bring_into(command.rate[i], -joint.max_rate, joint.max_rate);
      if (!command.has_position_target[i]) continue;
      bring_into(command.position_target[i], joint.lower, joint.upper);
    }
    return clamped;
  }

  MachineState state() noexcept {
    MachineState state;
    state.t_s = plant->time_s();
    const can::PlantState sensed = plant->sense();
    state.base = sensed.base;
    state.base_velocity = sensed.base_velocity;
    state.num_joints = machine.num_joints();
    state.position = sensed.position;
    state.rate = sensed.rate;
    state.effort = sensed.effort;
    for (int i = 0; i < state.num_joints; ++i) state.position[i] -= loop.offset_of_joint_rad(i);
    return state;
  }

  MachineModel machine;
  SimulationSettings settings;
  std::unique_ptr<SimulatedPlant> plant;
  JointLoop loop;

  JointCommand command;
  bool has_command = false, stopped = false, active = true;
  MachineHealth health;
  MachineState last_state;
  double cpu_time_s = 0.0;
};

SimulatedMachine::SimulatedMachine(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SimulatedMachine::~SimulatedMachine() = default;

Result<std::unique_ptr<SimulatedMachine>> SimulatedMachine::create(
    const MachineModel& machine, const TerrainMap& terrain, const Eigen::VectorXd& q,
    const SimulationSettings& settings) {
  auto plant = SimulatedPlant::create(machine, terrain, q, settings);
  if (!plant) return tl::unexpected(plant.error());
  auto impl = std::make_unique<Impl>(machine, settings, std::move(*plant));
  while (impl->plant->time_s() < settings.settle_time_s - kTimeTolerance_s &&
         !impl->plant->broken()) {
    impl->advance();
  }
  if (impl->plant->broken()) {
    return fail(ErrorCode::kInternal,
                "MuJoCo: the state is not finite any more after placing the machine");
  }
  impl->plant->restart_clock();
  impl->last_state = impl->state();
  return std::unique_ptr<SimulatedMachine>(new SimulatedMachine(std::move(impl)));
}

MachineState SimulatedMachine::read() noexcept {
  MachineState& last = impl_->last_state;
  if (!impl_->plant->broken()) last = impl_->state();
  last.age_s = impl_->plant->time_s() - last.t_s;
  last.joint_age_s.fill(last.age_s);
  if (impl_->plant->broken()) last.joint_quality.fill(SignalQuality::kInvalid);
  return last;
}

WriteOutcome SimulatedMachine::write(const JointCommand& command) noexcept {
  const WriteOutcome outcome = [&] {
    const int num_joints = impl_->machine.num_joints();
    if (impl_->stopped || impl_->plant->broken()) return WriteOutcome::kRejectedStopped;
    if (command.num_joints != num_joints) return WriteOutcome::kRejectedWrongSize;
    bool finite = std::isfinite(command.valid_until_s);
    for (int i = 0; i < num_joints; ++i) {
      finite = finite && std::isfinite(command.rate[i]) &&
               (!command.has_position_target[i] || std::isfinite(command.position_target[i]));
    }
    if (!finite || impl_->far_beyond_limits(command)) {
      impl_->has_command = false;
      return finite ? WriteOutcome::kRejectedRange : WriteOutcome::kRejectedNotFinite;
    }
    if (!impl_->active) return WriteOutcome::kRejectedNotActive;
    if (command.valid_until_s < impl_->plant->time_s()) return WriteOutcome::kRejectedExpired;
    impl_->command = command;
    impl_->has_command = true;
    return impl_->clamp_command() ? WriteOutcome::kClamped : WriteOutcome::kAccepted;
  }();
  ++(taken(outcome) ? impl_->health.commands_accepted : impl_->health.commands_rejected);
  if (outcome == WriteOutcome::kClamped) ++impl_->health.commands_clamped;
  return outcome;
}

void SimulatedMachine::stop() noexcept {
  impl_->stopped = true;
  impl_->has_command = false;
}

void SimulatedMachine::release() noexcept { impl_->stopped = false; }

MachineHealth SimulatedMachine::health() const noexcept {
  MachineHealth health = impl_->health;
  health.stall_stops = impl_->loop.stall_stops();
  const bool moving = impl_->has_command && !impl_->stopped && !impl_->loop.stalled();
  health.level = impl_->plant->broken() ? HealthLevel::kFault
                 : moving               ? HealthLevel::kOk
                                        : HealthLevel::kHolding;
  return health;
}

void SimulatedMachine::wait_until(double t_s) {
  const double start_s = thread_cpu_time_s();
  while (impl_->plant->time_s() < t_s - kTimeTolerance_s) impl_->advance();
  impl_->cpu_time_s += thread_cpu_time_s() - start_s;
}

Lifecycle SimulatedMachine::lifecycle() const noexcept {
  if (impl_->plant->broken()) return Lifecycle::kFault;
  return impl_->active ? Lifecycle::kActive : Lifecycle::kInactive;
}

Result<void> SimulatedMachine::activate() {
  if (impl_->plant->broken()) {
    return fail(ErrorCode::kStoppedSafely, "the simulation's state is not finite any more");
  }
  if (impl_->stopped) {
    return fail(ErrorCode::kStoppedSafely, "a stop is in force, release it first");
  }
  impl_->active = true;
  return {};
}

void SimulatedMachine::deactivate() noexcept {
  if (lifecycle() != Lifecycle::kActive) return;
  impl_->has_command = false;
  const double end_s = impl_->plant->time_s() + kStopPatience_s;
  while (!impl_->stands() && impl_->plant->time_s() < end_s) impl_->advance();
  impl_->active = false;
}

GroundTruth SimulatedMachine::ground_truth() const { return impl_->plant->ground_truth(); }

std::array<double, kNumWheels> SimulatedMachine::load_balance_offset_rad() const noexcept {
  return impl_->loop.load_balance_offset_rad();
}

Eigen::VectorXd SimulatedMachine::scalar_joint_positions() const {
  return impl_->plant->scalar_joint_positions();
}

Result<void> SimulatedMachine::render(const std::string& png_file, int width_px, int height_px) {
  return impl_->plant->render(png_file, width_px, height_px);
}

double SimulatedMachine::cpu_time_s() const noexcept { return impl_->cpu_time_s; }

}  // namespace wex
