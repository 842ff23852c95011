#include "initializer/stepping/stance_polygon.hpp"

#include <algorithm>
#include <cmath>

#include "initializer/stepping/stance_check.hpp"

namespace wex {
namespace {

constexpr std::array<Limb, kNumWheels> kCounterClockwise{Limb::kLF, Limb::kLH, Limb::kRH,
                                                         Limb::kRF};

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

StancePolygon::StancePolygon(const std::array<Eigen::Vector3d, kNumWheels>& p_world_patch,
                             std::uint8_t lifted) noexcept {
  for (const Limb limb : kCounterClockwise) {
    const auto i = static_cast<std::size_t>(limb);
    if ((lifted >> i & 1U) == 0) add(p_world_patch[i]);
  }
}

StancePolygon::StancePolygon(const std::array<Eigen::Vector3d, kNumWheels>& p_world_patch,
                             std::uint8_t lifted, const Eigen::Vector3d& p_world_bucket,
                             const BaseFrame& base) noexcept {
  // Counter-clockwise from straight ahead: the bucket goes where its bearing from the base is.
  const Eigen::Vector2d to_bucket = (p_world_bucket - base.p_world_base).head<2>();
  const Eigen::Vector2d ahead = base.R_world_base.col(0).head<2>().normalized();
  const auto bearing = [&](const Eigen::Vector2d& v) {
    // Rises monotonically from 0 (straight ahead) to 4 (once around, counter-clockwise).
    const double x = ahead.dot(v), y = cross(ahead, v);
    const double share = y / (std::abs(x) + std::abs(y));
    return x >= 0.0 ? (y >= 0.0 ? share : 4.0 + share) : 2.0 - share;
  };
  const double at = bearing(to_bucket);
  bool placed = false;
  for (const Limb limb : kCounterClockwise) {
    const auto i = static_cast<std::size_t>(limb);
    if ((lifted >> i & 1U) != 0) continue;
    if (!placed && bearing((p_world_patch[i] - base.p_world_base).head<2>()) > at) {
      add(p_world_bucket);
      placed = true;
    }
    add(p_world_patch[i]);
  }
  if (!placed) add(p_world_bucket);
  make_convex();
}

void StancePolygon::make_convex() noexcept {
  for (int i = 0; count_ > 3 && i < count_;) {
    const Eigen::Vector2d& a = p_[static_cast<std::size_t>((i + count_ - 1) % count_)];
    const Eigen::Vector2d& b = p_[static_cast<std::size_t>(i)];
    const Eigen::Vector2d& c = p_[static_cast<std::size_t>((i + 1) % count_)];
    if (cross(b - a, c - b) > 0.0) {
      ++i;
      continue;
    }
    std::copy(p_.begin() + i + 1, p_.begin() + count_, p_.begin() + i);
    --count_;
    i = 0;
  }
}

StancePolygon::InBase StancePolygon::in_base(const BaseFrame& base,
                                             const Eigen::Vector3d& fixed_moment_base,
                                             double mass_kg) const noexcept {
  InBase result;
  if (count_ < 3) return result;
  result.count_ = count_;
  result.none_m_ = 1e9;
  for (int i = 0; i < count_; ++i) {
    const Eigen::Vector2d& a = p_[static_cast<std::size_t>(i)];
    const Eigen::Vector2d edge = p_[static_cast<std::size_t>((i + 1) % count_)] - a;
    const Eigen::Vector2d inward = Eigen::Vector2d(-edge.y(), edge.x()).normalized();
    const Eigen::Vector3d normal = base.R_world_base.topRows<2>().transpose() * inward / mass_kg;
    result.normal_[static_cast<std::size_t>(i)] = normal;
    result.offset_[static_cast<std::size_t>(i)] =
        inward.dot(base.p_world_base.head<2>() - a) + normal.dot(fixed_moment_base);
  }
  return result;
}

}  // namespace wex
