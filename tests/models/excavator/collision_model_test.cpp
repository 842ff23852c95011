// Distances are tested against MuJoCo's, on the shapes of its own model and on our capsules put
// into it as geoms: the two codes have no line in common.
#include "models/excavator/collision_model.hpp"

#include <gmock/gmock.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <map>
#include <set>

#include "models/excavator/internal/segments.hpp"
#include "models/excavator/mjcf.hpp"
#include "models/excavator/mujoco_model.hpp"
#include "tests/models/excavator/random_posture.hpp"

namespace wex {
namespace {

using Part = CollisionModel::Part;

constexpr unsigned kSeed = 5;
constexpr double kMargin_m = 0.10;
constexpr double kMujocoTolerance_m = 1e-6;
/// How far a capsule may stick out of what it covers: sides of links, rims and sides of wheels.
constexpr double kProtrusion_m = 0.17;

class CollisionModelOfM545 : public ::testing::Test {
 protected:
  CollisionModelOfM545()
      : machine_(load_machine("m545").value()),
        model_(CollisionModel::build(machine_)),
        w_(machine_.tree.make_workspace()),
        generator_(kSeed) {}

  Eigen::VectorXd posture(const Eigen::VectorXd& joints) const {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(machine_.num_coordinates());
    q.tail(machine_.num_joints()) = joints;
    return q;
  }
  double& joint(Eigen::VectorXd& q, const std::string& name) const {
    return q[machine_.coordinate(name).value()];
  }
  double nearest_m(const Eigen::VectorXd& q) {
    machine_.tree.update(q, w_);
    return model_.nearest(w_).distance_m;
  }
  std::string names(int pair) const {
    const CollisionModel::Pair& p = model_.pairs().at(pair);
    return model_.capsules()[p.first].name + " and " + model_.capsules()[p.second].name;
  }

  const MachineModel machine_;
  const CollisionModel model_;
  KinematicTree::Workspace w_;
  std::mt19937 generator_;
};

/// The machine's MuJoCo model, with our capsules as geoms named by their index.
class WithMujoco : public CollisionModelOfM545 {
 protected:
  WithMujoco() {
    MujocoSpec spec = std::move(machine_spec(machine_).value());
    for (int i = 0; i < std::ssize(model_.capsules()); ++i) add_capsule(spec.get(), i);
    mujoco_ = std::move(compile(spec.get()).value());
    data_.reset(mj_makeData(mujoco_.get()));
  }

  void add_capsule(mjSpec* spec, int index) const {
    const CollisionModel::Capsule& capsule = model_.capsules()[index];
    const std::string body = machine_.tree.bodies()[capsule.body].name;
    mjsGeom* geom = mjs_addGeom(mjs_findBody(spec, body.c_str()), nullptr);
    mjs_setName(geom->element, std::to_string(index).c_str());
    const Eigen::Vector3d along = capsule.p_body_b - capsule.p_body_a;
    const Eigen::Vector3d centre = 0.5 * (capsule.p_body_a + capsule.p_body_b);
    const bool ball = along.norm() < 1e-9;
    geom->type = ball ? mjGEOM_SPHERE : mjGEOM_CAPSULE;
    geom->size[0] = capsule.radius_m;
    geom->size[1] = 0.5 * along.norm();
    geom->contype = geom->conaffinity = 0;
    geom->mass = 0.0;
    const auto rotation = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), along);
    geom->quat[0] = ball ? 1.0 : rotation.w();
    for (int k = 0; k < 3; ++k) {
      geom->pos[k] = centre[k];
      geom->quat[k + 1] = ball ? 0.0 : rotation.vec()[k];
    }
  }

  void pose(const Eigen::VectorXd& q) {
    machine_.tree.update(q, w_);
    const Eigen::Isometry3d T_world_base = T_world_base_from(q.head<kNumBaseCoordinates>());
    const Eigen::Quaterniond rotation(T_world_base.linear());
    const int root = mujoco_->jnt_qposadr[mj_name2id(mujoco_.get(), mjOBJ_JOINT, kRootJoint)];
    Eigen::Map<Eigen::Vector3d>(data_->qpos + root) = T_world_base.translation();
    data_->qpos[root + 3] = rotation.w();
    Eigen::Map<Eigen::Vector3d>(data_->qpos + root + 4) = rotation.vec();
    const auto joints = scalar_joint_names(machine_).value();
    const Eigen::VectorXd values = scalar_joint_values(machine_, q);
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const int id = mj_name2id(mujoco_.get(), mjOBJ_JOINT, joints[i].c_str());
      data_->qpos[mujoco_->jnt_qposadr[id]] = values[static_cast<Eigen::Index>(i)];
    }
    mj_kinematics(mujoco_.get(), data_.get());
  }

  double mujoco_distance(int geom, int other) const {
    return mj_geomDistance(mujoco_.get(), data_.get(), geom, other, 1e3, nullptr);
  }
  int geom_of(int capsule) const {
    return mj_name2id(mujoco_.get(), mjOBJ_GEOM, std::to_string(capsule).c_str());
  }
  bool collides(int geom) const { return mujoco_->geom_contype[geom] != 0; }
  std::string body_of(int geom) const {
    return mj_id2name(mujoco_.get(), mjOBJ_BODY, mujoco_->geom_bodyid[geom]);
  }

  /// A point on or in a geom, corners and rims often.
  Eigen::Vector3d random_point(int geom) {
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    std::bernoulli_distribution at_edge(0.7);
    const auto coordinate = [&] {
      const double x = unit(generator_);
      return at_edge(generator_) ? std::copysign(1.0, x) : x;
    };
    const double* size = mujoco_->geom_size + 3 * geom;
    Eigen::Vector3d p(coordinate(), coordinate(), coordinate());
    if (mujoco_->geom_type[geom] == mjGEOM_BOX) {
      p = p.cwiseProduct(Eigen::Map<const Eigen::Vector3d>(size));
    } else {
      const double angle = std::numbers::pi * unit(generator_), r = std::abs(p.x()) * size[0];
      p = {r * std::cos(angle), r * std::sin(angle), p.z() * size[1]};
    }
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(data_->geom_xmat +
                                                                           9 * geom);
    return R * p + Eigen::Map<const Eigen::Vector3d>(data_->geom_xpos + 3 * geom);
  }

  /// How far outside all capsules of a body.
  double outside_m(const std::string& body, const Eigen::Vector3d& p_world) const {
    double outside = 1e9;
    for (const CollisionModel::Capsule& capsule : model_.capsules()) {
      if (capsule.name != body) continue;
      const Eigen::Isometry3d& T = w_.T_world_body[capsule.body];
      const auto nearest =
          nearest_on_segments(T * capsule.p_body_a, T * capsule.p_body_b, p_world, p_world);
      outside = std::min(outside, nearest.between.norm() - capsule.radius_m);
    }
    return outside;
  }

  MujocoModel mujoco_;
  MujocoData data_;
};

TEST_F(WithMujoco, CapsulesContainEveryShapeThatCollides) {
  constexpr int kPostures = 20, kPoints = 200;
  constexpr double kRounding_m = 1e-9;
  std::set<std::string> bodies;
  for (int k = 0; k < kPostures; ++k) {
    pose(test::random_posture(machine_, generator_));
    for (int geom = 0; geom < mujoco_->ngeom; ++geom) {
      if (!collides(geom)) continue;
      bodies.insert(body_of(geom));
      for (int i = 0; i < kPoints; ++i) {
        ASSERT_LE(outside_m(body_of(geom), random_point(geom)), kRounding_m) << body_of(geom);
      }
    }
  }
  EXPECT_THAT(bodies, ::testing::IsSupersetOf({"base", "LF_beam", "LF_wheel", "LH_swivel", "boom",
                                               "dipper", "telescope", "cutting_edge"}));
}

TEST_F(WithMujoco, DistancesBetweenCapsulesAreThoseOfMujoco) {
  constexpr int kPostures = 200, kPairs = 50;
  std::uniform_int_distribution<int> any(0, static_cast<int>(model_.pairs().size()) - 1);
  for (int k = 0; k < kPostures; ++k) {
    pose(test::random_posture(machine_, generator_));
    for (int i = 0; i < kPairs; ++i) {
      const int index = any(generator_);
      const CollisionModel::Pair& pair = model_.pairs()[index];
      ASSERT_NEAR(model_.distance(w_, pair),
                  mujoco_distance(geom_of(pair.first), geom_of(pair.second)), kMujocoTolerance_m)
          << names(index);
    }
  }
}

// Whatever two bodies' geoms are apart, their capsules are nearer, but not by much. How deep bodies
// overlap is another matter: that of several capsules is not that of what they cover.
TEST_F(WithMujoco, DistancesAreALittleBelowThoseOfTheShapesThemselves) {
  constexpr int kPostures = 200;
  std::map<std::string, std::vector<int>> geoms;
  for (int geom = 0; geom < mujoco_->ngeom; ++geom) {
    if (collides(geom)) geoms[body_of(geom)].push_back(geom);
  }
  for (int k = 0; k < kPostures; ++k) {
    pose(test::random_posture(machine_, generator_));
    std::map<std::pair<std::string, std::string>, double> distances;
    for (const CollisionModel::Pair& pair : model_.pairs()) {
      const std::string &first = model_.capsules()[pair.first].name,
                        &second = model_.capsules()[pair.second].name;
      // Capsules of these contain more than the geoms that collide.
      const auto contains_more = [&](const std::string& body) {
        return !geoms.contains(body) || body == "cutting_edge" || body.ends_with("_carrier");
      };
      if (contains_more(first) || contains_more(second)) continue;
      double& distance = distances.try_emplace({first, second}, 1e9).first->second;
      distance = std::min(distance, model_.distance(w_, pair));
    }
    for (const auto& [bodies, distance] : distances) {
      double between_geoms = 1e9;
      for (const int a : geoms[bodies.first]) {
        for (const int b : geoms[bodies.second]) {
          between_geoms = std::min(between_geoms, mujoco_distance(a, b));
        }
      }
      ASSERT_LE(distance, std::max(0.0, between_geoms) + kMujocoTolerance_m)
          << bodies.first << " and " << bodies.second;
      if (between_geoms > 0.0) {
        ASSERT_LT(between_geoms - distance, 2.0 * kProtrusion_m)
            << bodies.first << " and " << bodies.second;
      }
    }
  }
}

TEST_F(CollisionModelOfM545, GradientsAreThoseOfFiniteDifferences) {
  constexpr int kTrials = 300;
  constexpr double kStep = 1e-6, kTolerance = 2e-6, kAxesNearlyCross_m = 0.02;
  std::uniform_int_distribution<int> any(0, static_cast<int>(model_.pairs().size()) - 1);
  int compared = 0;
  Eigen::VectorXd gradient(machine_.num_coordinates());
  for (int k = 0; k < kTrials; ++k) {
    const Eigen::VectorXd q = test::random_posture(machine_, generator_);
    const int index = any(generator_);
    const CollisionModel::Pair& pair = model_.pairs()[index];
    const double radii =
        model_.capsules()[pair.first].radius_m + model_.capsules()[pair.second].radius_m;
    machine_.tree.update(q, w_);
    const double distance = model_.distance(machine_.tree, w_, pair, gradient);
    EXPECT_EQ(distance, model_.distance(w_, pair));
    if (distance + radii < kAxesNearlyCross_m) continue;
    ++compared;
    for (int i = 0; i < q.size(); ++i) {
      Eigen::VectorXd shifted = q;
      shifted[i] = q[i] + kStep;
      machine_.tree.update(shifted, w_);
      const double above = model_.distance(w_, pair);
      shifted[i] = q[i] - kStep;
      machine_.tree.update(shifted, w_);
      const double below = model_.distance(w_, pair);
      ASSERT_NEAR(gradient[i], (above - below) / (2.0 * kStep), kTolerance)
          << names(index) << ", coordinate " << i;
    }
  }
  EXPECT_GT(compared, kTrials * 9 / 10);
}

TEST_F(CollisionModelOfM545, NearestIsTheSmallestOfAllPairs) {
  constexpr int kPostures = 100;
  for (int k = 0; k < kPostures; ++k) {
    machine_.tree.update(test::random_posture(machine_, generator_), w_);
    double smallest = 1e9, smallest_of_arm = 1e9;
    for (const CollisionModel::Pair& pair : model_.pairs()) {
      const double distance = model_.distance(w_, pair);
      smallest = std::min(smallest, distance);
      if (model_.capsules()[pair.first].part == Part::kArm ||
          model_.capsules()[pair.second].part == Part::kArm) {
        smallest_of_arm = std::min(smallest_of_arm, distance);
      }
    }
    const CollisionModel::Proximity all = model_.nearest(w_);
    EXPECT_NEAR(all.distance_m, smallest, 1e-12);
    EXPECT_NEAR(all.distance_m, model_.distance(w_, model_.pairs().at(all.pair)), 1e-12);
    EXPECT_NEAR(model_.nearest(w_, Part::kArm).distance_m, smallest_of_arm, 1e-12);
    for (const double margin : {-0.3, 0.0, kMargin_m, 0.5}) {
      EXPECT_EQ(model_.clear(w_, margin), smallest >= margin) << smallest;
      EXPECT_EQ(model_.clear(w_, Part::kArm, margin), smallest_of_arm >= margin);
      const CollisionModel::Proximity stopped = model_.nearest(w_, margin);
      EXPECT_EQ(stopped.distance_m < margin, smallest < margin);
    }
  }
}

TEST_F(CollisionModelOfM545, StandsClearInItsPosturesAtEveryCabinYaw) {
  for (const Eigen::VectorXd& joints : {machine_.default_posture(), machine_.transport_posture()}) {
    Eigen::VectorXd q = posture(joints);
    for (int i = 0; i < 72; ++i) {
      joint(q, "TURN") = 2.0 * std::numbers::pi * i / 72;
      machine_.tree.update(q, w_);
      const CollisionModel::Proximity nearest = model_.nearest(w_);
      EXPECT_GT(nearest.distance_m, kMargin_m) << "cabin " << i << ", " << names(nearest.pair);
    }
  }
}

// The pair lift: an axle's wheels raised, the arm stretched out over it to the ground.
TEST_F(CollisionModelOfM545, StandsClearWhileAnAxleIsLifted) {
  for (const bool front : {true, false}) {
    Eigen::VectorXd q = posture(machine_.default_posture());
    for (const char* leg : {"L", "R"}) {
      joint(q, std::string(leg) + (front ? "F_HFE" : "H_HFE")) = 0.25;
    }
    joint(q, "TURN") = front ? 0.0 : std::numbers::pi;
    joint(q, "BOOM") = 0.5;
    joint(q, "DIPPER") = 0.6;
    joint(q, "EE_PITCH") = -0.5;
    for (const double tele : {0.0, 0.6, 1.2}) {
      joint(q, "TELE") = tele;
      machine_.tree.update(q, w_);
      const CollisionModel::Proximity nearest = model_.nearest(w_);
      EXPECT_GT(nearest.distance_m, kMargin_m) << "telescope " << tele << names(nearest.pair);
    }
  }
}

TEST_F(CollisionModelOfM545, SeesTheArmReachIntoAWheel) {
  Eigen::VectorXd q = posture(machine_.default_posture());
  joint(q, "TURN") = 0.65;  // towards the left front wheel
  joint(q, "BOOM") = 0.0;
  joint(q, "DIPPER") = 0.0;
  EXPECT_LT(nearest_m(q), 0.0);
  const CollisionModel::Proximity nearest = model_.nearest(w_);
  EXPECT_THAT(names(nearest.pair), ::testing::AnyOf(::testing::HasSubstr("LF_wheel"),
                                                    ::testing::HasSubstr("LF_carrier")));
}

TEST_F(CollisionModelOfM545, TurningWheelsChangeNothing) {
  Eigen::VectorXd q = test::random_posture(machine_, generator_);
  const double before_m = nearest_m(q);
  for (const WheeledLeg& leg : machine_.legs) q[leg.wheel] += 0.3;
  EXPECT_EQ(nearest_m(q), before_m);
}

TEST_F(CollisionModelOfM545, MovingTheBaseChangesNothing) {
  Eigen::VectorXd q = test::random_posture(machine_, generator_);
  const double before_m = nearest_m(q);
  q.head<kNumBaseCoordinates>() << 3.0, -2.0, 0.5, 1.0, 0.2, -0.1;
  EXPECT_NEAR(nearest_m(q), before_m, 1e-12);
}

TEST_F(CollisionModelOfM545, WheelsAndBucketBearLoad) {
  std::set<std::string> bearing;
  for (const CollisionModel::Capsule& capsule : model_.capsules()) {
    if (capsule.load_bearing) bearing.insert(capsule.name);
  }
  EXPECT_THAT(bearing, ::testing::ElementsAre("LF_wheel", "LH_wheel", "RF_wheel", "RH_wheel",
                                              "cutting_edge"));
}

TEST_F(CollisionModelOfM545, ClearanceOverFlatGroundIsThatOfTheLowerEnd) {
  const Eigen::VectorXd q = test::random_posture(machine_, generator_);
  machine_.tree.update(q, w_);
  const auto height_at = [](const Eigen::Vector2d&) { return -1.5; };
  for (int i = 0; i < std::ssize(model_.capsules()); ++i) {
    const CollisionModel::Capsule& capsule = model_.capsules()[i];
    const Eigen::Isometry3d& T = w_.T_world_body[capsule.body];
    const double lower = std::min((T * capsule.p_body_a).z(), (T * capsule.p_body_b).z());
    EXPECT_NEAR(model_.ground_clearance_m(w_, i, 0.1, height_at), lower - capsule.radius_m + 1.5,
                1e-12);
  }
}

TEST(CollisionModel, TakesAnotherMachine) {
  const auto machine = load_machine(WEX_TEST_DATA_DIR "/small_walker");
  ASSERT_TRUE(machine) << machine.error().message;
  const CollisionModel model = CollisionModel::build(*machine);
  KinematicTree::Workspace w = machine->tree.make_workspace();
  Eigen::VectorXd q = Eigen::VectorXd::Zero(machine->num_coordinates());
  q.tail(machine->num_joints()) = machine->default_posture();
  machine->tree.update(q, w);
  EXPECT_GE(model.nearest(w).distance_m, kMargin_m);
  for (const CollisionModel::Capsule& capsule : model.capsules()) {
    EXPECT_NE(capsule.part, Part::kArm) << capsule.name;  // it has none
  }
}

TEST(NearestOnSegments, KnowsCrossingParallelAndEndToEnd) {
  const Eigen::Vector3d origin = Eigen::Vector3d::Zero(), x = Eigen::Vector3d::UnitX(),
                        y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
  const auto crossing = nearest_on_segments(-x, x, z - y, z + 3.0 * y);
  EXPECT_NEAR(crossing.s, 0.5, 1e-12);
  EXPECT_NEAR(crossing.t, 0.25, 1e-12);
  EXPECT_NEAR((crossing.between + z).norm(), 0.0, 1e-12);
  EXPECT_NEAR(nearest_on_segments(origin, x, y, y + x).between.norm(), 1.0, 1e-12);
  const auto end_to_end = nearest_on_segments(origin, x, 3.0 * x, 5.0 * x);
  EXPECT_NEAR(end_to_end.between.norm(), 2.0, 1e-12);
  EXPECT_EQ(end_to_end.s, 1.0);
  EXPECT_EQ(end_to_end.t, 0.0);
}

TEST(NearestOnSegments, TakesPointsForSegments) {
  const Eigen::Vector3d origin = Eigen::Vector3d::Zero(), x = Eigen::Vector3d::UnitX(),
                        y = Eigen::Vector3d::UnitY();
  EXPECT_NEAR(nearest_on_segments(y, y, -x, x).between.norm(), 1.0, 1e-12);
  EXPECT_NEAR(nearest_on_segments(-x, x, 3.0 * x, 3.0 * x).between.norm(), 2.0, 1e-12);
  EXPECT_NEAR(nearest_on_segments(origin, origin, y, y).between.norm(), 1.0, 1e-12);
}

}  // namespace
}  // namespace wex
