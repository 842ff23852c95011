#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "models/excavator/machine_model.hpp"
#include "tests/support/scratch_folder.hpp"

namespace wex {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

std::string contents(const std::filesystem::path& path) {
  std::ifstream stream(path);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

void expect_refused(const std::string& machine, const std::string& file, const std::string& what) {
  const auto loaded = load_machine(machine);
  ASSERT_FALSE(loaded) << "should not load: " << what;
  EXPECT_EQ(loaded.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(loaded.error().message,
              AllOf(HasSubstr(file), HasSubstr(what), Not(HasSubstr("\n"))));
}

// A copy of the m545 in a directory of its own, to be damaged.
class DamagedMachine : public ::testing::Test {
 protected:
  DamagedMachine() {
    std::filesystem::create_directories(directory_);
    const auto original = load_machine("m545");
    EXPECT_TRUE(original) << original.error().message;
    if (!original) return;
    urdf_ = contents(original->urdf_path);
    toml_ = contents(original->sidecar_path);
    write(urdf_, toml_);
  }

  void write(const std::string& urdf, const std::string& toml) const {
    std::ofstream(directory_ / "m545.urdf") << urdf;
    std::ofstream(directory_ / "m545.toml") << toml;
  }
  static std::string replaced(const std::string& text, const std::string& from,
                              const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return at == std::string::npos ? text : text.substr(0, at) + to + text.substr(at + from.size());
  }
  void expect_toml_refused(const std::string& from, const std::string& to,
                           const std::string& what) const {
    write(urdf_, replaced(toml_, from, to));
    expect_refused(directory_.string(), "m545.toml", what);
  }
  void expect_urdf_refused(const std::string& from, const std::string& to,
                           const std::string& what) const {
    write(replaced(urdf_, from, to), toml_);
    expect_refused(directory_.string(), "m545.urdf", what);
  }

  ScratchFolder folder_{"loader"};
  std::filesystem::path directory_ = folder_ / "m545";
  std::string urdf_, toml_;
};

TEST_F(DamagedMachine, LoadsBeforeItIsDamaged) {
  const auto loaded = load_machine(directory_.string());
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->urdf_path, directory_ / "m545.urdf");
  EXPECT_TRUE(load_machine(directory_.string() + "/"));
}

TEST_F(DamagedMachine, IsRefusedWithoutItsFiles) {
  std::filesystem::remove(directory_ / "m545.toml");
  expect_refused(directory_.string(), "m545.toml", "no such side-car file");
  std::filesystem::remove(directory_ / "m545.urdf");
  expect_refused(directory_.string(), "m545.urdf", "cannot be read");
  expect_refused("no_such_machine", "no_such_machine", "no such machine directory");
}

TEST_F(DamagedMachine, IsRefusedIfAFileDoesNotParse) {
  expect_toml_refused("[tyre]", "[tyre", "not valid TOML");
  expect_urdf_refused("</robot>", "", "not a valid URDF");
  expect_urdf_refused("value=\"118\"", "value=\"heavy\"", "not a valid URDF");
  write("", toml_);
  expect_refused(directory_.string(), "m545.urdf", "not a valid URDF");
}

TEST_F(DamagedMachine, NamesTheLineAndFieldOfABadSideCarValue) {
  expect_toml_refused("radius_m = 0.6", "radius_m = \"big\"", "'tyre.radius_m' must be a number");
  expect_toml_refused("radius_m = 0.6", "radius_m = 0", "'tyre.radius_m' must be greater than 0");
  expect_toml_refused("dead_band = 0.05", "dead_band = nan", "'hydraulics.dead_band'");
  expect_toml_refused("pump_pressure_pa = 35e6", "", "'hydraulics.pump_pressure_pa' is missing");
  expect_toml_refused("[tyre]", "[tyre]\ncolour = 1", "'tyre.colour' is not a known key");
  expect_toml_refused("format = 1", "format = 2", ":3: 'format' must be");
  expect_toml_refused("belly_min_m = [-0.90, -0.60]", "belly_min_m = [-0.90]",
                      "'chassis.belly_min_m' must be a list of 2 numbers");
  expect_toml_refused("belly_min_m = [-0.90, -0.60]", "belly_min_m = [1.90, -0.60]",
                      "'chassis.belly_min_m' must be below");
  expect_toml_refused("[limbs.LF]", "[limbs.FL]", "'limbs.LF' is missing");
}

TEST_F(DamagedMachine, IsRefusedIfTheTwoFilesDisagree) {
  expect_toml_refused("haa = \"LF_HAA\"", "haa = \"LF_HIP\"",
                      "'limbs.LF.haa' names joint 'LF_HIP', which the URDF does not have");
  expect_toml_refused("haa = \"LF_HAA\"", "haa = \"LF_PAR\"", "'LF_PAR', which is not actuated");
  expect_toml_refused("haa = \"RF_HAA\"", "haa = \"LF_HAA\"", "which has a place already");
  expect_toml_refused("haa = \"LF_HAA\"", "haa = \"LH_CLAW\"", "does not carry wheel 'LF_WHEEL'");
  expect_toml_refused("wheel = \"LF_WHEEL\"", "wheel = \"BOOM\"", "'limbs");
  expect_toml_refused("\"TURN\", \"BOOM\"", "\"BOOM\", \"TURN\"", "must go outwards");
  expect_toml_refused("contact_link = \"cutting_edge\"", "contact_link = \"blade\"",
                      "'limbs.ARM.contact_link' names 'blade'");
  expect_toml_refused("joints = [\"BOOM\"]", "joints = [\"JIB\"]", "'actuation.boom.joints'");
  expect_toml_refused("joints = [\"BOOM\"]", "joints = [\"TURN\"]", "already");
  expect_toml_refused("[\"LH_CLAW\", \"RH_CLAW\"]", "[\"LH_CLAW\"]",
                      "joint 'RH_CLAW' must be in one of");
  expect_toml_refused("LF_HFE = -0.37543", "LF_KNEE = -0.37543", "'posture.default.LF_KNEE'");
}

TEST_F(DamagedMachine, IsRefusedIfItCannotStandInItsDefaultPosture) {
  expect_toml_refused("LF_HFE = -0.37543", "LF_HFE = -0.9", "'LF_HFE' outside its limits");
  expect_toml_refused("LF_HFE = -0.37543", "LF_HFE = -0.3", "leaves wheel LF");
  write(replaced(urdf_, "xyz=\"0.015 0 0.149\"", "xyz=\"20 0 0.149\""), toml_);
  expect_refused(directory_.string(), "m545.toml", "the centre of mass between the axles");
}

TEST_F(DamagedMachine, IsRefusedIfALinkOrJointIsNotPhysical) {
  expect_urdf_refused("value=\"118\"", "value=\"-118\"", "link 'LF_swivel' needs a positive mass");
  expect_urdf_refused("ixx=\"1.77\"", "ixx=\"177\"", "link 'LF_swivel' has an inertia");
  expect_urdf_refused("lower=\"-0.49\" upper=\"0.75\"", "lower=\"0.49\" upper=\"-0.75\"",
                      "joint 'LF_HAA' needs a lower limit below");
  expect_urdf_refused("velocity=\"0.25\"", "velocity=\"0\"", "joint 'LF_HAA' needs a positive");
  expect_urdf_refused("<mimic joint=\"LF_HFE\"", "<mimic joint=\"LF_KNEE\"", "mimics 'LF_KNEE'");
  expect_urdf_refused("<joint name=\"LF_HAA\" type=\"revolute\">",
                      "<joint name=\"LF_HAA\" type=\"floating\">", "joint 'LF_HAA' must be");
}

// Another machine: no arm, steering before lifting, no abduction, right axles flipped.
class SmallWalker : public ::testing::Test {
 protected:
  const std::string directory_ = WEX_TEST_DATA_DIR "/small_walker";
};

TEST_F(SmallWalker, LoadsFromItsTwoFiles) {
  const auto machine = load_machine(directory_);
  ASSERT_TRUE(machine) << machine.error().message;
  EXPECT_EQ(machine->name, "small_walker");
  EXPECT_EQ(machine->num_joints(), 13);
  EXPECT_FALSE(machine->arm.has_value());
  EXPECT_NEAR(machine->total_mass_kg, 1250.0, 1e-9);
  std::vector<std::string> first;
  for (int i = 0; i < 4; ++i) first.push_back(machine->joints[i].name);
  EXPECT_THAT(first, ElementsAre("front_left_lift", "front_left_turn", "front_left_drive",
                                 "front_right_lift"));
  EXPECT_EQ(machine->joints.back().name, "blade");
  EXPECT_EQ(machine->joints.back().role, JointRole::kAuxiliary);
  EXPECT_EQ(machine->joints.back().transport_position, -0.5) << "as in the default posture";
  for (const WheeledLeg& leg : machine->legs) {
    EXPECT_EQ(leg.haa, -1);
    EXPECT_EQ(leg.radius_m, 0.5);
    const bool right = leg.limb == Limb::kRF || leg.limb == Limb::kRH;
    EXPECT_EQ(leg.wheel_sign, right ? -1.0 : 1.0);
    EXPECT_LT((leg.axle_carrier - Eigen::Vector3d::UnitY()).norm(), 1e-9);
  }
}

TEST_F(SmallWalker, IsFoundByNameUnderTheOverriddenDirectory) {
  ASSERT_EQ(setenv("WEX_MACHINES_DIR", WEX_TEST_DATA_DIR, 1), 0);
  const auto machine = load_machine("small_walker");
  const auto other = load_machine("m545");
  ASSERT_EQ(unsetenv("WEX_MACHINES_DIR"), 0);
  EXPECT_TRUE(machine) << machine.error().message;
  EXPECT_FALSE(other);
}

}  // namespace
}  // namespace wex
