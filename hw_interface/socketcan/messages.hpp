#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "models/types/limbs.hpp"

// What the frames of wex.dbc mean, in SI units. Plain values; codec.hpp turns them into bytes and
// refuses values outside the DBC's ranges, e.g. rates beyond a joint's limit, positions more than
// 0.25 beyond its end stops, angles of the base or of a continuous joint outside +-pi.

namespace wex::can {

/// Zones: LF, RF, LH, RH leg, turntable + arm, tool. Joints of a zone are in DBC order.
inline constexpr int kNumZones = 6;
inline constexpr int kMaxZoneJoints = 5;

/// Automaton of the machine's electronics, which are the authority; the host follows it.
enum class MachineMode : std::uint8_t {
  kInit = 0,
  kReady = 1,     ///< self-test passed, feedback valid, valves neutral; no motion
  kEnabling = 2,  ///< challenge sent, counting good bumpless frames
  kEnabled = 3,
  kHold = 4,   ///< zero flow, brakes; may be left within the session by good bumpless frames
  kFault = 5,  ///< latched: left by an operator's reset only
  kEStop = 6   ///< latched: cause gone and an operator's reset
};

enum class HostRequest : std::uint8_t { kNone = 0, kEnable = 1, kDisable = 2 };
enum class OperatorAction : std::uint8_t { kNone = 0, kStop = 1, kReset = 2 };

/// Quality of one joint's feedback.
enum class JointQuality : std::uint8_t { kOk = 0, kStale = 1, kInvalid = 2, kNotAvailable = 3 };

struct ZoneCommand {  // 0x080 + zone, 100 Hz, host
  int zone = 0;
  std::array<double, kMaxZoneJoints> rate{};  ///< rad/s or m/s
  std::array<bool, kMaxZoneJoints> active{};  ///< false: this joint holds
  std::uint8_t valid_for_ms = 0;              ///< relative to echo_time_ms
  std::uint32_t echo_time_ms = 0;             ///< sample time of the newest feedback used
};

struct ZoneFeedback {  // 0x100 + zone, 100 Hz, machine
  int zone = 0;
  std::array<double, kMaxZoneJoints> position{};  ///< rad or m; continuous joints wrap
  std::array<double, kMaxZoneJoints> rate{};
  std::array<double, kMaxZoneJoints> spool{};  ///< -1..1
  std::array<JointQuality, kMaxZoneJoints> quality{};
  std::uint32_t sample_time_ms = 0;  ///< machine time, wraps
};

struct ZonePressure {  // 0x300 + zone, 50 Hz, machine
  int zone = 0;
  std::array<double, kMaxZoneJoints> pressure_a_pa{}, pressure_b_pa{};  ///< -0.1e6..60e6
};

struct ZoneStatus {  // 0x200 + zone, 20 Hz and on change, machine
  int zone = 0;
  MachineMode mode = MachineMode::kInit;
  std::uint16_t fault_bits = 0;
  std::uint8_t last_accepted_counter = 0;
  std::uint16_t rejected_frames = 0;
  std::uint32_t challenge = 0;  ///< 0: none pending
  std::uint32_t session = 0;    ///< 0: no session
  std::uint32_t dbc_hash = 0;
};

struct HostHeartbeat {  // 0x040, 50 Hz, host
  std::uint32_t session = 0;
  HostRequest request = HostRequest::kNone;
  std::uint16_t nonce = 0;
  std::uint32_t challenge_echo = 0;
  std::uint32_t dbc_hash = 0;
};

struct HostStop {  // 0x020, host: three at the event, then 100 Hz while active
  bool active = false;
  std::uint8_t cause = 0;
};

struct OperatorCommand {  // 0x030, operator's terminal or panel; actions count on their rising edge
  OperatorAction action = OperatorAction::kNone;
};

struct EStopState {  // 0x010, 100 Hz and on change, safety controller: reports the hardwired chain
  bool chain_open = false;
  std::uint8_t cause = 0;
};

struct Imu {                                                         // 0x180, 100 Hz, machine
  Eigen::Vector3d angular_velocity_rad_s = Eigen::Vector3d::Zero();  ///< world frame
  Eigen::Vector3d acceleration_m_s2 = Eigen::Vector3d::Zero();       ///< base frame
  std::uint32_t sample_time_ms = 0;
};

struct BasePose {                                          // 0x188, 100 Hz, localisation unit
  Eigen::Vector3d p_map_base_m = Eigen::Vector3d::Zero();  ///< in the map file's own frame
  double yaw_rad = 0.0, pitch_rad = 0.0, roll_rad = 0.0;   ///< within +-pi
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();  ///< world frame
  JointQuality quality = JointQuality::kNotAvailable;
  std::uint32_t sample_time_ms = 0;
};

/// Lock step of functional tests: the host lets the machine's clock run to this time. Only a
/// simulated machine started for lock step listens; real electronics have no such frame.
struct LockStep {  // 0x7F0, host
  std::uint32_t run_until_ms = 0;
};

}  // namespace wex::can
