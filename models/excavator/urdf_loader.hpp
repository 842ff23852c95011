#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "models/excavator/kinematic_tree.hpp"
#include "models/types/result.hpp"

namespace wex {

/// What a URDF says of a joint, beyond its place in the tree.
struct UrdfJoint {
  enum class Type { kFixed, kRevolute, kContinuous, kPrismatic };
  std::string name;
  Type type = Type::kFixed;
  double lower = 0.0, upper = 0.0;  ///< rad or m; -/+infinity if continuous
  double max_rate = 0.0;            ///< rad/s or m/s
  double max_effort = 0.0;          ///< N m or N
  std::string mimics;               ///< joint it follows, empty if none
  double mimic_multiplier = 0.0;
};

/// A URDF as a tree, root first, children in the order of their joint names. Coordinates are not
/// assigned yet: which joint is which stands in the side-car.
struct UrdfModel {
  std::vector<KinematicTree::Body> bodies;
  std::vector<UrdfJoint> joints;  ///< joints[i] carries bodies[i]; joints[0] is empty
};

/// Parses and checks one URDF with urdfdom. Never throws.
///   errors  kBadInput naming the file and the joint or link
[[nodiscard]] Result<UrdfModel> load_urdf(const std::filesystem::path& path);

}  // namespace wex
