#include "initializer/paper/bucket_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wex {
namespace {

constexpr double kStep = 0.1;  // of telescope [m] and attitude [rad]
constexpr int kSteps = 8;      // to each side
constexpr double kEndStop = 0.005;

}  // namespace

std::pair<std::size_t, std::size_t> closest_pair(const std::vector<Eigen::Vector3d>& first,
                                                 const std::vector<Eigen::Vector3d>& second) {
  WEX_EXPECTS(!first.empty() && !second.empty());
  std::pair<std::size_t, std::size_t> best{0, 0};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < first.size(); ++i) {
    for (std::size_t k = 0; k < second.size(); ++k) {
      const double squared = (first[i] - second[k]).squaredNorm();
      if (squared >= least) continue;
      least = squared;
      best = {i, k};
    }
  }
  return best;
}

BucketPoints::BucketPoints(const TerrainMap& terrain, const Roadmaps& roadmaps,
                           const PaperCheck& check, const ArmKinematics& arm,
                           const PlanSettings& settings)
    : terrain_(terrain),
      roadmaps_(roadmaps),
      check_(check),
      arm_(arm),
      min_distance_m_(settings.min_signed_distance_m) {
  for (int i = -kSteps; i <= kSteps; ++i) {
    for (int k = -kSteps; k <= kSteps; ++k) offsets_.push_back({i * kStep, k * kStep});
  }
  std::stable_sort(offsets_.begin(), offsets_.end(), [](const Offset& a, const Offset& b) {
    return std::hypot(a.tele_m, a.attitude_rad) < std::hypot(b.tele_m, b.attitude_rad);
  });
}

Result<BucketPoint, std::string> BucketPoints::common(const PaperStance& begin,
                                                      const PaperStance& end) const {
  const auto positions = [&](const PaperStance& stance, const std::vector<int>& rows) {
    const Eigen::Isometry3d T_world_base = T_world_base_from(stance.base);
    std::vector<Eigen::Vector3d> p_world;
    for (const int row : rows) {
      p_world.push_back(T_world_base * check_.bucket_table().p_base_contact(row));
    }
    return p_world;
  };
  const std::vector<int> rows_begin = check_.carrying_bucket_rows(begin);
  const std::vector<int> rows_end = check_.carrying_bucket_rows(end);
  if (rows_begin.empty() || rows_end.empty()) {
    return tl::unexpected<std::string>("no bucket contact at one end of the phase");
  }
  const auto at_begin = positions(begin, rows_begin), at_end = positions(end, rows_end);
  const auto [first, second] = closest_pair(at_begin, at_end);
  BucketPoint point;
  point.p_world = 0.5 * (at_begin[first] + at_end[second]);
  point.p_world.z() = terrain_.height_m(point.p_world.head<2>());
  if (!(terrain_.signed_distance_m(point.p_world.head<2>()) >= min_distance_m_)) {
    return tl::unexpected<std::string>("the closest pair of contacts has no good ground between");
  }
  const LimbRoadmap& map = roadmaps_.limbs.back();
  const int vertex = check_.bucket_table().vertex(rows_begin[first]);
  ArmKinematics::Joints joints{};
  for (std::size_t k = 0; k < joints.size(); ++k) {
    joints[k] = map.q(static_cast<Eigen::Index>(k), vertex);
  }
  point.posture = ArmKinematics::posture_of(joints);
  return point;
}

Result<ArmPosture, std::string> BucketPoints::reach(const BucketPoint& point,
                                                    const Footing& footing, const ArmPosture& near,
                                                    ArmMover& mover,
                                                    const Eigen::VectorXd& q) const {
  const Eigen::Vector3d p_base = footing.T_world_base.inverse() * point.p_world;
  const double attitude_rad = arm_.attitude_rad(near);
  const char* why = "the bucket point is out of reach";
  Footing with_bucket = footing;
  with_bucket.contacts[with_bucket.num_contacts++] = point.p_world.head<2>();
  Eigen::VectorXd tried = q;
  for (const Offset& offset : offsets_) {
    auto posture = arm_.reach(p_base, near.tele_m + offset.tele_m,
                              attitude_rad + offset.attitude_rad, kEndStop);
    if (!posture ||
        std::abs(attitude_rad + offset.attitude_rad) > check_.paper().max_bucket_lean_rad + kStep) {
      continue;
    }
    posture->turn_rad = near.turn_rad + wrap_angle(posture->turn_rad - near.turn_rad);
    const char* fault = mover.fault(with_bucket, tried, *posture, true);
    if (fault == nullptr) return *posture;
    why = fault;
  }
  return tl::unexpected<std::string>(std::string("the standing bucket: ") + why);
}

}  // namespace wex
