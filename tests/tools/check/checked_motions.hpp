#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <string>

#include "models/excavator/machine_model.hpp"
#include "models/excavator/mjcf.hpp"
#include "models/terrain/raster_io.hpp"
#include "models/types/plan.hpp"

// Motions whose verdict is known by hand: on flat ground, made from the default posture.

namespace wex::test {

inline constexpr double kDegree = std::numbers::pi / 180.0;

inline const MachineModel& machine() {
  static const MachineModel model = [] {
    auto loaded = load_machine();
    if (!loaded) throw std::runtime_error(loaded.error().message);
    return *std::move(loaded);
  }();
  return model;
}

inline int coordinate(const std::string& joint) { return machine().coordinate(joint).value(); }

/// 0.1 m cells around the local origin, heights in local coordinates.
inline Raster make_raster(const std::function<double(double, double)>& height_m =
                              [](double, double) { return 0.0; }) {
  Raster raster;
  raster.map_origin_m = {200.0, 100.0};
  Grid& grid = raster.elevation;
  grid.size_x = 301;
  grid.size_y = 201;
  grid.cell_m = 0.1;
  grid.origin_m = {-15.0, -10.0};
  for (int j = 0; j < grid.size_y; ++j) {
    for (int i = 0; i < grid.size_x; ++i) {
      grid.values.push_back(
          static_cast<float>(height_m(grid.origin_m.x() + 0.1 * i, grid.origin_m.y() + 0.1 * j)));
    }
  }
  return raster;
}

/// Standing level on flat ground, arm in transport posture.
inline Eigen::VectorXd standing() {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(machine().num_coordinates());
  q.tail(machine().num_joints()) = machine().transport_posture();
  q[kBaseZ] = machine().default_base_height_m;
  return q;
}

/// Straight ahead from x = -5 to x = 5 at 0.5 m/s, the wheels rolling.
inline Plan driving() {
  Plan plan;
  plan.task = {{-5.0, 0.0, 0.0}, {5.0, 0.0, 0.0}};
  for (int i = 0; i <= 50; ++i) {
    WholeBodyNode node;
    node.t_s = 0.4 * i;
    node.q = standing();
    node.q[kBaseX] = -5.0 + 0.2 * i;
    for (const WheeledLeg& leg : machine().legs) {
      node.q[leg.wheel] = leg.wheel_sign * 0.2 * i / leg.radius_m;
    }
    plan.nodes.push_back(node);
  }
  return plan;
}

/// A motion at one place, told joint by joint.
class Standstill {
 public:
  Standstill() {
    plan_.task = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
    plan_.nodes.push_back({0.0, standing(), kDrivingContacts});
  }
  /// Straight to `q`, in steps of at most 0.05 rad or m, at half of every joint's rate.
  Standstill& to(const Eigen::VectorXd& q) {
    const Eigen::VectorXd from = plan_.nodes.back().q;
    double duration_s = 0.1;
    for (int j = 0; j < machine().num_joints(); ++j) {
      const double way = std::abs((q - from)[kNumBaseCoordinates + j]);
      duration_s = std::max(duration_s,
                            way / (0.5 * machine().joints[static_cast<std::size_t>(j)].max_rate));
    }
    const int steps = static_cast<int>(std::ceil((q - from).lpNorm<Eigen::Infinity>() / 0.05)) + 1;
    const double begin_s = plan_.nodes.back().t_s;
    for (int k = 1; k <= steps; ++k) {
      const double share = static_cast<double>(k) / steps;
      plan_.nodes.push_back({begin_s + share * duration_s, from + share * (q - from), contacts()});
    }
    return *this;
  }
  Standstill& to(const std::string& joint, double value) {
    Eigen::VectorXd q = plan_.nodes.back().q;
    q[coordinate(joint)] = value;
    return to(q);
  }
  /// The arm of `q` without touching the wheels: slewed folded, stretched while high, then lowered.
  Standstill& arm_to(const Eigen::VectorXd& q) {
    to("TURN", q[coordinate("TURN")]).to("BOOM", 1.25);
    for (const char* joint : {"DIPPER", "TELE", "EE_PITCH", "BOOM"})
      to(joint, q[coordinate(joint)]);
    return *this;
  }
  /// The same posture a second later with another schedule.
  Standstill& contact(Limb limb, bool on) {
    WholeBodyNode node = plan_.nodes.back();
    node.t_s += 1.0;
    node.contacts[static_cast<std::size_t>(limb)] = on;
    plan_.nodes.push_back(node);
    return *this;
  }
  [[nodiscard]] const Eigen::VectorXd& q() const { return plan_.nodes.back().q; }
  [[nodiscard]] Plan plan() const { return plan_; }

 private:
  [[nodiscard]] const ContactFlags& contacts() const { return plan_.nodes.back().contacts; }
  Plan plan_;
};

/// Arm ahead and stretched, the bucket's contact `height_m` above the flat ground.
inline Eigen::VectorXd bucket_ahead(double height_m) {
  Eigen::VectorXd q = standing();
  q[coordinate("TELE")] = 1.0;
  q[coordinate("DIPPER")] = -0.2;
  q[coordinate("EE_PITCH")] = -0.6;
  KinematicTree::Workspace w = machine().tree.make_workspace();
  const auto height = [&](double boom_rad) {
    q[coordinate("BOOM")] = boom_rad;
    machine().tree.update(q, w);
    return machine()
        .tree.position(w, machine().arm->contact_body, machine().arm->p_body_contact)
        .z();
  };
  double low = -0.1, high = 1.2;
  if (height(low) > height_m || height(high) < height_m) throw std::runtime_error("out of reach");
  while (high - low > 1e-12) {
    const double middle = 0.5 * (low + high);
    (height(middle) < height_m ? low : high) = middle;
  }
  return q;
}

/// Both front wheels lifted one after the other on the standing bucket, and put down again.
inline Plan front_pair_on_the_bucket() {
  const double down = standing()[coordinate("LF_HFE")];
  Eigen::VectorXd above = bucket_ahead(0.4);
  return Standstill()
      .to(above)
      .to(bucket_ahead(0.0))
      .contact(Limb::kArm, true)
      .contact(Limb::kLF, false)
      .to("LF_HFE", 0.1)
      .contact(Limb::kRF, false)
      .to("RF_HFE", 0.1)
      .to("RF_HFE", down)
      .contact(Limb::kRF, true)
      .to("LF_HFE", down)
      .contact(Limb::kLF, true)
      .contact(Limb::kArm, false)
      .to(above)
      .plan();
}

}  // namespace wex::test
