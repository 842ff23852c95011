#include "models/excavator/mjcf.hpp"

#include <array>

#include "models/excavator/mujoco_model.hpp"

namespace wex {
namespace {

constexpr int kFirstBuffer_bytes = 1 << 18;
constexpr int kErrorBuffer_bytes = 1024;

/// Calls visit(body) along the tree, depth first: the order in which MuJoCo numbers joints.
template <typename Visit>
void depth_first(const std::vector<KinematicTree::Body>& bodies, int index, const Visit& visit) {
  visit(index);
  for (int i = index + 1; i < static_cast<int>(bodies.size()); ++i) {
    if (bodies[i].parent == index) depth_first(bodies, i, visit);
  }
}

const WheeledLeg* leg_of_wheel(const MachineModel& machine, int body) {
  for (const WheeledLeg& leg : machine.legs) {
    if (leg.wheel_body == body) return &leg;
  }
  return nullptr;
}

}  // namespace

Result<std::string> machine_mjcf(const MachineModel& machine) {
  auto spec = machine_spec(machine);
  if (!spec) return tl::unexpected(spec.error());
  if (auto model = compile(spec->get()); !model) return tl::unexpected(model.error());
  std::string xml(kFirstBuffer_bytes, '\0');
  std::array<char, kErrorBuffer_bytes> error{};
  int status = mj_saveXMLString(spec->get(), xml.data(), static_cast<int>(xml.size()), error.data(),
                                kErrorBuffer_bytes);
  if (status > 0) {  // too short: the status says how long
    xml.resize(static_cast<std::size_t>(status) + 1);
    status = mj_saveXMLString(spec->get(), xml.data(), static_cast<int>(xml.size()), error.data(),
                              kErrorBuffer_bytes);
  }
  if (status != 0) {
    return fail(ErrorCode::kInternal,
                std::string("MuJoCo cannot write the model: ") + error.data());
  }
  xml.resize(xml.find('\0'));
  return xml;
}

Result<std::vector<std::string>> scalar_joint_names(const MachineModel& machine) {
  std::vector<std::string> names;
  depth_first(machine.tree.bodies(), 0, [&](int index) {
    if (const WheeledLeg* leg = leg_of_wheel(machine, index)) {
      names.push_back(tyre_joint_name(leg->limb));
    }
    const KinematicTree::Body& body = machine.tree.bodies()[index];
    if (index > 0 && body.coordinate >= 0) names.push_back(body.joint_name);
  });
  return names;
}

Eigen::VectorXd scalar_joint_values(const MachineModel& machine, const Eigen::VectorXd& q) {
  WEX_EXPECTS(q.size() == machine.num_coordinates());
  std::vector<double> values;
  depth_first(machine.tree.bodies(), 0, [&](int index) {
    if (const WheeledLeg* leg = leg_of_wheel(machine, index)) values.push_back(leg->static_sag_m);
    const KinematicTree::Body& body = machine.tree.bodies()[index];
    if (index > 0 && body.coordinate >= 0) {
      values.push_back(body.offset + body.multiplier * q[body.coordinate]);
    }
  });
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace wex
