#include "hw_interface/mujoco/simulated_plant.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "hw_interface/mujoco/ground_field.hpp"
#include "hw_interface/mujoco/offscreen_renderer.hpp"
#include "hw_interface/mujoco/truth_recorder.hpp"
#include "hw_interface/mujoco/valve_chain.hpp"
#include "models/excavator/mjcf.hpp"
#include "models/excavator/mujoco_model.hpp"

namespace wex {
namespace {

constexpr double kTimeTolerance_s = 1e-9;
constexpr double kRadToDeg = 180.0 / std::numbers::pi;
constexpr double kBrakeGain_1_s = 2.0;  ///< keeps the wheels at their angle while settling

// A machine parked on a slope must not creep: friction ten times as stiff as the model asks for,
// and a solver that does not stop before it is there (at its default of 1e-8 it let the wheels work
// against each other at 0.1 mm/s).
constexpr double kImpedanceRatio = 100.0;
constexpr double kSolverTolerance = 1e-12;

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
  m.opt.impratio = kImpedanceRatio;
  m.opt.tolerance = kSolverTolerance;
  // A state that is not finite is a fault to report, not something to restart from.
  m.opt.disableflags |= mjDSBL_AUTORESET;
  for (int g = 0; g < m.ngeom; ++g) {
    if (m.geom_group[g] == kLoadBearingGroup) m.geom_friction[3 * g] = settings.ground_friction;
  }
  return model;
}

}  // namespace

struct SimulatedPlant::Impl {
  struct Address {
    int qpos = 0, dof = 0, act = -1;
    double relief = 0.0;     ///< how far the oil column can be pressed before its valve opens
    double damping_s = 0.0;  ///< damping of the oil column over its stiffness
  };

  Impl(const MachineModel& machine_in, const SimulationSettings& settings_in, MujocoModel model_in)
      : machine(machine_in),
        settings(settings_in),
        model(std::move(model_in)),
        data(mj_makeData(model.get())),
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
      if (address.act < 0) continue;
      address.relief = joint.max_effort / joint.hold_stiffness;
      address.damping_s = -model->actuator_biasprm[mjNBIAS * i + 2] / joint.hold_stiffness;
    }
    const Result<std::vector<std::string>> names = scalar_joint_names(machine);
    for (const std::string& name : names.value()) {
      scalar_qpos.push_back(model->jnt_qposadr[mj_name2id(model.get(), mjOBJ_JOINT, name.c_str())]);
    }
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

  /// One control period: valves, physics.
  void advance(const std::array<double, kMaxJoints>& spool,
               const std::array<double, kMaxJoints>& wheel_rate, bool released,
               const std::array<bool, kMaxJoints>& braked) noexcept {
    if (broken) {
      data->time += settings.control_period_s;
      return;
    }
    const std::array<double, kMaxJoints> rate = valves.update(spool, wheel_rate, released, braked);
    for (int i = 0; i < machine.num_joints(); ++i) {
      data->ctrl[i] = rate[i];
      const Address& address = addresses[i];
      if (address.act < 0) continue;
      // The valve opens at the column's force, that is stiffness and damping together: a moving
      // joint is ahead of its position by what the damping takes.
      const double neutral = data->qpos[address.qpos] + address.damping_s * data->qvel[address.dof];
      data->act[address.act] =
          std::clamp(data->act[address.act], neutral - address.relief, neutral + address.relief);
    }
    for (int step = 0; step < steps_per_period; ++step) {
      mj_step(model.get(), data.get());
      recorder.observe(model.get(), data.get(), settings.timestep_s);
    }
    recorder.end_period(settings.control_period_s);
    broken = data->warning[mjWARN_BADQPOS].number + data->warning[mjWARN_BADQVEL].number +
                 data->warning[mjWARN_BADQACC].number >
             0;
  }

  MachineModel machine;
  SimulationSettings settings;
  MujocoModel model;
  MujocoData data;
  ValveChain valves;
  TruthRecorder recorder;
  int steps_per_period = 0;
  std::array<Address, kMaxJoints> addresses{};
  std::vector<int> scalar_qpos;
  bool broken = false;
  double yaw_rad = 0.0;  ///< as last sensed, unwrapped
  std::unique_ptr<OffscreenRenderer> renderer;
};

SimulatedPlant::SimulatedPlant(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SimulatedPlant::~SimulatedPlant() = default;

Result<std::unique_ptr<SimulatedPlant>> SimulatedPlant::create(const MachineModel& machine,
                                                               const TerrainMap& terrain,
                                                               const Eigen::VectorXd& q,
                                                               const SimulationSettings& settings) {
  WEX_EXPECTS(q.size() == machine.num_coordinates() && q.allFinite());
  WEX_EXPECTS(settings.timestep_s > 0.0 && settings.control_period_s >= settings.timestep_s);
  auto model = compile_scene(machine, terrain, settings);
  if (!model) return tl::unexpected(model.error());
  auto impl = std::make_unique<Impl>(machine, settings, std::move(*model));
  impl->place(q);
  return std::unique_ptr<SimulatedPlant>(new SimulatedPlant(std::move(impl)));
}

void SimulatedPlant::tick(const ActuatorCommand& command) noexcept {
  impl_->advance(command.spool, command.rate, true, {});
}

void SimulatedPlant::act(const can::PlantInput& input) noexcept {
  impl_->advance(input.spool, input.wheel_rate, input.motion_released, input.braked);
}

Result<void> SimulatedPlant::settle() {
  const std::array<double, kMaxJoints> placed = measure().position;
  while (time_s() < impl_->settings.settle_time_s - kTimeTolerance_s && !broken()) {
    const JointMeasurement measured = measure();
    can::PlantInput input;
    for (int i = 0; i < impl_->machine.num_joints(); ++i) {
      if (impl_->machine.joints[i].role != JointRole::kWheel) continue;
      input.wheel_rate[i] = kBrakeGain_1_s * (placed[i] - measured.position[i]);
    }
    act(input);
  }
  if (broken()) {
    return fail(ErrorCode::kInternal,
                "MuJoCo: the state is not finite any more after placing the machine");
  }
  restart_clock();
  return {};
}

void SimulatedPlant::restart_clock() noexcept {
  impl_->data->time = 0.0;
  impl_->recorder.reset();
}

JointMeasurement SimulatedPlant::measure() const noexcept {
  JointMeasurement measured;
  for (int i = 0; i < impl_->machine.num_joints(); ++i) {
    measured.position[i] = impl_->data->qpos[impl_->addresses[i].qpos];
    measured.rate[i] = impl_->data->qvel[impl_->addresses[i].dof];
    measured.effort[i] = impl_->data->actuator_force[i];
  }
  const BaseCoordinates tilted = base();
  measured.pitch_rad = tilted[kBasePitch];
  measured.roll_rad = tilted[kBaseRoll];
  return measured;
}

BaseCoordinates SimulatedPlant::base() const noexcept {
  Eigen::Isometry3d T_world_base = Eigen::Isometry3d::Identity();
  const mjtNum* pose = impl_->data->qpos;
  T_world_base.translation() << pose[0], pose[1], pose[2];
  T_world_base.linear() =
      Eigen::Quaterniond(pose[3], pose[4], pose[5], pose[6]).normalized().toRotationMatrix();
  BaseCoordinates base = base_coordinates_from(T_world_base);
  base[kBaseYaw] = impl_->yaw_rad + wrap_angle(base[kBaseYaw] - impl_->yaw_rad);
  return base;
}

can::PlantState SimulatedPlant::sense() noexcept {
  can::PlantState state;
  state.base = base();
  impl_->yaw_rad = state.base[kBaseYaw];
  // A free joint's angular velocity is in the body's frame, its linear one in the world's.
  const mjData* data = impl_->data.get();
  const Eigen::Quaterniond rotation(data->qpos[3], data->qpos[4], data->qpos[5], data->qpos[6]);
  const Eigen::Vector3d omega_base(data->qvel[3], data->qvel[4], data->qvel[5]);
  state.base_velocity << data->qvel[0], data->qvel[1], data->qvel[2],
      rotation.normalized() * omega_base;
  const JointMeasurement measured = measure();
  state.position = measured.position;
  state.rate = measured.rate;
  state.effort = measured.effort;
  state.sensors_valid = state.base_pose_valid = !broken();
  return state;
}

double SimulatedPlant::time_s() const noexcept { return impl_->data->time; }
bool SimulatedPlant::broken() const noexcept { return impl_->broken; }

GroundTruth SimulatedPlant::ground_truth() const {
  GroundTruth truth = impl_->recorder.truth(impl_->data.get());
  truth.base = base();
  return truth;
}

Eigen::VectorXd SimulatedPlant::scalar_joint_positions() const {
  Eigen::VectorXd positions(static_cast<Eigen::Index>(impl_->scalar_qpos.size()));
  for (Eigen::Index i = 0; i < positions.size(); ++i) {
    positions[i] = impl_->data->qpos[impl_->scalar_qpos[static_cast<std::size_t>(i)]];
  }
  return positions;
}

Result<void> SimulatedPlant::render(const std::string& png_file, int width_px, int height_px) {
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
  camera.azimuth = base()[kBaseYaw] * kRadToDeg - kBesideHeading_deg;
  return impl_->renderer->draw(impl_->model.get(), impl_->data.get(), camera, png_file, width_px,
                               height_px);
}

}  // namespace wex
