#include "models/excavator/mujoco_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "models/excavator/internal/mujoco_shapes.hpp"

namespace wex {
namespace {

// Settings measured on this machine; see models/excavator/README.md.
constexpr double kTimestep_s = 0.002;
constexpr double kImpedanceRatio =
    10.0;  ///< friction against normal constraints: no creep on slopes
constexpr int kIterations = 50;
constexpr double kOilDampingTime_s = 0.02;  ///< damping / stiffness of the oil column
constexpr double kArmaturePerStiffness_s2 =
    5e-6;  ///< keeps the oil column slower than the time step
constexpr double kDampingPerEffort_s = 0.02;
constexpr double kWheelServoGain = 2e5;  ///< N m s/rad
constexpr double kWheelArmature = 20.0, kWheelDamping = 50.0;
constexpr double kPassiveArmature = 20.0;
constexpr double kActuatorOverrun = 0.02;  ///< rad or m beyond the joint's limits
constexpr double kContinuousRange = 1e4;   ///< rad: an integrator needs some bound
constexpr double kTyreTravel_m = 0.15;
constexpr double kParallelogramSolref[2] = {0.004, 1.0};
constexpr double kParallelogramSolimp[3] = {0.99, 0.999, 0.001};

template <typename Vector>
void copy3(const Vector& from, double* to) {
  for (int i = 0; i < 3; ++i) to[i] = from[i];
}

void copy_quaternion(const Eigen::Matrix3d& R, double* to) {
  const Eigen::Quaterniond q(R);
  to[0] = q.w();
  to[1] = q.x();
  to[2] = q.y();
  to[3] = q.z();
}

/// Builds the bodies along the kinematic tree, once.
class SpecBuilder {
 public:
  SpecBuilder(const MachineModel& machine, mjSpec* spec)
      : machine_(machine),
        bodies_(machine.tree.bodies()),
        shapes_(shapes::link_shapes(machine)),
        spec_(spec) {}

  void build() {
    set_options();
    add_body(0, mjs_findBody(spec_, "world"));
    add_passive_couplings();
    for (const Joint& joint : machine_.joints) add_actuator(joint);
    add_sensors();
  }

 private:
  void set_options() {
    mjs_setString(spec_->modelname, machine_.name.c_str());
    spec_->compiler.degree = 0;
    mjOption& option = spec_->option;
    option.timestep = kTimestep_s;
    option.integrator = mjINT_IMPLICITFAST;
    option.cone = mjCONE_ELLIPTIC;
    option.impratio = kImpedanceRatio;
    option.solver = mjSOL_NEWTON;
    option.iterations = kIterations;
    option.noslip_iterations = 0;
  }

  const Joint* actuated(int body) const {
    const auto joint = std::find_if(machine_.joints.begin(), machine_.joints.end(),
                                    [&](const Joint& j) { return j.body == body; });
    return joint == machine_.joints.end() ? nullptr : &*joint;
  }

  const WheeledLeg* leg_of_wheel(int body) const {
    const auto leg = std::find_if(machine_.legs.begin(), machine_.legs.end(),
                                  [&](const WheeledLeg& l) { return l.wheel_body == body; });
    return leg == machine_.legs.end() ? nullptr : &*leg;
  }

  /// One body and everything beyond it, depth first.
  void add_body(int index, mjsBody* parent) {
    const KinematicTree::Body& source = bodies_[index];
    const WheeledLeg* leg = leg_of_wheel(index);
    mjsBody* body = mjs_addBody(parent, nullptr);
    mjs_setName(body->element, source.name.c_str());
    if (index > 0) {
      copy3(leg ? leg->p_carrier_wheel_unloaded : source.T_parent_joint.translation().eval(),
            body->pos);
      copy_quaternion(source.T_parent_joint.linear(), body->quat);
    }
    set_inertia(source, body);
    if (index == 0) {
      mjs_setName(mjs_addFreeJoint(body)->element, kRootJoint);
    } else if (leg) {
      add_wheel(*leg, source, body);
    } else if (source.coordinate >= 0) {
      add_joint(index, body);
    }
    for (const shapes::Shape& shape : shapes_[index]) shapes::add_geom(body, shape);
    if (machine_.arm && machine_.arm->contact_body == index) add_arm_site(body);
    for (const int child : children_of(index)) add_body(child, body);
  }

  std::vector<int> children_of(int index) const {
    std::vector<int> children;
    for (int i = index + 1; i < std::ssize(bodies_); ++i) {
      if (bodies_[i].parent == index) children.push_back(i);
    }
    return children;
  }

  static void set_inertia(const KinematicTree::Body& source, mjsBody* body) {
    body->explicitinertial = 1;
    if (source.mass_kg <= 0.0) return;
    const Eigen::Matrix3d& I = source.inertia_kg_m2;
    body->mass = source.mass_kg;
    copy3(source.p_body_com, body->ipos);
    const double full[6] = {I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2)};
    std::copy(full, full + 6, body->fullinertia);
  }

  mjsJoint* add_named_joint(mjsBody* body, const std::string& name, mjtJoint type,
                            const Eigen::Vector3d& axis) {
    mjsJoint* joint = mjs_addJoint(body, nullptr);
    mjs_setName(joint->element, name.c_str());
    joint->type = type;
    copy3(axis, joint->axis);
    return joint;
  }

  void add_joint(int index, mjsBody* body) {
    const KinematicTree::Body& source = bodies_[index];
    mjsJoint* joint = add_named_joint(body, source.joint_name,
                                      source.prismatic ? mjJNT_SLIDE : mjJNT_HINGE, source.axis);
    joint->limited = mjLIMITED_FALSE;
    const Joint* model_joint = actuated(index);
    if (!model_joint) {  // passive: its range follows from the joint it is coupled to
      joint->armature = kPassiveArmature;
      return;
    }
    joint->armature = kArmaturePerStiffness_s2 * model_joint->hold_stiffness;
    joint->damping[0] = kDampingPerEffort_s * model_joint->max_effort;
    if (model_joint->continuous) return;
    joint->limited = mjLIMITED_TRUE;
    joint->range[0] = model_joint->lower;
    joint->range[1] = model_joint->upper;
  }

  void add_wheel(const WheeledLeg& leg, const KinematicTree::Body& source, mjsBody* body) {
    const Eigen::Matrix3d R_wheel_carrier = source.T_parent_joint.linear().transpose();
    const Eigen::Vector3d up = R_wheel_carrier * leg.tyre_axis_carrier;
    mjsJoint* tyre = add_named_joint(body, tyre_joint_name(leg.limb), mjJNT_SLIDE, up);
    tyre->stiffness[0] = machine_.tyre_stiffness_n_m;
    tyre->damping[0] = machine_.tyre_damping_ns_m;
    tyre->limited = mjLIMITED_TRUE;
    tyre->range[0] = -kTyreTravel_m;
    tyre->range[1] = kTyreTravel_m;

    mjsJoint* wheel = add_named_joint(body, source.joint_name, mjJNT_HINGE, source.axis);
    wheel->armature = kWheelArmature;
    wheel->damping[0] = kWheelDamping;
    wheel->limited = mjLIMITED_FALSE;

    const Eigen::Vector3d axle = R_wheel_carrier * leg.axle_carrier;
    const Eigen::Vector3d forward = axle.cross(up).normalized();
    Eigen::Matrix3d R_wheel_site;  // y along the axle, x forward, z up at angle zero
    R_wheel_site << forward, axle, forward.cross(axle);
    mjsSite* site = mjs_addSite(body, nullptr);
    mjs_setName(site->element, wheel_site_name(leg.limb).c_str());
    copy_quaternion(R_wheel_site, site->quat);
  }

  void add_arm_site(mjsBody* body) {
    mjsSite* site = mjs_addSite(body, nullptr);
    mjs_setName(site->element, kArmContactSite);
    copy3(machine_.arm->p_body_contact, site->pos);
  }

  void add_passive_couplings() {
    for (const PassiveJoint& passive : machine_.passive_joints) {
      mjsEquality* equality = mjs_addEquality(spec_, nullptr);
      equality->type = mjEQ_JOINT;
      equality->objtype = mjOBJ_JOINT;
      mjs_setString(equality->name1, passive.name.c_str());
      mjs_setString(equality->name2,
                    machine_.joints[passive.coordinate - kNumBaseCoordinates].name.c_str());
      std::fill(equality->data, equality->data + mjNEQDATA, 0.0);
      equality->data[1] = passive.multiplier;
      std::copy(kParallelogramSolref, kParallelogramSolref + 2, equality->solref);
      std::copy(kParallelogramSolimp, kParallelogramSolimp + 3, equality->solimp);
    }
  }

  void add_actuator(const Joint& joint) {
    mjsActuator* actuator = mjs_addActuator(spec_, nullptr);
    mjs_setName(actuator->element, joint.name.c_str());
    actuator->trntype = mjTRN_JOINT;
    mjs_setString(actuator->target, joint.name.c_str());
    actuator->ctrllimited = mjLIMITED_TRUE;
    actuator->ctrlrange[0] = -joint.max_rate;
    actuator->ctrlrange[1] = joint.max_rate;
    actuator->forcelimited = mjLIMITED_TRUE;
    actuator->forcerange[0] = -joint.max_effort;
    actuator->forcerange[1] = joint.max_effort;
    if (joint.role == JointRole::kWheel) {
      mjs_setToVelocity(actuator, kWheelServoGain);
      return;
    }
    // A rate into a locked column of oil: integrated, held by its stiffness.
    actuator->actlimited = mjLIMITED_TRUE;
    actuator->actrange[0] = joint.continuous ? -kContinuousRange : joint.lower - kActuatorOverrun;
    actuator->actrange[1] = joint.continuous ? kContinuousRange : joint.upper + kActuatorOverrun;
    double damping = kOilDampingTime_s * joint.hold_stiffness;
    mjs_setToIntVelocity(actuator, joint.hold_stiffness, &damping, nullptr, nullptr, 0.0);
  }

  void add_sensor(mjtSensor type, mjtObj object, const std::string& target,
                  const std::string& suffix) {
    mjsSensor* sensor = mjs_addSensor(spec_);
    mjs_setName(sensor->element, (target + suffix).c_str());
    sensor->type = type;
    sensor->objtype = object;
    mjs_setString(sensor->objname, target.c_str());
  }

  void add_sensors() {
    mjsSite* imu = mjs_addSite(mjs_findBody(spec_, bodies_.front().name.c_str()), nullptr);
    mjs_setName(imu->element, "imu");
    for (const Joint& joint : machine_.joints) {
      add_sensor(mjSENS_JOINTPOS, mjOBJ_JOINT, joint.name, "_position");
      add_sensor(mjSENS_JOINTVEL, mjOBJ_JOINT, joint.name, "_rate");
      add_sensor(mjSENS_ACTUATORFRC, mjOBJ_ACTUATOR, joint.name, "_effort");
    }
    add_sensor(mjSENS_FRAMEPOS, mjOBJ_SITE, "imu", "_position");
    add_sensor(mjSENS_FRAMEQUAT, mjOBJ_SITE, "imu", "_orientation");
    add_sensor(mjSENS_FRAMELINVEL, mjOBJ_SITE, "imu", "_velocity");
    add_sensor(mjSENS_GYRO, mjOBJ_SITE, "imu", "_gyro");
    add_sensor(mjSENS_ACCELEROMETER, mjOBJ_SITE, "imu", "_accelerometer");
  }

  const MachineModel& machine_;
  const std::vector<KinematicTree::Body>& bodies_;
  std::vector<std::vector<shapes::Shape>> shapes_;  ///< by body
  mjSpec* spec_;
};

}  // namespace

std::string wheel_site_name(Limb limb) {
  return std::string(kLimbNames[static_cast<int>(limb)]) + "_wheel";
}

std::string tyre_joint_name(Limb limb) {
  return std::string(kLimbNames[static_cast<int>(limb)]) + "_TYRE";
}

Result<MujocoSpec> machine_spec(const MachineModel& machine) {
  MujocoSpec spec(mj_makeSpec());
  if (!spec) return fail(ErrorCode::kInternal, "MuJoCo: no memory for a model specification");
  SpecBuilder(machine, spec.get()).build();
  return spec;
}

Result<MujocoModel> compile(mjSpec* spec) {
  MujocoModel model(mj_compile(spec, nullptr));
  if (!model) {
    return fail(ErrorCode::kInternal, std::string("MuJoCo: ") + mjs_getError(spec));
  }
  return model;
}

}  // namespace wex
