#include "models/excavator/machine_model.hpp"

namespace wex {

std::optional<int> MachineModel::coordinate(const std::string& joint_name) const {
  for (int i = 0; i < num_joints(); ++i) {
    if (joints[i].name == joint_name) return kNumBaseCoordinates + i;
  }
  return std::nullopt;
}

Eigen::VectorXd MachineModel::default_posture() const {
  Eigen::VectorXd posture(num_joints());
  for (int i = 0; i < num_joints(); ++i) posture[i] = joints[i].default_position;
  return posture;
}

Eigen::VectorXd MachineModel::transport_posture() const {
  Eigen::VectorXd posture(num_joints());
  for (int i = 0; i < num_joints(); ++i) posture[i] = joints[i].transport_position;
  return posture;
}

}  // namespace wex
