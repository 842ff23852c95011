#include "initializer/plan_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "initializer/internal/direct_paths.hpp"
#include "initializer/internal/squared_paths.hpp"
#include "initializer/shorten_path.hpp"
#include "initializer/stepping/stance_tables.hpp"
#include "initializer/timing.hpp"
#include "initializer/verify_plan.hpp"
#include "initializer/whole_body.hpp"
#include "models/types/cpu_clock.hpp"

namespace wex {
namespace {

constexpr double kGoodEnough = 1.02;       // of the Reeds-Shepp length, which no path beats
constexpr double kWorthwhileShare = 0.99;  // of the tree's cost, to look at a path again
constexpr double kStagnationShare = 0.25;  // of the time budget without a better plan
constexpr double kProgressPeriodS = 0.1;   // between two calls of the observer
constexpr double kBlockRadiusM = 0.5;      // around a pose where a path failed
constexpr double kBlockYawRad = 0.1;       // 6 degrees
constexpr std::uint64_t kSeedStride = 0x9E3779B97F4A7C15ULL;  // independent streams per tree

constexpr double kNeedlessLiftM = 0.02;  // least cost of a change of support: none is idle

constexpr int kSliceIterations = 40;     // of one tree before the other kind has its turn
constexpr int kAlignedRejections = 3;    // then headings are free
constexpr int kTreeRejections = 6;       // then the certified tree grows beside the others
constexpr int kUnluckyIterations = 400;  // without a path: as good as a rejection
constexpr double kAlignmentRad = 0.17453292519943295;  // 10 degrees
constexpr double kGradientStepM = 0.5;  // of the signed distance, to see where an edge runs
constexpr double kClearGradient = 0.3;

// The state of a sequence that a node of its motion belongs to, as far as the node shows.
std::size_t state_like(const CertifiedSequence& sequence, const WholeBodyNode& node) {
  std::uint8_t lifted = 0;
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    if (!node.contacts[i]) lifted |= static_cast<std::uint8_t>(1U << i);
  }
  constexpr double kOtherSupportM = 1.0, kLeverM = 2.4;
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < sequence.states.size(); ++k) {
    const BaseCoordinates off = sequence.states[k].base - node.q.head<kNumBaseCoordinates>();
    const double distance =
        off.head<3>().norm() + kLeverM * std::abs(off[kBasePitch]) +
        ((sequence.states[k].support.lifted & lifted) == lifted ? 0.0 : kOtherSupportM);
    if (distance < least) {
      least = distance;
      nearest = k;
    }
  }
  return nearest;
}

}  // namespace

PlanSearch::PlanSearch(const TerrainMap& terrain, const MachineModel& machine, const Task& task,
                       const PlanSettings& settings,
                       const std::function<void(const PlanProgress&)>& observer,
                       const PoseCheck& check, const BaseCoordinates& standing_at_start,
                       double begin_s, SearchAids aids)
    : terrain_(terrain),
      machine_(machine),
      task_(task),
      settings_(settings),
      observer_(observer),
      check_(check),
      standing_at_start_(standing_at_start),
      begin_s_(begin_s),
      aids_(std::move(aids)) {
  search_settings_.turning_radius_m = machine.min_turning_radius_m;
  search_settings_.range_m = settings.range_m;
  search_settings_.subnode_spacing_m = settings.subnode_spacing_m;
  search_settings_.yaw_weight_m_rad = settings.yaw_weight_m_rad;
  search_settings_.x_min_m = terrain.min_corner_m().x();
  search_settings_.x_max_m = terrain.max_corner_m().x();
  search_settings_.y_min_m = terrain.min_corner_m().y();
  search_settings_.y_max_m = terrain.max_corner_m().y();
  const double curvature = 1.0 / machine.min_turning_radius_m;
  steering_ = {check.steering_for(-curvature, check.default_hfe_rad()),
               check.steering_for(0.0, check.default_hfe_rad()),
               check.steering_for(curvature, check.default_hfe_rad())};
}

double PlanSearch::elapsed_s() const { return thread_cpu_time_s() - begin_s_; }

int PlanSearch::iterations() const {
  int n = certified_tree_ ? certified_tree_->iterations() : 0;
  for (const Tree& tree : trees_) {
    n += tree.iterations_before + (tree.search ? tree.search->iterations() : 0);
  }
  return n;
}

bool PlanSearch::out_of_budget() {
  if (observer_ && elapsed_s() - reported_s_ > kProgressPeriodS) report();
  if (best_ && (aids_.first_will_do || best_->cost <= kGoodEnough * lower_bound_m_)) return true;
  if (settings_.iterations) return iterations() >= *settings_.iterations;
  const double now_s = elapsed_s();
  return now_s >= settings_.time_budget_s ||
         (best_ && now_s - improved_s_ >= kStagnationShare * settings_.time_budget_s);
}

void PlanSearch::report() {
  reported_s_ = elapsed_s();
  observer_({reported_s_, best_ ? std::optional<double>(best_->cost) : std::nullopt, nullptr});
}

bool PlanSearch::blocked(Kind kind, const Pose2& pose) {
  census_.count_pose();
  for (const Block& block : trees_[kind].blocks) {
    if (std::hypot(pose.x_m - block.pose.x_m, pose.y_m - block.pose.y_m) < block.radius_m &&
        std::abs(wrap_angle(pose.yaw_rad - block.pose.yaw_rad)) < kBlockYawRad) {
      census_.count_blocked();
      return true;
    }
  }
  return false;
}

bool PlanSearch::can_drive(const Pose2& pose, double curvature_1_m) {
  if (blocked(kDriving, pose)) return false;
  const std::size_t side = curvature_1_m < 0.0 ? 0 : (curvature_1_m > 0.0 ? 2 : 1);
  const Rejection rejection = check_.stand(pose, steering_[side]).rejection;
  census_.count(rejection);
  return rejection == Rejection::kNone;
}

// The heading of the machine against the way the ground falls off: an edge is met squarely.
bool PlanSearch::heads_squarely(const Pose2& pose) const {
  const auto distance = [&](double dx, double dy) {
    return terrain_.signed_distance_m({pose.x_m + dx, pose.y_m + dy});
  };
  const Eigen::Vector2d gradient(distance(kGradientStepM, 0.0) - distance(-kGradientStepM, 0.0),
                                 distance(0.0, kGradientStepM) - distance(0.0, -kGradientStepM));
  if (!(gradient.norm() > kClearGradient)) return true;
  const Eigen::Vector2d heading(std::cos(pose.yaw_rad), std::sin(pose.yaw_rad));
  return std::abs(gradient.normalized().dot(heading)) >= std::cos(kAlignmentRad);
}

bool PlanSearch::can_step(const Pose2& pose, double curvature_1_m) {
  if (blocked(kStepping, pose)) return false;
  switch (certifier_->admits(pose, curvature_1_m)) {
    case Certifier::Admission::kOnFourWheels:
      return true;
    case Certifier::Admission::kNeedsStepping:
      if (!settings_.ablation.alignment || trees_[kStepping].num_rejections >= kAlignedRejections ||
          heads_squarely(pose)) {
        return true;
      }
      census_.count_askew();
      return false;
    case Certifier::Admission::kRefused:
      break;
  }
  census_.count_unsupported();
  return false;
}

bool PlanSearch::may_step() const {
  return settings_.mode == PlanMode::kCertified && machine_.arm.has_value();
}

Result<void> PlanSearch::build_certifier() {
  if (certifier_) return {};
  CertificateSettings certificate;
  certificate.lift_cost_m =
      std::max(settings_.stepping_penalty * certificate.lift_cost_m, kNeedlessLiftM);
  certificate.bucket_cost_m =
      std::max(settings_.stepping_penalty * certificate.bucket_cost_m, kNeedlessLiftM);
  certificate.stepping_share *= settings_.stepping_penalty;
  if (!aids_.tables) {
    auto tables = StanceTables::build(machine_);
    if (!tables) return tl::unexpected<Error>(tables.error());
    aids_.tables = std::make_shared<const StanceTables>(*std::move(tables));
  }
  auto motion = SteppingMotion::build(terrain_, machine_, settings_, check_.legs());
  if (!motion) return tl::unexpected<Error>(motion.error());
  certifier_.emplace(terrain_, aids_.tables, settings_, certificate);
  motion_.emplace(*std::move(motion));
  return {};
}

// Paths that were good before may be good still.
Result<void> PlanSearch::try_given_paths() {
  const PoseValidity drivable = [this](const Pose2& pose, double curvature_1_m) {
    return can_drive(pose, curvature_1_m);
  };
  for (const DrivePath& path : aids_.paths) {
    if (path_is_valid(path, settings_.subnode_spacing_m, drivable)) consider_driving(path);
    if (best_) return {};
  }
  if (!may_step()) return {};
  for (const DrivePath& path : aids_.paths) {
    if (auto built = build_certifier(); !built) return built;
    consider_stepping(path);
    if (best_) return {};
  }
  return {};
}

Result<void> PlanSearch::try_direct_paths() {
  const std::vector<DrivePath> direct = direct_paths(
      task_.start, task_.goal, search_settings_.turning_radius_m, search_settings_.cost);
  const PoseValidity drivable = [this](const Pose2& pose, double curvature_1_m) {
    return can_drive(pose, curvature_1_m);
  };
  for (const DrivePath& path : direct) {
    if (path_is_valid(path, settings_.subnode_spacing_m, drivable)) consider_driving(path);
    if (best_) break;  // the others cost more
  }
  // Stepping may be cheaper than a detour.
  if (!may_step() || out_of_budget()) return {};
  if (auto built = build_certifier(); !built) return built;
  if (!settings_.ablation.certificate_first) return {};
  for (const DrivePath& path : direct) {
    if (aids_.hopeless && same_way(path, *aids_.hopeless)) continue;
    if (consider_stepping(path)) return {};
  }
  if (best_) return {};  // by driving: the trees have the rest of the budget
  if (!settings_.ablation.alignment) return {};
  constexpr std::size_t kMaxSquaredPaths = 6;
  const PoseFootholds footholds = [this](const Pose2& pose, double curvature_1_m) {
    switch (certifier_->admits(pose, curvature_1_m)) {
      case Certifier::Admission::kOnFourWheels:
        return Footholds::kAllWheels;
      case Certifier::Admission::kNeedsStepping:
        return Footholds::kSomeWheels;
      case Certifier::Admission::kRefused:
        break;
    }
    return Footholds::kNone;
  };
  for (const DrivePath& path : squared_paths(terrain_, task_.start, task_.goal, search_settings_,
                                             footholds, kMaxSquaredPaths)) {
    if (out_of_budget() || consider_stepping(path)) break;
  }
  return {};
}

Result<void> PlanSearch::grow(Kind kind) {
  Tree& tree = trees_[kind];
  if (!tree.search) {
    const PoseValidity valid = [this, kind](const Pose2& pose, double curvature_1_m) {
      return kind == kDriving ? can_drive(pose, curvature_1_m) : can_step(pose, curvature_1_m);
    };
    tree.search = std::make_unique<Se2Search>(task_.start, task_.goal, search_settings_, valid,
                                              settings_.seed + kSeedStride * num_trees_++);
    tree.wanted_m = std::numeric_limits<double>::infinity();
  }
  const int end = tree.search->iterations() + kSliceIterations;
  const auto stop = [&] { return tree.search->iterations() >= end || out_of_budget(); };
  auto path = tree.search->find_cheaper_than(
      std::min(tree.wanted_m, best_ ? best_->cost : std::numeric_limits<double>::infinity()), stop);
  if (!path) return tl::unexpected<Error>(path.error());
  bool sound = true;
  if (*path) {
    tree.wanted_m = kWorthwhileShare * tree.search->best_cost_m();
    const PoseValidity valid = [this, kind](const Pose2& pose, double curvature_1_m) {
      return kind == kDriving ? can_drive(pose, curvature_1_m) : can_step(pose, curvature_1_m);
    };
    const DrivePath shorter = shorten_path(**path, search_settings_, valid);
    sound = kind == kDriving ? consider_driving(shorter) : consider_stepping(shorter);
  } else if (kind == kStepping && !best_ && std::isinf(tree.wanted_m) &&
             tree.search->iterations() >= kUnluckyIterations) {
    // Headings may be what keeps the tree from the goal.
    if (tree.num_rejections < kAlignedRejections) tree.num_rejections = kAlignedRejections;
  }
  if (!sound) {
    tree.iterations_before += tree.search->iterations();
    tree.search.reset();
  }
  return {};
}

void PlanSearch::grow_certified_tree() {
  if (!certified_tree_) {
    certified_tree_ =
        std::make_unique<CertifiedTree>(*certifier_, task_.start, task_.goal, search_settings_,
                                        settings_.seed + kSeedStride * num_trees_++);
  }
  std::optional<CertifiedSequence> sequence = certified_tree_->grow();
  if (sequence && !consider_sequence(*std::move(sequence))) certified_tree_.reset();
}

Result<Plan> PlanSearch::run() {
  lower_bound_m_ =
      path_length_m(reeds_shepp_path(task_.start, task_.goal, search_settings_.turning_radius_m));
  if (auto tried = try_given_paths(); !tried) return tl::unexpected<Error>(tried.error());
  if (aids_.other_paths && !(best_ && aids_.first_will_do)) {
    if (auto tried = try_direct_paths(); !tried) return tl::unexpected<Error>(tried.error());
  }
  while (aids_.other_paths && !out_of_budget()) {
    if (auto grown = grow(kDriving); !grown) return tl::unexpected<Error>(grown.error());
    if (!certifier_ || out_of_budget()) continue;
    if (auto grown = grow(kStepping); !grown) return tl::unexpected<Error>(grown.error());
    if (settings_.ablation.certified_tree && !best_ &&
        trees_[kStepping].num_rejections >= kTreeRejections && !out_of_budget()) {
      grow_certified_tree();
    }
  }
  if (best_) return finished();
  char effort[96];
  std::snprintf(effort, sizeof effort, "%.2f s of computing and %d iterations", elapsed_s(),
                iterations());
  return fail(ErrorCode::kNoPlan,
              "no plan from start to goal in " + std::string(effort) + "; " + census_.sentence());
}

// Makes the path a plan and keeps it if it is the best so far. False if the machine cannot follow
// it; the place is then blocked for later trees.
bool PlanSearch::consider_driving(const DrivePath& path) {
  const double cost_m = path_cost_m(path, search_settings_.cost);
  if (best_ && cost_m >= best_->cost) return true;
  const std::vector<Station> stations = path_stations(path, settings_.subnode_spacing_m);
  auto nodes = whole_body_nodes(check_, machine_, path, stations);
  if (!nodes) {
    reject(kDriving, stations[nodes.error().station].pose,
           describe(nodes.error().pose, terrain_.map_origin_m()));
    return false;
  }
  assign_times(
      machine_, stations,
      {.nominal_speed_m_s = settings_.nominal_speed_m_s, .rate_fraction = settings_.rate_fraction},
      *nodes);
  Plan plan;
  plan.nodes = *std::move(nodes);
  plan.path_length_m = path_length_m(path);
  plan.cost = cost_m;
  plan.task = task_;
  const PlanVerdict verdict = verify_plan(terrain_, machine_, plan, settings_);
  if (!verdict.ok) {
    reject(kDriving, stations[verdict.node].pose, verdict.violation);
    return false;
  }
  plan.min_stability_margin_m = verdict.min_stability_margin_m;
  return keep(std::move(plan), path, std::nullopt);
}

bool PlanSearch::consider_stepping(const DrivePath& path) {
  if (best_ && path_cost_m(path, search_settings_.cost) >= best_->cost) return true;
  std::optional<Plan> plan;
  auto sequence =
      certifier_->certify(path, standing_at_start_, [&](const CertifiedSequence& candidate) {
        return out_of_budget() ? std::nullopt : objection_to(candidate, plan);
      });
  if (!sequence) {
    reject(kStepping, sequence.error().where, sequence.error().why);
    return false;
  }
  return !plan || keep(*std::move(plan), path, *std::move(sequence));
}

bool PlanSearch::consider_sequence(CertifiedSequence sequence) {
  std::optional<Plan> plan;
  if (const auto objection = objection_to(sequence, plan)) {
    reject(kStepping, sequence.stations[sequence.states[objection->state].station].pose,
           objection->why);
    return false;
  }
  return !plan || keep(*std::move(plan), DrivePath(sequence.path), std::move(sequence));
}

// What keeps a sequence from being a verified plan. No plan is made of one that costs too much.
std::optional<Objection> PlanSearch::objection_to(const CertifiedSequence& sequence,
                                                  std::optional<Plan>& plan) const {
  if (best_ && sequence.cost >= best_->cost) return std::nullopt;
  auto nodes = motion_->nodes(sequence);
  if (!nodes) return Objection{nodes.error().state, nodes.error().why, nodes.error().arm};
  Plan made;
  made.nodes = *std::move(nodes);
  made.path_length_m = path_length_m(sequence.path);
  made.cost = sequence.cost;
  made.task = task_;
  const PlanVerdict verdict = verify_plan(terrain_, machine_, made, settings_);
  if (!verdict.ok) {
    return Objection{state_like(sequence, made.nodes[verdict.node]), verdict.violation};
  }
  made.min_stability_margin_m = verdict.min_stability_margin_m;
  plan = std::move(made);
  return std::nullopt;
}

bool PlanSearch::keep(Plan plan, const DrivePath& path, std::optional<CertifiedSequence> sequence) {
  plan.seed = settings_.seed;
  plan.first_solution_time_s = best_ ? best_->first_solution_time_s : elapsed_s();
  best_ = std::move(plan);
  best_sequence_ = std::move(sequence);
  paths_.push_back(path);
  improved_s_ = elapsed_s();
  if (observer_) observer_({elapsed_s(), best_->cost, &*best_});
  return true;
}

void PlanSearch::reject(Kind kind, const Pose2& where, const std::string& why) {
  census_.add({where, why, kind == kStepping});
  Tree& tree = trees_[kind];
  ++tree.num_rejections;
  if (!settings_.ablation.blocking) return;
  double radius_m = kBlockRadiusM;
  for (const Pose2& end : {task_.start, task_.goal}) {
    radius_m = std::min(radius_m, 0.9 * std::hypot(where.x_m - end.x_m, where.y_m - end.y_m));
  }
  tree.blocks.push_back({where, radius_m});
}

Plan PlanSearch::finished() {
  best_->iterations = iterations();
  best_->total_time_s = elapsed_s();
  return *std::move(best_);
}

}  // namespace wex
