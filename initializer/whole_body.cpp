#include "initializer/whole_body.hpp"

#include <algorithm>
#include <cmath>

namespace wex {
namespace {

constexpr double kShareStep = 0.25;      // how fast smoothing is given up where it does not fit
constexpr double kShareSlope_1_m = 1.0;  // and how fast it may change along the path
constexpr int kSteeringRounds = 2;       // steering moves the wheel, the wheel its hip flexion

struct SmoothedBase {
  std::vector<double> z, pitch, roll;
};

SmoothedBase smooth(const std::vector<Station>& stations, const std::vector<StandingPose>& raw,
                    double window_m) {
  std::vector<double> s;
  SmoothedBase base;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    s.push_back(stations[i].s_m);
    base.z.push_back(raw[i].base[kBaseZ]);
    base.pitch.push_back(raw[i].base[kBasePitch]);
    base.roll.push_back(raw[i].base[kBaseRoll]);
  }
  for (std::vector<double>* values : {&base.z, &base.pitch, &base.roll}) {
    *values = moving_average(s, moving_average(s, *values, window_m), window_m);
  }
  return base;
}

// Lowers the shares so that they change no faster than kShareSlope along the path.
void limit_slope(const std::vector<Station>& stations, std::vector<double>& share) {
  for (std::size_t i = 1; i < share.size(); ++i) {
    const double step_m = stations[i].s_m - stations[i - 1].s_m;
    share[i] = std::min(share[i], share[i - 1] + kShareSlope_1_m * step_m);
  }
  for (std::size_t i = share.size() - 1; i > 0; --i) {
    const double step_m = stations[i].s_m - stations[i - 1].s_m;
    share[i - 1] = std::min(share[i - 1], share[i] + kShareSlope_1_m * step_m);
  }
}

// Raw pose of Algorithm 1, steering matched to where the wheels end up.
StandingPose stand_steered(const PoseCheck& check, const Pose2& pose, double curvature_1_m) {
  StandingPose standing =
      check.stand(pose, check.steering_for(curvature_1_m, check.default_hfe_rad()));
  for (int i = 0; i < kSteeringRounds && standing.ok(); ++i) {
    standing = check.stand(pose, check.steering_for(curvature_1_m, standing.hfe_rad));
  }
  return standing;
}

StandingPose blend(const PoseCheck& check, const StandingPose& raw, const SmoothedBase& smoothed,
                   std::size_t i, double share, double curvature_1_m) {
  if (share <= 0.0) return raw;
  BaseCoordinates base = raw.base;
  base[kBaseZ] += share * (smoothed.z[i] - base[kBaseZ]);
  base[kBasePitch] += share * (smoothed.pitch[i] - base[kBasePitch]);
  base[kBaseRoll] += share * (smoothed.roll[i] - base[kBaseRoll]);
  StandingPose pose = check.check(base, check.steering_for(curvature_1_m, raw.hfe_rad));
  if (pose.ok()) pose = check.check(base, check.steering_for(curvature_1_m, pose.hfe_rad));
  return pose;
}

// Turns the wheels by the way their centres go, less the turn of what carries the axle.
void spin_wheels(const MachineModel& machine, std::vector<WholeBodyNode>& nodes) {
  KinematicTree::Workspace before = machine.tree.make_workspace();
  KinematicTree::Workspace after = machine.tree.make_workspace();
  machine.tree.update(nodes.front().q, before);
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    machine.tree.update(nodes[i].q, after);
    for (const WheeledLeg& leg : machine.legs) {
      if (leg.wheel < 0) continue;
      const auto wheel = [&](const KinematicTree::Workspace& w) {
        return machine.tree.position(w, leg.carrier_body, leg.p_carrier_wheel);
      };
      const auto axle = [&](const KinematicTree::Workspace& w) {
        return machine.tree.direction(w, leg.carrier_body, leg.axle_carrier);
      };
      const auto carrier = static_cast<std::size_t>(leg.carrier_body);
      const Eigen::Vector3d axle_world = (axle(before) + axle(after)).normalized();
      const Eigen::Vector3d moved = wheel(after) - wheel(before);
      const Eigen::Vector3d rolled = moved - moved.dot(axle_world) * axle_world;
      const double travel_m =
          std::copysign(rolled.norm(), rolled.dot(axle_world.cross(Eigen::Vector3d::UnitZ())));
      const Eigen::AngleAxisd turn(before.T_world_body[carrier].linear().transpose() *
                                   after.T_world_body[carrier].linear());
      const double carried_rad = turn.angle() * turn.axis().dot(leg.axle_carrier);
      nodes[i].q[leg.wheel] =
          nodes[i - 1].q[leg.wheel] + leg.wheel_sign * (travel_m / leg.radius_m - carried_rad);
    }
    std::swap(before, after);
  }
}

}  // namespace

Eigen::VectorXd coordinates_of(const MachineModel& machine, const StandingPose& pose) {
  Eigen::VectorXd q(machine.num_coordinates());
  q.head<kNumBaseCoordinates>() = pose.base;
  q.tail(machine.num_joints()) = machine.transport_posture();
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    q[machine.legs[i].hfe] = pose.hfe_rad[i];
    if (machine.legs[i].steer >= 0) q[machine.legs[i].steer] = pose.steer_rad[i];
  }
  return q;
}

Result<std::vector<WholeBodyNode>, PathFailure> whole_body_nodes(
    const PoseCheck& check, const MachineModel& machine, const DrivePath& path,
    const std::vector<Station>& stations, const SmoothingSettings& smoothing) {
  const std::vector<double> curvature =
      steered_curvature_1_m(path, stations, smoothing.steering_window_m);
  std::vector<StandingPose> raw;
  raw.reserve(stations.size());
  for (std::size_t i = 0; i < stations.size(); ++i) {
    raw.push_back(stand_steered(check, stations[i].pose, curvature[i]));
    if (!raw.back().ok()) return tl::unexpected<PathFailure>({i, raw.back()});
  }

  // Give up smoothing step by step where the smoothed pose fails; the raw one always passes.
  const SmoothedBase smoothed = smooth(stations, raw, smoothing.base_window_m);
  std::vector<double> share(stations.size(), 1.0), tried(stations.size(), -1.0);
  std::vector<StandingPose> poses(raw);
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < stations.size(); ++i) {
      while (tried[i] != share[i]) {
        tried[i] = share[i];
        poses[i] = blend(check, raw[i], smoothed, i, share[i], curvature[i]);
        if (poses[i].ok()) break;
        share[i] = std::max(0.0, share[i] - kShareStep);
        changed = true;
      }
    }
    if (changed) limit_slope(stations, share);
  }

  std::vector<WholeBodyNode> nodes(stations.size());
  for (std::size_t i = 0; i < stations.size(); ++i) {
    nodes[i].q = coordinates_of(machine, poses[i]);
  }
  spin_wheels(machine, nodes);
  return nodes;
}

}  // namespace wex
