#include "hw_interface/electronics/machine_automaton.hpp"

#include <algorithm>

namespace wex::can {

MachineAutomaton::MachineAutomaton(std::uint32_t dbc_hash, RandomSource& random,
                                   const AutomatonSettings& settings) noexcept
    : dbc_hash_(dbc_hash),
      random_(&random),
      settings_(settings),
      crc_errors_(settings.max_crc_errors + 1, settings.crc_window_ms),
      range_rejects_(kRejectsForFault, settings.reject_window_ms) {}

std::uint32_t MachineAutomaton::random_not_zero() noexcept {
  std::uint32_t value = random_->next();
  while (value == 0) value = random_->next();  // 0 means "none" on the bus
  return value;
}

void MachineAutomaton::forget_commands() noexcept { zones_.fill(Zone{}); }

void MachineAutomaton::enter(MachineMode mode) noexcept {
  if (mode == MachineMode::kHold) ++holds_;
  if (mode != MachineMode::kEnabled && mode != MachineMode::kHold) {
    challenge_ = 0;
    session_ = 0;
  }
  if (mode != MachineMode::kEnabled) forget_commands();
  mode_ = mode;
}

void MachineAutomaton::fault(std::uint16_t bit) noexcept {
  fault_bits_ |= bit;
  if (mode_ != MachineMode::kEStop) enter(MachineMode::kFault);
}

void MachineAutomaton::on_heartbeat(const HostHeartbeat& heartbeat, std::int64_t now_ms) noexcept {
  if (heartbeat.dbc_hash != dbc_hash_) return;
  // A host that has restarted, or one that is not ours, does not keep this session alive.
  if (in_session() && heartbeat.session != session_) return;
  heard_host_ = true;
  heartbeat_ms_ = now_ms;

  const bool asks = heartbeat.request == HostRequest::kEnable;
  const bool edge = asks && request_was_off_;
  request_was_off_ = !asks;
  if (heartbeat.request == HostRequest::kDisable &&
      (in_session() || mode_ == MachineMode::kEnabling)) {
    enter(MachineMode::kInit);
  } else if (mode_ == MachineMode::kReady && edge && heartbeat.nonce != 0) {
    enter(MachineMode::kEnabling);
    nonce_ = heartbeat.nonce;
    challenge_ = random_not_zero();
    challenge_ms_ = now_ms;
  } else if (mode_ == MachineMode::kEnabling) {
    const bool same_request = asks && heartbeat.nonce == nonce_;
    if (!same_request) {
      enter(MachineMode::kInit);
    } else if (challenge_ != 0 && heartbeat.challenge_echo != 0) {
      if (heartbeat.challenge_echo == challenge_ &&
          now_ms - challenge_ms_ <= settings_.echo_within_ms) {
        challenge_ = 0;
        session_ = random_not_zero();
        echo_ms_ = now_ms;
      } else {
        enter(MachineMode::kInit);
      }
    }
  }
}

void MachineAutomaton::on_host_stop(const HostStop& stop, std::int64_t now_ms) noexcept {
  host_stop_ = stop.active;
  host_stop_ms_ = now_ms;
}

void MachineAutomaton::on_operator(const OperatorCommand& command, std::int64_t now_ms) noexcept {
  // Stop counts by itself; reset needs a frame without action before it.
  const bool after_idle = operator_idle_ && now_ms - operator_ms_ <= settings_.operator_memory_ms;
  operator_stop_ = command.action == OperatorAction::kStop;
  reset_edge_ = reset_edge_ || (command.action == OperatorAction::kReset && after_idle);
  operator_idle_ = command.action == OperatorAction::kNone;
  operator_ms_ = now_ms;
}

void MachineAutomaton::on_good_command(int zone, bool neutral, std::int64_t now_ms) noexcept {
  Zone& sender = zones_[static_cast<std::size_t>(zone)];
  if (now_ms - sender.last_good_ms >= settings_.hold_after_ms) sender.good_in_a_row = 0;
  sender.last_good_ms = now_ms;
  sender.good_in_a_row = neutral ? sender.good_in_a_row + 1 : 0;
}

void MachineAutomaton::on_bad_command(int zone) noexcept {
  zones_[static_cast<std::size_t>(zone)].good_in_a_row = 0;
}

void MachineAutomaton::on_range_reject(std::int64_t now_ms) noexcept {
  if (!range_rejects_.add(now_ms)) return;
  last_bus_fault_ms_ = now_ms;
  fault(kFaultRangeRejects);
}

void MachineAutomaton::on_crc_error(std::int64_t now_ms) noexcept {
  if (!crc_errors_.add(now_ms)) return;
  last_bus_fault_ms_ = now_ms;
  fault(kFaultCrcErrors);
}

void MachineAutomaton::on_masquerade(std::int64_t now_ms) noexcept {
  last_bus_fault_ms_ = now_ms;
  fault(kFaultMasquerade);
}

bool MachineAutomaton::heartbeat_older_than(int age_ms, std::int64_t now_ms) const noexcept {
  return !heard_host_ || now_ms - heartbeat_ms_ > age_ms;
}

bool MachineAutomaton::commands_alive(std::int64_t now_ms) const noexcept {
  return std::all_of(zones_.begin(), zones_.end(), [&](const Zone& zone) {
    return now_ms - zone.last_good_ms < settings_.hold_after_ms;
  });
}

bool MachineAutomaton::bumpless() const noexcept {
  return std::all_of(zones_.begin(), zones_.end(),
                     [&](const Zone& zone) { return zone.good_in_a_row >= settings_.good_frames; });
}

void MachineAutomaton::step_enabling(const SelfCheck& check, std::int64_t now_ms) noexcept {
  const bool still_ready = check.sensors_valid && check.base_pose_valid && !host_stop_ &&
                           !heartbeat_older_than(settings_.heartbeat_hold_after_ms, now_ms);
  const bool in_time = session_ == 0 ? now_ms - challenge_ms_ <= settings_.echo_within_ms
                                     : now_ms - echo_ms_ <= settings_.enabling_within_ms;
  if (!still_ready || !in_time) {
    enter(MachineMode::kInit);
  } else if (session_ != 0 && bumpless() && commands_alive(now_ms)) {
    heartbeat_ms_ = now_ms;  // from now on only those of this session count
    enter(MachineMode::kEnabled);
  }
}

void MachineAutomaton::step_session(const SelfCheck& check, std::int64_t now_ms) noexcept {
  if (heartbeat_older_than(settings_.heartbeat_fault_after_ms, now_ms)) {
    fault(kFaultHeartbeatLost);
    return;
  }
  const bool may_move = check.base_pose_valid && !host_stop_ && commands_alive(now_ms) &&
                        !heartbeat_older_than(settings_.heartbeat_hold_after_ms, now_ms);
  if (mode_ == MachineMode::kEnabled && !may_move) {
    enter(MachineMode::kHold);
  } else if (mode_ == MachineMode::kHold && may_move && bumpless()) {
    enter(MachineMode::kEnabled);
  }
}

void MachineAutomaton::try_reset(const SelfCheck& check, std::int64_t now_ms) noexcept {
  const bool bus_is_quiet = now_ms - last_bus_fault_ms_ >= settings_.quiet_before_reset_ms;
  if (!reset_edge_ || check.estop_chain_open || operator_stop_ || !check.sensors_valid ||
      !bus_is_quiet) {
    return;
  }
  fault_bits_ = 0;
  crc_errors_.clear();
  range_rejects_.clear();
  enter(MachineMode::kInit);
}

void MachineAutomaton::step(const SelfCheck& check, std::int64_t now_ms) noexcept {
  if (host_stop_ && now_ms - host_stop_ms_ > settings_.heartbeat_hold_after_ms) host_stop_ = false;
  if (check.estop_chain_open || operator_stop_) {
    fault_bits_ |= check.estop_chain_open ? kFaultEStopChain : kFaultOperatorStop;
    if (mode_ != MachineMode::kEStop) enter(MachineMode::kEStop);
  } else if (in_session() && !check.sensors_valid) {
    fault(kFaultSensors);
  }

  switch (mode_) {
    case MachineMode::kInit:
    case MachineMode::kReady: {
      const bool ready = check.sensors_valid && check.base_pose_valid && check.valves_neutral &&
                         !heartbeat_older_than(settings_.heartbeat_hold_after_ms, now_ms);
      mode_ = ready ? MachineMode::kReady : MachineMode::kInit;
      break;
    }
    case MachineMode::kEnabling:
      step_enabling(check, now_ms);
      break;
    case MachineMode::kEnabled:
    case MachineMode::kHold:
      step_session(check, now_ms);
      break;
    case MachineMode::kFault:
    case MachineMode::kEStop:
      try_reset(check, now_ms);
      break;
  }
  reset_edge_ = false;
}

}  // namespace wex::can
