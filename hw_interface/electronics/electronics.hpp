#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "hw_interface/electronics/command_watchdog.hpp"
#include "hw_interface/electronics/feedback_publisher.hpp"
#include "hw_interface/electronics/machine_automaton.hpp"
#include "hw_interface/electronics/machine_limits.hpp"
#include "hw_interface/electronics/plant.hpp"
#include "hw_interface/electronics/zone_controller.hpp"
#include "hw_interface/socketcan/frame_port.hpp"
#include "hw_interface/socketcan/protection.hpp"
#include "hw_interface/stopping_speed.hpp"

namespace wex::can {

/// Set in ZoneStatus::fault_bits by a simulated machine whose clock waits for LockStep frames. Not
/// a fault.
inline constexpr std::uint16_t kInfoLockStep = 1 << 15;

struct ElectronicsSettings {
  AutomatonSettings automaton;
  MachineLimitsSettings limits;
  ZoneControllerSettings zones;                            ///< dead_band is taken from the machine
  StoppingSpeed travel;                                    ///< beyond it all wheels get less
  StoppingSlew slew;                                       ///< beyond it the cabin gets less
  Eigen::Vector2d map_origin_m = Eigen::Vector2d::Zero();  ///< map frame = plant's frame + this
  double neutral_rate = 5e-3;      ///< rad/s or m/s: a bumpless command asks for no more
  int silence_ms = 100;            ///< after that a counter may start anywhere
  int operator_silence_ms = 1000;  ///< likewise for a terminal's frames
  bool lock_step = false;          ///< listen to LockStep (simulation only)
};

/// Why frames were not used.
struct ElectronicsCounters {
  long frames = 0;               ///< received, of any kind
  long commands_accepted = 0;    ///< ZoneCommands that were put in force
  long commands_bumpless = 0;    ///< good ones while enabling or holding
  long malformed = 0;            ///< unknown, wrong format or length, other sender's frames
  long crc_errors = 0;           ///< corrupted
  long other_session = 0;        ///< ZoneCommands of the session before
  long not_enabled = 0;          ///< ZoneCommands outside a session
  long sequence_errors = 0;      ///< repeated, reordered or after a gap
  std::array<long, 6> limits{};  ///< by LimitVerdict
  [[nodiscard]] long commands_rejected() const noexcept;
};

/// The machine's side of the bus: receives commands, judges them, runs the automaton, drives the
/// plant and publishes what it senses. One period:
///   receive() -> tick(now): automaton, limits, zones -> Plant::act -> Plant::sense -> frames
/// Control-rate calls are noexcept and allocation-free. Written apart from the host's side; both
/// share the codec and the protection only.
class Electronics {
 public:
  /// Plant, port and random source must live longer. At most kMaxJoints joints (contract).
  ///   errors  kBadInput: a joint of the machine has no place in wex.dbc
  [[nodiscard]] static Result<std::unique_ptr<Electronics>> create(
      const MachineModel& machine, Plant& plant, FramePort& port, RandomSource& random,
      const ElectronicsSettings& settings = {});

  /// Takes everything that has come. now_ms: machine time, never goes back. In lock step the clock
  /// stands meanwhile; what comes then counts as of the period that is about to run.
  void receive(std::int64_t now_ms) noexcept;
  /// One period that ends at now_ms; receives first.
  void tick(std::int64_t now_ms) noexcept;

  /// The hardwired e-stop chain as the electronics see it. In hardware it acts by itself.
  void set_estop_chain(bool open, std::uint8_t cause = 1) noexcept;

  /// Until when LockStep has let the clock run; nullopt if there was none since the last call.
  [[nodiscard]] std::optional<std::uint32_t> take_lock_step() noexcept;

  [[nodiscard]] const MachineAutomaton& automaton() const noexcept { return automaton_; }
  [[nodiscard]] const ElectronicsCounters& counters() const noexcept { return counters_; }
  [[nodiscard]] const FeedbackPublisher& publisher() const noexcept { return publisher_; }
  /// As of the last period.
  [[nodiscard]] const PlantState& plant_state() const noexcept { return state_; }
  [[nodiscard]] const PlantInput& plant_input() const noexcept { return input_; }
  [[nodiscard]] bool brakes_closed() const noexcept;  ///< all parking brakes and the swing brake
  [[nodiscard]] SocketStatus receive_status() const noexcept { return receive_status_; }

 private:
  Electronics(const MachineModel& machine, const SlotMap& slots, Plant& plant, FramePort& port,
              RandomSource& random, const ElectronicsSettings& settings);

  /// Counter of one sender's stream; a silence lets it start anew.
  struct Stream {
    Stream(MessageKind kind) noexcept : period_ms(1e3 * timing_of(kind).period_s) {}
    bool in_order(std::uint8_t counter, int silence_ms, std::int64_t now_ms) noexcept;
    double period_ms;  ///< 0: sent upon events only
    SequenceCheck check{SequenceCheck::Settings{}};
    std::int64_t last_ms = 0;
  };
  struct Zone {
    ZoneController controller;
    MachineLimits limits;
    Stream stream;
    ZoneReport report;
    std::array<double, kMaxZoneJoints> position{}, rate{};  ///< measured
  };

  void take_all(std::int64_t now_ms) noexcept;
  void handle(const CanFrame& frame, std::int64_t now_ms) noexcept;
  template <typename Message>
  bool take(const CanFrame& frame, Stream& stream, int silence_ms, Message& message,
            std::int64_t now_ms) noexcept;
  void handle_command(const CanFrame& frame, std::int64_t now_ms) noexcept;
  bool judge_command(const ZoneCommand& command, std::int64_t now_ms) noexcept;
  void handle_operator(const CanFrame& frame, std::int64_t now_ms) noexcept;
  void count_codec_error(CodecError error, std::int64_t now_ms) noexcept;
  void reject(int zone) noexcept;
  void follow_automaton(std::int64_t now_ms) noexcept;
  void sense() noexcept;
  [[nodiscard]] double wheel_share(std::int64_t now_ms) const noexcept;
  [[nodiscard]] double swing_share(std::int64_t now_ms) const noexcept;
  void act(std::int64_t now_ms) noexcept;

  struct Wheel {
    JointSlot slot;
    double way_per_rad_m = 0.0;  ///< forward > 0
  };

  SlotMap slots_;
  std::array<Wheel, kNumWheels> wheels_;
  JointSlot turn_ = slot_of("TURN"), boom_ = slot_of("BOOM"), dipper_ = slot_of("DIPPER"),
            tele_ = slot_of("TELE"), ee_pitch_ = slot_of("EE_PITCH");
  Plant* plant_;
  FramePort* port_;
  ElectronicsSettings settings_;
  MachineAutomaton automaton_;
  CommandWatchdog watchdog_;
  FeedbackPublisher publisher_;
  std::vector<Zone> zones_;  ///< kNumZones, never resized
  Stream heartbeat_{MessageKind::kHostHeartbeat}, host_stop_{MessageKind::kHostStop},
      operator_{MessageKind::kOperatorCommand};
  std::uint32_t session_ = 0, previous_session_ = 0;
  MachineMode last_mode_ = MachineMode::kInit;
  bool chain_open_ = false;
  std::uint8_t estop_cause_ = 0;
  std::optional<std::uint32_t> lock_step_;
  PlantState state_;
  PlantInput input_;
  ElectronicsCounters counters_;
  SocketStatus receive_status_ = SocketStatus::kWouldBlock;
};

}  // namespace wex::can
