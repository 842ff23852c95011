#include "models/excavator/mjcf.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <numeric>

#include "models/excavator/mujoco_model.hpp"

namespace wex {
namespace {

const MachineModel& m545() {
  static const MachineModel machine = load_machine().value();
  return machine;
}

/// The model as somebody gets it who has only the file.
const mjModel& reloaded() {
  static const MujocoModel model = [] {
    const std::string xml = machine_mjcf(m545()).value();
    char error[1000] = "";
    mjSpec* spec = mj_parseXMLString(xml.c_str(), nullptr, error, sizeof(error));
    if (!spec) throw std::runtime_error(error);
    const MujocoSpec owner(spec);
    return compile(spec).value();
  }();
  return *model;
}

TEST(MachineMjcf, HasTheWholeMachineAndNothingElse) {
  const mjModel& model = reloaded();
  EXPECT_EQ(model.nu, 25);
  EXPECT_EQ(model.neq, 2) << "the front parallelograms";
  const double mass_kg = std::accumulate(model.body_mass, model.body_mass + model.nbody, 0.0);
  EXPECT_NEAR(mass_kg, 12000.0, 0.01);
  EXPECT_EQ(std::count(model.geom_bodyid, model.geom_bodyid + model.ngeom, 0), 0) << "no terrain";
  EXPECT_EQ(model.jnt_type[mj_name2id(&model, mjOBJ_JOINT, kRootJoint)], mjJNT_FREE);
}

TEST(MachineMjcf, ActuatorsStandInMachineOrderWithItsLimits) {
  const mjModel& model = reloaded();
  for (int i = 0; i < m545().num_joints(); ++i) {
    const Joint& joint = m545().joints[i];
    EXPECT_STREQ(mj_id2name(&model, mjOBJ_ACTUATOR, i), joint.name.c_str());
    EXPECT_EQ(model.actuator_trnid[2 * i], mj_name2id(&model, mjOBJ_JOINT, joint.name.c_str()));
    EXPECT_DOUBLE_EQ(model.actuator_forcerange[2 * i + 1], joint.max_effort);
    EXPECT_DOUBLE_EQ(model.actuator_ctrlrange[2 * i + 1], joint.max_rate);
    EXPECT_EQ(model.actuator_actadr[i] < 0, joint.role == JointRole::kWheel);
  }
}

TEST(MachineMjcf, ScalarJointNamesAreThoseOfTheFileInItsOrder) {
  const mjModel& model = reloaded();
  std::vector<std::string> in_file;
  for (int j = 0; j < model.njnt; ++j) {
    if (model.jnt_type[j] != mjJNT_FREE) in_file.push_back(mj_id2name(&model, mjOBJ_JOINT, j));
  }
  EXPECT_EQ(scalar_joint_names(m545()).value(), in_file);
  EXPECT_EQ(in_file.size(), 25u + 2u + 4u);
}

TEST(MachineMjcf, WheelSitesAreWhereThePlannersPutTheWheelsAtStaticSag) {
  const mjModel& model = reloaded();
  const MujocoData data(mj_makeData(&model));
  Eigen::VectorXd q = Eigen::VectorXd::Zero(m545().num_coordinates());
  q.tail(m545().num_joints()) = m545().default_posture();
  q[m545().legs[0].steer] = 0.3;
  const Eigen::VectorXd values = scalar_joint_values(m545(), q);
  const auto names = scalar_joint_names(m545()).value();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const int joint = mj_name2id(&model, mjOBJ_JOINT, names[i].c_str());
    data->qpos[model.jnt_qposadr[joint]] = values[static_cast<Eigen::Index>(i)];
  }
  mj_kinematics(&model, data.get());

  KinematicTree::Workspace workspace = m545().tree.make_workspace();
  m545().tree.update(q, workspace);
  for (const WheeledLeg& leg : m545().legs) {
    const int site = mj_name2id(&model, mjOBJ_SITE, wheel_site_name(leg.limb).c_str());
    ASSERT_GE(site, 0);
    const Eigen::Map<const Eigen::Vector3d> p_site(data->site_xpos + 3 * site);
    const Eigen::Vector3d p_planner =
        m545().tree.position(workspace, leg.carrier_body, leg.p_carrier_wheel);
    EXPECT_LT((p_site - p_planner).norm(), 1e-6) << wheel_site_name(leg.limb);
    const mjtNum* R = data->site_xmat + 9 * site;
    const Eigen::Vector3d axle_planner =
        m545().tree.direction(workspace, leg.carrier_body, leg.axle_carrier);
    EXPECT_LT((Eigen::Vector3d(R[1], R[4], R[7]) - axle_planner).norm(), 1e-6);
    EXPECT_EQ(model.body_jntnum[model.site_bodyid[site]], 2) << "tyre slide, then wheel";
  }
  const int contact = mj_name2id(&model, mjOBJ_SITE, kArmContactSite);
  ASSERT_GE(contact, 0);
  const Eigen::Map<const Eigen::Vector3d> p_contact(data->site_xpos + 3 * contact);
  EXPECT_LT((p_contact -
             m545().tree.position(workspace, m545().arm->contact_body, m545().arm->p_body_contact))
                .norm(),
            1e-6);
}

TEST(MachineMjcf, KeepsTheContactAndSolverSettings) {
  const mjModel& model = reloaded();
  EXPECT_EQ(model.opt.cone, mjCONE_ELLIPTIC);
  EXPECT_EQ(model.opt.integrator, mjINT_IMPLICITFAST);
  EXPECT_DOUBLE_EQ(model.opt.impratio, 10.0);
  EXPECT_DOUBLE_EQ(model.opt.timestep, 0.002);
  int wheels = 0;
  for (int g = 0; g < model.ngeom; ++g) {
    if (model.geom_type[g] != mjGEOM_CYLINDER || model.geom_group[g] != kLoadBearingGroup) continue;
    ++wheels;
    EXPECT_DOUBLE_EQ(model.geom_size[3 * g], 0.6);
    EXPECT_DOUBLE_EQ(model.geom_size[3 * g + 1], 0.2);
    EXPECT_EQ(model.geom_condim[g], 4);
  }
  EXPECT_EQ(wheels, kNumWheels);
}

TEST(MachineMjcf, SensorsTellEveryJointAndTheBase) {
  const mjModel& model = reloaded();
  for (const Joint& joint : m545().joints) {
    for (const char* quantity : {"_position", "_rate", "_effort"}) {
      EXPECT_GE(mj_name2id(&model, mjOBJ_SENSOR, (joint.name + quantity).c_str()), 0) << joint.name;
    }
  }
  for (const char* sensor : {"imu_gyro", "imu_accelerometer", "imu_position", "imu_orientation"}) {
    EXPECT_GE(mj_name2id(&model, mjOBJ_SENSOR, sensor), 0) << sensor;
  }
}

}  // namespace
}  // namespace wex
