#include "tools/check/checked_machine.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>

namespace wex::check {
namespace {

constexpr int kLoadBearingGroup = 2;  // geom group of wheels and bucket in the exported model
constexpr double kSampleSpacingM = 0.1;
constexpr double kTouchesM = 0.01;  // shapes this close at zero are joined to each other
constexpr int kFreeJointPositions = 7;

struct SpecDeleter {
  void operator()(mjSpec* spec) const noexcept { mj_deleteSpec(spec); }
};
struct ModelDeleter {
  void operator()(mjModel* model) const noexcept { mj_deleteModel(model); }
};
struct DataDeleter {
  void operator()(mjData* data) const noexcept { mj_deleteData(data); }
};

Eigen::Vector3d vector3(const mjtNum* values) { return {values[0], values[1], values[2]}; }

Eigen::Matrix3d matrix3(const mjtNum* values) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values);
}

/// Points of a box's surface, edges included, at most the spacing apart.
std::vector<Eigen::Vector3d> box_samples(const Eigen::Vector3d& half_m) {
  const Eigen::Array3i steps = (2.0 * half_m.array() / kSampleSpacingM).ceil().max(1.0).cast<int>();
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= steps.x(); ++i) {
    for (int j = 0; j <= steps.y(); ++j) {
      for (int k = 0; k <= steps.z(); ++k) {
        const bool surface =
            i == 0 || i == steps.x() || j == 0 || j == steps.y() || k == 0 || k == steps.z();
        if (!surface) continue;
        const Eigen::Array3d share = 2.0 * Eigen::Array3d(i, j, k) / steps.cast<double>() - 1.0;
        points.emplace_back(half_m.array() * share);
      }
    }
  }
  return points;
}

std::vector<Eigen::Vector3d> axis_samples(double half_length_m) {
  const int steps = static_cast<int>(std::ceil(2.0 * half_length_m / kSampleSpacingM)) + 1;
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k <= steps; ++k) {
    points.emplace_back(0.0, 0.0, half_length_m * (2.0 * k / steps - 1.0));
  }
  return points;
}

}  // namespace

struct CheckedMachine::Mujoco {
  std::unique_ptr<mjModel, ModelDeleter> model;
  std::unique_ptr<mjData, DataDeleter> data;
};

CheckedMachine::CheckedMachine() : mujoco_(std::make_unique<Mujoco>()) {}
CheckedMachine::CheckedMachine(CheckedMachine&&) noexcept = default;
CheckedMachine::~CheckedMachine() = default;

Result<CheckedMachine> CheckedMachine::load(const std::string& mjcf) {
  std::array<char, 1024> message{};
  const std::unique_ptr<mjSpec, SpecDeleter> spec(
      mj_parseXMLString(mjcf.c_str(), nullptr, message.data(), static_cast<int>(message.size())));
  if (!spec) return fail(ErrorCode::kBadInput, std::string(message.data()));
  CheckedMachine machine;
  machine.mujoco_->model.reset(mj_compile(spec.get(), nullptr));
  if (!machine.mujoco_->model) return fail(ErrorCode::kBadInput, mjs_getError(spec.get()));
  machine.mujoco_->data.reset(mj_makeData(machine.mujoco_->model.get()));
  if (!machine.mujoco_->data) return fail(ErrorCode::kInternal, "MuJoCo: no memory for a state");
  std::string problem = machine.read_joints();
  if (problem.empty()) problem = machine.read_sites();
  if (!problem.empty()) return fail(ErrorCode::kBadInput, problem);
  machine.read_shapes();
  machine.read_pairs();
  return machine;
}

std::string CheckedMachine::read_joints() {
  const mjModel& m = *mujoco_->model;
  if (m.njnt == 0 || m.jnt_type[0] != mjJNT_FREE || m.jnt_bodyid[0] != 1) {
    return "the first joint is not the base's free joint";
  }
  for (int j = 1; j < m.njnt; ++j) {
    CheckedJoint joint;
    joint.name = m.names + m.name_jntadr[j];
    if (m.jnt_type[j] != mjJNT_HINGE && m.jnt_type[j] != mjJNT_SLIDE) {
      return "joint " + joint.name + " is neither a hinge nor a slide";
    }
    joint.limited = m.jnt_limited[j] != 0;
    joint.lower = m.jnt_range[2 * j];
    joint.upper = m.jnt_range[2 * j + 1];
    joints_.push_back(joint);
  }
  // Every actuator of the model takes a rate, so its control range is the joint's rate limit.
  for (int a = 0; a < m.nu; ++a) {
    const int j = m.actuator_trnid[2 * a];
    if (m.actuator_trntype[a] != mjTRN_JOINT || j < 1) continue;
    joints_[static_cast<std::size_t>(j - 1)].max_rate = m.actuator_ctrlrange[2 * a + 1];
  }
  for (int e = 0; e < m.neq; ++e) {
    const int j = m.eq_obj1id[e], other = m.eq_obj2id[e];
    if (m.eq_type[e] != mjEQ_JOINT || j < 1 || other < 1) continue;
    CheckedJoint::Coupling& coupling = joints_[static_cast<std::size_t>(j - 1)].coupling;
    coupling.joint = other - 1;
    std::copy_n(m.eq_data + mjNEQDATA * e, coupling.polynomial.size(), coupling.polynomial.begin());
  }
  return "";
}

std::string CheckedMachine::read_sites() {
  const mjModel& m = *mujoco_->model;
  for (int i = 0; i < kNumWheels; ++i) {
    const std::string name = std::string(kLimbNames[static_cast<std::size_t>(i)]) + "_wheel";
    const int site = mj_name2id(&m, mjOBJ_SITE, name.c_str());
    if (site < 0) return "there is no site " + name;
    wheel_sites_[static_cast<std::size_t>(i)] = site;
    const int body = m.site_bodyid[site];
    for (int g = 0; g < m.ngeom; ++g) {
      if (m.geom_bodyid[g] != body || m.geom_group[g] != kLoadBearingGroup) continue;
      if (m.geom_type[g] != mjGEOM_CYLINDER) continue;
      tyres_[static_cast<std::size_t>(i)] = {m.geom_size[3 * g], m.geom_size[3 * g + 1]};
    }
    if (!(tyres_[static_cast<std::size_t>(i)].radius_m > 0.0)) {
      return "the body of site " + name + " has no load-bearing cylinder";
    }
    for (int j = m.body_jntadr[body]; j < m.body_jntadr[body] + m.body_jntnum[body]; ++j) {
      joints_[static_cast<std::size_t>(j - 1)].tyre = m.jnt_type[j] == mjJNT_SLIDE;
    }
  }
  arm_site_ = mj_name2id(&m, mjOBJ_SITE, "ARM_contact");
  return "";
}

MachinePart CheckedMachine::part_of(int body) const {
  const mjModel& m = *mujoco_->model;
  const auto root = [&](int of) {
    while (m.body_parentid[of] > 1) of = m.body_parentid[of];
    return of;
  };
  if (body <= 1) return MachinePart::kChassis;
  for (int i = 0; i < kNumWheels; ++i) {
    if (root(body) == root(m.site_bodyid[wheel_sites_[static_cast<std::size_t>(i)]])) {
      return static_cast<MachinePart>(static_cast<int>(MachinePart::kLF) + i);
    }
  }
  if (arm_site_ >= 0 && root(body) == root(m.site_bodyid[arm_site_])) {
    return body == root(body) ? MachinePart::kCabin : MachinePart::kArm;
  }
  return MachinePart::kChassis;
}

void CheckedMachine::read_shapes() {
  const mjModel& m = *mujoco_->model;
  for (int g = 0; g < m.ngeom; ++g) {
    const int body = m.geom_bodyid[g];
    const bool load_bearing = m.geom_group[g] == kLoadBearingGroup;
    const bool on_wheel = std::any_of(wheel_sites_.begin(), wheel_sites_.end(),
                                      [&](int site) { return m.site_bodyid[site] == body; });
    if (on_wheel && !load_bearing) continue;  // rim and spokes, inside the tyre
    Shape shape;
    shape.name = m.names + m.name_bodyadr[body];
    shape.geom = g;
    shape.body = body;
    shape.part = part_of(body);
    const bool bucket = arm_site_ >= 0 && m.site_bodyid[arm_site_] == body;
    shape.role = on_wheel                              ? ShapeRole::kTyre
                 : bucket                              ? ShapeRole::kBucket
                 : shape.part == MachinePart::kChassis ? ShapeRole::kChassis
                                                       : ShapeRole::kLimb;
    const mjtNum* size = m.geom_size + 3 * g;
    switch (m.geom_type[g]) {
      case mjGEOM_BOX:
        shape.half_m = vector3(size);
        shape.p_samples = box_samples(shape.half_m);
        break;
      case mjGEOM_CYLINDER:
        shape.half_m = {size[0], size[0], size[1]};
        shape.p_samples = box_samples(shape.half_m);  // the box around it
        break;
      case mjGEOM_CAPSULE:
        shape.half_m = {size[0], size[0], size[0] + size[1]};
        shape.p_samples = axis_samples(size[1]);
        shape.sample_radius_m = size[0];
        break;
      case mjGEOM_SPHERE:
        shape.half_m.setConstant(size[0]);
        shape.p_samples = axis_samples(0.0);
        shape.sample_radius_m = size[0];
        break;
      default:
        continue;  // planes and meshes: the exported model has none
    }
    shape.radius_m = m.geom_rbound[g];
    shapes_.push_back(std::move(shape));
  }
}

void CheckedMachine::read_pairs() {
  const mjModel& m = *mujoco_->model;
  CheckedPosture zero;
  zero.joints = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(joints_.size()));
  set(zero);
  const auto neighbours = [&](int a, int b) {
    return m.body_parentid[a] == b || m.body_parentid[b] == a;
  };
  for (int a = 0; a < static_cast<int>(shapes_.size()); ++a) {
    for (int b = a + 1; b < static_cast<int>(shapes_.size()); ++b) {
      const Shape& first = shapes_[static_cast<std::size_t>(a)];
      const Shape& second = shapes_[static_cast<std::size_t>(b)];
      if (first.part == second.part || neighbours(first.body, second.body)) continue;
      if (distance_m({a, b}, 2.0 * kTouchesM) > kTouchesM) pairs_.push_back({a, b});
    }
  }
}

void CheckedMachine::set(const CheckedPosture& posture) {
  const mjModel& m = *mujoco_->model;
  mjData& d = *mujoco_->data;
  WEX_EXPECTS(posture.joints.size() == m.nq - kFreeJointPositions);
  std::copy_n(posture.p_base.data(), 3, d.qpos);
  d.qpos[3] = posture.R_base.w();
  d.qpos[4] = posture.R_base.x();
  d.qpos[5] = posture.R_base.y();
  d.qpos[6] = posture.R_base.z();
  std::copy_n(posture.joints.data(), posture.joints.size(), d.qpos + kFreeJointPositions);
  mj_kinematics(&m, &d);
  mj_comPos(&m, &d);
}

Eigen::Vector3d CheckedMachine::p_wheel(int wheel) const {
  return vector3(mujoco_->data->site_xpos + 3 * wheel_sites_[static_cast<std::size_t>(wheel)]);
}

Eigen::Matrix3d CheckedMachine::R_wheel(int wheel) const {
  return matrix3(mujoco_->data->site_xmat + 9 * wheel_sites_[static_cast<std::size_t>(wheel)]);
}

Eigen::Vector3d CheckedMachine::p_bucket() const {
  WEX_EXPECTS(has_arm());
  return vector3(mujoco_->data->site_xpos + 3 * arm_site_);
}

Eigen::Vector3d CheckedMachine::com() const { return vector3(mujoco_->data->subtree_com + 3); }

Eigen::Vector3d CheckedMachine::p_shape(const Shape& shape) const {
  return vector3(mujoco_->data->geom_xpos + 3 * shape.geom);
}

Eigen::Matrix3d CheckedMachine::R_shape(const Shape& shape) const {
  return matrix3(mujoco_->data->geom_xmat + 9 * shape.geom);
}

double CheckedMachine::distance_m(const Pair& pair, double beyond_m) {
  const Shape& a = shapes_[static_cast<std::size_t>(pair.first)];
  const Shape& b = shapes_[static_cast<std::size_t>(pair.second)];
  // Cheap bounds first: spheres, then the six face axes of the boxes around the shapes.
  const Eigen::Vector3d between = p_shape(b) - p_shape(a);
  const double reach_m = beyond_m + a.radius_m + b.radius_m;
  if (between.squaredNorm() > reach_m * reach_m) return beyond_m;
  const Eigen::Matrix3d R_a = R_shape(a), R_b = R_shape(b);
  const Eigen::Matrix3d turn = (R_a.transpose() * R_b).cwiseAbs();
  const Eigen::Vector3d along_a =
      (R_a.transpose() * between).cwiseAbs() - a.half_m - turn * b.half_m;
  const Eigen::Vector3d along_b =
      (R_b.transpose() * between).cwiseAbs() - b.half_m - turn.transpose() * a.half_m;
  if (std::max(along_a.maxCoeff(), along_b.maxCoeff()) > beyond_m) return beyond_m;
  return mj_geomDistance(mujoco_->model.get(), mujoco_->data.get(), a.geom, b.geom, beyond_m,
                         nullptr);
}

}  // namespace wex::check
