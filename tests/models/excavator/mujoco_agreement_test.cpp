// Our chain code and MuJoCo have no line in common, so agreement over many postures checks both the
// code and the model that is built from it.
#include <gmock/gmock.h>
#include <mujoco/mujoco.h>

#include <array>

#include "models/excavator/machine_model.hpp"
#include "models/excavator/mjcf.hpp"
#include "models/excavator/mujoco_model.hpp"
#include "tests/models/excavator/random_posture.hpp"

namespace wex {
namespace {

constexpr unsigned kSeed = 11;
constexpr int kPostures = 10000;
constexpr double kCompiledToleranceM = 1e-9;
constexpr double kTextToleranceM = 1e-6;  // MJCF text rounds its numbers
constexpr double kJacobianTolerance = 1e-9;

// Kinematic outcomes of one posture: the five contact sites, then the CoM.
using Points = std::array<Eigen::Vector3d, kNumLimbs + 1>;

class MujocoAgreement : public ::testing::Test {
 protected:
  MujocoAgreement() {
    auto loaded = load_machine("m545");
    EXPECT_TRUE(loaded) << loaded.error().message;
    machine_ = std::move(*loaded);
    workspace_ = machine_.tree.make_workspace();
  }

  MujocoModel compiled() const {
    auto spec = machine_spec(machine_);
    EXPECT_TRUE(spec) << spec.error().message;
    auto model = compile(spec->get());
    EXPECT_TRUE(model) << model.error().message;
    return std::move(*model);
  }
  MujocoModel compiled_from_text() const {
    const auto xml = machine_mjcf(machine_);
    EXPECT_TRUE(xml) << xml.error().message;
    std::array<char, 1000> error{};
    const MujocoSpec spec(mj_parseXMLString(xml->c_str(), nullptr, error.data(), error.size()));
    EXPECT_TRUE(spec) << error.data();
    return MujocoModel(mj_compile(spec.get(), nullptr));
  }

  void set_posture(const mjModel& model, mjData& data, const Eigen::VectorXd& q) const {
    const BaseCoordinates base = q.head<kNumBaseCoordinates>();
    const Eigen::Isometry3d T_world_base = T_world_base_from(base);
    const Eigen::Quaterniond rotation(T_world_base.linear());
    const int root = model.jnt_qposadr[mj_name2id(&model, mjOBJ_JOINT, kRootJoint)];
    Eigen::Map<Eigen::Vector3d>(data.qpos + root) = base.head<3>();
    data.qpos[root + 3] = rotation.w();
    Eigen::Map<Eigen::Vector3d>(data.qpos + root + 4) = rotation.vec();
    const auto names = scalar_joint_names(machine_);
    const Eigen::VectorXd values = scalar_joint_values(machine_, q);
    for (std::size_t i = 0; i < names->size(); ++i) {
      const int joint = mj_name2id(&model, mjOBJ_JOINT, (*names)[i].c_str());
      ASSERT_GE(joint, 0) << (*names)[i];
      data.qpos[model.jnt_qposadr[joint]] = values[static_cast<Eigen::Index>(i)];
    }
    mj_kinematics(&model, &data);
    mj_comPos(&model, &data);
  }

  static int site(const mjModel& model, int limb) {
    const std::string name =
        limb < kNumWheels ? wheel_site_name(static_cast<Limb>(limb)) : std::string(kArmContactSite);
    return mj_name2id(&model, mjOBJ_SITE, name.c_str());
  }

  static Points mujoco_points(const mjModel& model, const mjData& data) {
    Points points;
    for (int limb = 0; limb < kNumLimbs; ++limb) {
      points[limb] = Eigen::Map<const Eigen::Vector3d>(data.site_xpos + 3 * site(model, limb));
    }
    points[kNumLimbs] = Eigen::Map<const Eigen::Vector3d>(data.subtree_com);
    return points;
  }
  Points our_points(const Eigen::VectorXd& q) {
    machine_.tree.update(q, workspace_);
    Points points;
    for (const WheeledLeg& leg : machine_.legs) {
      points[static_cast<int>(leg.limb)] =
          machine_.tree.position(workspace_, leg.carrier_body, leg.p_carrier_wheel);
    }
    points[static_cast<int>(Limb::kArm)] = machine_.tree.position(
        workspace_, machine_.arm->contact_body, machine_.arm->p_body_contact);
    points[kNumLimbs] = machine_.tree.com(workspace_);
    return points;
  }

  double worst_difference_m(const mjModel& model) {
    const MujocoData data(mj_makeData(&model));
    std::mt19937 generator(kSeed);
    double worst = 0.0;
    for (int i = 0; i < kPostures; ++i) {
      const Eigen::VectorXd q = test::random_posture(machine_, generator);
      set_posture(model, *data, q);
      const Points theirs = mujoco_points(model, *data), ours = our_points(q);
      for (std::size_t k = 0; k < ours.size(); ++k) {
        worst = std::max(worst, (ours[k] - theirs[k]).norm());
      }
    }
    RecordProperty("worst_difference_nm", std::to_string(worst * 1e9));
    return worst;
  }

  MachineModel machine_;
  KinematicTree::Workspace workspace_;
};

TEST_F(MujocoAgreement, OfContactPointsAndCentreOfMassHoldsAt10000Postures) {
  EXPECT_LT(worst_difference_m(*compiled()), kCompiledToleranceM);
}

TEST_F(MujocoAgreement, HoldsForTheModelReadBackFromItsText) {
  const MujocoModel model = compiled_from_text();
  ASSERT_TRUE(model);
  EXPECT_LT(worst_difference_m(*model), kTextToleranceM);
}

TEST_F(MujocoAgreement, OfTheTotalMassHolds) {
  EXPECT_NEAR(mj_getTotalmass(compiled().get()), 12000.0, 1e-6);
}

TEST_F(MujocoAgreement, OfAxlesAndJointJacobiansHolds) {
  const MujocoModel model = compiled();
  const MujocoData data(mj_makeData(model.get()));
  std::mt19937 generator(kSeed);
  const int n = machine_.num_coordinates();
  Eigen::Matrix3Xd ours(3, n);
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor> theirs(3, model->nv);
  for (int i = 0; i < 100; ++i) {
    const Eigen::VectorXd q = test::random_posture(machine_, generator);
    set_posture(*model, *data, q);
    machine_.tree.update(q, workspace_);
    for (const WheeledLeg& leg : machine_.legs) {
      const int id = site(*model, static_cast<int>(leg.limb));
      const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(data->site_xmat +
                                                                             9 * id);
      const Eigen::Vector3d axle =
          machine_.tree.direction(workspace_, leg.carrier_body, leg.axle_carrier);
      EXPECT_LT((axle - R.col(1)).norm(), kJacobianTolerance) << "local y along the axle";

      machine_.tree.position_jacobian(workspace_, leg.carrier_body, leg.p_carrier_wheel, ours);
      mj_jacSite(model.get(), data.get(), theirs.data(), nullptr, id);
      Eigen::Matrix3Xd folded = Eigen::Matrix3Xd::Zero(3, n);  // passive columns onto their leaders
      for (int b = 1; b < static_cast<int>(machine_.tree.bodies().size()); ++b) {
        const KinematicTree::Body& body = machine_.tree.bodies()[b];
        if (body.coordinate < 0) continue;
        const int joint = mj_name2id(model.get(), mjOBJ_JOINT, body.joint_name.c_str());
        folded.col(body.coordinate) += body.multiplier * theirs.col(model->jnt_dofadr[joint]);
      }
      EXPECT_LT((ours - folded).rightCols(machine_.num_joints()).cwiseAbs().maxCoeff(),
                kJacobianTolerance);
    }
  }
}

}  // namespace
}  // namespace wex
