#include "initializer/stepping/stance_tables.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "initializer/leg_table.hpp"
#include "models/excavator/collision_model.hpp"

namespace wex {
namespace {

constexpr double kJointMarginRad = 0.02;  // keeps hip flexion off its end stops
constexpr int kNumSlewYaws = 24;

// Bodies from the base's child to `body`, base side first.
std::vector<int> chain_to(const KinematicTree& tree, int body) {
  std::vector<int> chain;
  for (int b = body; b > 0; b = tree.bodies()[static_cast<std::size_t>(b)].parent) {
    chain.insert(chain.begin(), b);
  }
  return chain;
}

/// A rod that contains what is carried beside the wheel: stands out behind it by half a metre.
struct Claw {
  int body = -1;
  Eigen::Vector3d p_body_a, p_body_b;
  double radius_m = 0.0;
};

std::optional<Claw> claw_of(const KinematicTree& tree, const CollisionModel& shapes,
                            int carrier_body) {
  std::optional<Claw> claw;
  for (const CollisionModel::Capsule& capsule : shapes.capsules()) {
    if (capsule.load_bearing || !tree.descends_from(capsule.body, carrier_body)) continue;
    const bool longer = !claw || (capsule.p_body_b - capsule.p_body_a).norm() >
                                     (claw->p_body_b - claw->p_body_a).norm();
    if (longer) claw = {capsule.body, capsule.p_body_a, capsule.p_body_b, capsule.radius_m};
  }
  return claw;
}

}  // namespace

int steering_for(double curvature_1_m, double min_turning_radius_m) noexcept {
  const double share = std::clamp(curvature_1_m * min_turning_radius_m, -1.0, 1.0);
  return kSteeredStraight + static_cast<int>(std::lround(share * kSteeredStraight));
}

Result<StanceTables> StanceTables::build(const MachineModel& machine) {
  auto leg_tables = build_leg_tables(machine);
  if (!leg_tables) return tl::unexpected<Error>(leg_tables.error());
  const KinematicTree& tree = machine.tree;
  KinematicTree::Workspace w = tree.make_workspace();
  Eigen::VectorXd q = Eigen::VectorXd::Zero(machine.num_coordinates());
  q.tail(machine.num_joints()) = machine.transport_posture();

  StanceTables tables;
  tables.mass_kg = tree.total_mass_kg();
  tables.belly_min_m = machine.belly_min_m;
  tables.belly_max_m = machine.belly_max_m;
  tables.belly_below_base_m = machine.belly_below_base_m;
  tables.default_base_height_m = machine.default_base_height_m;
  tables.min_turning_radius_m = machine.min_turning_radius_m;

  std::array<std::vector<int>, kNumWheels> chains;
  std::array<bool, kNumWheels> upper_is_high{};
  std::array<std::optional<Claw>, kNumWheels> claws;
  const CollisionModel shapes = CollisionModel::build(machine);
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    const WheeledLeg& leg = machine.legs[i];
    const LegTable& table = (*leg_tables)[i];
    chains[i] = chain_to(tree, leg.carrier_body);
    upper_is_high[i] = table.p_base_wheel(table.hfe_upper_rad(), {}).z() >
                       table.p_base_wheel(table.hfe_lower_rad(), {}).z();
    tables.radius_m[i] = leg.radius_m;
    tables.half_width_m[i] = leg.half_width_m;
    tables.sag_m[i] = leg.static_sag_m;
    claws[i] = claw_of(tree, shapes, leg.carrier_body);
    if (claws[i]) tables.claw_radius_m[i] = claws[i]->radius_m;
  }
  for (std::size_t k = 0; k < kNumSteerings; ++k) {
    const double curvature_1_m =
        (static_cast<double>(k) / kSteeredStraight - 1.0) / machine.min_turning_radius_m;
    for (std::size_t n = 0; n < LegSweep::kSamples; ++n) {
      const double share = static_cast<double>(n) / (LegSweep::kSamples - 1);
      std::array<double, kNumWheels> hfe{};
      for (std::size_t i = 0; i < kNumWheels; ++i) {
        const WheeledLeg& leg = machine.legs[i];
        const LegTable& table = (*leg_tables)[i];
        const double low = table.hfe_lower_rad() + kJointMarginRad,
                     high = table.hfe_upper_rad() - kJointMarginRad;
        hfe[i] = upper_is_high[i] ? std::lerp(high, low, share) : std::lerp(low, high, share);
        q[leg.hfe] = hfe[i];
        if (leg.steer >= 0) q[leg.steer] = table.steering_rad(hfe[i], curvature_1_m);
      }
      tree.update(q, w);
      for (std::size_t i = 0; i < kNumWheels; ++i) {
        const WheeledLeg& leg = machine.legs[i];
        LegSweep& sweep = tables.legs[i][k];
        LegSample& sample = sweep.samples[n];
        sample.hfe_rad = hfe[i];
        sample.p_base_wheel = tree.position(w, leg.carrier_body, leg.p_carrier_wheel);
        sample.axle_base = tree.direction(w, leg.carrier_body, leg.axle_carrier);
        sample.moment_base = w.subtree_mass_times_com[static_cast<std::size_t>(chains[i].front())];
        sweep.has_claw = claws[i].has_value();
        if (claws[i]) {
          sample.p_base_claw = {tree.position(w, claws[i]->body, claws[i]->p_body_a),
                                tree.position(w, claws[i]->body, claws[i]->p_body_b)};
        }
        sweep.num_beam_points =
            std::min(LegSample::kMaxBeamPoints, static_cast<int>(chains[i].size()));
        for (int b = 0; b < sweep.num_beam_points; ++b) {
          // The outermost hinges, if there are more than fit.
          const std::size_t at = chains[i].size() - sweep.num_beam_points + b;
          sample.p_base_beam[static_cast<std::size_t>(b)] =
              w.p_world_joint[static_cast<std::size_t>(chains[i][at])];
        }
      }
    }
  }

  // Cabin and arm: everything that turns with the first arm joint.
  tables.moment_chassis_base = tables.mass_kg * tree.com(w);
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    tables.moment_chassis_base -=
        tables.legs[i][kNumSteerings - 1].samples[LegSweep::kSamples - 1].moment_base;
  }
  if (!machine.arm) {
    tables.moment_folded_base.emplace_back(Eigen::Vector3d::Zero());
    tables.moment_transport_base = tables.moment_folded_base;
    return tables;
  }
  const int turn = machine.arm->coordinates.front();
  const int cabin = machine.joints[static_cast<std::size_t>(turn - kNumBaseCoordinates)].body;
  tables.moment_chassis_base -= w.subtree_mass_times_com[static_cast<std::size_t>(cabin)];
  const double transport_turn_rad = q[turn];
  for (int y = 0; y < kNumSlewYaws; ++y) {
    q[turn] = transport_turn_rad + 2.0 * std::numbers::pi * y / kNumSlewYaws;
    tree.update(q, w);
    tables.moment_folded_base.push_back(w.subtree_mass_times_com[static_cast<std::size_t>(cabin)]);
  }
  tables.moment_transport_base = {tables.moment_folded_base.front()};
  if (const auto plane = ArmPlane::of(machine)) {
    tables.arm = ArmTable(*plane);
    tables.counter_weights = make_counter_weights(machine, *plane);
  }
  return tables;
}

}  // namespace wex
