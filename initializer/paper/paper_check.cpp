#include "initializer/paper/paper_check.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "initializer/leg_table.hpp"
#include "initializer/stepping/arm_kinematics.hpp"
#include "initializer/stepping/support_polygon.hpp"

namespace wex {
namespace {

constexpr double kBellySpacingM = 0.2;
constexpr double kSwingBucketM = 0.3;  // contact point of a swinging bucket above the base origin
constexpr double kRoundingM = 1e-4;    // added to demands: single precision errs by less

/// Highest sample within a square around every cell; infinite if one of them is unknown.
Grid highest_within(const Grid& grid, double reach_m) {
  const int reach = static_cast<int>(std::ceil(reach_m / grid.cell_m));
  const auto sweep = [&](const Grid& in, int along_x, int along_y) {
    Grid out = in;
    for (int j = 0; j < in.size_y; ++j) {
      for (int i = 0; i < in.size_x; ++i) {
        float top = -std::numeric_limits<float>::infinity();
        for (int k = -reach; k <= reach; ++k) {
          const int a = i + k * along_x, b = j + k * along_y;
          if (a < 0 || b < 0 || a >= in.size_x || b >= in.size_y) continue;
          top = std::isnan(in.at(a, b)) ? std::numeric_limits<float>::infinity()
                                        : std::max(top, in.at(a, b));
        }
        out.at(i, j) = top;
      }
    }
    return out;
  };
  return sweep(sweep(grid, 1, 0), 0, 1);
}

/// Bits of a block's gaps within +-reach.
unsigned within(const float* gap_m, float reach_m) noexcept {
  unsigned bits = 0;
  for (int i = 0; i < LimbTable::kBlock; ++i) {
    bits |= static_cast<unsigned>(std::abs(gap_m[i]) <= reach_m) << i;
  }
  return bits;
}

unsigned above(const float* gap_m, float least_m) noexcept {
  unsigned bits = 0;
  for (int i = 0; i < LimbTable::kBlock; ++i) {
    bits |= static_cast<unsigned>(gap_m[i] >= least_m) << i;
  }
  return bits;
}

}  // namespace

const char* describe(PaperRejection rejection) noexcept {
  switch (rejection) {
    case PaperRejection::kNone:
      return "nothing";
    case PaperRejection::kOffMap:
      return "off the map or over unknown ground";
    case PaperRejection::kTilt:
      return "too much tilt";
    case PaperRejection::kBelly:
      return "too little clearance under the chassis";
    case PaperRejection::kTooFewLegs:
      return "fewer than two legs on the ground";
    case PaperRejection::kSwingLeg:
      return "a swing leg without clearance";
    case PaperRejection::kArmInGround:
      return "no counterweight posture clear of the ground";
    case PaperRejection::kNoArmContact:
      return "no contact for the bucket";
    case PaperRejection::kUnstable:
      return "too little stability margin";
  }
  return "an unnamed reason";
}

PaperCheck::PaperCheck(const TerrainMap& terrain, const MachineModel& machine,
                       const PlanSettings& settings, const PaperSettings& paper)
    : terrain_(&terrain),
      settings_(settings),
      paper_(paper),
      dilated_(terrain.dilated_height()),
      height_(terrain.elevation()),
      distance_(terrain.signed_distance()),
      top_(highest_within(terrain.elevation(),
                          machine.belly_min_m.cwiseAbs().cwiseMax(machine.belly_max_m).norm())),
      mass_kg_(machine.tree.total_mass_kg()),
      base_height_m_(machine.default_base_height_m),
      belly_m_(machine.belly_below_base_m),
      belly_radius_m_(
          static_cast<float>(machine.belly_min_m.cwiseAbs().cwiseMax(machine.belly_max_m).norm())) {
  settings_.min_signed_distance_m += kRoundingM;
  settings_.belly_clearance_m += kRoundingM;
  const Eigen::Vector2d size = machine.belly_max_m - machine.belly_min_m;
  const Eigen::Array2i steps = (size.array() / kBellySpacingM).ceil().max(1.0).cast<int>();
  for (int i = 0; i <= steps.x(); ++i) {
    for (int j = 0; j <= steps.y(); ++j) {
      p_base_belly_.emplace_back(
          static_cast<float>(machine.belly_min_m.x() + size.x() * i / steps.x()),
          static_cast<float>(machine.belly_min_m.y() + size.y() * j / steps.y()),
          static_cast<float>(-machine.belly_below_base_m));
    }
  }
}

Result<PaperCheck> PaperCheck::build(const TerrainMap& terrain, const MachineModel& machine,
                                     const Roadmaps& roadmaps, const PlanSettings& settings,
                                     const PaperSettings& paper) {
  const auto legs = build_leg_tables(machine);
  if (!legs) return tl::unexpected<Error>(legs.error());
  const auto arm = ArmKinematics::build(machine);
  if (!arm) return tl::unexpected<Error>(arm.error());
  WEX_EXPECTS(roadmaps.limbs.size() == kNumLimbs);
  for (const LimbRoadmap& map : roadmaps.limbs) {
    if (map.num_vertices() == 0) {
      return fail(ErrorCode::kBadInput,
                  "the roadmap of limb " +
                      std::string(kLimbNames[static_cast<std::size_t>(map.limb)]) + " of machine " +
                      machine.name + " is empty");
    }
  }

  PaperCheck check(terrain, machine, settings, paper);
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    const LegTable& leg = (*legs)[i];
    const auto wheel = [&](double hfe_rad) { return leg.p_base_wheel(hfe_rad, LegTable::Steer()); };
    DefaultFoot& foot = check.feet_[i];
    const Eigen::Vector3d p_base = wheel(leg.hfe_default_rad());
    foot.p_base = p_base.cast<float>();
    foot.radius_m = static_cast<float>(machine.legs[i].radius_m);
    foot.up_m = static_cast<float>(wheel(leg.hfe_upper_rad()).z() - p_base.z());
    foot.down_m = static_cast<float>(p_base.z() - wheel(leg.hfe_lower_rad()).z());
    check.legs_[i] = LimbTable(roadmaps.limbs[i]);
  }
  const LimbRoadmap& arm_map = roadmaps.limbs.back();
  const auto posture = [&](int vertex) {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(machine.num_coordinates());
    for (std::size_t k = 0; k < arm_map.coordinates.size(); ++k) {
      q[arm_map.coordinates[k]] = arm_map.q(static_cast<Eigen::Index>(k), vertex);
    }
    return arm->posture_of(q);
  };
  check.bucket_ = LimbTable(arm_map, [&](int vertex) {
    return std::abs(arm->attitude_rad(posture(vertex))) <= paper.max_bucket_lean_rad;
  });
  check.swing_ = LimbTable(
      arm_map, [&](int vertex) { return arm_map.p_base_contact(2, vertex) >= kSwingBucketM; });

  Eigen::VectorXd q = Eigen::VectorXd::Zero(machine.num_coordinates());
  q.tail(machine.num_joints()) = machine.default_posture();
  for (const LimbRoadmap& map : roadmaps.limbs) {
    for (std::size_t k = 0; k < map.coordinates.size(); ++k) {
      q[map.coordinates[k]] = map.q(static_cast<Eigen::Index>(k), 0);
    }
  }
  KinematicTree::Workspace w = machine.tree.make_workspace();
  machine.tree.update(q, w);
  check.fixed_moment_base_ = check.mass_kg_ * machine.tree.com(w);
  for (const LimbRoadmap& map : roadmaps.limbs) {
    check.fixed_moment_base_ -= map.moment_base.col(0);
  }
  check.arm_moment_base_ = arm_map.moment_base.col(0);
  return check;
}

// The square under the chassis first: nearly always it is clear as a whole.
bool PaperCheck::belly_clear(const CellPose& pose) const noexcept {
  const auto least_m = static_cast<float>(settings_.belly_clearance_m);
  const auto below_m = static_cast<float>(-belly_m_);
  const float lowest_m =
      pose.height_m(0.0F, 0.0F, below_m) - belly_radius_m_ * std::hypot(pose.hx, pose.hy);
  if (lowest_m - top_.at({pose.u, pose.v}) >= least_m) return true;
  return std::all_of(p_base_belly_.begin(), p_base_belly_.end(), [&](const Eigen::Vector3f& p) {
    const CellPoint at = pose.cells(p.x(), p.y(), p.z());
    return pose.height_m(p.x(), p.y(), p.z()) - height_.at(at) >= least_m;
  });
}

// Rows whose contact is on traversable ground, until the visitor has enough.
template <typename Visit>
void PaperCheck::visit_touching(const LimbTable& table, const GroundQuads& ground, float offset_m,
                                const CellPose& pose, const Visit& visit) const noexcept {
  const auto reach_m = static_cast<float>(paper_.touch_m);
  const auto least_m = static_cast<float>(settings_.min_signed_distance_m);
  for (int block = 0; block < table.num_blocks(); ++block) {
    alignas(32) float gap_m[LimbTable::kBlock];
    table.gaps_m(pose, ground, offset_m, block, gap_m);
    for (unsigned bits = within(gap_m, reach_m); bits != 0; bits &= bits - 1) {
      const int row = block * LimbTable::kBlock + std::countr_zero(bits);
      if (!(distance_.at(table.cells(pose, row)) >= least_m)) continue;
      if (visit(row)) return;
    }
  }
}

// Of the configurations that touch the one nearest to default, if there are enough of them; the
// loop ends as soon as there are.
int PaperCheck::grounded_row(std::size_t leg, const CellPose& pose) const noexcept {
  int touching = 0, first = -1;
  visit_touching(legs_[leg], dilated_, feet_[leg].radius_m, pose, [&](int row) {
    if (first < 0) first = row;
    return ++touching >= paper_.min_touching;
  });
  return touching >= paper_.min_touching ? first : -1;
}

int PaperCheck::swing_row(std::size_t leg, const CellPose& pose) const noexcept {
  const LimbTable& table = legs_[leg];
  const auto least_m = static_cast<float>(paper_.swing_clearance_m);
  for (int block = 0; block < table.num_blocks(); ++block) {
    alignas(32) float gap_m[LimbTable::kBlock];
    table.gaps_m(pose, dilated_, feet_[leg].radius_m, block, gap_m);
    const unsigned bits = above(gap_m, least_m);
    if (bits == 0) continue;
    const int row = block * LimbTable::kBlock + std::countr_zero(bits);
    return row < table.size() ? row : -1;
  }
  return -1;
}

namespace {

/// Margin of a support polygon as a function of the arm's moment: an offset and a gradient per
/// edge.
struct MarginInMoment {
  int edges = 0;
  float offset_m[3]{}, by_x[3]{}, by_y[3]{}, by_z[3]{};

  MarginInMoment(const Eigen::Isometry3d& T_world_base, const Eigen::Vector3d& moment_base,
                 double mass_kg, std::array<Eigen::Vector2d, 3> corners) noexcept {
    const Eigen::Vector2d ab = corners[1] - corners[0], ac = corners[2] - corners[0];
    if (ab.x() * ac.y() - ab.y() * ac.x() < 0.0) std::swap(corners[1], corners[2]);
    const Eigen::Vector2d com = (T_world_base * (moment_base / mass_kg)).head<2>();
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector2d along = (corners[(i + 1) % 3] - corners[i]).normalized();
      const Eigen::Vector2d inwards(-along.y(), along.x());
      const Eigen::Vector3d by_moment =
          T_world_base.linear().topRows<2>().transpose() * inwards / mass_kg;
      offset_m[i] = static_cast<float>(inwards.dot(com - corners[i]));
      by_x[i] = static_cast<float>(by_moment.x());
      by_y[i] = static_cast<float>(by_moment.y());
      by_z[i] = static_cast<float>(by_moment.z());
    }
  }
  [[nodiscard]] float at(float x, float y, float z) const noexcept {
    const auto edge = [&](int i) { return offset_m[i] + by_x[i] * x + by_y[i] * y + by_z[i] * z; };
    return std::min(edge(0), std::min(edge(1), edge(2)));
  }
};

}  // namespace

std::array<Eigen::Vector2d, 3> PaperCheck::wheel_corners(const Eigen::Isometry3d& T_world_base,
                                                         const PaperStance& stance) const noexcept {
  std::array<Eigen::Vector2d, 3> corners;
  std::size_t count = 0;
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    if (!stance.contacts[i]) continue;
    corners[count++] = (T_world_base * legs_[i].p_base_contact(stance.vertex[i])).head<2>();
  }
  return corners;
}

// Three wheels stand: the arm goes where the centre of mass is as far inside their triangle as can
// be. Every lane of the blocks keeps its best row, so that there is another choice if the bucket
// would be in the ground.
void PaperCheck::balance_with_arm(const Eigen::Isometry3d& T_world_base, const CellPose& pose,
                                  const Eigen::Vector3d& moment_base,
                                  PaperStance& stance) const noexcept {
  const MarginInMoment margin(T_world_base, moment_base, mass_kg_,
                              wheel_corners(T_world_base, stance));
  if (!settings_.ablation.arm_centring) {
    const Eigen::Vector3f m = arm_moment_base_.cast<float>();
    stance.margin_m = static_cast<double>(margin.at(m.x(), m.y(), m.z()));
    if (!(stance.margin_m >= settings_.min_stability_margin_m)) {
      stance.rejection = PaperRejection::kUnstable;
    }
    return;
  }
  constexpr int n = LimbTable::kBlock;
  alignas(32) float best_m[n];
  alignas(32) int best_row[n];
  std::fill_n(best_m, n, -1e9F);
  std::fill_n(best_row, n, -1);
  const float* x = swing_.moment_x();
  const float* y = swing_.moment_y();
  const float* z = swing_.moment_z();
  const int whole_blocks = swing_.size() / n;
  for (int block = 0; block < whole_blocks; ++block) {
    const int first = block * n;
    for (int i = 0; i < n; ++i) {
      const float m = margin.at(x[first + i], y[first + i], z[first + i]);
      const bool better = m > best_m[i];
      best_m[i] = better ? m : best_m[i];
      best_row[i] = better ? first + i : best_row[i];
    }
  }
  for (int i = 0; i < swing_.size() - whole_blocks * n; ++i) {
    const int row = whole_blocks * n + i;
    const float m = margin.at(x[row], y[row], z[row]);
    if (m > best_m[i]) best_m[i] = m, best_row[i] = row;
  }
  const auto clear_m = static_cast<float>(paper_.swing_clearance_m);
  for (int round = 0; round < n; ++round) {
    const auto lane = std::max_element(best_m, best_m + n) - best_m;
    const int row = best_row[lane];
    if (row < 0) break;
    if (swing_.height_m(pose, row) - height_.at(swing_.cells(pose, row)) >= clear_m) {
      stance.vertex[static_cast<std::size_t>(Limb::kArm)] = swing_.vertex(row);
      stance.margin_m = static_cast<double>(best_m[lane]);
      if (!(stance.margin_m >= settings_.min_stability_margin_m)) {
        stance.rejection = PaperRejection::kUnstable;
      }
      return;
    }
    best_m[lane] = -1e9F;
    best_row[lane] = -1;
  }
  stance.rejection = PaperRejection::kArmInGround;
}

double PaperCheck::margin_on_bucket_m(const Eigen::Isometry3d& T_world_base,
                                      const Eigen::Vector3d& moment_base, const PaperStance& stance,
                                      int row) const noexcept {
  std::array<Eigen::Vector2d, 3> corners = wheel_corners(T_world_base, stance);
  corners[2] = (T_world_base * bucket_.p_base_contact(row)).template head<2>();
  const Eigen::Vector3d com = T_world_base * ((moment_base + bucket_.moment_base(row)) / mass_kg_);
  return hull_margin_m(com.head<2>(), corners);
}

// Two wheels stand: the arm is grounded if enough of its configurations touch; of those the one
// nearest to default that makes a stable tripod.
void PaperCheck::support_with_arm(const Eigen::Isometry3d& T_world_base, const CellPose& pose,
                                  const Eigen::Vector3d& moment_base,
                                  PaperStance& stance) const noexcept {
  if (!settings_.ablation.arm_support) {
    stance.rejection = PaperRejection::kTooFewLegs;
    return;
  }
  int touching = 0, row_found = -1;
  visit_touching(bucket_, height_, 0.0F, pose, [&](int row) {
    ++touching;
    if (row_found < 0) {
      const double margin_m = margin_on_bucket_m(T_world_base, moment_base, stance, row);
      if (margin_m >= settings_.min_stability_margin_m) {
        row_found = row;
        stance.margin_m = margin_m;
      }
    }
    return row_found >= 0 && touching >= paper_.min_touching;
  });
  if (touching < paper_.min_touching) {
    stance.rejection = PaperRejection::kNoArmContact;
  } else if (row_found < 0) {
    stance.rejection = PaperRejection::kUnstable;
  } else {
    stance.contacts[static_cast<std::size_t>(Limb::kArm)] = true;
    stance.vertex[static_cast<std::size_t>(Limb::kArm)] = bucket_.vertex(row_found);
  }
}

std::array<int, kNumWheels> PaperCheck::ground_legs(const BaseCoordinates& base) const noexcept {
  const CellPose pose(T_world_base_from(base), dilated_);
  std::array<int, kNumWheels> rows{};
  for (std::size_t i = 0; i < kNumWheels; ++i) rows[i] = grounded_row(i, pose);
  return rows;
}

std::vector<int> PaperCheck::touching_vertices(const BaseCoordinates& base, std::size_t leg) const {
  std::vector<int> vertices;
  visit_touching(legs_[leg], dilated_, feet_[leg].radius_m,
                 CellPose(T_world_base_from(base), dilated_), [&](int row) {
                   vertices.push_back(legs_[leg].vertex(row));
                   return false;
                 });
  return vertices;
}

int PaperCheck::swing_vertex(const BaseCoordinates& base, std::size_t leg) const noexcept {
  const int row = swing_row(leg, CellPose(T_world_base_from(base), dilated_));
  return row < 0 ? -1 : legs_[leg].vertex(row);
}

Eigen::Vector3d PaperCheck::moment_but_arm(const PaperStance& stance) const noexcept {
  Eigen::Vector3d moment_base = fixed_moment_base_;
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    moment_base += legs_[i].moment_base(stance.vertex[i]);
  }
  return moment_base;
}

std::vector<int> PaperCheck::counterweights(const PaperStance& stance) const {
  const Eigen::Isometry3d T_world_base = T_world_base_from(stance.base);
  const MarginInMoment margin(T_world_base, moment_but_arm(stance), mass_kg_,
                              wheel_corners(T_world_base, stance));
  std::vector<std::pair<float, int>> by_margin;
  for (int row = 0; row < swing_.size(); ++row) {
    const Eigen::Vector3f moment = swing_.moment_base(row).cast<float>();
    const float margin_m = margin.at(moment.x(), moment.y(), moment.z());
    if (static_cast<double>(margin_m) < settings_.min_stability_margin_m) continue;
    by_margin.emplace_back(-margin_m, swing_.vertex(row));
  }
  std::sort(by_margin.begin(), by_margin.end());
  std::vector<int> vertices;
  for (const auto& [margin_m, vertex] : by_margin) vertices.push_back(vertex);
  return vertices;
}

std::vector<int> PaperCheck::carrying_bucket_rows(const PaperStance& stance) const {
  const Eigen::Isometry3d T_world_base = T_world_base_from(stance.base);
  const Eigen::Vector3d moment_base = moment_but_arm(stance);
  std::vector<int> rows;
  visit_touching(bucket_, height_, 0.0F, CellPose(T_world_base, dilated_), [&](int row) {
    const double margin_m = margin_on_bucket_m(T_world_base, moment_base, stance, row);
    if (margin_m >= settings_.min_stability_margin_m) rows.push_back(row);
    return false;
  });
  return rows;
}

PaperStance PaperCheck::stand(const BaseCoordinates& base, int lifted) const noexcept {
  PaperStance stance;
  stance.base = base;
  const auto rejected = [&](PaperRejection why) {
    stance.rejection = why;
    return stance;
  };
  if (!base.allFinite()) return rejected(PaperRejection::kOffMap);
  if (std::abs(base[kBaseRoll]) > settings_.max_tilt_rad ||
      std::abs(base[kBasePitch]) > settings_.max_tilt_rad) {
    return rejected(PaperRejection::kTilt);
  }
  const Eigen::Isometry3d T_world_base = T_world_base_from(base);
  const CellPose pose(T_world_base, dilated_);
  if (!belly_clear(pose)) return rejected(PaperRejection::kBelly);

  int grounded = 0;
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    stance.vertex[i] = static_cast<int>(i) == lifted ? -1 : grounded_row(i, pose);
    stance.contacts[i] = stance.vertex[i] >= 0;
    grounded += stance.contacts[i];
    if (static_cast<int>(i) - grounded >= 2) return rejected(PaperRejection::kTooFewLegs);
  }
  Eigen::Vector3d moment_base = fixed_moment_base_;
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    if (!stance.contacts[i]) stance.vertex[i] = swing_row(i, pose);
    if (stance.vertex[i] < 0) return rejected(PaperRejection::kSwingLeg);
    moment_base += legs_[i].moment_base(stance.vertex[i]);
  }
  if (grounded == 3) {
    balance_with_arm(T_world_base, pose, moment_base, stance);
  } else if (grounded == 2) {
    support_with_arm(T_world_base, pose, moment_base, stance);
  } else {
    std::array<Eigen::Vector2d, kNumWheels> contacts;
    for (std::size_t i = 0; i < kNumWheels; ++i) {
      contacts[i] = (T_world_base * legs_[i].p_base_contact(stance.vertex[i])).head<2>();
    }
    const Eigen::Vector3d com = T_world_base * ((moment_base + arm_moment_base_) / mass_kg_);
    stance.margin_m = hull_margin_m(com.head<2>(), contacts);
    if (!(stance.margin_m >= settings_.min_stability_margin_m)) {
      return rejected(PaperRejection::kUnstable);
    }
  }
  return stance;
}

PaperStance PaperCheck::stand(const Pose2& pose) const noexcept { return stand(base_at(pose)); }

}  // namespace wex
