#include "hw_interface/replay/replay_machine.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "hw_interface/joint_loop.hpp"
#include "hw_interface/socketcan/candump_log.hpp"
#include "hw_interface/socketcan/host_feedback.hpp"
#include "hw_interface/socketcan/host_limits.hpp"

namespace wex {
namespace {

using can::MessageKind;

constexpr double kTimeTolerance_s = 1e-6;
constexpr double kResolution = 1.0001e-4;  ///< rad/s or m/s: one step of a rate on the bus
constexpr double kStale_s = 0.03;

bool is_host_frame(const can::CanFrame& frame) {
  switch (can::kind_of(frame)) {
    case MessageKind::kHostStop:
    case MessageKind::kHostHeartbeat:
    case MessageKind::kZoneCommand:
    case MessageKind::kLockStep:
      return !frame.error;
    default:
      return false;
  }
}

/// Machine time of a frame that carries one.
std::optional<std::uint32_t> stamp_of(const can::CanFrame& frame) {
  can::ZoneFeedback feedback;
  can::Imu imu;
  can::BasePose pose;
  if (can::decode(frame, 0, feedback)) return feedback.sample_time_ms;
  if (can::decode(frame, 0, imu)) return imu.sample_time_ms;
  if (can::decode(frame, 0, pose)) return pose.sample_time_ms;
  return std::nullopt;
}

JointLoopSettings joint_loop_settings(const MachineModel& machine) {
  JointLoopSettings loop;
  loop.dead_band = machine.valve_dead_band;
  return loop;
}

}  // namespace

struct ReplayMachine::Impl {
  Impl(const MachineModel& machine_in, can::HostFeedback feedback_in,
       std::vector<can::LoggedFrame> frames_in)
      : machine(machine_in),
        feedback(std::move(feedback_in)),
        frames(std::move(frames_in)),
        loop(machine, joint_loop_settings(machine)),
        limits(machine) {
    // The machine's own stamps are the only clock, so that a replay depends on nothing else.
    feedback.clock().set_mode(can::HostClock::Mode::kLockStep, 0);
  }

  bool finished() const noexcept { return next == frames.size(); }
  double heard_s() const noexcept { return feedback.now_s(0); }
  double now_s() const noexcept { return heard_s() + after_end_s; }

  /// The cycle of the host that begins with this ZoneCommand of the first zone.
  void compute_cycle() noexcept {
    if (has_command && now_s() > command.valid_until_s + kTimeTolerance_s) {
      has_command = false;
      ++health.expiries;
    }
    const bool enabled = feedback.mode() == can::MachineMode::kEnabled;
    const bool live = has_command && enabled;
    const JointMeasurement measured = feedback.measurement();
    if (!enabled) loop.stand_still();
    rates = loop.update(live ? &command : nullptr, measured).rate;
    if (enabled) {
      limits.limit_rates(rates, measured.position);
    } else {
      limits.stand_still();
      rates.fill(0.0);
    }
  }

  void compare(const can::CanFrame& frame) noexcept {
    const int zone = can::zone_of(frame);
    if (zone == 0) compute_cycle();
    can::ZoneCommand recorded;
    if (!can::decode(frame, feedback.status(zone).session, recorded)) {
      ++report.commands_unreadable;
      return;
    }
    ++report.commands_compared;
    bool differs = false;
    for (int i = 0; i < machine.num_joints(); ++i) {
      const auto [joint_zone, index] = feedback.slot(i);
      if (joint_zone != zone || !recorded.active[index]) continue;
      const double difference = std::abs(recorded.rate[index] - rates[i]);
      differs = differs || difference > kResolution;
      if (difference > report.max_rate_difference) {
        report.max_rate_difference = difference;
        worst_joint = i;
      }
    }
    if (differs) ++report.commands_differing;
  }

  void play_next() noexcept {
    const can::LoggedFrame& logged = frames[next++];
    ++report.frames;
    if (is_host_frame(logged.frame)) {
      if (can::kind_of(logged.frame) == MessageKind::kZoneCommand) compare(logged.frame);
      return;
    }
    // The time of arrival means nothing here: 0 for all.
    const can::FrameVerdict verdict = feedback.take(logged.frame, 0);
    if (verdict != can::FrameVerdict::kUsed && verdict != can::FrameVerdict::kError) {
      ++report.frames_refused;
    }
  }

  /// True while the log's next frame belongs to a moment up to t_s.
  bool next_belongs_to(double t_s) const noexcept {
    if (finished()) return false;
    if (heard_s() < t_s - kTimeTolerance_s) return true;
    const can::CanFrame& frame = frames[next].frame;
    if (is_host_frame(frame)) return false;
    const auto stamp = stamp_of(frame);
    return !stamp || feedback.clock().seconds_of(*stamp) <= t_s + kTimeTolerance_s;
  }

  WriteOutcome judge(const JointCommand& wanted) noexcept {
    if (stopped) return WriteOutcome::kRejectedStopped;
    if (wanted.num_joints != machine.num_joints()) return WriteOutcome::kRejectedWrongSize;
    JointCommand within = wanted;
    const can::LimitOutcome limited = limits.check(within, feedback.measurement().position);
    if (limited == can::LimitOutcome::kRejectedNotFinite ||
        limited == can::LimitOutcome::kRejectedRange) {
      has_command = false;
      return limited == can::LimitOutcome::kRejectedNotFinite ? WriteOutcome::kRejectedNotFinite
                                                              : WriteOutcome::kRejectedRange;
    }
    if (lifecycle() != Lifecycle::kActive) return WriteOutcome::kRejectedNotActive;
    if (wanted.valid_until_s < now_s()) return WriteOutcome::kRejectedExpired;
    command = within;
    has_command = true;
    return limited == can::LimitOutcome::kClamped ? WriteOutcome::kClamped
                                                  : WriteOutcome::kAccepted;
  }

  Lifecycle lifecycle() const noexcept {
    if (finished() || deactivated) return Lifecycle::kInactive;
    switch (feedback.mode()) {
      case can::MachineMode::kEnabled:
      case can::MachineMode::kHold:
        return Lifecycle::kActive;
      case can::MachineMode::kFault:
        return Lifecycle::kFault;
      case can::MachineMode::kEStop:
        return Lifecycle::kEStop;
      default:
        return feedback.complete() ? Lifecycle::kInactive : Lifecycle::kUnconfigured;
    }
  }

  MachineModel machine;
  can::HostFeedback feedback;
  std::vector<can::LoggedFrame> frames;
  std::size_t next = 0;
  JointLoop loop;
  can::HostLimits limits;
  std::array<double, kMaxJoints> rates{};
  JointCommand command;
  bool has_command = false, stopped = false, deactivated = false;
  double after_end_s = 0.0;  ///< how far the program has waited beyond the log
  int worst_joint = -1;
  MachineHealth health;
  ReplayReport report;
};

ReplayMachine::ReplayMachine(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ReplayMachine::~ReplayMachine() = default;

Result<std::unique_ptr<ReplayMachine>> ReplayMachine::open(const std::string& log_file,
                                                           const MachineModel& machine,
                                                           const Eigen::Vector2d& map_origin_m) {
  auto frames = can::read_candump_log(log_file);
  if (!frames) return tl::unexpected(frames.error());
  auto feedback = can::HostFeedback::create(machine, map_origin_m);
  if (!feedback) return tl::unexpected(feedback.error());
  auto impl = std::make_unique<Impl>(machine, std::move(*feedback), std::move(*frames));
  while (!impl->feedback.complete() && !impl->finished()) impl->play_next();
  if (!impl->feedback.complete()) {
    return fail(ErrorCode::kBadInput,
                "in the log '" + log_file +
                    "' not all of the machine is heard: it needs feedback and status of every "
                    "zone, the e-stop report and the base pose, as wex.dbc has them");
  }
  while (impl->next_belongs_to(impl->heard_s())) impl->play_next();
  return std::unique_ptr<ReplayMachine>(new ReplayMachine(std::move(impl)));
}

MachineState ReplayMachine::read() noexcept {
  MachineState state = impl_->feedback.state(0);
  state.age_s += impl_->after_end_s;
  for (int i = 0; i < state.num_joints; ++i) {
    state.position[i] -= impl_->loop.offset_of_joint_rad(i);
    state.joint_age_s[i] += impl_->after_end_s;
    if (state.joint_quality[i] == SignalQuality::kOk && state.joint_age_s[i] > kStale_s) {
      state.joint_quality[i] = SignalQuality::kStale;
    }
  }
  return state;
}

WriteOutcome ReplayMachine::write(const JointCommand& command) noexcept {
  const WriteOutcome outcome = impl_->judge(command);
  MachineHealth& health = impl_->health;
  ++(taken(outcome) ? health.commands_accepted : health.commands_rejected);
  if (outcome == WriteOutcome::kClamped) ++health.commands_clamped;
  return outcome;
}

void ReplayMachine::stop() noexcept {
  impl_->stopped = true;
  impl_->has_command = false;
}

void ReplayMachine::release() noexcept { impl_->stopped = false; }

MachineHealth ReplayMachine::health() const noexcept {
  MachineHealth health = impl_->health;
  health.stall_stops = impl_->loop.stall_stops();
  health.degraded = impl_->report.frames_refused > 0;
  const Lifecycle lifecycle = impl_->lifecycle();
  const bool moving = impl_->has_command && !impl_->stopped && lifecycle == Lifecycle::kActive;
  health.level = lifecycle == Lifecycle::kFault || lifecycle == Lifecycle::kEStop
                     ? HealthLevel::kFault
                 : moving ? HealthLevel::kOk
                          : HealthLevel::kHolding;
  return health;
}

void ReplayMachine::wait_until(double t_s) {
  while (impl_->next_belongs_to(t_s)) impl_->play_next();
  if (impl_->finished()) impl_->after_end_s = std::max(0.0, t_s - impl_->heard_s());
}

Lifecycle ReplayMachine::lifecycle() const noexcept { return impl_->lifecycle(); }

Result<void> ReplayMachine::activate() {
  impl_->deactivated = false;
  while (impl_->lifecycle() != Lifecycle::kActive && !impl_->finished()) impl_->play_next();
  while (impl_->next_belongs_to(impl_->heard_s())) impl_->play_next();
  if (impl_->lifecycle() == Lifecycle::kActive) return {};
  return fail(ErrorCode::kStoppedSafely,
              "the machine of the log is not enabled any more from here to its end");
}

void ReplayMachine::deactivate() noexcept {
  impl_->has_command = false;
  impl_->deactivated = true;
}

bool ReplayMachine::finished() const noexcept { return impl_->finished(); }

ReplayReport ReplayMachine::report() const {
  ReplayReport report = impl_->report;
  if (impl_->worst_joint >= 0) report.worst_joint = impl_->machine.joints[impl_->worst_joint].name;
  return report;
}

}  // namespace wex
