#include "initializer/stepping/stepping_motion.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "initializer/stepping/internal/motion_builder.hpp"

namespace wex {

struct SteppingMotion::Impl {
  MotionParts parts;
};

SteppingMotion::SteppingMotion(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SteppingMotion::~SteppingMotion() = default;
SteppingMotion::SteppingMotion(SteppingMotion&&) noexcept = default;

Result<SteppingMotion> SteppingMotion::build(const TerrainMap& terrain, const MachineModel& machine,
                                             const PlanSettings& settings,
                                             const SteppingMotionSettings& motion) {
  auto legs = build_leg_tables(machine);
  if (!legs) return tl::unexpected<Error>(legs.error());
  return build(terrain, machine, settings, *std::move(legs), motion);
}

Result<SteppingMotion> SteppingMotion::build(const TerrainMap& terrain, const MachineModel& machine,
                                             const PlanSettings& settings,
                                             std::array<LegTable, kNumWheels> legs,
                                             const SteppingMotionSettings& motion) {
  auto arm = ArmKinematics::build(machine);
  if (!arm) return tl::unexpected<Error>(arm.error());
  return SteppingMotion(std::make_unique<Impl>(Impl{
      {terrain, machine, settings, motion, WheelPlacer(terrain, machine, settings, std::move(legs)),
       *std::move(arm), CollisionModel::build(machine)}}));
}

Result<std::vector<WholeBodyNode>, MotionFailure> SteppingMotion::nodes(
    const CertifiedSequence& sequence) const {
  WEX_EXPECTS(!sequence.states.empty() && sequence.states.front().support == Support{} &&
              sequence.states.back().support == Support{});
  // Steering is smoothed as far as the wheels find ground: turned less or more they stand
  // elsewhere.
  Result<std::vector<MotionNode>, MotionFailure> built = std::vector<MotionNode>();
  for (const double share : {1.0, 0.5, 0.2}) {
    MotionBuilder builder(impl_->parts, sequence, share * impl_->parts.motion.steering_window_m);
    built = builder.build();
    if (built || !builder.missed_ground()) break;
  }
  if (!built) return tl::unexpected<MotionFailure>(built.error());
  std::vector<MotionNode>& nodes = *built;
  const MachineModel& machine = impl_->parts.machine;
  turn_wheels(machine, nodes);
  constexpr double kRoundingM = 2e-3;  // margins were judged before nodes were put between knots
  if (const auto fault = find_fault(impl_->parts.terrain, impl_->parts.placer.ground(), machine,
                                    impl_->parts.collision, nodes,
                                    impl_->parts.settings.min_stability_margin_m - kRoundingM,
                                    impl_->parts.motion.swing_clearance_m)) {
    return tl::unexpected<MotionFailure>({nodes[fault->node].state, fault->why});
  }
  const std::vector<double> t_s = node_times_s(
      machine, nodes,
      {impl_->parts.motion.rate_fraction, impl_->parts.motion.max_base_acceleration_m_s2});
  std::vector<WholeBodyNode> result(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    result[i] = {t_s[i], std::move(nodes[i].q), nodes[i].contacts};
  }
  return result;
}

Result<std::vector<WholeBodyNode>, MotionFailure> stepping_motion(
    const TerrainMap& terrain, const MachineModel& machine, const PlanSettings& settings,
    const CertifiedSequence& sequence, const SteppingMotionSettings& motion) {
  const auto steps = SteppingMotion::build(terrain, machine, settings, motion);
  if (!steps) return tl::unexpected<MotionFailure>({0, steps.error().message});
  return steps->nodes(sequence);
}

}  // namespace wex
