#pragma once

#include <cstdint>

#include "hw_interface/socketcan/messages.hpp"

namespace wex::can {

/// Where the host stands. kAsking to kHold need a session or lead to one; kFault and kEStop are
/// latched.
enum class HostPhase : std::uint8_t {
  kUnconfigured,  ///< not everything of the machine was heard of, or it speaks another DBC
  kInactive,
  kAsking,   ///< enable and nonce sent, waiting for the machine's challenge
  kProving,  ///< challenge echoed; neutral commands until the machine is enabled
  kActive,
  kHold,  ///< within the session: neutral commands until it may go on
  kFault,
  kEStop
};

/// Why the phase is what it is.
enum class HostCause : std::uint8_t {
  kNone,
  kStopRequested,      ///< stop() of the program
  kStaleFeedback,      ///< no feedback of a joint or of the base for 50 ms
  kMachineHolds,       ///< the machine went to hold by itself
  kStaleStatus,        ///< no report of the machine's mode or of the e-stop chain
  kBusStalled,         ///< frames were not taken for three cycles
  kReceiveOverflow,    ///< the host lost received frames twice within a second
  kBusOff,             ///< the controller reports bus-off and nothing is heard
  kSessionEnded,       ///< by the machine, or its clock started anew
  kNoAnswer,           ///< the machine did not follow the handshake in time
  kHandshakeViolated,  ///< another challenge, a session too early, an old one
  kLostFeedback,       ///< nothing for 200 ms
  kInterfaceLost,      ///< interface down or gone
  kCrcErrors,
  kMasquerade,    ///< somebody else sends the host's frames
  kMachineFault,  ///< the machine reports a fault
  kEStopOpen,
  kOtherDbc,     ///< the machine was built from another wex.dbc
  kOperatorStop  ///< emergency stop by a person's frame; the chain itself is closed
};
/// One clause for a person.
[[nodiscard]] const char* describe(HostCause cause) noexcept;

struct HostTimes {
  double hold_after_s = 0.05;  ///< age of feedback
  double fault_after_s = 0.2;
  double status_hold_after_s = 0.25;  ///< five periods of ZoneStatus
  double estop_hold_after_s = 0.1;    ///< ten periods of EStopState
  double answer_within_s = 1.0;       ///< each step of the handshake
  double reset_memory_s = 1.0;        ///< the machine may follow a reset that long after the host
  int bumpless_frames = 10;
};

/// What is known at one moment; times in seconds of the machine's clock.
struct HostInputs {
  double now_s = 0.0;
  bool complete = false;  ///< everything was heard of at least once
  bool dbc_matches = false;
  double feedback_age_s = 0.0;
  double status_age_s = 0.0;
  double estop_age_s = 0.0;
  MachineMode mode = MachineMode::kInit;
  std::uint32_t session = 0, challenge = 0;  ///< as all zones report
  bool estop_open = false;
  bool operator_stopped = false;  ///< as any zone reports
  bool stop = false;              ///< stop() is in force
  bool bus_stalled = false;
  bool bus_off_reported = false;  ///< by an error frame, which any local process can forge
  bool overflowed = false;        ///< twice within a second
  bool neutral_sent = false;      ///< all zones were sent a neutral command since the last step
  // Events since the last step.
  bool enable = false, disable = false;
  bool operator_reset = false;
  bool masquerade = false, crc_fault = false, restarted = false, interface_lost = false;
  std::uint16_t nonce = 0;  ///< random, not 0; used if a handshake begins
};

/// Everything the automaton remembers.
struct HostState {
  HostPhase phase = HostPhase::kUnconfigured;
  HostCause cause = HostCause::kNone;
  std::uint16_t nonce = 0;
  std::uint32_t old_challenge = 0;  ///< what stood there before the handshake
  std::uint32_t challenge = 0;
  std::uint32_t session = 0, old_session = 0;
  double since_s = 0.0;  ///< of the phase
  int neutral_frames = 0;
  double reset_until_s = -1.0;
  long holds = 0;  ///< that nobody asked for
};

/// What follows from it.
struct HostOutputs {
  HostRequest request = HostRequest::kNone;
  std::uint16_t nonce = 0;
  std::uint32_t challenge_echo = 0, session = 0;
  bool send_commands = false;  ///< ZoneCommands go out, neutral unless `live`
  bool live = false;           ///< the program's commands move the machine
  bool send_stop = false;      ///< HostStop is active
  bool silent = false;         ///< nothing at all goes out
};

/// One step: a pure function, without clock, bus or memory of its own.
///   any -> kEStop         e-stop chain open, or the machine says so
///   any -> kFault         masquerade, CRC errors, machine fault; within a session also feedback
///                         older than 200 ms, interface lost
///   kUnconfigured <-> kInactive   complete and the same DBC
///   kInactive -> kAsking          enable(), the machine is kReady
///   kAsking -> kProving           a new challenge; it is echoed with the next heartbeat
///   kProving -> kActive           the machine is enabled, in a new session, after at least ten
///                                 neutral commands of ours
///   kActive -> kHold              stop(), stale feedback, stalled bus, overflow, machine holds
///   kHold -> kActive              all causes gone and ten neutral commands since
///   session ended, disable()      -> kInactive
///   kFault, kEStop -> kUnconfigured  a person's reset edge and the causes gone
[[nodiscard]] HostState advance(const HostState& state, const HostInputs& inputs,
                                const HostTimes& times) noexcept;
[[nodiscard]] HostOutputs outputs_of(const HostState& state, const HostInputs& inputs) noexcept;

}  // namespace wex::can
