// The published forward kinematics of the joint table as it stands in its source, before our model
// symmetrises it: the tree is built here from that table, so that only the chain code is on trial.
#include <gmock/gmock.h>

#include <map>
#include <numbers>

#include "models/excavator/kinematic_tree.hpp"

namespace wex {
namespace {

constexpr double kToleranceM = 3e-3;  // the vectors are given to 1 mm, the table's angles to 1e-4
constexpr double kPi = std::numbers::pi;

struct Row {
  const char* name;
  const char* parent;
  Eigen::Vector3d xyz, rpy;
  bool prismatic = false;
  const char* mimics = nullptr;  // with multiplier -1
};

const std::vector<Row>& raw_table() {
  static const std::vector<Row> rows{
      {"LF_HAA", "base", {0.55, 0.85, 0.1335}, {0, 0, 0}},
      {"LF_HFE", "LF_HAA", {0.28, 0, -0.0895}, {1.5708, 0, 0}},
      {"LF_PAR", "LF_HFE", {1.2, 0, 0}, {0, 0, 0}, false, "LF_HFE"},
      {"LF_STEER", "LF_PAR", {0.235, -0.003, -0.298}, {-1.5708, 0, 0}},
      {"LF_WHEEL", "LF_STEER", {0.27, 0.373, 0}, {-1.5708, 0, 0}},
      {"RF_HAA", "base", {0.55, -0.85, 0.1335}, {0, 0, 0}},
      {"RF_HFE", "RF_HAA", {0.28, 0, -0.0895}, {1.5708, 0, 0}},
      {"RF_PAR", "RF_HFE", {1.2, 0, 0}, {0, 0, 0}, false, "RF_HFE"},
      {"RF_STEER", "RF_PAR", {0.235, -0.003, 0.298}, {-1.5708, 0, 0}},
      {"RF_WHEEL", "RF_STEER", {0.27, -0.40984, 0}, {-1.5708, 0.62959, 3.1416}},
      {"LH_HFE", "base", {-0.64, 0.755, 0.06}, {1.5708, 0, -3.1416}},
      {"LH_HAA", "LH_HFE", {0.205, 0.12, 0.102}, {-1.5708, 0, 0}},
      {"LH_STEER", "LH_HAA", {0.975, 0, -0.045}, {0, 0, 0}},
      {"LH_WHEEL", "LH_STEER", {0.5, -0.398, 0.0305}, {1.5708, 0, 0}},
      {"RH_HFE", "base", {-0.64, -0.755, 0.06}, {1.5708, 0, -3.1416}},
      {"RH_HAA", "RH_HFE", {0.205, 0.12, -0.102}, {-1.5708, 0, 0}},
      {"RH_STEER", "RH_HAA", {0.975, 0, -0.045}, {0, 0, 0}},
      {"RH_WHEEL", "RH_STEER", {0.5, 0.398, 0.0305}, {-1.5708, 0, 0}},
      {"TURN", "base", {0, 0, 0.444}, {0, 0, 0}},
      {"BOOM", "TURN", {0.69784, -0.28, 0.633}, {1.5708, 0, 0}},
      {"DIPPER", "BOOM", {2.85, 0, 0}, {0, 0, 0}},
      {"TELE", "DIPPER", {0.336, -1.47, 0}, {1.5708, 0, 0}, true},
      {"EE_PITCH", "TELE", {0.03, 0, 0.53}, {-1.5708, 0.14, 0}},
      {"EE_ROLL", "EE_PITCH", {0.3645, -0.238, 0}, {1.5708, 0, 1.5708}},
      {"EE_YAW", "EE_ROLL", {-0.17865, 0, -0.0225}, {0.0267, -1.5708, 3.1149}},
  };
  return rows;
}

Eigen::Matrix3d rotation(const Eigen::Vector3d& rpy) {
  return (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

class RawJointTable : public ::testing::Test {
 protected:
  RawJointTable() {
    std::vector<KinematicTree::Body> bodies(1);
    bodies[0].name = "base";
    bodies[0].mass_kg = 1.0;
    std::map<std::string, int> body_of{{"base", 0}};
    int next_coordinate = kNumBaseCoordinates;
    for (const Row& row : raw_table()) {
      KinematicTree::Body body;
      body.name = row.name;
      body.parent = body_of.at(row.parent);
      body.T_parent_joint.translation() = row.xyz;
      body.T_parent_joint.linear() = rotation(row.rpy);
      body.prismatic = row.prismatic;
      body.multiplier = row.mimics ? -1.0 : 1.0;
      body.coordinate = row.mimics ? coordinate_.at(row.mimics) : next_coordinate++;
      coordinate_[row.name] = body.coordinate;
      body_of[row.name] = static_cast<int>(bodies.size());
      bodies.push_back(body);
    }
    tree_ = KinematicTree(bodies, next_coordinate);
  }

  Eigen::Vector3d origin_of(const std::string& body, const std::map<std::string, double>& joints,
                            const Eigen::Vector3d& p_body = Eigen::Vector3d::Zero()) const {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(tree_.num_coordinates());
    for (const auto& [name, value] : joints) q[coordinate_.at(name)] = value;
    auto w = tree_.make_workspace();
    tree_.update(q, w);
    return tree_.position(w, tree_.body_index(body), p_body);
  }

  static void expect_near(const Eigen::Vector3d& p, double x, double y, double z) {
    EXPECT_LT((p - Eigen::Vector3d(x, y, z)).cwiseAbs().maxCoeff(), kToleranceM)
        << p.transpose() << " instead of " << x << " " << y << " " << z;
  }

  std::map<std::string, int> coordinate_;
  KinematicTree tree_;
};

TEST_F(RawJointTable, PutsTheWheelCentresWherePublishedAtZero) {
  expect_near(origin_of("LF_WHEEL", {}), 2.535, 1.521, 0.041);
  expect_near(origin_of("RF_WHEEL", {}), 2.535, -1.558, 0.041);
  expect_near(origin_of("LH_WHEEL", {}), -2.320, 1.255, 0.165);
  expect_near(origin_of("RH_WHEEL", {}), -2.320, -1.255, 0.166);
}

TEST_F(RawJointTable, MovesTheFrontWheelAsPublished) {
  expect_near(origin_of("LF_WHEEL", {{"LF_HFE", -0.83}}), 2.145, 1.521, -0.845);
  expect_near(origin_of("LF_WHEEL", {{"LF_HFE", 0.29}}), 2.485, 1.521, 0.384);
  expect_near(origin_of("LF_WHEEL", {{"LF_HAA", -0.52}}), 2.606, 0.446, 0.041);
  expect_near(origin_of("LF_WHEEL", {{"LF_HAA", 0.75}}), 1.545, 2.694, 0.041);
  expect_near(origin_of("LF_WHEEL", {{"LF_STEER", -0.87}}), 2.724, 1.182, 0.041);
  expect_near(origin_of("LF_WHEEL", {{"LF_STEER", 0.75}}), 2.208, 1.605, 0.041);
}

TEST_F(RawJointTable, MovesTheHindWheelAsPublished) {
  expect_near(origin_of("LH_WHEEL", {{"LH_HFE", -0.77}}), -1.920, 1.255, -1.034);
  expect_near(origin_of("LH_WHEEL", {{"LH_HFE", 0.27}}), -2.231, 1.255, 0.610);
  expect_near(origin_of("LH_WHEEL", {{"LH_HAA", -0.69}}), -1.729, 2.103, 0.165);
  expect_near(origin_of("LH_WHEEL", {{"LH_HAA", 0.56}}), -2.306, 0.411, 0.165);
}

TEST_F(RawJointTable, StandsNominallyWherePublished) {
  const std::map<std::string, double> nominal{
      {"LF_HFE", -0.332}, {"RF_HFE", -0.332}, {"LH_HFE", -0.309}, {"RH_HFE", -0.309}};
  expect_near(origin_of("LF_WHEEL", nominal), 2.469, 1.521, -0.35);
  expect_near(origin_of("RF_WHEEL", nominal), 2.469, -1.558, -0.35);
  expect_near(origin_of("LH_WHEEL", nominal), -2.273, 1.255, -0.35);
  expect_near(origin_of("RH_WHEEL", nominal), -2.273, -1.255, -0.35);
}

TEST_F(RawJointTable, PutsTheArmWherePublishedAtZero) {
  expect_near(origin_of("BOOM", {}), 0.698, -0.28, 1.077);
  expect_near(origin_of("DIPPER", {}), 3.548, -0.28, 1.077);
  expect_near(origin_of("EE_PITCH", {}), 3.914, -0.28, -0.923);
  // Tool and cutting edge hang rigidly on the rotator.
  Eigen::Isometry3d T_yaw_tool = Eigen::Isometry3d::Identity();
  T_yaw_tool.translation() << -0.201, 0, -0.1165;
  T_yaw_tool.linear() = rotation({1.5708, 0, 0});
  Eigen::Isometry3d T_tool_bucket = Eigen::Isometry3d::Identity();
  T_tool_bucket.translation() << 0.35, 0, 0;
  T_tool_bucket.linear() = rotation({0, kPi, 0});
  expect_near(origin_of("EE_YAW", {}, T_yaw_tool.translation()), 4.128, -0.28, -1.431);
  expect_near(
      origin_of("EE_YAW", {}, T_yaw_tool * (T_tool_bucket * Eigen::Vector3d(-0.13757, -0.8578, 0))),
      4.730, -0.28, -2.213);
}

TEST_F(RawJointTable, KeepsTheFrontKingpinUprightAtAnyHipAngle) {
  for (const double hfe : {-0.8, -0.3, 0.2}) {
    const std::map<std::string, double> joints{{"LF_HFE", hfe}, {"LF_HAA", 0.4}};
    const Eigen::Vector3d kingpin =
        origin_of("LF_STEER", joints, Eigen::Vector3d::UnitZ()) - origin_of("LF_STEER", joints);
    EXPECT_LT((kingpin - Eigen::Vector3d::UnitZ()).norm(), 1e-4);  // the table's right angles
  }
}

}  // namespace
}  // namespace wex
