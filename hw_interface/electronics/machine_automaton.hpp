#pragma once

#include <array>
#include <cstdint>

#include "hw_interface/electronics/event_window.hpp"
#include "hw_interface/electronics/random_source.hpp"
#include "hw_interface/socketcan/messages.hpp"

namespace wex::can {

/// Bits of ZoneStatus::fault_bits: why the electronics are in kFault or kEStop. Latched.
enum FaultBit : std::uint16_t {
  kFaultHeartbeatLost = 1 << 0,
  kFaultCrcErrors = 1 << 1,
  kFaultRangeRejects = 1 << 2,
  kFaultMasquerade = 1 << 3,  ///< somebody else sends our frames
  kFaultSensors = 1 << 4,
  kFaultEStopChain = 1 << 5,
  kFaultOperatorStop = 1 << 6
};

struct AutomatonSettings {
  int hold_after_ms = 50;             ///< without a valid ZoneCommand of every zone
  int heartbeat_hold_after_ms = 100;  ///< without a host heartbeat of this session
  int heartbeat_fault_after_ms = 500;
  int echo_within_ms = 200;       ///< of the challenge
  int enabling_within_ms = 2000;  ///< from the echo to ten good frames of every zone
  int good_frames = 10;           ///< consecutive, bumpless
  int max_crc_errors = 3;         ///< more within crc_window_ms: fault
  int crc_window_ms = 1000;
  int reject_window_ms = 100;        ///< the third range reject within it: fault
  int operator_memory_ms = 1000;     ///< how long an operator's frame counts as the one before
  int quiet_before_reset_ms = 1000;  ///< a bus fault must be over for that long
};

/// What the electronics know of themselves in one period.
struct SelfCheck {
  bool sensors_valid = false, base_pose_valid = false;
  bool valves_neutral = false;
  bool estop_chain_open = true;
};

/// The MachineMode automaton, the authority over motion:
///   kInit -> kReady     sensors and base pose valid, valves neutral, a host with our DBC alive
///   kReady -> kEnabling a heartbeat with request kEnable, after one without, and a nonce that is
///                       not 0: a random challenge appears in ZoneStatus
///   (in kEnabling)      a heartbeat with the same nonce and the challenge as its echo within
///                       200 ms: a random session appears in ZoneStatus, the challenge goes; from
///                       here ZoneCommands carry that session
///   kEnabling -> kEnabled  every zone has sent 10 good neutral ZoneCommands in a row
///   kEnabled -> kHold   a zone silent for 50 ms, heartbeat of this session for 100 ms, HostStop,
///                       base pose lost
///   kHold -> kEnabled   cause gone and again 10 good neutral frames of every zone
///   kEnabled, kHold -> kInit  request kDisable; a new enable starts from kReady
///   any -> kFault, any -> kEStop: latched; left to kInit by an operator's reset edge (a frame with
///                       kNone, then one with kReset) once the cause is gone
/// The session ends with every mode but kEnabling, kEnabled and kHold. Pure: time comes in,
/// milliseconds of any clock that never goes back. Noexcept, allocation-free.
class MachineAutomaton {
 public:
  MachineAutomaton(std::uint32_t dbc_hash, RandomSource& random,
                   const AutomatonSettings& settings = {}) noexcept;

  // What came over the bus, already decoded and with its counter in order.
  void on_heartbeat(const HostHeartbeat& heartbeat, std::int64_t now_ms) noexcept;
  void on_host_stop(const HostStop& stop, std::int64_t now_ms) noexcept;
  void on_operator(const OperatorCommand& command, std::int64_t now_ms) noexcept;
  /// A ZoneCommand that nothing speaks against; neutral: it asks for no motion.
  void on_good_command(int zone, bool neutral, std::int64_t now_ms) noexcept;
  /// A ZoneCommand that something speaks against: the count of good ones starts again.
  void on_bad_command(int zone) noexcept;
  void on_range_reject(std::int64_t now_ms) noexcept;
  void on_crc_error(std::int64_t now_ms) noexcept;
  void on_masquerade(std::int64_t now_ms) noexcept;

  /// Once per period: time-outs and transitions.
  void step(const SelfCheck& check, std::int64_t now_ms) noexcept;

  [[nodiscard]] MachineMode mode() const noexcept { return mode_; }
  [[nodiscard]] std::uint16_t fault_bits() const noexcept { return fault_bits_; }
  [[nodiscard]] std::uint32_t challenge() const noexcept { return challenge_; }
  [[nodiscard]] std::uint32_t session() const noexcept { return session_; }
  [[nodiscard]] long holds() const noexcept { return holds_; }

 private:
  void enter(MachineMode mode) noexcept;
  void fault(std::uint16_t bit) noexcept;
  void step_session(const SelfCheck& check, std::int64_t now_ms) noexcept;
  void step_enabling(const SelfCheck& check, std::int64_t now_ms) noexcept;
  void try_reset(const SelfCheck& check, std::int64_t now_ms) noexcept;
  [[nodiscard]] bool heartbeat_older_than(int age_ms, std::int64_t now_ms) const noexcept;
  [[nodiscard]] bool commands_alive(std::int64_t now_ms) const noexcept;
  [[nodiscard]] bool bumpless() const noexcept;
  void forget_commands() noexcept;
  [[nodiscard]] std::uint32_t random_not_zero() noexcept;
  [[nodiscard]] bool in_session() const noexcept {
    return mode_ == MachineMode::kEnabled || mode_ == MachineMode::kHold;
  }

  static constexpr std::int64_t kNever_ms = -1'000'000'000;
  static constexpr int kRejectsForFault = 3;

  struct Zone {
    std::int64_t last_good_ms = kNever_ms;
    int good_in_a_row = 0;
  };

  std::uint32_t dbc_hash_;
  RandomSource* random_;
  AutomatonSettings settings_;

  MachineMode mode_ = MachineMode::kInit;
  std::uint16_t fault_bits_ = 0;
  std::uint32_t challenge_ = 0, session_ = 0;
  std::uint16_t nonce_ = 0;
  std::int64_t challenge_ms_ = 0, echo_ms_ = 0;
  long holds_ = 0;

  bool heard_host_ = false;  ///< a heartbeat that counts, ever
  std::int64_t heartbeat_ms_ = 0;
  bool request_was_off_ = false;  ///< the last heartbeat did not ask for kEnable
  bool host_stop_ = false;
  std::int64_t host_stop_ms_ = 0;
  bool operator_stop_ = false, operator_idle_ = false, reset_edge_ = false;
  std::int64_t operator_ms_ = 0;
  std::array<Zone, kNumZones> zones_{};
  EventWindow crc_errors_, range_rejects_;
  std::int64_t last_bus_fault_ms_ = kNever_ms;
};

}  // namespace wex::can
