#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <string>

#include "models/excavator/machine_model.hpp"
#include "models/types/result.hpp"

// For the few places that hold MuJoCo objects themselves (simulation, checker). Everybody else uses
// models/excavator/mjcf.hpp.

namespace wex {

struct SpecDeleter {
  void operator()(mjSpec* spec) const noexcept { mj_deleteSpec(spec); }
};
struct ModelDeleter {
  void operator()(mjModel* model) const noexcept { mj_deleteModel(model); }
};
struct DataDeleter {
  void operator()(mjData* data) const noexcept { mj_deleteData(data); }
};
using MujocoSpec = std::unique_ptr<mjSpec, SpecDeleter>;
using MujocoModel = std::unique_ptr<mjModel, ModelDeleter>;
using MujocoData = std::unique_ptr<mjData, DataDeleter>;

/// Contact types: the machine touches the ground, never itself. A ground geom has
/// contype = kGroundContactType, conaffinity = kMachineContactType.
inline constexpr int kGroundContactType = 1, kMachineContactType = 2;

/// Geom groups of the machine (all shown by default): chassis, legs and arm, which must not touch
/// the ground; what is only looked at; wheels and bucket.
enum GeomGroup { kBodyGroup = 0, kVisualGroup = 1, kLoadBearingGroup = 2 };

/// Names of what the machine's model contains besides its joints (actuators have joint names).
[[nodiscard]] std::string wheel_site_name(Limb limb);  ///< "LF_wheel"
[[nodiscard]] std::string tyre_joint_name(Limb limb);  ///< "LF_TYRE", positive = compressed
inline constexpr const char* kArmContactSite = "ARM_contact";
inline constexpr const char* kRootJoint = "root";

/// The machine as a specification that can be extended (terrain, lights) and compiled: floating
/// base, joints by name, tyres as slides under the wheels, front parallelograms as coupled hinges,
/// actuators in MachineModel::joints order, sensors, sites. Contact and solver settings included.
///   errors  kInternal
[[nodiscard]] Result<MujocoSpec> machine_spec(const MachineModel& machine);

/// errors  kInternal with MuJoCo's message
[[nodiscard]] Result<MujocoModel> compile(mjSpec* spec);

}  // namespace wex
