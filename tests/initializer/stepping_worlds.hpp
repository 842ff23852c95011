#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "initializer/stepping/certificate.hpp"
#include "initializer/stepping/support_polygon.hpp"
#include "initializer/stepping/tyre_patch.hpp"
#include "models/terrain/wheel_rest.hpp"
#include "test_worlds.hpp"

namespace wex {

inline constexpr std::uint8_t kFrontPair = 0b0011, kRearPair = 0b1100;

/// A sequence along the x axis, made by hand: stations every 0.2 m, level base.
class HandMadeSequence {
 public:
  HandMadeSequence(double x_0_m, double x_1_m, double z_m, double y_m = 0.0) : z_m_(z_m) {
    sequence_.path = {{{x_0_m, y_m, 0.0}, 0.0, x_1_m - x_0_m}};
    sequence_.stations = path_stations(sequence_.path, 0.2);
  }
  int bucket_at(const Eigen::Vector3d& p_world) {
    sequence_.bucket_points.push_back(p_world);
    return static_cast<int>(sequence_.bucket_points.size()) - 1;
  }
  /// Drives on one support until the base is at x, changing to it first where needed.
  HandMadeSequence& drive_to(double x_m, const Support& support = {}) {
    if (sequence_.states.empty()) add(0, support);
    if (!(sequence_.states.back().support == support))
      add(sequence_.states.back().station, support);
    while (sequence_.stations[sequence_.states.back().station].pose.x_m < x_m - 1e-6) {
      add(sequence_.states.back().station + 1, support);
    }
    return *this;
  }
  /// Changes height and pitch on the spot, in steps of the certificate's grid.
  HandMadeSequence& rise_to(double z_m, double pitch_rad = 0.0) {
    const double pitch_0 = pitch_rad_, z_0 = z_m_;
    const int steps = static_cast<int>(std::ceil(
        std::max(std::abs(z_m - z_0) / 0.1, std::abs(pitch_rad - pitch_0) / 0.0873) - 1e-6));
    for (int i = 1; i <= steps; ++i) {
      z_m_ = z_0 + (z_m - z_0) * i / steps;
      pitch_rad_ = pitch_0 + (pitch_rad - pitch_0) * i / steps;
      add(sequence_.states.back().station, sequence_.states.back().support);
    }
    return *this;
  }
  void hold_arm(const ArmPosture& arm) { arm_ = arm; }
  [[nodiscard]] const CertifiedSequence& get() const { return sequence_; }

 private:
  void add(std::size_t station, const Support& support) {
    SteppingState state;
    state.station = station;
    const Pose2& pose = sequence_.stations[station].pose;
    state.base << pose.x_m, pose.y_m, z_m_, pose.yaw_rad, pitch_rad_, 0.0;
    state.support = support;
    state.arm = arm_;
    sequence_.states.push_back(state);
  }
  double z_m_, pitch_rad_ = 0.0;
  ArmPosture arm_;
  CertifiedSequence sequence_;
};

/// Across a gap 0 < x < width, straight on, with the bucket as support (limits.md's phases).
inline CertifiedSequence gap_sequence(double width_m, double z_m = 1.0) {
  const double front_m = 2.45, rear_m = 2.31, reserve_m = 0.45;  // wheels from the base
  HandMadeSequence hand(-7.0, width_m + 7.0, z_m);
  const auto grid = [](double x) { return std::round(x / 0.2) * 0.2; };
  const double front_up = grid(-front_m - reserve_m),
               front_down = grid(width_m - front_m + reserve_m);
  const double rear_up = grid(rear_m - reserve_m), rear_down = grid(width_m + rear_m + reserve_m);
  const int ahead = hand.bucket_at({front_down + 3.4, 0.0, 0.0});
  const int behind = hand.bucket_at({rear_up - 3.4, 0.0, 0.0});
  hand.drive_to(front_up)
      .drive_to(front_down, {kFrontPair, ahead})
      .drive_to(rear_up)
      .drive_to(rear_down, {kRearPair, behind})
      .drive_to(width_m + 7.0);
  return hand.get();
}

/// The worst of a plan, looked at in steps of a centimetre of any wheel or a hundredth of a radian.
struct PlanFacts {
  double contact_error_at_nodes_m = 0.0, contact_error_between_m = 0.0;
  double bucket_slip_m = 0.0, bucket_height_error_m = 0.0;
  double swing_clearance_m = 1e9;  ///< of lifted wheels while the base drives
  double margin_m = 1e9, margin_at_s = 0.0;
  double joint_step = 0.0;  ///< largest from node to node but wheels
  double base_step_m = 0.0;
  double rate_share = 0.0;    ///< of joint rate limits
  double flow_share = 0.0;    ///< of the pump
  double limit_excess = 0.0;  ///< beyond joint limits
  int contact_changes = 0, most_changes_at_once = 0;
  double duration_s = 0.0;
  bool time_increases = true;
};

inline PlanFacts look_at(const TerrainMap& terrain, const MachineModel& machine,
                         const std::vector<WholeBodyNode>& nodes) {
  PlanFacts facts;
  KinematicTree::Workspace w = machine.tree.make_workspace();
  Eigen::Vector3d p_bucket = Eigen::Vector3d::Zero();
  bool stood = false;
  const auto look = [&](const Eigen::VectorXd& q, const ContactFlags& contacts, double t_s,
                        bool at_node, bool driving) {
    machine.tree.update(q, w);
    std::vector<Eigen::Vector2d> support;
    for (std::size_t i = 0; i < kNumWheels; ++i) {
      const WheeledLeg& leg = machine.legs[i];
      const Eigen::Vector3d p = machine.tree.position(w, leg.carrier_body, leg.p_carrier_wheel);
      if (!contacts[i]) {
        if (driving) {
          facts.swing_clearance_m =
              std::min(facts.swing_clearance_m,
                       p.z() - leg.radius_m - terrain.dilated_height_m(p.head<2>()));
        }
        continue;
      }
      const Eigen::Vector3d axle = machine.tree.direction(w, leg.carrier_body, leg.axle_carrier);
      support.push_back(tyre_patch(terrain, p, axle, leg.radius_m, leg.half_width_m).head<2>());
      const double error_m = std::abs(
          p.z() - wheel_rest(terrain, p.head<2>(), axle, leg.radius_m, leg.half_width_m).height_m);
      double& worst = at_node ? facts.contact_error_at_nodes_m : facts.contact_error_between_m;
      worst = std::max(worst, error_m);
    }
    if (contacts[4]) {
      const Eigen::Vector3d p =
          machine.tree.position(w, machine.arm->contact_body, machine.arm->p_body_contact);
      if (!stood) p_bucket = p;
      stood = true;
      support.push_back(p.head<2>());
      facts.bucket_slip_m = std::max(facts.bucket_slip_m, (p - p_bucket).norm());
      facts.bucket_height_error_m =
          std::max(facts.bucket_height_error_m, std::abs(p.z() - terrain.height_m(p.head<2>())));
    } else {
      stood = false;
    }
    const double margin_m = hull_margin_m(machine.tree.com(w).head<2>(), support);
    if (margin_m < facts.margin_m) {
      facts.margin_m = margin_m;
      facts.margin_at_s = t_s;
    }
  };

  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    const WholeBodyNode& a = nodes[i];
    const WholeBodyNode& b = nodes[i + 1];
    const Eigen::VectorXd step = b.q - a.q;
    const double dt_s = b.t_s - a.t_s;
    facts.time_increases = facts.time_increases && dt_s > 0.0;
    facts.base_step_m = std::max(facts.base_step_m, step.head<3>().norm());
    int changes = 0;
    for (std::size_t k = 0; k < kNumLimbs; ++k) changes += a.contacts[k] != b.contacts[k] ? 1 : 0;
    facts.contact_changes += changes;
    facts.most_changes_at_once = std::max(facts.most_changes_at_once, changes);
    double flow = 0.0;
    for (int j = 0; j < machine.num_joints(); ++j) {
      const Joint& joint = machine.joints[static_cast<std::size_t>(j)];
      const double move = std::abs(step[kNumBaseCoordinates + j]);
      facts.rate_share = std::max(facts.rate_share, move / dt_s / joint.max_rate);
      if (joint.role != JointRole::kWheel) {
        facts.joint_step = std::max(facts.joint_step, move);
        flow += move / dt_s * joint.max_effort / machine.pump_pressure_pa;
      }
      if (!joint.continuous) {
        const double value = b.q[kNumBaseCoordinates + j];
        facts.limit_excess =
            std::max({facts.limit_excess, joint.lower - value, value - joint.upper});
      }
    }
    facts.flow_share = std::max(facts.flow_share, flow / machine.pump_flow_limit_w_over_pa);
    const bool driving = step.head<2>().norm() > 1e-6;
    const int pieces = std::max(1, static_cast<int>(std::ceil(step.cwiseAbs().maxCoeff() / 0.01)));
    for (int k = 0; k < pieces; ++k) {
      const double share = static_cast<double>(k) / pieces;
      look(a.q + share * step, a.contacts, a.t_s + share * dt_s, k == 0, driving);
    }
    look(b.q, b.contacts, b.t_s, true, driving);
  }
  facts.duration_s = nodes.back().t_s;
  return facts;
}

inline void print(const char* name, std::size_t num_nodes, const PlanFacts& f) {
  std::printf(
      "%s: %zu nodes %.1f s, contact %.4f/%.4f m, slip %.4f bucket height %.4f, swing %.3f, margin "
      "%.3f at %.1f s, joint step %.3f base %.3f, rate %.3f flow %.3f, limits %.4f, changes %d "
      "(%d)\n",
      name, num_nodes, f.duration_s, f.contact_error_at_nodes_m, f.contact_error_between_m,
      f.bucket_slip_m, f.bucket_height_error_m, f.swing_clearance_m, f.margin_m, f.margin_at_s,
      f.joint_step, f.base_step_m, f.rate_share, f.flow_share, f.limit_excess, f.contact_changes,
      f.most_changes_at_once);
}

}  // namespace wex
