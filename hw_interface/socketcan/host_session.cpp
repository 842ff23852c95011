#include "hw_interface/socketcan/host_session.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace wex::can {
namespace {

constexpr double kTimeTolerance_s = 1e-6;
constexpr double kRestRate = 1e-3;  ///< rad/s: nothing is asked of a wheel
constexpr double kBrakeRate_rad_s =
    0.1;  ///< below it the machine's brake takes over from the latch
constexpr int kPeriodsPerHeartbeat = 2;
constexpr int kStopBurst = 3;
constexpr std::int64_t kRecordAfterFault_ns = 1'000'000'000;

JointLoopSettings joint_loop_settings(const MachineModel& machine, const HostSettings& settings) {
  JointLoopSettings loop;
  loop.period_s = settings.period_s;
  loop.dead_band = machine.valve_dead_band;
  loop.load_balance = settings.load_balance;
  return loop;
}

bool latched(HostPhase phase) noexcept {
  return phase == HostPhase::kFault || phase == HostPhase::kEStop;
}

}  // namespace

HostSession::HostSession(FramePort& port, const MachineModel& machine, HostFeedback feedback,
                         const HostSettings& settings)
    : machine_(machine),
      settings_(settings),
      feedback_(std::move(feedback)),
      link_(port, settings.link),
      loop_(machine_, joint_loop_settings(machine_, settings)),
      limits_(machine_, settings.limits),
      random_(std::random_device{}()) {}

void HostSession::receive(std::int64_t now_ns) noexcept {
  now_ns_ = now_ns;
  link_.receive(feedback_, now_ns);
}

HostInputs HostSession::inputs() noexcept {
  HostInputs in;
  in.now_s = now_s();
  in.complete = feedback_.complete();
  in.dbc_matches = feedback_.dbc_matches();
  in.feedback_age_s = feedback_.feedback_age_s(now_ns_);
  in.status_age_s = feedback_.status_age_s(now_ns_);
  in.estop_age_s = feedback_.estop_age_s(now_ns_);
  in.mode = feedback_.mode();
  in.session = feedback_.session();
  in.challenge = feedback_.challenge();
  in.estop_open = feedback_.estop_open();
  in.operator_stopped = feedback_.operator_stopped();
  in.stop = stopped_;
  in.bus_stalled = link_.stalled();
  in.bus_off_reported = link_.bus_off_reported(now_ns_);
  in.overflowed = link_.overflowed(now_ns_);
  in.neutral_sent = std::exchange(neutral_sent_, false);
  in.enable = std::exchange(enable_, false);
  in.disable = std::exchange(disable_, false);
  in.operator_reset = feedback_.take_operator_reset();
  in.masquerade = feedback_.take_masquerade();
  in.crc_fault = feedback_.take_crc_fault();
  in.restarted = feedback_.take_restart();
  const bool link_lost = link_.take_lost();
  in.interface_lost = std::exchange(lock_step_lost_, false) || link_lost;
  constexpr unsigned kNonces = 0xFFFF;  // 0 means "none" on the bus
  in.nonce = static_cast<std::uint16_t>(1U + static_cast<unsigned>(random_()) % kNonces);
  return in;
}

void HostSession::follow_phase(const HostState& before, const HostInputs& in) noexcept {
  BusStatistics& statistics = link_.statistics();
  const HostPhase phase = automaton_.phase;
  if (phase == HostPhase::kActive || phase == HostPhase::kHold) {
    statistics.max_feedback_age_s = std::max(statistics.max_feedback_age_s, in.feedback_age_s);
    statistics.max_status_age_s = std::max(statistics.max_status_age_s, in.status_age_s);
  }
  statistics.holds = automaton_.holds;
  statistics.rates_limited = limits_.rates_limited();
  if (phase == before.phase) return;

  has_command_ = false;  // what moved the machine before does not move it after a change
  if (latched(phase)) {
    link_.mailbox().clear();
    freeze_at_ns_ = now_ns_ + kRecordAfterFault_ns;
  } else if (latched(before.phase)) {
    freeze_at_ns_.reset();
    link_.recorder().thaw();
  }
  if (phase == HostPhase::kFault) {
    ++statistics.faults;
    stop_burst_ = kStopBurst;
  }
}

void HostSession::cycle(std::int64_t now_ns) noexcept {
  receive(now_ns);
  const HostInputs in = inputs();
  const HostState before = automaton_;
  automaton_ = advance(before, in, settings_.times);
  follow_phase(before, in);
  const HostOutputs out = outputs_of(automaton_, in);

  if (has_command_ && in.now_s > command_.valid_until_s + kTimeTolerance_s) {
    has_command_ = false;
    ++health_.expiries;
  }
  const bool live = out.live && has_command_;
  const JointMeasurement measured = feedback_.measurement();
  if (!out.live) loop_.stand_still();  // the machine holds by itself and starts from rest
  ActuatorCommand wanted = loop_.update(live ? &command_ : nullptr, measured);
  if (out.silent) {
    limits_.stand_still();
    link_.restart_controller(now_ns_);
  } else {
    put_stop(out.send_stop);
    put_heartbeat(out);
    put_commands(out, live, wanted, measured);
    link_.send(now_ns_);
  }
  link_.end_cycle(now_ns_);
  if (freeze_at_ns_ && now_ns_ >= *freeze_at_ns_) link_.recorder().freeze();
  ++cycles_;
}

template <typename Message>
void HostSession::put(int slot, const Message& message, std::uint32_t session) noexcept {
  // A value that the codec refuses is not sent: the machine's time-outs see a missing frame.
  if (!link_.mailbox().put(slot, message, session)) ++link_.statistics().refused_by_codec;
}

void HostSession::put_stop(bool active) noexcept {
  if (stop_was_active_ && !active) release_burst_ = kStopBurst;
  stop_was_active_ = active;
  if (!active && release_burst_ == 0) return;
  if (!active) --release_burst_;
  const HostStop message{active, static_cast<std::uint8_t>(automaton_.cause)};
  put(HostMailbox::kStop, message, 0);
  for (; active && stop_burst_ > 1; --stop_burst_) {
    link_.send(now_ns_);
    put(HostMailbox::kStop, message, 0);
  }
  stop_burst_ = 0;
}

void HostSession::put_heartbeat(const HostOutputs& out) noexcept {
  // At its rate, and at once when the handshake goes on.
  const bool changed = out.request != heartbeat_.request ||
                       out.challenge_echo != heartbeat_.challenge_echo ||
                       out.session != heartbeat_.session;
  if (!changed && cycles_ % kPeriodsPerHeartbeat != 0) return;
  heartbeat_ = {out.session, out.request, out.nonce, out.challenge_echo, dbc_hash()};
  put(HostMailbox::kHeartbeat, heartbeat_, 0);
}

void HostSession::put_commands(const HostOutputs& out, bool live, ActuatorCommand& wanted,
                               const JointMeasurement& measured) noexcept {
  if (!out.live) limits_.stand_still();
  if (!out.send_commands) return;
  std::array<ZoneCommand, kNumZones> zones{};
  for (int zone = 0; zone < kNumZones; ++zone) {
    zones[zone].zone = zone;
    zones[zone].echo_time_ms = feedback_.zone_stamp_ms(zone);
    zones[zone].valid_for_ms =
        static_cast<std::uint8_t>(std::lround(1e3 * settings_.command_valid_s));
  }
  bool neutral = true;
  if (out.live) {
    limits_.limit_rates(wanted.rate, measured.position);
    for (int i = 0; i < machine_.num_joints(); ++i) {
      const auto [zone, index] = feedback_.slot(i);
      const bool is_wheel = machine_.joints[i].role == JointRole::kWheel;
      const double asked = live ? std::abs(command_.rate[i]) : 0.0;
      // A wheel of which nothing is asked is left to the machine's brake, a cylinder to its valve.
      const bool active = (live && !is_wheel) || asked >= kRestRate ||
                          std::abs(wanted.rate[i]) >= (is_wheel ? kBrakeRate_rad_s : kRestRate);
      zones[zone].active[index] = active;
      zones[zone].rate[index] = active ? wanted.rate[i] : 0.0;
      neutral = neutral && !active;
    }
  }
  for (int zone = 0; zone < kNumZones; ++zone) {
    put(HostMailbox::kCommand + zone, zones[zone], out.session);
  }
  neutral_sent_ = neutral;
}

void HostSession::send_lock_step(std::uint32_t until_ms) noexcept {
  put(HostMailbox::kStep, LockStep{until_ms}, 0);
  link_.send(now_ns_);
}

WriteOutcome HostSession::judge(const JointCommand& wanted) noexcept {
  if (stopped_) return WriteOutcome::kRejectedStopped;
  if (wanted.num_joints != machine_.num_joints()) return WriteOutcome::kRejectedWrongSize;
  JointCommand within = wanted;
  const LimitOutcome limited = limits_.check(within, feedback_.measurement().position);
  if (limited == LimitOutcome::kRejectedNotFinite || limited == LimitOutcome::kRejectedRange) {
    has_command_ = false;
    return limited == LimitOutcome::kRejectedNotFinite ? WriteOutcome::kRejectedNotFinite
                                                       : WriteOutcome::kRejectedRange;
  }
  if (automaton_.phase == HostPhase::kHold) {
    switch (automaton_.cause) {
      case HostCause::kBusStalled:
        return WriteOutcome::kBusStalled;
      case HostCause::kStaleFeedback:
      case HostCause::kStaleStatus:
      case HostCause::kReceiveOverflow:
        return WriteOutcome::kRejectedStale;
      default:
        return WriteOutcome::kRejectedNotActive;
    }
  }
  if (automaton_.phase != HostPhase::kActive) return WriteOutcome::kRejectedNotActive;
  if (!(feedback_.feedback_age_s(now_ns_) < settings_.times.hold_after_s)) {
    return WriteOutcome::kRejectedStale;
  }
  if (wanted.valid_until_s < now_s()) return WriteOutcome::kRejectedExpired;
  command_ = within;
  has_command_ = true;
  return limited == LimitOutcome::kClamped ? WriteOutcome::kClamped : WriteOutcome::kAccepted;
}

WriteOutcome HostSession::write(const JointCommand& command) noexcept {
  const WriteOutcome outcome = judge(command);
  ++(taken(outcome) ? health_.commands_accepted : health_.commands_rejected);
  if (outcome == WriteOutcome::kClamped) ++health_.commands_clamped;
  return outcome;
}

void HostSession::stop() noexcept {
  has_command_ = false;
  if (std::exchange(stopped_, true)) return;
  stop_burst_ = kStopBurst;
  put_stop(true);
  link_.send(now_ns_);
}

MachineState HostSession::state() const noexcept {
  MachineState state = feedback_.state(now_ns_);
  for (int i = 0; i < state.num_joints; ++i) state.position[i] -= loop_.offset_of_joint_rad(i);
  return state;
}

MachineHealth HostSession::health() const noexcept {
  MachineHealth health = health_;
  health.stall_stops = loop_.stall_stops();
  health.holds = automaton_.holds;
  health.degraded = link_.degraded(now_ns_);
  const bool moving =
      automaton_.phase == HostPhase::kActive && has_command_ && !stopped_ && !loop_.stalled();
  health.level = latched(automaton_.phase) ? HealthLevel::kFault
                 : moving                  ? HealthLevel::kOk
                                           : HealthLevel::kHolding;
  return health;
}

bool HostSession::stands(double standing_rate) const noexcept {
  const JointMeasurement measured = feedback_.measurement();
  return std::all_of(measured.rate.begin(), measured.rate.begin() + machine_.num_joints(),
                     [=](double rate) { return std::abs(rate) < standing_rate; });
}

}  // namespace wex::can
