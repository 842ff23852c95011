#include <algorithm>
#include <cmath>
#include <limits>

#include "initializer/paper/paper_check.hpp"
#include "initializer/pose_check.hpp"

// Algorithm 1 of the paper.

namespace wex {
namespace {

constexpr double kUngroundedCost = 1000.0;  // dominates tilt and stroke
constexpr double kTiltedCost = 5000.0;      // what Algorithm 2 would turn down anyway

}  // namespace

// Wheels in default posture let down or raised straight to the ground.
double PaperCheck::pose_cost(const BaseCoordinates& base) const noexcept {
  const CellPose pose(T_world_base_from(base), dilated_);
  const auto least_m = static_cast<float>(settings_.min_signed_distance_m);
  double cost = (std::pow(base[kBaseRoll], 2) + std::pow(base[kBasePitch], 2)) /
                std::pow(settings_.max_tilt_rad, 2);
  for (const DefaultFoot& foot : feet_) {
    const Eigen::Vector3f& p = foot.p_base;
    const CellPoint at = pose.cells(p.x(), p.y(), p.z());
    const float drop_m = pose.height_m(p.x(), p.y(), p.z()) - foot.radius_m - dilated_.at(at);
    const float share = drop_m > 0.0F ? drop_m / foot.down_m : drop_m / foot.up_m;
    if (std::abs(share) <= 1.0F && distance_.at(at) >= least_m) {
      cost += static_cast<double>(share * share) / kNumWheels;
    } else {
      cost += kUngroundedCost;
    }
  }
  return cost;
}

BaseCoordinates PaperCheck::base_at(const Pose2& pose) const noexcept {
  std::array<double, 4> heights_m;
  std::array<Eigen::Vector3d, 4> normals;
  std::size_t count = 0;
  const auto propose = [&](double height_m, const Eigen::Vector3d& normal) {
    heights_m[count] = height_m;
    normals[count++] = normal;
  };
  const auto propose_at = [&](const Eigen::Vector2d& p) {
    propose(terrain_->height_m(p), terrain_->normal(p));
    if (!settings_.ablation.filtered_heights) return;
    propose(terrain_->filtered_height_m(p), terrain_->filtered_normal(p));
  };
  const Eigen::Vector2d here(pose.x_m, pose.y_m);
  BaseCoordinates best = BaseCoordinates::Constant(std::numeric_limits<double>::quiet_NaN());
  if (!terrain_->known(here)) return best;
  propose_at(here);
  // On traversable ground the nearest traversable place is here.
  if (settings_.ablation.nearest_traversable && !terrain_->traversable_at(here)) {
    propose_at(terrain_->nearest_traversable(here));
  }

  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < count; ++n) {
    const Tilt tilt = tilt_from_normal(normals[n], pose.yaw_rad);
    const bool tilted = std::abs(tilt.roll_rad) > settings_.max_tilt_rad ||
                        std::abs(tilt.pitch_rad) > settings_.max_tilt_rad;
    for (std::size_t k = 0; k < count; ++k) {
      if (std::isnan(heights_m[k])) continue;
      BaseCoordinates base;
      base << pose.x_m, pose.y_m, heights_m[k] + base_height_m_, pose.yaw_rad, tilt.pitch_rad,
          tilt.roll_rad;
      const double cost = pose_cost(base) + (tilted ? kTiltedCost : 0.0);
      if (cost >= lowest) continue;
      lowest = cost;
      best = base;
    }
  }
  return best;
}

}  // namespace wex
