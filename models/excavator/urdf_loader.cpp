#include "models/excavator/urdf_loader.hpp"

#include <console_bridge/console.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <mutex>
#include <utility>

namespace wex {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// urdfdom reports through a process-wide logger; this keeps its first complaint instead of
// printing.
class FirstComplaint final : public console_bridge::OutputHandler {
 public:
  FirstComplaint() : lock_(mutex()) { console_bridge::useOutputHandler(this); }
  ~FirstComplaint() override { console_bridge::restorePreviousOutputHandler(); }
  FirstComplaint(const FirstComplaint&) = delete;
  FirstComplaint& operator=(const FirstComplaint&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && text_.empty()) text_ = text;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  static std::mutex& mutex() {
    static std::mutex instance;
    return instance;
  }
  std::lock_guard<std::mutex> lock_;
  std::string text_;
};

Eigen::Vector3d to_eigen(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

Eigen::Isometry3d to_eigen(const urdf::Pose& pose) {
  const urdf::Rotation& r = pose.rotation;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized().toRotationMatrix();
  T.translation() = to_eigen(pose.position);
  return T;
}

class Converter {
 public:
  explicit Converter(std::string file) : file_(std::move(file)) {}

  Result<UrdfModel> convert(const urdf::ModelInterface& source) {
    UrdfModel model;
    model.bodies.emplace_back();
    model.joints.emplace_back();
    if (auto done = add_link(*source.getRoot(), false, model.bodies.back()); !done) {
      return tl::unexpected(done.error());
    }
    // Breadth first over the list that grows, so that parents precede children.
    for (std::size_t parent = 0; parent < model.bodies.size(); ++parent) {
      const auto link = source.getLink(model.bodies[parent].name);
      for (const auto& joint : link->child_joints) {
        KinematicTree::Body body;
        UrdfJoint limits;
        body.parent = static_cast<int>(parent);
        if (auto done = add_joint(*joint, body, limits); !done) {
          return tl::unexpected(done.error());
        }
        const bool moves = limits.type != UrdfJoint::Type::kFixed;
        if (auto done = add_link(*source.getLink(joint->child_link_name), moves, body); !done) {
          return tl::unexpected(done.error());
        }
        model.bodies.push_back(std::move(body));
        model.joints.push_back(std::move(limits));
      }
    }
    return model;
  }

 private:
  [[nodiscard]] tl::unexpected<Error> bad(const std::string& what) const {
    return fail(ErrorCode::kBadInput, file_ + ": " + what);
  }

  Result<void> add_joint(const urdf::Joint& source, KinematicTree::Body& body,
                         UrdfJoint& joint) const {
    const std::string label = "joint '" + source.name + "' ";
    joint.name = body.joint_name = source.name;
    body.T_parent_joint = to_eigen(source.parent_to_joint_origin_transform);
    if (!body.T_parent_joint.matrix().allFinite())
      return bad(label + "has an origin that is not finite");
    switch (source.type) {
      case urdf::Joint::FIXED:
        joint.type = UrdfJoint::Type::kFixed;
        return {};
      case urdf::Joint::REVOLUTE:
        joint.type = UrdfJoint::Type::kRevolute;
        break;
      case urdf::Joint::CONTINUOUS:
        joint.type = UrdfJoint::Type::kContinuous;
        break;
      case urdf::Joint::PRISMATIC:
        joint.type = UrdfJoint::Type::kPrismatic;
        body.prismatic = true;
        break;
      default:
        return bad(label + "must be fixed, revolute, continuous or prismatic");
    }
    body.axis = to_eigen(source.axis);
    if (!(body.axis.norm() > 0.5)) return bad(label + "needs an axis of unit length");
    if (!source.limits) return bad(label + "needs a <limit> with velocity and effort");
    const bool continuous = joint.type == UrdfJoint::Type::kContinuous;
    joint.lower = continuous ? -kInfinity : source.limits->lower;
    joint.upper = continuous ? kInfinity : source.limits->upper;
    joint.max_rate = source.limits->velocity;
    joint.max_effort = source.limits->effort;
    if (!(joint.lower < joint.upper))
      return bad(label + "needs a lower limit below its upper limit");
    if (!(joint.max_rate > 0.0) || !std::isfinite(joint.max_rate)) {
      return bad(label + "needs a positive limit of velocity");
    }
    if (!(joint.max_effort > 0.0) || !std::isfinite(joint.max_effort)) {
      return bad(label + "needs a positive limit of effort");
    }
    if (source.mimic) {
      joint.mimics = source.mimic->joint_name;
      joint.mimic_multiplier = source.mimic->multiplier;
      if (source.mimic->offset != 0.0) return bad(label + "has a mimic offset, which must be 0");
    }
    return {};
  }

  Result<void> add_link(const urdf::Link& source, bool moves, KinematicTree::Body& body) const {
    const std::string label = "link '" + source.name + "' ";
    body.name = source.name;
    if (!source.inertial) {
      if (moves) return bad(label + "moves and needs an <inertial>");
      return {};
    }
    const urdf::Inertial& inertial = *source.inertial;
    body.mass_kg = inertial.mass;
    if (!(body.mass_kg > 0.0) || !std::isfinite(body.mass_kg)) {
      return bad(label + "needs a positive mass");
    }
    const Eigen::Isometry3d T_body_inertia = to_eigen(inertial.origin);
    Eigen::Matrix3d inertia;
    inertia << inertial.ixx, inertial.ixy, inertial.ixz,  //
        inertial.ixy, inertial.iyy, inertial.iyz,         //
        inertial.ixz, inertial.iyz, inertial.izz;
    body.p_body_com = T_body_inertia.translation();
    body.inertia_kg_m2 = T_body_inertia.linear() * inertia * T_body_inertia.linear().transpose();
    if (!body.p_body_com.allFinite() || !inertia.allFinite()) {
      return bad(label + "has an inertia that is not finite");
    }
    // Ascending; a rigid body's principal moments are positive and obey the triangle inequality.
    const Eigen::Vector3d moments =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia, Eigen::EigenvaluesOnly)
            .eigenvalues();
    if (!(moments[0] > 0.0) || moments[0] + moments[1] < moments[2] * (1.0 - 1e-6)) {
      return bad(label + "has an inertia no rigid body can have");
    }
    return {};
  }

  std::string file_;
};

}  // namespace

Result<UrdfModel> load_urdf(const std::filesystem::path& path) {
  std::ifstream stream(path);
  if (!stream) return fail(ErrorCode::kBadInput, path.string() + ": cannot be read as a URDF file");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const FirstComplaint complaint;
  const auto invalid = [&](const std::string& why) {
    return fail(ErrorCode::kBadInput, path.string() + ": is not a valid URDF: " + why);
  };
  try {
    const urdf::ModelInterfaceSharedPtr source = urdf::parseURDF(text);
    // urdfdom goes on after some errors, with zeros for what it could not read.
    if (!complaint.text().empty()) return invalid(complaint.text());
    if (!source || !source->getRoot()) return invalid("no robot found");
    return Converter(path.string()).convert(*source);
  } catch (const std::exception& error) {
    return invalid(error.what());
  }
}

}  // namespace wex
