#include "initializer/stepping/bucket_phase.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace wex {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kMaxRounds = 40;
constexpr double kMarginWeight = 200.0;  // per m^2 short of comfort, against squared rate shares
constexpr double kMiddleWeight = 0.02;   // of joints away from the middle of their range
constexpr double kSecondsPerKnot = 1.5;  // what the machine takes from knot to knot, about
constexpr double kArmRadiusM = 0.25, kBucketRadiusM = 0.15;
constexpr double kBucketShare = 0.7;  // of the way from wrist to edge: the rest may touch

// How far a cell got.
enum class Fault { kReach, kStability, kGround, kNotClear, kNoAccess, kNone };

const char* describe(Fault fault) {
  switch (fault) {
    case Fault::kReach:
      return "the bucket's point is out of the arm's reach";
    case Fault::kStability:
      return "the bucket's point gives too little stability";
    case Fault::kGround:
      return "the arm would touch the ground with the bucket on its point";
    case Fault::kNotClear:
      return "the arm would be too close to the machine or the ground with the bucket on its point";
    case Fault::kNoAccess:
      return "the arm does not get to the bucket's point and away";
    case Fault::kNone:
      break;
  }
  return "the arm cannot follow the base with the bucket standing";
}

struct Cell {
  ArmPosture posture;
  double node_cost = kInfinity;
  Fault fault = Fault::kReach;
  bool judged = false, accessible = false;

  void rule_out(Fault why) {
    node_cost = kInfinity;
    fault = why;
  }
};

bool above_ground(const StanceGround& ground, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                  double radius_m) {
  constexpr int kPieces = 4;
  for (int k = 0; k <= kPieces; ++k) {
    const Eigen::Vector3d p = a + (b - a) * (static_cast<double>(k) / kPieces);
    if (p.z() - radius_m < ground.highest_m(p.x(), p.y())) return false;
  }
  return true;
}

// Dynamic programming over knots x telescope x attitude.
class Programme {
 public:
  Programme(const ArmKinematics& arm, const StanceGround& ground,
            const Eigen::Vector3d& p_world_bucket, const BucketPathSettings& settings)
      : arm_(arm), ground_(ground), p_world_bucket_(p_world_bucket), settings_(settings) {
    const double lower = std::max(0.0, arm.lower()[3]) + 0.02, upper = arm.upper()[3] - 0.02;
    const int num_tele = static_cast<int>((upper - lower) / settings.tele_step_m) + 1;
    for (int i = 0; i < num_tele; ++i) {
      tele_.push_back(lower + (upper - lower) * i / std::max(1, num_tele - 1));
    }
    const int half = static_cast<int>(settings.max_attitude_rad / settings.attitude_step_rad + 0.5);
    for (int i = -half; i <= half; ++i) attitude_.push_back(i * settings.attitude_step_rad);
  }

  [[nodiscard]] std::size_t num_cells() const { return tele_.size() * attitude_.size(); }
  [[nodiscard]] double tele(std::size_t cell) const { return tele_[cell / attitude_.size()]; }
  [[nodiscard]] double attitude(std::size_t cell) const {
    return attitude_[cell % attitude_.size()];
  }

  // Margin of the worse footing; -infinity where the posture is impossible.
  double margin(const BucketStance& stance, const ArmPosture& posture) const {
    const Eigen::Vector3d moment = arm_.moment_base(posture);
    double margin_m = stance.footing.margin_m(moment);
    if (stance.on_wheels) margin_m = std::min(margin_m, stance.on_wheels->margin_m(moment));
    if (margin_m < settings_.min_margin_m) return margin_m;
    const Eigen::Isometry3d& T = stance.footing.T_world_base;
    const ArmKinematics::Shape shape = arm_.shape(posture);
    const Eigen::Vector3d wrist = T * shape.p_base_wrist;
    if (!above_ground(ground_, T * shape.p_base_elbow, wrist, kArmRadiusM) ||
        !above_ground(ground_, wrist, wrist + kBucketShare * (p_world_bucket_ - wrist),
                      kBucketRadiusM)) {
      return -kInfinity;
    }
    return margin_m;
  }

  [[nodiscard]] double node_cost(double margin_m, const ArmPosture& posture) const {
    if (margin_m < settings_.min_margin_m) return kInfinity;
    double cost = kMarginWeight * square(std::max(0.0, settings_.comfortable_margin_m - margin_m));
    const auto joints = ArmKinematics::joints_of(posture);
    for (std::size_t k = 1; k < joints.size(); ++k) {
      const double half = 0.5 * (arm_.upper()[k] - arm_.lower()[k]);
      cost += kMiddleWeight * square((joints[k] - arm_.lower()[k]) / half - 1.0);
    }
    return cost;
  }

  void fill(const BucketStance& stance, Cell* cells) const {
    const Eigen::Vector3d p_base = stance.footing.T_world_base.inverse() * p_world_bucket_;
    for (std::size_t c = 0; c < num_cells(); ++c) {
      const auto posture = arm_.reach(p_base, tele(c), attitude(c));
      if (!posture) continue;
      cells[c].posture = *posture;
      const double margin_m = margin(stance, *posture);
      cells[c].node_cost = node_cost(margin_m, *posture);
      cells[c].fault = cells[c].node_cost < kInfinity ? Fault::kNone
                       : margin_m == -kInfinity       ? Fault::kGround
                                                      : Fault::kStability;
    }
  }

  // The number of knots that can be reached; the way only if that is all of them.
  std::size_t cheapest_way(const std::vector<Cell>& table, std::size_t knots,
                           std::vector<std::size_t>& way) const {
    const std::size_t n = num_cells();
    std::vector<double> cost(n), next(n);
    std::vector<int> from(knots * n, -1);
    for (std::size_t i = 0; i < knots; ++i) {
      bool alive = false;
      for (std::size_t c = 0; c < n; ++c) {
        const Cell& cell = table[i * n + c];
        next[c] = i == 0 ? cell.node_cost : kInfinity;
        if (i > 0 && cell.node_cost < kInfinity) {
          for_each_neighbour(c, [&](std::size_t b) {
            if (cost[b] == kInfinity) return;
            const double total =
                cost[b] + cell.node_cost + move_cost(table[(i - 1) * n + b].posture, cell.posture);
            if (total >= next[c]) return;
            next[c] = total;
            from[i * n + c] = static_cast<int>(b);
          });
        }
        alive |= next[c] < kInfinity;
      }
      if (!alive) return i;
      std::swap(cost, next);
    }
    way.resize(knots);
    way.back() =
        static_cast<std::size_t>(std::min_element(cost.begin(), cost.end()) - cost.begin());
    for (std::size_t i = knots - 1; i > 0; --i) {
      way[i - 1] = static_cast<std::size_t>(from[i * n + way[i]]);
    }
    return knots;
  }

 private:
  [[nodiscard]] static double square(double x) { return x * x; }

  [[nodiscard]] double move_cost(const ArmPosture& a, const ArmPosture& b) const {
    const auto from = ArmKinematics::joints_of(a), to = ArmKinematics::joints_of(b);
    double cost = 0.0;
    for (std::size_t k = 1; k < from.size(); ++k) {
      cost += square((to[k] - from[k]) / (arm_.max_rate()[k] * kSecondsPerKnot));
    }
    return cost;
  }

  template <typename Visit>
  void for_each_neighbour(std::size_t cell, const Visit& visit) const {
    const int columns = static_cast<int>(attitude_.size()), rows = static_cast<int>(tele_.size());
    const int row = static_cast<int>(cell) / columns, column = static_cast<int>(cell) % columns;
    for (int r = std::max(0, row - 1); r <= std::min(rows - 1, row + 1); ++r) {
      for (int c = std::max(0, column - 1); c <= std::min(columns - 1, column + 1); ++c) {
        visit(static_cast<std::size_t>(r * columns + c));
      }
    }
  }

  const ArmKinematics& arm_;
  const StanceGround& ground_;
  Eigen::Vector3d p_world_bucket_;
  BucketPathSettings settings_;
  std::vector<double> tele_, attitude_;
};

// Averages the staircase of cells, as far as every knot still holds.
void smooth_samples(const Programme& programme, const ArmKinematics& arm, const PostureJudge& judge,
                    const std::vector<BucketStance>& stances, const Eigen::Vector3d& p_world_bucket,
                    double min_margin_m, std::vector<BucketPath::Sample>& samples) {
  constexpr int kRounds = 8;
  for (int round = 0; round < kRounds; ++round) {
    bool changed = false;
    for (std::size_t i = 1; i + 1 < samples.size(); ++i) {
      const BucketPath::Sample& a = samples[i - 1];
      const BucketPath::Sample& b = samples[i + 1];
      const double share = (samples[i].sigma_m - a.sigma_m) / (b.sigma_m - a.sigma_m);
      const double tele_m = 0.5 * (samples[i].tele_m + a.tele_m + share * (b.tele_m - a.tele_m));
      const double attitude_rad = 0.5 * (samples[i].attitude_rad + a.attitude_rad +
                                         share * (b.attitude_rad - a.attitude_rad));
      const auto posture = arm.reach(stances[i].footing.T_world_base.inverse() * p_world_bucket,
                                     tele_m, attitude_rad);
      if (!posture || programme.margin(stances[i], *posture) < min_margin_m) continue;
      if (round + 1 == kRounds && !judge(i, *posture)) continue;
      samples[i].tele_m = tele_m;
      samples[i].attitude_rad = attitude_rad;
      changed = true;
    }
    if (!changed) return;
  }
}

}  // namespace

BucketPath::Sample BucketPath::at(double sigma_m) const {
  const auto after =
      std::upper_bound(samples.begin(), samples.end(), sigma_m,
                       [](double sigma, const Sample& sample) { return sigma < sample.sigma_m; });
  if (after == samples.begin()) return samples.front();
  if (after == samples.end()) return samples.back();
  const Sample& a = *std::prev(after);
  const double share = (sigma_m - a.sigma_m) / (after->sigma_m - a.sigma_m);
  return {sigma_m, a.tele_m + share * (after->tele_m - a.tele_m),
          a.attitude_rad + share * (after->attitude_rad - a.attitude_rad)};
}

Result<BucketPath, MotionFailure> bucket_path(const ArmKinematics& arm, const StanceGround& ground,
                                              const BaseRun& run,
                                              const std::vector<BucketStance>& stances,
                                              const Eigen::Vector3d& p_world_bucket,
                                              const BucketPathSettings& settings,
                                              const PostureJudges& judges) {
  const Programme programme(arm, ground, p_world_bucket, settings);
  const std::size_t n = run.knots.size(), cells = programme.num_cells();
  std::vector<Cell> table(n * cells);
  for (std::size_t i = 0; i < n; ++i) programme.fill(stances[i], &table[i * cells]);

  std::vector<std::size_t> way;
  for (int round = 0; way.empty(); ++round) {
    const std::size_t reached = programme.cheapest_way(table, n, way);
    if (reached < n || round == kMaxRounds) {
      const std::size_t knot = std::min(reached, n - 1);
      const auto furthest =
          std::max_element(table.begin() + static_cast<std::ptrdiff_t>(knot * cells),
                           table.begin() + static_cast<std::ptrdiff_t>((knot + 1) * cells),
                           [](const Cell& a, const Cell& b) { return a.fault < b.fault; });
      MotionFailure failure{run.knots[knot].state, describe(furthest->fault), true};
      return tl::unexpected<MotionFailure>(std::move(failure));
    }
    bool passes = true;
    for (std::size_t i = 0; i < n; ++i) {
      Cell& cell = table[i * cells + way[i]];
      if (!cell.judged) {
        cell.judged = true;
        if (!judges.clear(i, cell.posture)) cell.rule_out(Fault::kNotClear);
        // Where one is not clear, others will not be: better to know at once.
        for (std::size_t c = 0; c < cells && cell.node_cost == kInfinity; ++c) {
          Cell& other = table[i * cells + c];
          if (other.judged || other.node_cost == kInfinity) continue;
          other.judged = true;
          if (!judges.clear(i, other.posture)) other.rule_out(Fault::kNotClear);
        }
      }
      const bool end = i == 0 || i + 1 == n;
      if (end && cell.node_cost < kInfinity && !cell.accessible) {
        cell.accessible = judges.accessible(i, cell.posture);
        if (!cell.accessible) cell.rule_out(Fault::kNoAccess);
      }
      passes &= cell.node_cost < kInfinity;
    }
    if (!passes) way.clear();
  }

  BucketPath path;
  path.samples.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    path.samples[i] = {run.knots[i].sigma_m, programme.tele(way[i]), programme.attitude(way[i])};
  }
  smooth_samples(programme, arm, judges.clear, stances, p_world_bucket, settings.min_margin_m,
                 path.samples);
  path.min_margin_m = kInfinity;
  for (std::size_t i = 0; i < n; ++i) {
    const auto posture = arm.reach(stances[i].footing.T_world_base.inverse() * p_world_bucket,
                                   path.samples[i].tele_m, path.samples[i].attitude_rad);
    path.min_margin_m = std::min(path.min_margin_m, programme.margin(stances[i], *posture));
  }
  return path;
}

}  // namespace wex
