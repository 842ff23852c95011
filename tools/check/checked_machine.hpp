#pragma once

#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "models/types/limbs.hpp"
#include "models/types/result.hpp"

namespace wex::check {

/// A scalar joint of the exported model.
struct CheckedJoint {
  /// Value = polynomial of another joint's value, both from the model's zero posture.
  struct Coupling {
    int joint = -1;  ///< -1: not coupled
    std::array<double, 5> polynomial{};
  };
  std::string name;
  bool limited = false;
  double lower = 0.0, upper = 0.0;  ///< rad or m
  double max_rate = 0.0;            ///< of its actuator; 0: it has none
  bool tyre = false;                ///< slide between carrier and wheel
  Coupling coupling;
};

/// A tyre of the exported model.
struct CheckedTyre {
  double radius_m = 0.0, half_width_m = 0.0;
};

/// One posture, world frame.
struct CheckedPosture {
  Eigen::Vector3d p_base = Eigen::Vector3d::Zero();
  Eigen::Quaterniond R_base = Eigen::Quaterniond::Identity();
  Eigen::VectorXd joints;  ///< in the order of CheckedMachine::joints()
};

enum class MachinePart { kChassis, kCabin, kLF, kRF, kLH, kRH, kArm };

/// What a shape of the machine means for the ground.
enum class ShapeRole { kChassis, kLimb, kBucket, kTyre };

/// The machine as the exported MJCF describes it, posed by MuJoCo's kinematics. Knows the model's
/// names (sites LF_wheel ... ARM_contact, geom group 2 = load-bearing) and nothing of planners.
class CheckedMachine {
 public:
  /// A shape of the model, with what the ground needs to know of it.
  struct Shape {
    std::string name;  ///< body it belongs to
    int geom = -1, body = -1;
    MachinePart part{};
    ShapeRole role{};
    Eigen::Vector3d half_m = Eigen::Vector3d::Zero();  ///< of the box around it
    double radius_m = 0.0;                             ///< of the sphere around it
    double sample_radius_m = 0.0;                      ///< samples are balls of this radius
    std::vector<Eigen::Vector3d> p_samples;            ///< of its surface, shape frame, 10 cm apart
  };
  struct Pair {
    int first = -1, second = -1;  ///< shapes
  };

  /// errors  kBadInput: what MuJoCo says, or the site, joint or shape that is missing
  [[nodiscard]] static Result<CheckedMachine> load(const std::string& mjcf);
  CheckedMachine(CheckedMachine&&) noexcept;
  ~CheckedMachine();

  [[nodiscard]] const std::vector<CheckedJoint>& joints() const noexcept { return joints_; }
  [[nodiscard]] const std::array<CheckedTyre, kNumWheels>& tyres() const noexcept { return tyres_; }
  [[nodiscard]] bool has_arm() const noexcept { return arm_site_ >= 0; }
  [[nodiscard]] const std::vector<Shape>& shapes() const noexcept { return shapes_; }
  /// Shapes of different parts, without neighbouring links and without what touches at zero.
  [[nodiscard]] const std::vector<Pair>& pairs() const noexcept { return pairs_; }

  /// Kinematics of a posture; the queries below are about the last one.
  void set(const CheckedPosture& posture);
  [[nodiscard]] Eigen::Vector3d p_wheel(int wheel) const;
  [[nodiscard]] Eigen::Matrix3d R_wheel(int wheel) const;  ///< turns with it; column 1 is the axle
  [[nodiscard]] Eigen::Vector3d p_bucket() const;          ///< has_arm() (contract)
  [[nodiscard]] Eigen::Vector3d com() const;
  [[nodiscard]] Eigen::Vector3d p_shape(const Shape& shape) const;
  [[nodiscard]] Eigen::Matrix3d R_shape(const Shape& shape) const;
  /// Between surfaces, negative if they overlap; `beyond_m` if it is more than that.
  [[nodiscard]] double distance_m(const Pair& pair, double beyond_m);

 private:
  struct Mujoco;
  CheckedMachine();
  [[nodiscard]] std::string read_joints();
  [[nodiscard]] std::string read_sites();
  [[nodiscard]] MachinePart part_of(int body) const;
  void read_shapes();
  void read_pairs();

  std::unique_ptr<Mujoco> mujoco_;
  std::vector<CheckedJoint> joints_;
  std::array<CheckedTyre, kNumWheels> tyres_;
  std::array<int, kNumWheels> wheel_sites_{};
  int arm_site_ = -1;
  std::vector<Shape> shapes_;
  std::vector<Pair> pairs_;
};

}  // namespace wex::check
