#include "hw_interface/mujoco/simulated_machine.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "hw_interface/joint_loop.hpp"
#include "hw_interface/mujoco/ground_field.hpp"
#include "hw_interface/mujoco/offscreen_renderer.hpp"
#include "hw_interface/mujoco/truth_recorder.hpp"
#include "hw_interface/mujoco/valve_chain.hpp"
#include "models/excavator/mjcf.hpp"
#include "models/excavator/mujoco_model.hpp"
#include "models/types/cpu_clock.hpp"

namespace wex {
namespace {

constexpr double kTimeTolerance_s = 1e-9;
constexpr double kLimitTolerance = 1e-6;  ///< rad/s, rad (m/s, m): rounding of a planner
constexpr double kRadToDeg = 180.0 / std::numbers::pi;

JointLoopSettings joint_loop_settings(const MachineModel& machine,
                                      const SimulationSettings& settings) {
  JointLoopSettings loop;
  loop.period_s = settings.control_period_s;
  loop.dead_band = machine.valve_dead_band;
  loop.load_balance = settings.load_balance;
  return loop;
}

/// Machine and terrain as one compiled model.
Result<MujocoModel> compile_scene(const MachineModel& machine, const TerrainMap& terrain,
                                  const SimulationSettings& settings) {
  auto spec = machine_spec(machine);
  if (!spec) return tl::unexpected(spec.error());
  spec->get()->option.timestep = settings.timestep_s;
  add_ground(spec->get(), terrain.elevation(), settings.ground_friction);
  add_scenery(spec->get(), terrain.elevation(), machine.tree.bodies().front().name);
  auto model = compile(spec->get());
  if (!model) return model;
  mjModel& m = **model;
  // A state that is not finite is a fault to report, not something to restart from.
  m.opt.disableflags |= mjDSBL_AUTORESET;
  for (int g = 0; g < m.ngeom; ++g) {
    if (m.geom_group[g] == kLoadBearingGroup) m.geom_friction[3 * g] = settings.ground_friction;
  }
  return model;
}

}  // namespace

struct SimulatedMachine::Impl {
  struct Address {
    int qpos = 0, dof = 0, act = -1;
    double relief = 0.0;  ///< how far the oil column can be pressed before its valve opens
  };

  Impl(const MachineModel& machine_in, const SimulationSettings& settings_in, MujocoModel model_in)
      : machine(machine_in),
        settings(settings_in),
        model(std::move(model_in)),
        data(mj_makeData(model.get())),
        loop(machine, joint_loop_settings(machine, settings)),
        valves(machine, settings.control_period_s, machine.valve_dead_band),
        recorder(machine, model.get()),
        steps_per_period(
            static_cast<int>(std::lround(settings.control_period_s / settings.timestep_s))) {
    WEX_EXPECTS(std::abs(steps_per_period * settings.timestep_s - settings.control_period_s) <
                kTimeTolerance_s);
    for (int i = 0; i < machine.num_joints(); ++i) {
      const Joint& joint = machine.joints[i];
      const int id = mj_name2id(model.get(), mjOBJ_JOINT, joint.name.c_str());
      Address& address = addresses[i];
      address.qpos = model->jnt_qposadr[id];
      address.dof = model->jnt_dofadr[id];
      address.act = model->actuator_actadr[i];  // actuators stand in joint order
      if (address.act >= 0) address.relief = joint.max_effort / joint.hold_stiffness;
    }
    const Result<std::vector<std::string>> names = scalar_joint_names(machine);
    for (const std::string& name : names.value()) {
      scalar_qpos.push_back(model->jnt_qposadr[mj_name2id(model.get(), mjOBJ_JOINT, name.c_str())]);
    }
    root_body = model->jnt_bodyid[mj_name2id(model.get(), mjOBJ_JOINT, kRootJoint)];
  }

  void place(const Eigen::VectorXd& q) {
    const Eigen::Isometry3d T_world_base =
        T_world_base_from(BaseCoordinates(q.head<kNumBaseCoordinates>()));
    const Eigen::Quaterniond rotation(T_world_base.linear());
    const double base[7] = {q[kBaseX],    q[kBaseY],    q[kBaseZ],   rotation.w(),
                            rotation.x(), rotation.y(), rotation.z()};
    std::copy(base, base + 7, data->qpos);
    const Eigen::VectorXd scalars = scalar_joint_values(machine, q);
    for (std::size_t i = 0; i < scalar_qpos.size(); ++i) data->qpos[scalar_qpos[i]] = scalars[i];
    for (int i = 0; i < machine.num_joints(); ++i) {
      if (addresses[i].act >= 0) data->act[addresses[i].act] = data->qpos[addresses[i].qpos];
    }
    yaw_rad = q[kBaseYaw];
    mj_forward(model.get(), data.get());
  }

  JointMeasurement measure() const noexcept {
    JointMeasurement measured;
    for (int i = 0; i < machine.num_joints(); ++i) {
      measured.position[i] = data->qpos[addresses[i].qpos];
      measured.rate[i] = data->qvel[addresses[i].dof];
      measured.effort[i] = data->actuator_force[i];
    }
    return measured;
  }

  /// One control period: joint loop, valves, physics.
  void advance() noexcept {
    if (has_command && data->time > command.valid_until_s + kTimeTolerance_s) {
      has_command = false;
      ++health.expiries;
    }
    if (fault) {
      data->time += settings.control_period_s;
      return;
    }
    const bool live = has_command && !stopped;
    const ActuatorCommand wanted = loop.update(live ? &command : nullptr, measure());
    const std::array<double, kMaxJoints> rate = valves.update(wanted.spool, wanted.rate);
    for (int i = 0; i < machine.num_joints(); ++i) {
      data->ctrl[i] = rate[i];
      const Address& address = addresses[i];
      if (address.act < 0) continue;
      const double position = data->qpos[address.qpos];
      data->act[address.act] =
          std::clamp(data->act[address.act], position - address.relief, position + address.relief);
    }
    for (int step = 0; step < steps_per_period; ++step) {
      mj_step(model.get(), data.get());
      recorder.observe(model.get(), data.get(), settings.timestep_s);
    }
    recorder.end_period(settings.control_period_s);
    fault = data->warning[mjWARN_BADQPOS].number + data->warning[mjWARN_BADQVEL].number +
                data->warning[mjWARN_BADQACC].number >
            0;
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

  BaseCoordinates base() const noexcept {
    Eigen::Isometry3d T_world_base = Eigen::Isometry3d::Identity();
    const mjtNum* pose = data->qpos;
    T_world_base.translation() << pose[0], pose[1], pose[2];
    T_world_base.linear() =
        Eigen::Quaterniond(pose[3], pose[4], pose[5], pose[6]).normalized().toRotationMatrix();
    BaseCoordinates base = base_coordinates_from(T_world_base);
    base[kBaseYaw] = yaw_rad + wrap_angle(base[kBaseYaw] - yaw_rad);
    return base;
  }

  MachineState state() noexcept {
    MachineState state;
    state.t_s = data->time;
    state.base = base();
    yaw_rad = state.base[kBaseYaw];
    // A free joint's angular velocity is in the body's frame, its linear one in the world's.
    const Eigen::Quaterniond rotation(data->qpos[3], data->qpos[4], data->qpos[5], data->qpos[6]);
    const Eigen::Vector3d omega_base(data->qvel[3], data->qvel[4], data->qvel[5]);
    state.base_velocity << data->qvel[0], data->qvel[1], data->qvel[2],
        rotation.normalized() * omega_base;
    state.num_joints = machine.num_joints();
    const JointMeasurement measured = measure();
    state.position = measured.position;
    state.rate = measured.rate;
    state.effort = measured.effort;
    for (int i = 0; i < state.num_joints; ++i) state.position[i] -= loop.offset_of_joint_rad(i);
    return state;
  }

  MachineModel machine;
  SimulationSettings settings;
  MujocoModel model;
  MujocoData data;
  JointLoop loop;
  ValveChain valves;
  TruthRecorder recorder;
  int steps_per_period = 0;
  std::array<Address, kMaxJoints> addresses{};
  std::vector<int> scalar_qpos;
  int root_body = 0;

  JointCommand command;
  bool has_command = false, stopped = false, fault = false;
  MachineHealth health;
  MachineState last_state;
  double yaw_rad = 0.0;  ///< as last read, unwrapped
  double cpu_time_s = 0.0;
  std::unique_ptr<OffscreenRenderer> renderer;
};

SimulatedMachine::SimulatedMachine(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SimulatedMachine::~SimulatedMachine() = default;

Result<std::unique_ptr<SimulatedMachine>> SimulatedMachine::create(
    const MachineModel& machine, const TerrainMap& terrain, const Eigen::VectorXd& q,
    const SimulationSettings& settings) {
  WEX_EXPECTS(q.size() == machine.num_coordinates() && q.allFinite());
  WEX_EXPECTS(settings.timestep_s > 0.0 && settings.control_period_s >= settings.timestep_s);
  auto model = compile_scene(machine, terrain, settings);
  if (!model) return tl::unexpected(model.error());
  auto impl = std::make_unique<Impl>(machine, settings, std::move(*model));
  impl->place(q);
  while (impl->data->time < settings.settle_time_s - kTimeTolerance_s && !impl->fault) {
    impl->advance();
  }
  if (impl->fault) {
    return fail(ErrorCode::kInternal,
                "MuJoCo: the state is not finite any more after placing the machine");
  }
  impl->data->time = 0.0;
  impl->recorder.reset();
  impl->last_state = impl->state();
  return std::unique_ptr<SimulatedMachine>(new SimulatedMachine(std::move(impl)));
}

MachineState SimulatedMachine::read() noexcept {
  MachineState& last = impl_->last_state;
  if (!impl_->fault) last = impl_->state();
  last.age_s = impl_->data->time - last.t_s;
  return last;
}

WriteOutcome SimulatedMachine::write(const JointCommand& command) noexcept {
  const WriteOutcome outcome = [&] {
    const int num_joints = impl_->machine.num_joints();
    if (impl_->stopped || impl_->fault) return WriteOutcome::kRejectedStopped;
    if (command.num_joints != num_joints) return WriteOutcome::kRejectedWrongSize;
    bool finite = std::isfinite(command.valid_until_s);
    for (int i = 0; i < num_joints; ++i) {
      finite = finite && std::isfinite(command.rate[i]) &&
               (!command.has_position_target[i] || std::isfinite(command.position_target[i]));
    }
    if (!finite) {
      impl_->has_command = false;
      return WriteOutcome::kRejectedNotFinite;
    }
    if (command.valid_until_s < impl_->data->time) return WriteOutcome::kRejectedExpired;
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
  health.level = impl_->fault ? HealthLevel::kFault
                 : moving     ? HealthLevel::kOk
                              : HealthLevel::kHolding;
  return health;
}

void SimulatedMachine::wait_until(double t_s) {
  const double start_s = thread_cpu_time_s();
  while (impl_->data->time < t_s - kTimeTolerance_s) impl_->advance();
  impl_->cpu_time_s += thread_cpu_time_s() - start_s;
}

GroundTruth SimulatedMachine::ground_truth() const {
  GroundTruth truth = impl_->recorder.truth(impl_->data.get());
  truth.base = impl_->base();
  return truth;
}

std::array<double, kNumWheels> SimulatedMachine::load_balance_offset_rad() const noexcept {
  return impl_->loop.load_balance_offset_rad();
}

Eigen::VectorXd SimulatedMachine::scalar_joint_positions() const {
  Eigen::VectorXd positions(static_cast<Eigen::Index>(impl_->scalar_qpos.size()));
  for (Eigen::Index i = 0; i < positions.size(); ++i) {
    positions[i] = impl_->data->qpos[impl_->scalar_qpos[static_cast<std::size_t>(i)]];
  }
  return positions;
}

Result<void> SimulatedMachine::render(const std::string& png_file, int width_px, int height_px) {
  if (!impl_->renderer) {
    auto renderer = OffscreenRenderer::create(impl_->model.get());
    if (!renderer) return tl::unexpected(renderer.error());
    impl_->renderer = std::move(*renderer);
  }
  constexpr double kDistance_m = 13.0, kElevation_deg = -24.0, kBesideHeading_deg = 40.0;
  mjvCamera camera;
  mjv_defaultCamera(&camera);
  std::copy(impl_->data->qpos, impl_->data->qpos + 3, camera.lookat);
  camera.distance = kDistance_m;
  camera.elevation = kElevation_deg;
  camera.azimuth = impl_->base()[kBaseYaw] * kRadToDeg - kBesideHeading_deg;
  return impl_->renderer->draw(impl_->model.get(), impl_->data.get(), camera, png_file, width_px,
                               height_px);
}

double SimulatedMachine::cpu_time_s() const noexcept { return impl_->cpu_time_s; }

}  // namespace wex
