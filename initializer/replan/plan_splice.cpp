#include "initializer/replan/plan_splice.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "initializer/stepping/certificate.hpp"
#include "initializer/stepping/motion_nodes.hpp"
#include "initializer/stepping/stepping_motion.hpp"
#include "initializer/stepping/stepping_timing.hpp"

namespace wex {
namespace {

constexpr double kSamePosture = 1e-6;
constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kStandingStep = 0.02;  // m or rad of the base, from node to node
constexpr double kSteeringStepRad = 0.05;
constexpr auto kArmIndex = static_cast<std::size_t>(Limb::kArm);

bool is_of_a_leg(const MachineModel& machine, int coordinate) {
  return std::any_of(machine.legs.begin(), machine.legs.end(), [&](const WheeledLeg& leg) {
    return coordinate == leg.hfe || coordinate == leg.steer || coordinate == leg.wheel;
  });
}

// Turns by which `to` lies beyond `from` where that makes no difference to the machine.
Eigen::VectorXd whole_turns(const MachineModel& machine, const Eigen::VectorXd& from,
                            const Eigen::VectorXd& to) {
  Eigen::VectorXd turns = Eigen::VectorXd::Zero(from.size());
  const auto set = [&](int i) { turns[i] = kTurn * std::round((to[i] - from[i]) / kTurn); };
  set(kBaseYaw);
  for (int j = 0; j < machine.num_joints(); ++j) {
    const int i = kNumBaseCoordinates + j;
    if (machine.joints[static_cast<std::size_t>(j)].continuous && !is_of_a_leg(machine, i)) set(i);
  }
  return turns;
}

class StandingChange {
 public:
  StandingChange(const MachineModel& machine, const PoseCheck& check)
      : machine_(machine), check_(check) {}

  // Nodes from one posture to another at one place, without the ends.
  [[nodiscard]] std::optional<std::vector<Eigen::VectorXd>> between(
      const Eigen::VectorXd& from, const Eigen::VectorXd& to) const {
    double steps = (to - from).head<kNumBaseCoordinates>().cwiseAbs().maxCoeff() / kStandingStep;
    for (const WheeledLeg& leg : machine_.legs) {
      if (leg.steer >= 0) {
        steps = std::max(steps, std::abs(to[leg.steer] - from[leg.steer]) / kSteeringStepRad);
      }
    }
    const int num_steps = static_cast<int>(std::ceil(steps));
    std::vector<Eigen::VectorXd> nodes;
    for (int k = 1; k < num_steps; ++k) {
      Eigen::VectorXd q = from + (to - from) * (static_cast<double>(k) / num_steps);
      PoseCheck::Steering steering;
      for (std::size_t i = 0; i < kNumWheels; ++i) {
        const int steer = machine_.legs[i].steer;
        if (steer >= 0) steering[i] = LegTable::Steer(q[steer]);
      }
      const BaseCoordinates base = q.head<kNumBaseCoordinates>();
      const StandingPose standing = check_.check(base, steering);
      if (!standing.ok()) return std::nullopt;
      for (std::size_t i = 0; i < kNumWheels; ++i) q[machine_.legs[i].hfe] = standing.hfe_rad[i];
      nodes.push_back(std::move(q));
    }
    return nodes;
  }

 private:
  const MachineModel& machine_;
  const PoseCheck& check_;
};

// Slower towards a stop at the end of the nodes; joints only ever move slower than they did.
void brake_to_a_stop(std::vector<WholeBodyNode>& nodes, double max_acceleration_m_s2) {
  std::vector<double> added_s(nodes.size(), 0.0);
  double to_go_m = 0.0;
  for (std::size_t i = nodes.size() - 1; i > 0; --i) {
    const double step_m = (nodes[i].q - nodes[i - 1].q).head<2>().norm();
    const double slow = std::sqrt(2.0 * max_acceleration_m_s2 * to_go_m);
    const double fast = std::sqrt(2.0 * max_acceleration_m_s2 * (to_go_m + step_m));
    const double dt_s = nodes[i].t_s - nodes[i - 1].t_s;
    if (slow * dt_s > step_m) break;  // slower than that anyway
    if (slow + fast > 0.0) added_s[i] = std::max(0.0, 2.0 * step_m / (slow + fast) - dt_s);
    to_go_m += step_m;
  }
  double later_s = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i].t_s += later_s += added_s[i];
}

void start_from_rest(std::vector<WholeBodyNode>& nodes, double max_acceleration_m_s2) {
  const double end_s = nodes.back().t_s;
  const auto reverse = [&] {
    std::reverse(nodes.begin(), nodes.end());
    for (WholeBodyNode& node : nodes) node.t_s = end_s - node.t_s;
  };
  reverse();
  brake_to_a_stop(nodes, max_acceleration_m_s2);
  reverse();
}

}  // namespace

bool may_be_cut(const MachineModel& machine, const WholeBodyNode& node) {
  if (node.contacts != kDrivingContacts) return false;
  const Eigen::VectorXd transport = machine.transport_posture();
  for (int j = 0; j < machine.num_joints(); ++j) {
    if (is_of_a_leg(machine, kNumBaseCoordinates + j)) continue;
    double off = node.q[kNumBaseCoordinates + j] - transport[j];
    if (machine.joints[static_cast<std::size_t>(j)].continuous) off = wrap_angle(off);
    if (std::abs(off) > kSamePosture) return false;
  }
  return true;
}

std::vector<double> distances_along(const DrivePath& path,
                                    const std::vector<WholeBodyNode>& nodes) {
  std::vector<double> distances;
  std::size_t segment = 0;
  double begin_m = 0.0, at_m = 0.0;  // driven before the segment, within it
  Eigen::Vector2d last = nodes.front().q.head<2>();
  for (const WholeBodyNode& node : nodes) {
    const Eigen::Vector2d here = node.q.head<2>();
    at_m += (here - last).norm();
    last = here;
    while (segment + 1 < path.size() && at_m > std::abs(path[segment].length_m) - 1e-4) {
      at_m = std::max(0.0, at_m - std::abs(path[segment].length_m));
      begin_m += std::abs(path[segment].length_m);
      ++segment;
    }
    // Chords are shorter than arcs.
    const PathSegment& piece = path[segment];
    const double gear = piece.length_m < 0.0 ? -1.0 : 1.0;
    const Pose2 pose = pose_along(piece, gear * at_m);
    const Eigen::Vector2d heading(std::cos(pose.yaw_rad), std::sin(pose.yaw_rad));
    at_m += gear * heading.dot(here - Eigen::Vector2d(pose.x_m, pose.y_m));
    at_m = std::clamp(at_m, 0.0, std::abs(piece.length_m));
    distances.push_back(std::max(begin_m + at_m, distances.empty() ? 0.0 : distances.back()));
  }
  return distances;
}

DrivePath part_of(const DrivePath& path, double from_m, double to_m) {
  constexpr double kShortestM = 1e-6;
  DrivePath part;
  double begin_m = 0.0;
  for (const PathSegment& segment : path) {
    const double length_m = std::abs(segment.length_m);
    const double low = std::clamp(from_m - begin_m, 0.0, length_m);
    const double high = std::clamp(to_m - begin_m, 0.0, length_m);
    begin_m += length_m;
    if (high - low < kShortestM) continue;
    const double gear = segment.length_m < 0.0 ? -1.0 : 1.0;
    part.push_back({pose_along(segment, gear * low), segment.curvature_1_m, gear * (high - low)});
  }
  return part;
}

double stretch_cost(const DrivePath& path, const std::vector<WholeBodyNode>& nodes,
                    std::size_t first, std::size_t last, const PlanSettings& settings) {
  const CertificateSettings weights;
  double stepping_m = 0.0;
  for (std::size_t i = first; i < last; ++i) {
    const ContactFlags& a = nodes[i].contacts;
    const ContactFlags& b = nodes[i + 1].contacts;
    const bool on_bucket = a[kArmIndex] || b[kArmIndex];
    if (!a[kArmIndex] && b[kArmIndex]) stepping_m += weights.bucket_cost_m;
    if (a[kArmIndex] && !b[kArmIndex]) stepping_m += weights.lift_cost_m;
    bool in_air = false;
    for (std::size_t k = 0; k < kNumWheels; ++k) {
      if (a[k] != b[k] && !on_bucket) stepping_m += weights.lift_cost_m;
      in_air = in_air || !a[k];
    }
    if (in_air) {
      stepping_m += weights.stepping_share * (nodes[i + 1].q - nodes[i].q).head<2>().norm();
    }
  }
  return path_cost_m(path, {}) + settings.stepping_penalty * stepping_m;
}

std::optional<Plan> splice(const MachineModel& machine, const PoseCheck& check, const Plan& plan,
                           std::size_t first, std::size_t last, const Plan& stretch,
                           const PlanSettings& settings) {
  const SteppingMotionSettings motion;
  const Eigen::VectorXd& q_first = plan.nodes[first].q;
  const Eigen::VectorXd& q_last = plan.nodes[last].q;
  const Eigen::VectorXd shift = whole_turns(machine, stretch.nodes.front().q, q_first);
  const auto shifted = [&](std::size_t i) -> Eigen::VectorXd { return stretch.nodes[i].q + shift; };
  const Eigen::VectorXd shift_after =
      whole_turns(machine, q_last, shifted(stretch.nodes.size() - 1));
  const StandingChange standing(machine, check);
  const auto entering = standing.between(q_first, shifted(0));
  const auto leaving = standing.between(shifted(stretch.nodes.size() - 1), q_last + shift_after);
  if (!entering || !leaving) return std::nullopt;

  // The new nodes from `first` to `last`, wheels turned as they roll.
  std::vector<MotionNode> nodes;
  const auto add = [&](const Eigen::VectorXd& q, const ContactFlags& contacts) {
    MotionNode node;
    node.q = q;
    node.contacts = contacts;
    node.base_speed_m_s = settings.nominal_speed_m_s;
    nodes.push_back(std::move(node));
  };
  add(q_first, kDrivingContacts);
  for (const Eigen::VectorXd& q : *entering) add(q, kDrivingContacts);
  const std::size_t stretch_begin = nodes.size();
  for (std::size_t i = 0; i < stretch.nodes.size(); ++i) add(shifted(i), stretch.nodes[i].contacts);
  const std::size_t stretch_end = nodes.size() - 1;
  for (const Eigen::VectorXd& q : *leaving) add(q, kDrivingContacts);
  add(q_last + shift_after, kDrivingContacts);
  turn_wheels(machine, nodes);

  const auto standing_times = [&](std::size_t from, std::size_t to) {
    return node_times_s(machine,
                        {nodes.begin() + static_cast<std::ptrdiff_t>(from),
                         nodes.begin() + static_cast<std::ptrdiff_t>(to) + 1},
                        {settings.rate_fraction, motion.max_base_acceleration_m_s2});
  };
  Plan spliced = plan;
  spliced.nodes.assign(plan.nodes.begin(),
                       plan.nodes.begin() + static_cast<std::ptrdiff_t>(first) + 1);
  brake_to_a_stop(spliced.nodes, motion.max_base_acceleration_m_s2);
  const auto append = [&](std::size_t i, double t_s) {
    // A change between equal postures takes no time and needs no node.
    if (t_s <= spliced.nodes.back().t_s + kSamePosture ||
        (nodes[i].q - spliced.nodes.back().q).cwiseAbs().maxCoeff() < kSamePosture) {
      if (nodes[i].contacts == spliced.nodes.back().contacts) return;
    }
    spliced.nodes.push_back({t_s, nodes[i].q, nodes[i].contacts});
  };
  double begin_s = spliced.nodes.back().t_s;
  const std::vector<double> in_s = standing_times(0, stretch_begin);
  for (std::size_t i = 1; i <= stretch_begin; ++i) append(i, begin_s + in_s[i]);
  begin_s = spliced.nodes.back().t_s;
  for (std::size_t i = stretch_begin + 1; i <= stretch_end; ++i) {
    append(i, begin_s + stretch.nodes[i - stretch_begin].t_s - stretch.nodes.front().t_s);
  }
  begin_s = spliced.nodes.back().t_s;
  const std::vector<double> out_s = standing_times(stretch_end, nodes.size() - 1);
  for (std::size_t i = stretch_end + 1; i < nodes.size(); ++i) {
    append(i, begin_s + out_s[i - stretch_end]);
  }

  std::vector<WholeBodyNode> rest(plan.nodes.begin() + static_cast<std::ptrdiff_t>(last),
                                  plan.nodes.end());
  start_from_rest(rest, motion.max_base_acceleration_m_s2);
  const Eigen::VectorXd carried = spliced.nodes.back().q - q_last;
  begin_s = spliced.nodes.back().t_s - rest.front().t_s;
  for (std::size_t i = 1; i < rest.size(); ++i) {
    Eigen::VectorXd q = rest[i].q + shift_after;
    for (const WheeledLeg& leg : machine.legs) {
      if (leg.wheel >= 0) q[leg.wheel] = rest[i].q[leg.wheel] + carried[leg.wheel];
    }
    spliced.nodes.push_back({rest[i].t_s + begin_s, std::move(q), rest[i].contacts});
  }
  return spliced;
}

}  // namespace wex
