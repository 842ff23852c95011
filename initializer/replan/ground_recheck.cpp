#include "initializer/replan/ground_recheck.hpp"

#include <algorithm>
#include <cmath>

#include "initializer/stepping/stepping_motion.hpp"
#include "initializer/verify_plan.hpp"
#include "models/terrain/wheel_rest.hpp"

namespace wex {
namespace {

constexpr double kRoundingM = 1e-6;
constexpr double kHalfWayM = 0.01;     // of a standing wheel's height between nodes
constexpr double kLinkSpacingM = 0.1;  // between the points of a link held against the ground

class Recheck {
 public:
  Recheck(const RecheckedPlan& rechecked, const PlanSettings& settings)
      : r_(rechecked), settings_(settings), workspace_(rechecked.machine.tree.make_workspace()) {}

  /// parts  bit: CollisionModel::Part, those to be looked at
  [[nodiscard]] bool sound(const Eigen::VectorXd& q, const ContactFlags& contacts, unsigned parts) {
    parts_ = parts;
    r_.machine.tree.update(q, workspace_);
    return wheels_sound(contacts) && links_sound(contacts);
  }

 private:
  [[nodiscard]] bool asked_for(std::size_t part) const { return (parts_ >> part & 1U) != 0; }
  // Not closer to the ground than it was, or still beyond its clearance.
  [[nodiscard]] static bool kept(double before_m, double after_m, double clearance_m) {
    return after_m >= std::min(before_m, clearance_m) - kRoundingM;
  }

  [[nodiscard]] bool wheels_sound(const ContactFlags& contacts) const {
    for (std::size_t i = 0; i < kNumWheels; ++i) {
      if (!asked_for(i + static_cast<std::size_t>(CollisionModel::Part::kLF))) continue;
      const WheeledLeg& leg = r_.machine.legs[i];
      const Eigen::Vector3d p =
          r_.machine.tree.position(workspace_, leg.carrier_body, leg.p_carrier_wheel);
      const Eigen::Vector2d xy = p.head<2>();
      if (!contacts[i]) {
        const auto gap_m = [&](const TerrainMap& terrain) {
          return p.z() - leg.radius_m - terrain.dilated_height_m(xy);
        };
        if (!kept(gap_m(r_.before), gap_m(r_.after), motion_.swing_clearance_m)) return false;
        continue;
      }
      const Eigen::Vector3d axle =
          r_.machine.tree.direction(workspace_, leg.carrier_body, leg.axle_carrier);
      const auto rest_m = [&](const TerrainMap& terrain) {
        return wheel_rest(terrain, xy, axle, leg.radius_m, leg.half_width_m).height_m;
      };
      if (!(std::abs(rest_m(r_.after) - rest_m(r_.before)) <= kHalfWayM)) return false;
      if (!r_.after.known(xy) || !r_.after.traversable_at(xy) ||
          !kept(r_.before.signed_distance_m(xy), r_.after.signed_distance_m(xy),
                settings_.min_signed_distance_m)) {
        return false;
      }
    }
    return true;
  }

  [[nodiscard]] bool links_sound(const ContactFlags& contacts) const {
    using Part = CollisionModel::Part;
    const bool bucket_stands = contacts[static_cast<std::size_t>(Limb::kArm)];
    for (std::size_t c = 0; c < r_.shape.capsules().size(); ++c) {
      const CollisionModel::Capsule& capsule = r_.shape.capsules()[c];
      if (!asked_for(static_cast<std::size_t>(capsule.part))) continue;
      const bool on_arm = capsule.part == Part::kArm;
      // Tyres were looked at as discs; a bucket that stands touches the ground.
      if (capsule.load_bearing && (!on_arm || bucket_stands)) continue;
      const auto clearance_m = [&](const TerrainMap& terrain) {
        return r_.shape.ground_clearance_m(
            workspace_, static_cast<int>(c), kLinkSpacingM,
            [&terrain](const Eigen::Vector2d& p) { return terrain.height_m(p); });
      };
      const double wanted_m = on_arm                           ? motion_.swing_clearance_m
                              : capsule.part == Part::kChassis ? settings_.belly_clearance_m
                                                               : 0.0;
      const double after_m = clearance_m(r_.after);
      if (after_m >= wanted_m) continue;
      if (!kept(clearance_m(r_.before), after_m, wanted_m)) return false;
    }
    return true;
  }

  const RecheckedPlan& r_;
  const PlanSettings& settings_;
  const SteppingMotionSettings motion_;
  KinematicTree::Workspace workspace_;
  unsigned parts_ = ~0U;
};

}  // namespace

std::vector<std::size_t> unsound_on_changed_ground(const RecheckedPlan& rechecked,
                                                   const std::vector<std::size_t>& nodes,
                                                   const PlanSettings& settings) {
  std::vector<std::size_t> unsound =
      unsound_nodes(rechecked.after, rechecked.machine, rechecked.plan, nodes, settings);
  Recheck recheck(rechecked, settings);
  const std::vector<WholeBodyNode>& all = rechecked.plan.nodes;
  std::vector<std::size_t> result;
  for (const std::size_t i : nodes) {
    if (std::binary_search(unsound.begin(), unsound.end(), i)) {
      result.push_back(i);
      continue;
    }
    const bool is_last = i + 1 == all.size();
    const unsigned parts = rechecked.change != nullptr && rechecked.reach != nullptr
                               ? touched_parts(*rechecked.reach, *rechecked.change, i)
                               : ~0U;
    const bool sound =
        recheck.sound(all[i].q, all[i].contacts, parts) &&
        (is_last || recheck.sound(0.5 * (all[i].q + all[i + 1].q), all[i].contacts, parts));
    if (!sound) result.push_back(i);
  }
  return result;
}

}  // namespace wex
