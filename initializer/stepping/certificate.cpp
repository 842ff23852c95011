#include "initializer/stepping/certificate.hpp"

#include <algorithm>
#include <cmath>

#include "initializer/stepping/layered_graph.hpp"
#include "initializer/stepping/path_layers.hpp"
#include "initializer/stepping/stance_check.hpp"
#include "initializer/stepping/stance_projection.hpp"

namespace wex {

struct Certifier::Impl {
  Impl(const TerrainMap& terrain, std::shared_ptr<const StanceTables> made,
       const PlanSettings& plan_settings, const CertificateSettings& certificate_settings)
      : shared_tables(std::move(made)),
        tables(*shared_tables),
        ground(terrain),
        check(ground, tables),
        plan(plan_settings),
        settings(certificate_settings) {}

  const std::shared_ptr<const StanceTables> shared_tables;
  const StanceTables& tables;
  const StanceGround ground;
  const StanceCheck check;
  const PlanSettings plan;
  const CertificateSettings settings;

  [[nodiscard]] Result<CertifiedSequence, CertificateFailure> certify(
      const DrivePath& path, bool or_furthest, const std::optional<BaseCoordinates>& begin,
      const SequenceJudge& judge) const;
  [[nodiscard]] Result<CertifiedSequence, CertificateFailure> accepted(
      const DrivePath& path, const PathGrid& grid, LayeredGraph& graph, LayeredGraph::Answer answer,
      bool from_nominal, const SequenceJudge& judge) const;
  [[nodiscard]] CertifiedSequence sequence_of(const DrivePath& path, PathGrid grid,
                                              const LayeredGraph::Answer& answer) const;
};

namespace {

constexpr int kMaxObjections = 12;

/// Exact joints for a table posture, whose place is up to half a cell away: the attitude gives way
/// first, then the telescope.
std::optional<ArmPosture> exact_posture(const ArmPlane& plane, const ArmPlane::InPlane& place,
                                        const ArmTable::Posture& near) {
  constexpr double kAttitudeStep = 0.05, kTelescopeStep = 0.05;
  constexpr int kSteps = 3;
  for (int t = 0; t <= 2 * kSteps; ++t) {
    const double tele = near.tele_m + kTelescopeStep * ((t + 1) / 2) * (t % 2 == 0 ? 1 : -1);
    for (int a = 0; a <= 2 * kSteps; ++a) {
      const double attitude =
          near.attitude_rad + kAttitudeStep * ((a + 1) / 2) * (a % 2 == 0 ? 1 : -1);
      if (auto posture = plane.reach(place.contact, tele, attitude)) {
        posture->turn_rad = wrap_angle(place.turn_rad);
        return posture;
      }
    }
  }
  return std::nullopt;
}

}  // namespace

CertifiedSequence Certifier::Impl::sequence_of(const DrivePath& path, PathGrid grid,
                                               const LayeredGraph::Answer& answer) const {
  CertifiedSequence sequence;
  sequence.path = path;
  sequence.cost = answer.cost;
  sequence.min_margin_m = std::numeric_limits<double>::infinity();
  const StanceClearances plain{plan.min_signed_distance_m, StanceClearances{}.swing_m,
                               plan.belly_clearance_m};
  for (const GraphState& from : answer.states) {
    const PathLayer& layer = grid.layers[from.layer];
    SteppingState state;
    state.station = from.layer;
    state.base = grid.base(layer, from.z, from.pitch);
    state.support = {kSupportClasses[from.support_class].lifted, from.bucket};
    const BaseFrame base = BaseFrame::from(state.base);
    const Stance stance = check.stance(base, check.steering(layer.curvature_1_m), plain);
    if (from.bucket >= 0) {
      const Eigen::Vector3d& point = grid.bucket_points[static_cast<std::size_t>(from.bucket)];
      const auto on_bucket =
          check.margin_on_bucket(base, stance, state.support.lifted, point, 1e9, -2.0);
      state.margin_m = on_bucket.margin_m;
      const ArmPlane& plane = tables.arm.plane();
      const auto place =
          plane.in_plane(base.R_world_base.transpose() * (point - base.p_world_base));
      if (const auto posture = exact_posture(plane, *place, *on_bucket.posture))
        state.arm = *posture;
    } else if (state.support.lifted != 0) {
      const auto balanced = check.margin_with_counter_weight(base, stance, state.support.lifted);
      state.margin_m = balanced.margin_m;
      state.arm = tables.counter_weights[static_cast<std::size_t>(balanced.counter_weight)].posture;
    } else {
      state.margin_m = check.margin_on_wheels(base, stance);
    }
    sequence.min_margin_m = std::min(sequence.min_margin_m, state.margin_m);
    sequence.states.push_back(state);
  }
  const std::size_t num_stations = sequence.states.back().station + 1;
  if (num_stations < grid.stations.size()) {
    // A prefix: the path ends at its last station.
    double rest_m = grid.stations[num_stations - 1].s_m;
    sequence.path.clear();
    for (PathSegment segment : path) {
      const double length_m = std::min(std::abs(segment.length_m), rest_m);
      rest_m -= length_m;
      segment.length_m = std::copysign(length_m, segment.length_m);
      sequence.path.push_back(segment);
      if (rest_m <= 0.0) break;
    }
    grid.stations.resize(num_stations);
    grid.stations.back().stop = true;
  }
  sequence.stations = std::move(grid.stations);
  sequence.bucket_points = std::move(grid.bucket_points);
  return sequence;
}

Result<CertifiedSequence, CertificateFailure> Certifier::Impl::certify(
    const DrivePath& path, bool or_furthest, const std::optional<BaseCoordinates>& begin,
    const SequenceJudge& judge) const {
  WEX_EXPECTS(!path.empty());
  constexpr double kFineReachM = 0.8;
  PathGrid grid = PathGrid::of(check, path, plan, settings, begin);
  LayeredGraph graph(check, grid, plan, settings);
  LayeredGraph::Answer answer = graph.search(!begin.has_value(), or_furthest);
  if (answer.states.empty() || answer.hopeless) {
    const PathLayer& layer = grid.layers[answer.furthest_layer];
    CertificateFailure failure{answer.furthest_layer, layer.pose,
                               graph.why_not_beyond(answer.furthest_layer)};
    if (answer.hopeless && !or_furthest) {
      // The place to stand astride may lie between two stations.
      const double s_m = grid.stations[answer.furthest_layer].s_m;
      PathGrid fine =
          PathGrid::of(check, path, plan, settings, begin, {s_m - kFineReachM, s_m + kFineReachM});
      LayeredGraph closer(check, fine, plan, settings);
      LayeredGraph::Answer second = closer.search(!begin.has_value(), false);
      if (!second.states.empty()) {
        return accepted(path, fine, closer, std::move(second), !begin.has_value(), judge);
      }
    }
    if (answer.states.empty()) return tl::unexpected<CertificateFailure>(std::move(failure));
  }
  return accepted(path, grid, graph, std::move(answer), !begin.has_value(), judge);
}

// What the judge objects to is banned from the graph, which keeps all else it has found out.
Result<CertifiedSequence, CertificateFailure> Certifier::Impl::accepted(
    const DrivePath& path, const PathGrid& grid, LayeredGraph& graph, LayeredGraph::Answer answer,
    bool from_nominal, const SequenceJudge& judge) const {
  CertificateFailure failure;
  for (int objections = 0; objections <= kMaxObjections; ++objections) {
    if (answer.states.empty()) break;
    CertifiedSequence sequence = sequence_of(path, grid, answer);
    const std::optional<Objection> objection = judge ? judge(sequence) : std::nullopt;
    if (!objection) return sequence;
    const GraphState& state = answer.states[objection->state];
    if (objections == 0) {
      failure = {state.layer, grid.layers[state.layer].pose, objection->why};
    }
    graph.ban(state, objection->bucket);
    answer = graph.search(from_nominal, false);
  }
  return tl::unexpected<CertificateFailure>(std::move(failure));
}

Certifier::Certifier(const TerrainMap& terrain, std::shared_ptr<const StanceTables> tables,
                     const PlanSettings& settings, const CertificateSettings& certificate)
    : impl_(std::make_unique<Impl>(terrain, std::move(tables), settings, certificate)) {}
Certifier::~Certifier() = default;
Certifier::Certifier(Certifier&&) noexcept = default;

Result<Certifier> Certifier::build(const TerrainMap& terrain, const MachineModel& machine,
                                   const PlanSettings& settings,
                                   const CertificateSettings& certificate) {
  auto tables = StanceTables::build(machine);
  if (!tables) return tl::unexpected<Error>(tables.error());
  return Certifier(terrain, std::make_shared<const StanceTables>(*std::move(tables)), settings,
                   certificate);
}

Result<CertifiedSequence, CertificateFailure> Certifier::certify(
    const DrivePath& path, const std::optional<BaseCoordinates>& begin,
    const SequenceJudge& judge) const {
  return impl_->certify(path, false, begin, judge);
}

std::optional<CertifiedSequence> Certifier::certify_prefix(
    const DrivePath& path, double min_progress_m,
    const std::optional<BaseCoordinates>& begin) const {
  auto sequence = impl_->certify(path, true, begin, {});
  if (!sequence || sequence->stations.back().s_m <= min_progress_m) return std::nullopt;
  return *std::move(sequence);
}

Certifier::Admission Certifier::admits(const Pose2& pose, double curvature_1_m) const noexcept {
  return project_stance(impl_->check, impl_->plan, impl_->settings, pose, curvature_1_m);
}

}  // namespace wex
