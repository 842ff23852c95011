#include "models/excavator/machine_model.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/models/excavator/random_posture.hpp"

namespace wex {
namespace {

using ::testing::ElementsAre;

constexpr double kExactM = 1e-9;
constexpr double kStandingToleranceM = 1e-4;  // the HFE angles of the file have five digits

class Machine : public ::testing::Test {
 protected:
  Machine() {
    auto loaded = load_machine("m545");
    EXPECT_TRUE(loaded) << loaded.error().message;
    if (loaded) machine_ = std::move(*loaded);
  }

  KinematicTree::Workspace at(const Eigen::VectorXd& joints) const {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(machine_.num_coordinates());
    q.tail(machine_.num_joints()) = joints;
    auto w = machine_.tree.make_workspace();
    machine_.tree.update(q, w);
    return w;
  }
  Eigen::Vector3d wheel_centre(const KinematicTree::Workspace& w, Limb limb) const {
    const WheeledLeg& leg = machine_.legs[static_cast<int>(limb)];
    return machine_.tree.position(w, leg.carrier_body, leg.p_carrier_wheel);
  }
  // Distance of the CoM's ground projection to the nearest edge of the four wheels' polygon.
  double four_wheel_margin_m(const KinematicTree::Workspace& w) const {
    const std::array<Limb, 4> ring{Limb::kRF, Limb::kLF, Limb::kLH, Limb::kRH};
    double margin = 1e9;
    for (int i = 0; i < 4; ++i) {
      const Eigen::Vector2d a = wheel_centre(w, ring[i]).head<2>();
      const Eigen::Vector2d edge = wheel_centre(w, ring[(i + 1) % 4]).head<2>() - a;
      const Eigen::Vector2d inward = Eigen::Vector2d(-edge.y(), edge.x()).normalized();
      margin = std::min(margin, inward.dot(machine_.tree.com(w).head<2>() - a));
    }
    return margin;
  }

  MachineModel machine_;
};

TEST_F(Machine, Has25ActuatedJointsInTheDocumentedOrder) {
  std::vector<std::string> names;
  for (const Joint& joint : machine_.joints) names.push_back(joint.name);
  EXPECT_THAT(names, ElementsAre("LF_HAA", "LF_HFE", "LF_STEER", "LF_WHEEL",  //
                                 "RF_HAA", "RF_HFE", "RF_STEER", "RF_WHEEL",  //
                                 "LH_HAA", "LH_HFE", "LH_STEER", "LH_WHEEL",  //
                                 "RH_HAA", "RH_HFE", "RH_STEER", "RH_WHEEL",  //
                                 "TURN", "BOOM", "DIPPER", "TELE", "EE_PITCH", "EE_ROLL", "EE_YAW",
                                 "LH_CLAW", "RH_CLAW"));
  ASSERT_EQ(machine_.passive_joints.size(), 2u);
  for (const PassiveJoint& joint : machine_.passive_joints) {
    EXPECT_EQ(joint.multiplier, -1.0);
    EXPECT_EQ(machine_.joints[joint.coordinate - kNumBaseCoordinates].role, JointRole::kHipFlexion);
  }
}

TEST(MachineReadme, ExampleFindsTheLeftFrontWheel) {
  const auto machine = load_machine("m545");
  ASSERT_TRUE(machine) << machine.error().message;
  Eigen::VectorXd q = Eigen::VectorXd::Zero(machine->num_coordinates());
  q.tail(machine->num_joints()) = machine->transport_posture();
  q[kBaseZ] = machine->default_base_height_m;
  auto w = machine->tree.make_workspace();
  machine->tree.update(q, w);
  const WheeledLeg& leg = machine->legs[static_cast<int>(Limb::kLF)];
  const Eigen::Vector3d p_world_wheel =
      machine->tree.position(w, leg.carrier_body, leg.p_carrier_wheel);
  EXPECT_NEAR(p_world_wheel.z(), leg.radius_m, kStandingToleranceM);
}

TEST_F(Machine, WeighsTwelveTonnes) { EXPECT_NEAR(machine_.total_mass_kg, 12000.0, 1e-6); }

TEST_F(Machine, KnowsEachJointsRoleLimitsAndActuation) {
  const auto joint = [&](const std::string& name) {
    return machine_.joints[machine_.coordinate(name).value() - kNumBaseCoordinates];
  };
  EXPECT_EQ(joint("LF_HAA").role, JointRole::kHipAbduction);
  EXPECT_EQ(joint("RH_STEER").role, JointRole::kSteering);
  EXPECT_EQ(joint("LH_WHEEL").role, JointRole::kWheel);
  EXPECT_EQ(joint("TELE").role, JointRole::kArm);
  EXPECT_EQ(joint("LH_CLAW").role, JointRole::kAuxiliary);
  EXPECT_TRUE(joint("TELE").prismatic);
  EXPECT_TRUE(joint("TURN").continuous);
  EXPECT_EQ(joint("TURN").upper, std::numeric_limits<double>::infinity());
  EXPECT_EQ(joint("RH_HAA").lower, -0.56);
  EXPECT_EQ(joint("RH_HAA").upper, 0.69);
  EXPECT_EQ(joint("LF_STEER").max_rate, 0.175);
  EXPECT_EQ(joint("BOOM").max_effort, 300e3);
  EXPECT_EQ(joint("LF_HFE").dead_time_s, 0.05);
  EXPECT_EQ(joint("BOOM").lag_s, 0.3);
  EXPECT_EQ(machine_.coordinate("LF_PAR"), std::nullopt);
}

TEST_F(Machine, IsMirrorSymmetricInItsLegs) {
  std::mt19937 generator(3);
  for (int i = 0; i < 50; ++i) {
    Eigen::VectorXd joints = test::random_posture(machine_, generator).tail(machine_.num_joints());
    // HAA and STEER turn about z and change sign, HFE turns about y and does not.
    for (int j = 0; j < 4; ++j) {
      const double sign = j == 0 || j == 2 ? -1.0 : 1.0;
      joints[4 + j] = sign * joints[j];
      joints[12 + j] = sign * joints[8 + j];
    }
    for (int j = 0; j < machine_.num_joints(); ++j) {
      EXPECT_GE(joints[j], machine_.joints[j].lower) << machine_.joints[j].name;
      EXPECT_LE(joints[j], machine_.joints[j].upper) << machine_.joints[j].name;
    }
    const auto w = at(joints);
    const Eigen::Vector3d mirror(1.0, -1.0, 1.0);
    EXPECT_LT((wheel_centre(w, Limb::kRF) - mirror.cwiseProduct(wheel_centre(w, Limb::kLF))).norm(),
              kExactM);
    EXPECT_LT((wheel_centre(w, Limb::kRH) - mirror.cwiseProduct(wheel_centre(w, Limb::kLH))).norm(),
              kExactM);
  }
}

TEST_F(Machine, PutsFrontWheelsWhereTheClosedFormDoes) {
  std::mt19937 generator(4);
  for (int i = 0; i < 200; ++i) {
    const Eigen::VectorXd joints =
        test::random_posture(machine_, generator).tail(machine_.num_joints());
    const auto w = at(joints);
    for (const Limb limb : {Limb::kLF, Limb::kRF}) {
      const WheeledLeg& leg = machine_.legs[static_cast<int>(limb)];
      const double s = limb == Limb::kLF ? 1.0 : -1.0;
      const double haa = joints[leg.haa - kNumBaseCoordinates];
      const double hfe = joints[leg.hfe - kNumBaseCoordinates];
      const double steer = joints[leg.steer - kNumBaseCoordinates];
      const Eigen::AngleAxisd hip(haa, Eigen::Vector3d::UnitZ());
      const Eigen::AngleAxisd wheel(haa + steer, Eigen::Vector3d::UnitZ());
      const Eigen::Vector3d expected = Eigen::Vector3d(0.55, 0.85 * s, 0.1335) +
                                       hip * Eigen::Vector3d(0.515 + 1.2 * std::cos(hfe), 0.298 * s,
                                                             -0.0925 + 1.2 * std::sin(hfe)) +
                                       wheel * Eigen::Vector3d(0.27, 0.39 * s, 0.0);
      const Eigen::Vector3d actual =
          machine_.tree.position(w, leg.carrier_body, leg.p_carrier_wheel_unloaded);
      EXPECT_LT((actual - expected).norm(), kExactM);
    }
  }
}

TEST_F(Machine, HasAxlesThatPointLeftSoThatPositiveRatesDriveForward) {
  const auto w = at(Eigen::VectorXd::Zero(machine_.num_joints()));
  for (const WheeledLeg& leg : machine_.legs) {
    EXPECT_EQ(leg.wheel_sign, 1.0);
    const Eigen::Vector3d axle = machine_.tree.direction(w, leg.carrier_body, leg.axle_carrier);
    EXPECT_LT((axle - Eigen::Vector3d::UnitY()).norm(), kExactM);
    EXPECT_LT((w.axis_world[leg.wheel_body] - Eigen::Vector3d::UnitY()).norm(), kExactM);
  }
}

TEST_F(Machine, StandsOnItsWheelsInTheDefaultPosture) {
  const auto w = at(machine_.default_posture());
  for (const WheeledLeg& leg : machine_.legs) {
    EXPECT_NEAR(wheel_centre(w, leg.limb).z(), -0.95 + 0.6, kStandingToleranceM);
    const Eigen::Vector3d axle = machine_.tree.direction(w, leg.carrier_body, leg.axle_carrier);
    EXPECT_LT((axle - Eigen::Vector3d::UnitY()).norm(), kExactM) << "wheels are straight";
    const Eigen::Vector3d slide =
        machine_.tree.direction(w, leg.carrier_body, leg.tyre_axis_carrier);
    EXPECT_LT((slide - Eigen::Vector3d::UnitZ()).norm(), kExactM);
  }
}

TEST_F(Machine, SagsOnItsTyresByWhatTheyCarry) {
  const auto w = at(machine_.default_posture());
  double carried_n = 0.0, moment_n_m = 0.0;
  for (const WheeledLeg& leg : machine_.legs) {
    const double load_n = leg.static_sag_m * machine_.tyre_stiffness_n_m + 350.0 * 9.81;
    carried_n += load_n;
    moment_n_m += load_n * wheel_centre(w, leg.limb).x();
    EXPECT_LT((leg.p_carrier_wheel - leg.p_carrier_wheel_unloaded -
               leg.static_sag_m * leg.tyre_axis_carrier)
                  .norm(),
              kExactM);
    EXPECT_LT((w.T_world_body[leg.wheel_body].translation() - wheel_centre(w, leg.limb)).norm(),
              kExactM);
  }
  EXPECT_NEAR(carried_n, 12000.0 * 9.81, 1e-3);
  EXPECT_NEAR(moment_n_m / carried_n, machine_.tree.com(w).x(), 1e-6);
}

TEST_F(Machine, CarriesItsBucketHighAndItsWeightBetweenTheWheelsInTransport) {
  const auto w = at(machine_.transport_posture());
  const double ground_z = -machine_.default_base_height_m;
  // The bucket as a box of 1.5 m width around tool plate and cutting edge, bucket frame.
  const int bucket = machine_.tree.body_index("bucket");
  for (const double x : {-0.35, 0.25}) {
    for (const double y : {-0.86, 0.0}) {
      for (const double z : {-0.75, 0.75}) {
        const Eigen::Vector3d corner = machine_.tree.position(w, bucket, {x, y, z});
        EXPECT_GT(corner.z() - ground_z, 0.8);
        EXPECT_GT(corner.x(), 1.2) << "clear of the cabin, which ends at the boom's foot";
      }
    }
  }
  EXPECT_GT(four_wheel_margin_m(w), 1.0);
}

// Flat ground, nominal stance, one leg lifted: over which cabin angles the machine stands on the
// other three. Published to 15 degrees; the result does not depend on the exact masses.
struct YawRange {
  Limb lifted;
  double from_deg, to_deg;  // the narrower of the published bounds, 0 = arm forward
  double slack_deg;
};

class LiftedLeg : public Machine, public ::testing::WithParamInterface<YawRange> {};

TEST_P(LiftedLeg, NeedsTheCabinTurnedToItsOppositeSide) {
  const YawRange& range = GetParam();
  const std::array<std::map<std::string, double>, 2> arms{
      {{{"BOOM", 0.6}, {"DIPPER", 0.0}, {"TELE", 0.3}, {"EE_PITCH", -0.5}},
       {{"BOOM", 0.4}, {"DIPPER", 0.8}, {"TELE", 1.2}, {"EE_PITCH", -0.5}}}};
  int stable = 0, unstable = 0;
  for (const auto& arm : arms) {
    for (int yaw_deg = 0; yaw_deg < 360; yaw_deg += 5) {
      Eigen::VectorXd joints = Eigen::VectorXd::Zero(machine_.num_joints());
      const auto set = [&](const std::string& name, double value) {
        joints[machine_.coordinate(name).value() - kNumBaseCoordinates] = value;
      };
      for (const auto& [name, value] : arm) set(name, value);
      set("TURN", yaw_deg * std::numbers::pi / 180.0);
      for (const WheeledLeg& leg : machine_.legs) {
        const bool front = leg.limb == Limb::kLF || leg.limb == Limb::kRF;
        joints[leg.hfe - kNumBaseCoordinates] =
            leg.limb == range.lifted ? 0.25 : (front ? -0.332 : -0.309);
      }
      const auto w = at(joints);
      std::vector<Eigen::Vector2d> feet;
      for (const WheeledLeg& leg : machine_.legs) {
        if (leg.limb != range.lifted) feet.emplace_back(wheel_centre(w, leg.limb).head<2>());
      }
      const Eigen::Vector2d com = machine_.tree.com(w).head<2>();
      const auto side = [&](int i) {
        const Eigen::Vector2d edge = feet[(i + 1) % 3] - feet[i], to_com = com - feet[i];
        return edge.x() * to_com.y() - edge.y() * to_com.x() > 0.0;
      };
      const bool stands = side(0) == side(1) && side(1) == side(2);
      const double half_deg = 0.5 * (range.to_deg - range.from_deg);
      const double off_centre_deg =
          std::abs(std::remainder(yaw_deg - range.from_deg - half_deg, 360.0));
      if (off_centre_deg < half_deg - range.slack_deg) {
        EXPECT_TRUE(stands) << "cabin at " << yaw_deg << " degrees";
        ++stable;
      } else if (off_centre_deg > half_deg + range.slack_deg) {
        EXPECT_FALSE(stands) << "cabin at " << yaw_deg << " degrees";
        ++unstable;
      }
    }
  }
  EXPECT_GT(stable, 40);
  EXPECT_GT(unstable, 40);
}

INSTANTIATE_TEST_SUITE_P(Legs, LiftedLeg,
                         ::testing::Values(YawRange{Limb::kLF, 165.0, 315.0, 20.0},
                                           YawRange{Limb::kRF, 45.0, 195.0, 20.0},
                                           YawRange{Limb::kLH, 210.0, 390.0, 20.0},
                                           YawRange{Limb::kRH, 330.0, 517.5, 25.0}),
                         [](const auto& info) {
                           return std::string(kLimbNames[static_cast<int>(info.param.lifted)]);
                         });

}  // namespace
}  // namespace wex
