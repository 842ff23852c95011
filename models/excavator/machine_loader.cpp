#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <utility>

#include "models/excavator/machine_model.hpp"
#include "models/excavator/sidecar_loader.hpp"
#include "models/excavator/urdf_loader.hpp"
#include "models/types/machine_io_types.hpp"

namespace wex {
namespace {

constexpr double kGravityMS2 = 9.81;
// An axle this far from lateral at q = 0 has no left end.
constexpr double kMinLateralAxle = 0.5;
// The default posture has to stand on flat ground; well above rounding in the file, well below sag.
constexpr double kStandingToleranceM = 0.005;
// Sag moves the CoM, which moves the loads: each round shrinks the error to about 1 %.
constexpr int kSagRounds = 8;

std::string in_quotes(const std::string& name) { return "'" + name + "'"; }

// Joins URDF and side-car. The steps of build() run in order and stop at the first complaint.
class MachineBuilder {
 public:
  MachineBuilder(UrdfModel urdf, Sidecar sidecar, std::string name, std::filesystem::path urdf_path,
                 std::filesystem::path sidecar_path)
      : urdf_(std::move(urdf)), sidecar_(std::move(sidecar)) {
    machine_.name = std::move(name);
    machine_.urdf_path = std::move(urdf_path);
    machine_.sidecar_path = std::move(sidecar_path);
    for (std::size_t b = 1; b < urdf_.joints.size(); ++b) {
      body_of_[urdf_.joints[b].name] = static_cast<int>(b);
    }
  }

  Result<MachineModel> build() {
    copy_plain_values();
    add_limb_joints();
    add_auxiliary_joints();
    assign_coordinates();
    add_actuation();
    add_postures();
    if (!error_) machine_.tree = KinematicTree(urdf_.bodies, machine_.num_coordinates());
    add_leg_geometry();
    add_arm_geometry();
    add_static_sag();
    check_default_stance();
    if (error_) return tl::unexpected(*error_);
    machine_.total_mass_kg = machine_.tree.total_mass_kg();
    return std::move(machine_);
  }

 private:
  void complain(const std::filesystem::path& file, const std::string& what) {
    if (!error_) error_ = Error{ErrorCode::kBadInput, file.string() + ": " + what};
  }
  void complain_sidecar(const std::string& what) { complain(machine_.sidecar_path, what); }

  void copy_plain_values() {
    machine_.belly_below_base_m = sidecar_.belly_below_base_m;
    machine_.belly_min_m = sidecar_.belly_min_m;
    machine_.belly_max_m = sidecar_.belly_max_m;
    machine_.default_base_height_m = sidecar_.default_base_height_m;
    machine_.min_turning_radius_m = sidecar_.min_turning_radius_m;
    machine_.pump_flow_limit_w_over_pa = sidecar_.pump_flow_m3_s;
    machine_.pump_pressure_pa = sidecar_.pump_pressure_pa;
    machine_.valve_dead_band = sidecar_.dead_band;
    machine_.tyre_stiffness_n_m = sidecar_.tyre_stiffness_n_m;
    machine_.tyre_damping_ns_m = sidecar_.tyre_damping_ns_m;
    if (!(sidecar_.belly_min_m.array() < sidecar_.belly_max_m.array()).all()) {
      complain_sidecar("'chassis.belly_min_m' must be below 'chassis.belly_max_m'");
    }
  }

  // Appends an actuated joint and returns its coordinate, -1 after a complaint.
  int add_joint(const std::string& name, JointRole role, const std::string& field) {
    const auto found = body_of_.find(name);
    if (found == body_of_.end()) {
      complain_sidecar(in_quotes(field) + " names joint " + in_quotes(name) +
                       ", which the URDF does not have");
      return -1;
    }
    const UrdfJoint& source = urdf_.joints[found->second];
    if (source.type == UrdfJoint::Type::kFixed || !source.mimics.empty()) {
      complain_sidecar(in_quotes(field) + " names joint " + in_quotes(name) +
                       ", which is not actuated");
      return -1;
    }
    if (machine_.coordinate(name)) {
      complain_sidecar(in_quotes(field) + " names joint " + in_quotes(name) +
                       ", which has a place already");
      return -1;
    }
    Joint& joint = machine_.joints.emplace_back();
    joint.name = name;
    joint.body = found->second;
    joint.role = role;
    joint.prismatic = source.type == UrdfJoint::Type::kPrismatic;
    joint.continuous = source.type == UrdfJoint::Type::kContinuous;
    joint.lower = source.lower;
    joint.upper = source.upper;
    joint.max_rate = source.max_rate;
    joint.max_effort = source.max_effort;
    return machine_.num_coordinates() - 1;
  }

  void add_limb_joints() {
    for (int i = 0; i < kNumWheels; ++i) {
      const Sidecar::Leg& source = sidecar_.legs[i];
      WheeledLeg& leg = machine_.legs[i];
      leg.limb = static_cast<Limb>(i);
      leg.radius_m = sidecar_.tyre_radius_m;
      leg.half_width_m = sidecar_.tyre_half_width_m;
      const std::string field = "limbs." + std::string(kLimbNames[i]);
      if (!source.haa.empty())
        leg.haa = add_joint(source.haa, JointRole::kHipAbduction, field + ".haa");
      if (!source.hfe.empty())
        leg.hfe = add_joint(source.hfe, JointRole::kHipFlexion, field + ".hfe");
      if (!source.steer.empty())
        leg.steer = add_joint(source.steer, JointRole::kSteering, field + ".steer");
      leg.wheel = add_joint(source.wheel, JointRole::kWheel, field + ".wheel");
    }
    if (!sidecar_.arm) return;
    ArmLimb& arm = machine_.arm.emplace();
    for (const std::string& name : sidecar_.arm->joints) {
      arm.coordinates.push_back(add_joint(name, JointRole::kArm, "limbs.ARM.joints"));
    }
  }

  void add_auxiliary_joints() {
    for (const auto& [name, body] : body_of_) {  // by name
      const UrdfJoint& joint = urdf_.joints[body];
      const bool actuated = joint.type != UrdfJoint::Type::kFixed && joint.mimics.empty();
      if (actuated && !machine_.coordinate(name)) add_joint(name, JointRole::kAuxiliary, "");
    }
    if (machine_.num_joints() > kMaxJoints) {
      complain(machine_.urdf_path, "has " + std::to_string(machine_.num_joints()) +
                                       " actuated joints, at most " + std::to_string(kMaxJoints) +
                                       " are supported");
    }
  }

  void assign_coordinates() {
    for (int i = 0; i < machine_.num_joints(); ++i) {
      urdf_.bodies[machine_.joints[i].body].coordinate = kNumBaseCoordinates + i;
    }
    for (std::size_t b = 1; b < urdf_.joints.size(); ++b) {
      const UrdfJoint& joint = urdf_.joints[b];
      if (joint.mimics.empty()) continue;
      const auto leader = machine_.coordinate(joint.mimics);
      if (!leader) {
        complain(machine_.urdf_path, "joint " + in_quotes(joint.name) + " mimics " +
                                         in_quotes(joint.mimics) +
                                         ", which is not an actuated joint");
        continue;
      }
      urdf_.bodies[b].coordinate = *leader;
      urdf_.bodies[b].multiplier = joint.mimic_multiplier;
      machine_.passive_joints.push_back(
          {joint.name, static_cast<int>(b), *leader, joint.mimic_multiplier});
    }
  }

  void add_actuation() {
    std::map<std::string, std::string> class_of;
    for (const Sidecar::ActuationClass& entry : sidecar_.actuation) {
      const std::string field = "actuation." + entry.name + ".joints";
      for (const std::string& name : entry.joints) {
        const auto coordinate = machine_.coordinate(name);
        if (!coordinate) {
          complain_sidecar(in_quotes(field) + " names " + in_quotes(name) +
                           ", which is not an actuated joint");
          continue;
        }
        if (!class_of.emplace(name, entry.name).second) {
          complain_sidecar(in_quotes(field) + " names " + in_quotes(name) + ", which is in class " +
                           in_quotes(class_of[name]) + " already");
        }
        Joint& joint = machine_.joints[*coordinate - kNumBaseCoordinates];
        joint.dead_time_s = entry.dead_time_s;
        joint.lag_s = entry.lag_s;
        joint.hold_stiffness = entry.hold_stiffness;
        joint.max_acceleration = entry.max_acceleration;
      }
    }
    for (const Joint& joint : machine_.joints) {
      if (!class_of.contains(joint.name)) {
        complain_sidecar("joint " + in_quotes(joint.name) +
                         " must be in one of 'actuation.*.joints'");
      }
    }
  }

  void add_posture(const std::map<std::string, double>& posture, const std::string& field,
                   double Joint::* position) {
    for (const auto& [name, value] : posture) {
      const auto coordinate = machine_.coordinate(name);
      if (!coordinate) {
        complain_sidecar(in_quotes(field + "." + name) + " is not an actuated joint");
        continue;
      }
      machine_.joints[*coordinate - kNumBaseCoordinates].*position = value;
    }
    for (const Joint& joint : machine_.joints) {
      if (joint.*position < joint.lower || joint.*position > joint.upper) {
        complain_sidecar(in_quotes(field) + " puts joint " + in_quotes(joint.name) +
                         " outside its limits");
      }
    }
  }

  void add_postures() {
    add_posture(sidecar_.default_posture, "posture.default", &Joint::default_position);
    for (Joint& joint : machine_.joints) joint.transport_position = joint.default_position;
    add_posture(sidecar_.transport_posture, "posture.transport", &Joint::transport_position);
  }

  [[nodiscard]] bool carries(int ancestor, int body) const {
    while (body > ancestor) body = urdf_.bodies[body].parent;
    return body == ancestor;
  }

  [[nodiscard]] KinematicTree::Workspace workspace_at(
      const Eigen::VectorXd& joint_positions) const {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(machine_.num_coordinates());
    q.tail(machine_.num_joints()) = joint_positions;
    KinematicTree::Workspace w = machine_.tree.make_workspace();
    machine_.tree.update(q, w);
    return w;
  }

  void add_leg_geometry() {
    if (error_) return;
    const auto zero = workspace_at(Eigen::VectorXd::Zero(machine_.num_joints()));
    const auto standing = workspace_at(machine_.default_posture());
    for (WheeledLeg& leg : machine_.legs) {
      const std::string field = "limbs." + std::string(kLimbNames[static_cast<int>(leg.limb)]);
      const Joint& wheel = machine_.joints[leg.wheel - kNumBaseCoordinates];
      if (!wheel.continuous) {
        complain_sidecar(in_quotes(field + ".wheel") + " must name a continuous joint");
      }
      for (const int coordinate : {leg.haa, leg.hfe, leg.steer}) {
        if (coordinate < 0) continue;
        const Joint& joint = machine_.joints[coordinate - kNumBaseCoordinates];
        if (!carries(joint.body, wheel.body)) {
          complain_sidecar(in_quotes(field) + " names joint " + in_quotes(joint.name) +
                           ", which does not carry wheel " + in_quotes(wheel.name));
        }
      }
      const KinematicTree::Body& body = urdf_.bodies[wheel.body];
      leg.wheel_body = wheel.body;
      leg.carrier_body = body.parent;
      leg.p_carrier_wheel_unloaded = body.T_parent_joint.translation();
      leg.p_carrier_wheel = leg.p_carrier_wheel_unloaded;
      leg.axle_carrier = body.T_parent_joint.linear() * body.axis.normalized();
      const double leftward = zero.axis_world[wheel.body].y();
      if (std::abs(leftward) < kMinLateralAxle) {
        complain(machine_.urdf_path,
                 "joint " + in_quotes(wheel.name) + " needs an axis across the machine at q = 0");
      }
      // Turning about an axle that points left rolls forward.
      leg.wheel_sign = leftward > 0.0 ? 1.0 : -1.0;
      leg.axle_carrier *= leg.wheel_sign;
      leg.tyre_axis_carrier =
          standing.T_world_body[leg.carrier_body].linear().transpose() * Eigen::Vector3d::UnitZ();
    }
  }

  void add_arm_geometry() {
    if (error_ || !machine_.arm) return;
    ArmLimb& arm = *machine_.arm;
    arm.contact_body = machine_.tree.body_index(sidecar_.arm->contact_link);
    arm.p_body_contact = sidecar_.arm->contact_point_m;
    if (arm.contact_body < 0) {
      complain_sidecar("'limbs.ARM.contact_link' names " + in_quotes(sidecar_.arm->contact_link) +
                       ", which the URDF does not have");
      return;
    }
    int carried_by = 0;
    for (const int coordinate : arm.coordinates) {
      const Joint& joint = machine_.joints[coordinate - kNumBaseCoordinates];
      if (!carries(carried_by, joint.body) || !carries(joint.body, arm.contact_body)) {
        complain_sidecar("'limbs.ARM.joints' must go outwards from the cabin to link " +
                         in_quotes(sidecar_.arm->contact_link) + ", which joint " +
                         in_quotes(joint.name) + " does not");
      }
      carried_by = joint.body;
    }
  }

  // Loads of the default posture on flat ground: split front to hind by the CoM, evenly left to
  // right. The tyre carries what stands on it, not the wheel itself.
  void add_static_sag() {
    for (int round = 0; round < kSagRounds && !error_; ++round) {
      const auto w = workspace_at(machine_.default_posture());
      const auto mean_x = [&](Limb a, Limb b) {
        double sum = 0.0;
        for (const Limb limb : {a, b}) {
          const WheeledLeg& leg = machine_.legs[static_cast<int>(limb)];
          sum += machine_.tree.position(w, leg.carrier_body, leg.p_carrier_wheel).x();
        }
        return 0.5 * sum;
      };
      const double x_front = mean_x(Limb::kLF, Limb::kRF), x_hind = mean_x(Limb::kLH, Limb::kRH);
      const double x_com = machine_.tree.com(w).x();
      if (!(x_hind < x_com && x_com < x_front)) {
        complain_sidecar("'posture.default' must have the centre of mass between the axles");
        return;
      }
      const double front_share = (x_com - x_hind) / (x_front - x_hind);
      for (WheeledLeg& leg : machine_.legs) {
        const bool front = leg.limb == Limb::kLF || leg.limb == Limb::kRF;
        const double carried_kg =
            0.5 * (front ? front_share : 1.0 - front_share) * machine_.tree.total_mass_kg() -
            w.subtree_mass_kg[leg.wheel_body];
        leg.static_sag_m = std::max(0.0, carried_kg) * kGravityMS2 / machine_.tyre_stiffness_n_m;
        leg.p_carrier_wheel =
            leg.p_carrier_wheel_unloaded + leg.static_sag_m * leg.tyre_axis_carrier;
        urdf_.bodies[leg.wheel_body].T_parent_joint.translation() = leg.p_carrier_wheel;
      }
      machine_.tree = KinematicTree(urdf_.bodies, machine_.num_coordinates());
    }
  }

  void check_default_stance() {
    if (error_) return;
    const auto w = workspace_at(machine_.default_posture());
    for (const WheeledLeg& leg : machine_.legs) {
      const double height_m = machine_.default_base_height_m - leg.radius_m +
                              machine_.tree.position(w, leg.carrier_body, leg.p_carrier_wheel).z();
      if (std::abs(height_m) > kStandingToleranceM) {
        complain_sidecar("'posture.default' leaves wheel " +
                         std::string(kLimbNames[static_cast<int>(leg.limb)]) + " " +
                         std::to_string(height_m) +
                         " m above the ground at 'chassis.default_base_height_m', it must stand");
      }
    }
  }

  UrdfModel urdf_;
  Sidecar sidecar_;
  MachineModel machine_;
  std::map<std::string, int> body_of_;  // by joint name
  std::optional<Error> error_;
};

std::filesystem::path machine_directory(const std::string& name_or_directory) {
  if (name_or_directory.find('/') != std::string::npos) return name_or_directory;
  const char* override_directory = std::getenv("WEX_MACHINES_DIR");
  const bool overridden = override_directory && *override_directory;
  return std::filesystem::path(overridden ? override_directory : WEX_MACHINES_DIR) /
         name_or_directory;
}

}  // namespace

Result<MachineModel> load_machine(const std::string& name_or_directory) {
  std::filesystem::path directory = machine_directory(name_or_directory);
  if (!directory.has_filename()) directory = directory.parent_path();  // "machines/m545/"
  const std::string name = directory.filename().string();
  std::error_code ignored;
  if (!std::filesystem::is_directory(directory, ignored)) {
    return fail(ErrorCode::kBadInput, directory.string() +
                                          ": there is no such machine directory with " + name +
                                          ".urdf and " + name + ".toml");
  }
  const auto urdf_path = directory / (name + ".urdf");
  const auto sidecar_path = directory / (name + ".toml");
  auto urdf = load_urdf(urdf_path);
  if (!urdf) return tl::unexpected(urdf.error());
  auto sidecar = load_sidecar(sidecar_path);
  if (!sidecar) return tl::unexpected(sidecar.error());
  return MachineBuilder(std::move(*urdf), std::move(*sidecar), name, urdf_path, sidecar_path)
      .build();
}

}  // namespace wex
