#pragma once

#include <string>
#include <utility>
#include <vector>

#include "initializer/paper/paper_check.hpp"
#include "initializer/stepping/arm_kinematics.hpp"
#include "initializer/stepping/arm_motion.hpp"

namespace wex {

/// Where the bucket stands during one contact phase.
struct BucketPoint {
  Eigen::Vector3d p_world;
  ArmPosture posture;  ///< of the roadmap at the beginning of the phase, to begin the search with
};

/// Indices (first, second) of the closest two points, one of each list; both not empty (contract).
[[nodiscard]] std::pair<std::size_t, std::size_t> closest_pair(
    const std::vector<Eigen::Vector3d>& first, const std::vector<Eigen::Vector3d>& second);

/// Bucket contacts of whole phases. All it refers to must outlive it.
class BucketPoints {
 public:
  BucketPoints(const TerrainMap& terrain, const Roadmaps& roadmaps, const PaperCheck& check,
               const ArmKinematics& arm, const PlanSettings& settings);

  /// Halfway between the closest pair of roadmap positions at the two ends of a phase, put on the
  /// ground; of the positions with which Algorithm 2 accepts either end.
  ///   begin, end  on two wheels and the bucket (contract)
  ///   errors      why there is none
  [[nodiscard]] Result<BucketPoint, std::string> common(const PaperStance& begin,
                                                        const PaperStance& end) const;

  /// The posture nearest to `near` that keeps the bucket there: telescope and attitude give way a
  /// little. Turn is within half a turn of `near`.
  ///   footing  on the wheels alone
  ///   errors  out of reach, or what is wrong with the last posture in reach
  [[nodiscard]] Result<ArmPosture, std::string> reach(const BucketPoint& point,
                                                      const Footing& footing,
                                                      const ArmPosture& near, ArmMover& mover,
                                                      const Eigen::VectorXd& q) const;

 private:
  struct Offset {
    double tele_m, attitude_rad;
  };
  const TerrainMap& terrain_;
  const Roadmaps& roadmaps_;
  const PaperCheck& check_;
  const ArmKinematics& arm_;
  double min_distance_m_;
  std::vector<Offset> offsets_;  ///< by size
};

}  // namespace wex
