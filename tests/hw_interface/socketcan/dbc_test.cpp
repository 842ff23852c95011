#include <gtest/gtest.h>

#include <set>

#include "hw_interface/socketcan/frame_fields.hpp"
#include "models/excavator/machine_model.hpp"
#include "tests/hw_interface/socketcan/codec_fields.hpp"
#include "tests/hw_interface/socketcan/dbc_text.hpp"

// wex.dbc against the machine model, against the table generated from it and against the protocol
// that messages.hpp promises.

namespace wex::can {
namespace {

TEST(Dbc, LimitsAreThoseOfTheMachineModel) {
  const auto machine = load_machine();
  ASSERT_TRUE(machine) << machine.error().message;
  int num_joints = 0;
  for (const Joint& joint : machine->joints) {
    SCOPED_TRACE(joint.name);
    const JointSlot slot = slot_of(joint.name);
    ASSERT_GE(slot.zone, 0) << "not on the bus";
    const SlotLimits limits = limits_of(slot);
    EXPECT_EQ(limits.max_rate, joint.max_rate);
    EXPECT_EQ(limits.max_acceleration, joint.max_acceleration);
    EXPECT_EQ(limits.lower, joint.lower);
    EXPECT_EQ(limits.upper, joint.upper);
    ++num_joints;
  }
  EXPECT_EQ(num_joints, 25);
  std::size_t on_the_bus = 0;
  for (const auto& zone : kZoneJoints) on_the_bus += zone.size();
  EXPECT_EQ(on_the_bus, machine->joints.size());
}

TEST(Dbc, RangesLetPassWhatTheMachineCanDoAndNoCommandBeyond) {
  const auto machine = load_machine();
  ASSERT_TRUE(machine);
  const auto dbc = read_wex_dbc();
  for (const Joint& joint : machine->joints) {
    const std::string& label = kZoneLabels[slot_of(joint.name).zone];
    const auto& command = dbc.at("ZoneCommand" + label).signal(joint.name + "_Rate");
    EXPECT_EQ(command.maximum, joint.max_rate) << joint.name;
    EXPECT_EQ(command.minimum, -joint.max_rate) << joint.name;
    const auto& position = dbc.at("ZoneFeedback" + label).signal(joint.name + "_Position");
    if (joint.continuous) {
      EXPECT_NEAR(position.maximum, M_PI, 1e-6);
      EXPECT_NEAR(position.minimum, -M_PI, 1e-6);
    } else {
      EXPECT_NEAR(position.minimum, joint.lower - 0.25, 1e-9);
      EXPECT_NEAR(position.maximum, joint.upper + 0.25, 1e-9);
    }
    const auto& rate = dbc.at("ZoneFeedback" + label).signal(joint.name + "_Rate");
    EXPECT_GE(rate.maximum, 2.0 * joint.max_rate) << joint.name;
  }
}

TEST(Dbc, TheGeneratedTableSaysWhatTheTextSays) {
  const auto dbc = read_wex_dbc();
  ASSERT_EQ(dbc.size(), generated::kMessages.size());
  for (const MessageRow& row : generated::kMessages) {
    SCOPED_TRACE(row.name);
    const DbcMessage& message = dbc.at(row.name);
    EXPECT_EQ(row.id, message.id);
    EXPECT_EQ(row.length, message.length);
    EXPECT_EQ(row.fd, message.attributes.at("VFrameFormat") == "14");
    EXPECT_EQ(std::to_string(row.data_id), message.attributes.at("E2EDataId"));
    EXPECT_EQ(std::to_string(row.cycle_ms), message.attributes.at("GenMsgCycleTime"));
    EXPECT_EQ(std::to_string(row.timeout_ms), message.attributes.at("TimeoutMs"));
    EXPECT_EQ(row.session_bound, message.attributes.contains("SessionBound"));
    EXPECT_EQ(row.profile, E2eProfile::kCrc16Counter8);
    ASSERT_EQ(row.signals.size(), message.signals.size());
    for (const SignalRow& signal : row.signals) {
      const DbcSignal& expected = message.signal(signal.name);
      EXPECT_DOUBLE_EQ(signal.numerator / signal.denominator, expected.scale) << signal.name;
      EXPECT_EQ(signal.minimum, expected.minimum) << signal.name;
      EXPECT_EQ(signal.maximum, expected.maximum) << signal.name;
      EXPECT_EQ(signal.raw_min, expected.raw_minimum()) << signal.name;
      EXPECT_EQ(signal.raw_max, expected.raw_maximum()) << signal.name;
      EXPECT_EQ(signal.is_signed, expected.is_signed) << signal.name;
      EXPECT_EQ(!signal.choices.empty(), expected.is_enumeration()) << signal.name;
      if (signal.is_signed) {
        EXPECT_EQ(signal.not_available, expected.not_available()) << signal.name;
        EXPECT_LT(signal.not_available, signal.raw_min) << signal.name;
        EXPECT_EQ(expected.table.at(signal.not_available), "NotAvailable") << signal.name;
      }
    }
  }
}

// The codec finds signals by their place; here the names at those places are compared.
TEST(Dbc, JointSignalsStandWhereTheCodecLooks) {
  for (int zone = 0; zone < kNumZones; ++zone) {
    const auto& joints = kZoneJoints[zone];
    const auto count = joints.size();
    const auto name = [](const MessageRow* row, std::size_t field) {
      return std::string(row->signals[field].name);
    };
    const MessageRow* command = row_of(MessageKind::kZoneCommand, zone);
    const MessageRow* feedback = row_of(MessageKind::kZoneFeedback, zone);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(name(command, 4 + i), joints[i] + "_Rate");
      EXPECT_EQ(name(command, 4 + count + i), joints[i] + "_Active");
      EXPECT_EQ(name(feedback, 3 + i), joints[i] + "_Quality");
      EXPECT_EQ(name(feedback, 3 + count + i), joints[i] + "_Position");
      EXPECT_EQ(command->signals[4 + i].joint, joints[i]);
    }
  }
}

TEST(Dbc, IdsFollowUrgencyAndHaveOneSenderEach) {
  std::set<std::uint32_t> ids, data_ids;
  for (const MessageRow& row : generated::kMessages) {
    EXPECT_TRUE(ids.insert(row.id).second);
    EXPECT_TRUE(data_ids.insert(row.data_id).second);
    EXPECT_LT(row.id, 0x800u);
  }
  EXPECT_STREQ(row_of(MessageKind::kEStopState, -1)->sender, "SAFETY");
  EXPECT_STREQ(row_of(MessageKind::kHostStop, -1)->sender, "HOST");
  EXPECT_STREQ(row_of(MessageKind::kOperatorCommand, -1)->sender, "TERMINAL");
  EXPECT_STREQ(row_of(MessageKind::kBasePose, -1)->sender, "LOCALISATION");
  EXPECT_STREQ(row_of(MessageKind::kZoneCommand, 3)->sender, "HOST");
  EXPECT_STREQ(row_of(MessageKind::kZoneFeedback, 3)->sender, "MACHINE");
  EXPECT_LT(row_of(MessageKind::kEStopState, -1)->id, row_of(MessageKind::kHostStop, -1)->id);
  EXPECT_LT(row_of(MessageKind::kHostStop, -1)->id, row_of(MessageKind::kZoneCommand, 0)->id);
}

TEST(Dbc, TheEnumerationsAreThoseOfTheMessages) {
  const auto dbc = read_wex_dbc();
  const auto& mode = dbc.at("ZoneStatusLF").signal("Mode").table;
  EXPECT_EQ(mode.size(), 7u);
  EXPECT_EQ(mode.at(static_cast<int>(MachineMode::kEnabled)), "Enabled");
  EXPECT_EQ(mode.at(static_cast<int>(MachineMode::kHold)), "Hold");
  EXPECT_EQ(mode.at(static_cast<int>(MachineMode::kFault)), "Fault");
  const auto& request = dbc.at("HostHeartbeat").signal("Request").table;
  EXPECT_EQ(request.at(static_cast<int>(HostRequest::kDisable)), "Disable");
  const auto& action = dbc.at("OperatorCommand").signal("Action").table;
  EXPECT_EQ(action.at(static_cast<int>(OperatorAction::kReset)), "Reset");
  const auto& quality = dbc.at("BasePose").signal("Quality").table;
  EXPECT_EQ(quality.at(static_cast<int>(JointQuality::kInvalid)), "Invalid");
}

// cantools' encode functions wrap values beyond the raw range; they are not generated, and nobody
// may bring them back.
TEST(Dbc, NoWrappingEncodeFunctionExists) {
  for (const char* name : {"wex_dbc.c", "wex_dbc.h"}) {
    std::ifstream file(std::string(WEX_SOCKETCAN_DIR "/generated/") + name);
    std::ostringstream text;
    text << file.rdbuf();
    EXPECT_NE(text.str().find("_unpack("), std::string::npos) << name;
    EXPECT_EQ(text.str().find("_encode("), std::string::npos) << name;
    EXPECT_EQ(text.str().find("double"), std::string::npos) << name;
  }
}

TEST(Dbc, TheHashIsGenerated) {
  EXPECT_NE(dbc_hash(), 0u);
  EXPECT_EQ(dbc_hash(), generated::kDbcHash);
}

}  // namespace
}  // namespace wex::can
