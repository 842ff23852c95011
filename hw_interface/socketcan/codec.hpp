#pragma once

#include <cstdint>
#include <string>

#include "hw_interface/socketcan/can_frame.hpp"
#include "hw_interface/socketcan/messages.hpp"
#include "models/types/result.hpp"

namespace wex::can {

// The protocol is wex.dbc; generated/ holds its bit layout and its table of ranges. Everything here
// but describe() is noexcept and allocation-free, and safe to call concurrently.

/// Why bytes or values were refused. Nothing is ever wrapped, clamped or truncated here.
enum class CodecError : std::uint8_t {
  kNotFinite,      ///< NaN or infinity in a value to send
  kOutOfRange,     ///< outside the DBC's physical range
  kUnknownId,      ///< no such message, or 29-bit, remote or error frame
  kWrongLength,    ///< payload length differs from the DBC
  kWrongFormat,    ///< classic instead of FD or the other way round
  kBadCrc,         ///< corrupted, other data id or other session
  kBadEnumeration  ///< a value that the DBC's table does not list
};

/// Sender's side of end-to-end protection: counter per message id and the session in the CRC.
struct SendContext {
  std::uint32_t session = 0;
  std::uint8_t counter = 0;  ///< incremented by every successful encode
};

/// What protection needs of a received frame besides its values.
struct ReceivedMeta {
  std::uint8_t counter = 0;
};

/// First 32 bits of the SHA-256 of wex.dbc, generated with the codec.
[[nodiscard]] std::uint32_t dbc_hash() noexcept;

/// Values -> frame: finite, physical range, rounding to nearest, raw range, CRC and counter.
///   on error `frame` and the counter are untouched; the session counts only for ZoneCommand
///   ZoneFeedback, BasePose: values of quality kInvalid or kNotAvailable are not looked at and go
///   out as "not available"
///   ZoneCommand: joints that the zone does not have must be inactive with rate 0
///   a zone that does not exist: kUnknownId
#define WEX_CAN_MESSAGE(Type)                                                               \
  [[nodiscard]] Result<void, CodecError> encode(const Type& message, SendContext& context,  \
                                                CanFrame& frame) noexcept;                  \
  /* Frame -> values: id, format, length, CRC (with `session`), tables, ranges. On error */ \
  /* `message` is untouched. What its sender has no value for is NaN; joints that the    */ \
  /* zone does not have are 0 and kNotAvailable.                                         */ \
  [[nodiscard]] Result<ReceivedMeta, CodecError> decode(                                    \
      const CanFrame& frame, std::uint32_t session, Type& message) noexcept

WEX_CAN_MESSAGE(ZoneCommand);   // session-bound
WEX_CAN_MESSAGE(ZoneFeedback);  // the others are decoded with session 0
WEX_CAN_MESSAGE(ZonePressure);
WEX_CAN_MESSAGE(ZoneStatus);
WEX_CAN_MESSAGE(HostHeartbeat);
WEX_CAN_MESSAGE(HostStop);
WEX_CAN_MESSAGE(OperatorCommand);
WEX_CAN_MESSAGE(EStopState);
WEX_CAN_MESSAGE(Imu);
WEX_CAN_MESSAGE(BasePose);
WEX_CAN_MESSAGE(LockStep);

#undef WEX_CAN_MESSAGE

/// Which message an id belongs to.
enum class MessageKind : std::uint8_t {
  kEStopState,
  kHostStop,
  kOperatorCommand,
  kHostHeartbeat,
  kZoneCommand,
  kZoneFeedback,
  kZonePressure,
  kImu,
  kBasePose,
  kZoneStatus,
  kLockStep,
  kUnknown
};
[[nodiscard]] MessageKind kind_of(const CanFrame& frame) noexcept;
[[nodiscard]] int zone_of(const CanFrame& frame) noexcept;  ///< -1 if it has none

[[nodiscard]] const char* name_of(const CanFrame& frame) noexcept;  ///< "unknown" if it has none

/// Of the DBC: how often a message is sent, and after which silence its receiver reacts (0: never).
struct MessageTiming {
  double period_s = 0.0, timeout_s = 0.0;
};
[[nodiscard]] MessageTiming timing_of(MessageKind kind) noexcept;

/// Where a joint of the machine stands on the bus; from the DBC's JointName attributes.
struct JointSlot {
  int zone = -1, index = -1;
};
/// Slot {-1, -1} if no zone has a joint of this name.
[[nodiscard]] JointSlot slot_of(const std::string& joint_name) noexcept;
/// Limits of a slot as the DBC's attributes state them (both sides check against these).
struct SlotLimits {
  double lower = 0.0, upper = 0.0;  ///< +-infinity for continuous joints
  double max_rate = 0.0, max_acceleration = 0.0;
};
/// All zero for a slot that no joint has.
[[nodiscard]] SlotLimits limits_of(JointSlot slot) noexcept;

/// Words for reports.
[[nodiscard]] const char* to_string(CodecError error) noexcept;
[[nodiscard]] const char* to_string(MachineMode mode) noexcept;

/// One line for a person: name, counter, verdict, values with units. A ZoneCommand's CRC needs the
/// session. Not real-time code.
[[nodiscard]] std::string describe(const CanFrame& frame, std::uint32_t session = 0);

}  // namespace wex::can
