#include "hw_interface/socketcan/codec.hpp"
#include "hw_interface/socketcan/frame_fields.hpp"

// What the DBC says of messages and joints, apart from bytes.

namespace wex::can {
namespace {

constexpr int kRateField = 4;  // first joint rate of a ZoneCommand

}  // namespace

MessageKind kind_of(const CanFrame& frame) noexcept {
  if (frame.extended || frame.remote || frame.error) return MessageKind::kUnknown;
  const MessageRow* row = row_of(frame.id);
  return row == nullptr ? MessageKind::kUnknown : row->kind;
}

int zone_of(const CanFrame& frame) noexcept {
  if (kind_of(frame) == MessageKind::kUnknown) return -1;
  return row_of(frame.id)->zone;
}

const char* name_of(const CanFrame& frame) noexcept {
  return kind_of(frame) == MessageKind::kUnknown ? "unknown" : row_of(frame.id)->name;
}

MessageTiming timing_of(MessageKind kind) noexcept {
  for (const MessageRow& row : generated::kMessages) {
    if (row.kind == kind) return {row.cycle_ms * 1e-3, row.timeout_ms * 1e-3};
  }
  return {};
}

JointSlot slot_of(const std::string& joint_name) noexcept {
  for (int zone = 0; zone < kNumZones; ++zone) {
    const MessageRow* row = row_of(MessageKind::kZoneCommand, zone);
    for (int i = 0; i < row->num_joints; ++i) {
      if (joint_name == row->signals[kRateField + i].joint) return {zone, i};
    }
  }
  return {};
}

SlotLimits limits_of(JointSlot slot) noexcept {
  const MessageRow* command = row_of(MessageKind::kZoneCommand, slot.zone);
  const MessageRow* feedback = row_of(MessageKind::kZoneFeedback, slot.zone);
  if (command == nullptr || slot.index < 0 || slot.index >= command->num_joints) return {};
  const SignalRow& rate = command->signals[kRateField + slot.index];
  // Positions follow Crc, Counter, SampleTimeMs and the qualities.
  const SignalRow& position =
      feedback->signals[kFirstField + 1 + feedback->num_joints + slot.index];
  return {position.position_lower, position.position_upper, rate.rate_limit,
          rate.acceleration_limit};
}

}  // namespace wex::can
