#include "hw_interface/socketcan/host_automaton.hpp"

namespace wex::can {
namespace {

/// Ages that are not numbers are too old as well. Stamps are whole milliseconds.
bool too_old(double age_s, double limit_s) noexcept {
  constexpr double kTolerance_s = 1e-6;
  return !(age_s < limit_s - kTolerance_s);
}

bool leads_to_motion(HostPhase phase) noexcept {
  return phase == HostPhase::kAsking || phase == HostPhase::kProving ||
         phase == HostPhase::kActive || phase == HostPhase::kHold;
}

/// Enters a phase; the session survives only where it may.
HostState enter(HostState state, HostPhase phase, HostCause cause, double now_s) noexcept {
  const bool keeps_session = phase == HostPhase::kActive || phase == HostPhase::kHold;
  if (!keeps_session) {
    if (state.session != 0) state.old_session = state.session;
    state.session = 0;
    state.challenge = 0;
    state.nonce = 0;
  }
  if (phase == HostPhase::kHold && cause != HostCause::kStopRequested) ++state.holds;
  state.phase = phase;
  state.cause = cause;
  state.since_s = now_s;
  state.neutral_frames = 0;
  return state;
}

/// kNone: nothing forces the machine to stand still for good.
HostCause fault_cause(const HostState& state, const HostInputs& in,
                      const HostTimes& times) noexcept {
  if (in.masquerade) return HostCause::kMasquerade;
  if (in.crc_fault) return HostCause::kCrcErrors;
  if (in.mode == MachineMode::kFault) return HostCause::kMachineFault;
  if (!leads_to_motion(state.phase)) return HostCause::kNone;
  if (in.interface_lost) return HostCause::kInterfaceLost;
  if (too_old(in.feedback_age_s, times.fault_after_s)) return HostCause::kLostFeedback;
  return HostCause::kNone;
}

/// kNone: the machine may move within its session.
HostCause hold_cause(const HostInputs& in, const HostTimes& times) noexcept {
  const bool stale = too_old(in.feedback_age_s, times.hold_after_s);
  // An error frame alone proves nothing: the bus must be silent as well.
  if (stale && in.bus_off_reported) return HostCause::kBusOff;
  if (stale) return HostCause::kStaleFeedback;
  if (in.bus_stalled) return HostCause::kBusStalled;
  if (in.overflowed) return HostCause::kReceiveOverflow;
  if (too_old(in.status_age_s, times.status_hold_after_s) ||
      too_old(in.estop_age_s, times.estop_hold_after_s)) {
    return HostCause::kStaleStatus;
  }
  if (in.stop) return HostCause::kStopRequested;
  if (in.mode != MachineMode::kEnabled) return HostCause::kMachineHolds;
  return HostCause::kNone;
}

bool session_ended(const HostState& state, const HostInputs& in) noexcept {
  const bool in_session = in.mode == MachineMode::kEnabled || in.mode == MachineMode::kHold;
  return in.restarted || !in_session || in.session != state.session;
}

HostState advance_handshake(HostState state, const HostInputs& in,
                            const HostTimes& times) noexcept {
  if (in.disable || in.stop) return enter(state, HostPhase::kInactive, HostCause::kNone, in.now_s);
  if (in.restarted) {
    return enter(state, HostPhase::kInactive, HostCause::kSessionEnded, in.now_s);
  }
  if (in.now_s - state.since_s > times.answer_within_s) {
    return enter(state, HostPhase::kInactive, HostCause::kNoAnswer, in.now_s);
  }
  const HostState violated =
      enter(state, HostPhase::kInactive, HostCause::kHandshakeViolated, in.now_s);
  if (state.phase == HostPhase::kAsking) {
    if (in.session != 0) return violated;  // nobody has proved anything yet
    if (in.mode == MachineMode::kEnabling && in.challenge != 0 &&
        in.challenge != state.old_challenge) {
      state.phase = HostPhase::kProving;
      state.challenge = in.challenge;
      state.since_s = in.now_s;
    }
    return state;
  }

  const bool other_challenge = in.challenge != 0 && in.challenge != state.challenge;
  const bool other_session = state.session != 0 && in.session != state.session;
  const bool old_session = in.session != 0 && in.session == state.old_session;
  if (other_challenge || other_session || old_session) return violated;
  if (in.session != 0) state.session = in.session;
  if (state.session != 0 && in.neutral_sent) ++state.neutral_frames;
  if (in.mode == MachineMode::kEnabled) {
    if (state.session == 0 || state.neutral_frames < times.bumpless_frames) return violated;
    return enter(state, HostPhase::kActive, HostCause::kNone, in.now_s);
  }
  if (in.mode != MachineMode::kEnabling) {
    return enter(state, HostPhase::kInactive, HostCause::kNoAnswer, in.now_s);
  }
  return state;
}

HostState advance_session(HostState state, const HostInputs& in, const HostTimes& times) noexcept {
  if (in.disable) return enter(state, HostPhase::kInactive, HostCause::kNone, in.now_s);
  const HostCause cause = hold_cause(in, times);
  if (session_ended(state, in)) {
    return enter(state, HostPhase::kInactive, HostCause::kSessionEnded, in.now_s);
  }
  if (state.phase == HostPhase::kActive) {
    return cause == HostCause::kNone ? state : enter(state, HostPhase::kHold, cause, in.now_s);
  }
  // After bus-off there is no way back into the session.
  if (state.cause == HostCause::kBusOff) {
    return cause == HostCause::kBusOff
               ? state
               : enter(state, HostPhase::kInactive, HostCause::kBusOff, in.now_s);
  }
  if (cause == HostCause::kBusOff) {
    state.cause = cause;
    return state;
  }
  // While the machine itself holds, our neutral commands are what lets it go on.
  const bool counts = cause == HostCause::kNone || cause == HostCause::kMachineHolds;
  if (!counts) {
    state.cause = cause;
    state.neutral_frames = 0;
  } else if (in.neutral_sent) {
    ++state.neutral_frames;
  }
  if (cause == HostCause::kNone && state.neutral_frames >= times.bumpless_frames) {
    return enter(state, HostPhase::kActive, HostCause::kNone, in.now_s);
  }
  return state;
}

}  // namespace

const char* describe(HostCause cause) noexcept {
  switch (cause) {
    case HostCause::kNone:
      return "nothing is wrong";
    case HostCause::kStopRequested:
      return "the program asked for a stop";
    case HostCause::kStaleFeedback:
      return "feedback of a joint or of the base is older than 50 ms";
    case HostCause::kMachineHolds:
      return "the machine holds by itself";
    case HostCause::kStaleStatus:
      return "the machine does not report its mode or its e-stop chain any more";
    case HostCause::kBusStalled:
      return "the bus takes no frames";
    case HostCause::kReceiveOverflow:
      return "received frames were lost in this computer twice within a second";
    case HostCause::kBusOff:
      return "the CAN controller is bus-off and nothing is heard";
    case HostCause::kSessionEnded:
      return "the machine has ended the session";
    case HostCause::kNoAnswer:
      return "the machine did not follow the enable handshake in time";
    case HostCause::kHandshakeViolated:
      return "the enable handshake was violated: other challenge, or a session too early";
    case HostCause::kLostFeedback:
      return "feedback is older than 200 ms";
    case HostCause::kInterfaceLost:
      return "the CAN interface is down or gone";
    case HostCause::kCrcErrors:
      return "more than three frames with a wrong CRC within a second";
    case HostCause::kMasquerade:
      return "somebody else on the bus sends this host's frames";
    case HostCause::kMachineFault:
      return "the machine reports a fault";
    case HostCause::kEStopOpen:
      return "the e-stop chain is open";
    case HostCause::kOperatorStop:
      return "an operator has stopped the machine";
    case HostCause::kOtherDbc:
      break;
  }
  return "the machine was built from another wex.dbc";
}

HostState advance(const HostState& before, const HostInputs& in, const HostTimes& times) noexcept {
  HostState state = before;
  if (in.operator_reset) state.reset_until_s = in.now_s + times.reset_memory_s;

  const bool estop = in.estop_open || in.mode == MachineMode::kEStop;
  if (estop && state.phase != HostPhase::kEStop) {
    const bool by_operator = in.operator_stopped && !in.estop_open;
    return enter(state, HostPhase::kEStop,
                 by_operator ? HostCause::kOperatorStop : HostCause::kEStopOpen, in.now_s);
  }
  const HostCause fault = fault_cause(state, in, times);
  const bool latched = state.phase == HostPhase::kFault || state.phase == HostPhase::kEStop;
  if (!latched && fault != HostCause::kNone) {
    return enter(state, HostPhase::kFault, fault, in.now_s);
  }

  switch (state.phase) {
    case HostPhase::kFault:
    case HostPhase::kEStop:
      if (!estop && fault == HostCause::kNone && in.now_s <= state.reset_until_s) {
        state.reset_until_s = -1.0;  // an edge counts once
        return enter(state, HostPhase::kUnconfigured, HostCause::kNone, in.now_s);
      }
      return state;
    case HostPhase::kUnconfigured:
      if (in.complete && !too_old(in.feedback_age_s, times.hold_after_s)) {
        if (in.dbc_matches) {
          return enter(state, HostPhase::kInactive, HostCause::kNone, in.now_s);
        }
        state.cause = HostCause::kOtherDbc;
      }
      return state;
    case HostPhase::kInactive:
      if (!in.complete || !in.dbc_matches || too_old(in.feedback_age_s, times.fault_after_s)) {
        return enter(state, HostPhase::kUnconfigured, HostCause::kLostFeedback, in.now_s);
      }
      if (in.enable && !in.stop && in.mode == MachineMode::kReady && in.nonce != 0) {
        state = enter(state, HostPhase::kAsking, HostCause::kNone, in.now_s);
        state.nonce = in.nonce;
        state.old_challenge = in.challenge;
      }
      return state;
    case HostPhase::kAsking:
    case HostPhase::kProving:
      return advance_handshake(state, in, times);
    case HostPhase::kActive:
    case HostPhase::kHold:
      break;
  }
  return advance_session(state, in, times);
}

HostOutputs outputs_of(const HostState& state, const HostInputs& in) noexcept {
  HostOutputs out;
  out.session = state.session;
  out.send_stop = in.stop || state.phase == HostPhase::kFault;
  switch (state.phase) {
    case HostPhase::kUnconfigured:
    case HostPhase::kInactive:
    case HostPhase::kFault:
    case HostPhase::kEStop:
      // A session that the machine still believes in (ours has ended) is to end there too; it
      // listens to heartbeats of that session only.
      if (in.session != 0 || in.mode == MachineMode::kEnabling) {
        out.request = HostRequest::kDisable;
        out.session = in.session;
      }
      return out;
    case HostPhase::kAsking:
      out.request = HostRequest::kEnable;
      out.nonce = state.nonce;
      return out;
    case HostPhase::kProving:
    case HostPhase::kActive:
    case HostPhase::kHold:
      out.request = HostRequest::kEnable;
      out.nonce = state.nonce;
      out.challenge_echo = state.challenge;
      out.send_commands = state.session != 0;
      out.live = state.phase == HostPhase::kActive && !in.stop;
      out.silent = state.phase == HostPhase::kHold && state.cause == HostCause::kBusOff;
  }
  return out;
}

}  // namespace wex::can
