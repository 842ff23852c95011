#include "hw_interface/socketcan/codec.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <set>

#include "tests/hw_interface/socketcan/codec_fields.hpp"

namespace wex::can {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

ZoneCommand some_command() {
  ZoneCommand command;
  command.zone = 2;
  command.rate = {0.25, -0.1, 0.175, 2.5, -0.25};
  command.active = {true, true, false, true, true};
  command.valid_for_ms = 50;
  command.echo_time_ms = 4000000000u;
  return command;
}

CanFrame encoded(const AnyMessage& message, std::uint32_t session = 0) {
  SendContext context{session, 3};
  CanFrame frame;
  EXPECT_TRUE(encode_any(message, context, frame));
  return frame;
}

TEST(Codec, CarriesEveryFieldOfEveryMessage) {
  for (auto& [name, sent] : every_message()) {
    double value = 1.0;
    for (const Field& field : fields(sent)) {
      if (!field.signal.ends_with("Quality")) field.set(field.is_real ? 0.01 * value : 1.0);
      value += 1.0;
      if (field.signal.find("Pressure") != std::string::npos) field.set(1e5 * value);
    }
    AnyMessage received = sent;
    for (const Field& field : fields(received)) field.set(0.0);
    ASSERT_TRUE(decode_any(encoded(sent, 77), 77, received)) << name;
    const auto wanted = fields(sent);
    const auto got = fields(received);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      EXPECT_NEAR(got[i].get(), wanted[i].get(), 5e-4) << name << "." << wanted[i].signal;
    }
  }
}

TEST(Codec, RateLimitsSurviveTheBusExactly) {
  ZoneCommand received;
  ASSERT_TRUE(decode(encoded(some_command(), 9), 9, received));
  EXPECT_EQ(received.rate, some_command().rate);
  EXPECT_EQ(received.active, some_command().active);
  EXPECT_EQ(received.echo_time_ms, 4000000000u);
}

TEST(Codec, ADecodedMessageKeepsNothingOfAnEarlierOne) {
  ZoneCommand received = some_command();
  ZoneCommand small;
  small.zone = 5;
  ASSERT_TRUE(decode(encoded(small), 0, received));
  EXPECT_EQ(received.zone, 5);
  for (int i = 0; i < kMaxZoneJoints; ++i) {
    EXPECT_FALSE(received.active[i]);
    EXPECT_EQ(received.rate[i], 0.0);
  }
}

TEST(Codec, JointsThatAZoneDoesNotHaveAreNotAvailable) {
  ZoneFeedback feedback;
  feedback.zone = 5;
  feedback.position.fill(0.1);
  ZoneFeedback received;
  ASSERT_TRUE(decode(encoded(feedback), 0, received));
  EXPECT_EQ(received.quality[2], JointQuality::kOk);
  EXPECT_EQ(received.quality[3], JointQuality::kNotAvailable);
  EXPECT_EQ(received.quality[4], JointQuality::kNotAvailable);
  EXPECT_EQ(received.position[3], 0.0);
}

TEST(Codec, RefusesToCommandJointsThatAZoneDoesNotHave) {
  SendContext context;
  CanFrame frame;
  ZoneCommand command;
  command.zone = 0;
  ASSERT_TRUE(encode(command, context, frame));
  command.rate[4] = 0.001;
  EXPECT_EQ(encode(command, context, frame).error(), CodecError::kOutOfRange);
  command.rate[4] = 0.0;
  command.active[4] = true;
  EXPECT_EQ(encode(command, context, frame).error(), CodecError::kOutOfRange);
  command.active[4] = false;
  command.rate[4] = kNan;
  EXPECT_EQ(encode(command, context, frame).error(), CodecError::kNotFinite);
  EXPECT_EQ(context.counter, 1);
}

TEST(Codec, ReportsTheFirstOfSeveralReasons) {
  SendContext context;
  CanFrame frame;
  ZoneCommand command;
  command.rate[1] = 99.0;
  command.rate[2] = kNan;
  EXPECT_EQ(encode(command, context, frame).error(), CodecError::kOutOfRange);
  ZoneFeedback feedback;
  feedback.quality[0] = static_cast<JointQuality>(9);
  feedback.position[1] = kNan;
  EXPECT_EQ(encode(feedback, context, frame).error(), CodecError::kBadEnumeration);
}

TEST(Codec, ZonesThatDoNotExistCannotBeSent) {
  for (const int zone : {-1, kNumZones}) {
    SendContext context;
    CanFrame frame;
    ZoneCommand command;
    ZoneFeedback feedback;
    ZonePressure pressure;
    ZoneStatus status;
    command.zone = feedback.zone = pressure.zone = status.zone = zone;
    for (const AnyMessage& message :
         {AnyMessage(command), AnyMessage(feedback), AnyMessage(pressure), AnyMessage(status)}) {
      EXPECT_EQ(encode_any(message, context, frame).error(), CodecError::kUnknownId);
    }
    EXPECT_EQ(context.counter, 0);
  }
}

TEST(Codec, CountsEveryFrameAndWraps) {
  SendContext context{0, 254};
  CanFrame frame;
  LockStep received;
  for (const int expected : {254, 255, 0, 1}) {
    ASSERT_TRUE(encode(LockStep{}, context, frame));
    EXPECT_EQ(decode(frame, 0, received)->counter, expected);
  }
}

TEST(Codec, AReusedFrameKeepsNothingOfItsEarlierContent) {
  CanFrame used;
  used.id = 0x1FFFFFFF;
  used.extended = used.remote = used.error = true;
  used.length = 64;
  used.data.fill(0xEE);
  used.kernel_time_ns = 5;
  SendContext context{0, 3};
  ASSERT_TRUE(encode(HostStop{true, 4}, context, used));
  const CanFrame fresh = encoded(HostStop{true, 4});
  EXPECT_EQ(used.id, fresh.id);
  EXPECT_FALSE(used.extended || used.remote || used.error);
  EXPECT_TRUE(used.fd);
  EXPECT_EQ(used.length, 8);
  EXPECT_EQ(used.data, fresh.data);
  EXPECT_EQ(used.kernel_time_ns, 0);
}

TEST(Codec, RefusesForeignFormatsBeforeItLooksAtTheContent) {
  for (auto& [name, message] : every_message()) {
    const CanFrame good = encoded(message);
    const auto error_of = [&](auto change) {
      CanFrame frame = good;
      change(frame);
      AnyMessage read = message;
      const auto result = decode_any(frame, 0, read);
      EXPECT_FALSE(result) << name;
      return result ? CodecError::kNotFinite : result.error();
    };
    EXPECT_EQ(error_of([](CanFrame& f) { f.extended = true; }), CodecError::kUnknownId);
    EXPECT_EQ(error_of([](CanFrame& f) { f.remote = true; }), CodecError::kUnknownId);
    EXPECT_EQ(error_of([](CanFrame& f) { f.error = true; }), CodecError::kUnknownId);
    EXPECT_EQ(error_of([](CanFrame& f) { f.id = 0x7FF; }), CodecError::kUnknownId);
    EXPECT_EQ(error_of([](CanFrame& f) { f.id = 0; }), CodecError::kUnknownId);
    EXPECT_EQ(error_of([](CanFrame& f) { f.id |= 0x80000000u; }), CodecError::kUnknownId);
    EXPECT_EQ(error_of([](CanFrame& f) { f.fd = false; }), CodecError::kWrongFormat);
    EXPECT_EQ(error_of([](CanFrame& f) { --f.length; }), CodecError::kWrongLength);
    EXPECT_EQ(error_of([](CanFrame& f) { ++f.length; }), CodecError::kWrongLength);
    EXPECT_EQ(error_of([](CanFrame& f) { f.length = 0; }), CodecError::kWrongLength);
    EXPECT_EQ(error_of([](CanFrame& f) { f.data[3] ^= 0x10; }), CodecError::kBadCrc);
  }
}

TEST(Codec, AMessageIsNotReadAsAnother) {
  const auto all = every_message();
  for (const auto& [name, message] : all) {
    const CanFrame frame = encoded(message);
    for (const auto& [other_name, other] : all) {
      if (other.index() == message.index()) continue;
      AnyMessage read = other;
      const auto result = decode_any(frame, 0, read);
      ASSERT_FALSE(result);
      EXPECT_EQ(result.error(), CodecError::kUnknownId) << name << " as " << other_name;
    }
  }
}

TEST(Codec, BytesBeyondTheLengthDoNotCount) {
  CanFrame frame = encoded(LockStep{5});
  for (int i = 8; i < kMaxPayloadBytes; ++i) frame.data[i] = 0xFF;
  LockStep read;
  ASSERT_TRUE(decode(frame, 0, read));
  EXPECT_EQ(read.run_until_ms, 5u);
}

TEST(Catalogue, KnowsEveryFrameByItsId) {
  std::set<MessageKind> kinds;
  std::set<std::uint32_t> ids;
  for (auto& [name, message] : every_message()) {
    const CanFrame frame = encoded(message);
    EXPECT_EQ(name_of(frame), name);
    EXPECT_TRUE(ids.insert(frame.id).second);
    kinds.insert(kind_of(frame));
    const bool has_zone = name.starts_with("Zone");
    EXPECT_EQ(zone_of(frame), has_zone ? static_cast<int>(frame.id & 0xF) : -1) << name;
  }
  EXPECT_EQ(ids.size(), 31u);
  EXPECT_EQ(kinds.size(), 11u);
  EXPECT_FALSE(kinds.contains(MessageKind::kUnknown));
  EXPECT_EQ(kind_of(encoded(HostStop{})), MessageKind::kHostStop);
  EXPECT_EQ(kind_of(encoded(some_command())), MessageKind::kZoneCommand);
}

template <typename Message>
void expect_zone_comes_back() {
  for (int zone = 0; zone < kNumZones; ++zone) {
    Message message, received;
    message.zone = zone;
    SendContext context;
    CanFrame frame;
    ASSERT_TRUE(encode(message, context, frame));
    ASSERT_TRUE(decode(frame, 0, received));
    EXPECT_EQ(received.zone, zone);
  }
}

TEST(Codec, TheIdSaysWhichZoneSpeaks) {
  expect_zone_comes_back<ZoneCommand>();
  expect_zone_comes_back<ZoneFeedback>();
  expect_zone_comes_back<ZonePressure>();
  expect_zone_comes_back<ZoneStatus>();
}

TEST(Catalogue, ForeignFramesAreUnknown) {
  CanFrame frame = encoded(some_command());
  for (bool CanFrame::* flag : {&CanFrame::extended, &CanFrame::remote, &CanFrame::error}) {
    frame.*flag = true;
    EXPECT_EQ(kind_of(frame), MessageKind::kUnknown);
    EXPECT_EQ(zone_of(frame), -1);
    EXPECT_STREQ(name_of(frame), "unknown");
    frame.*flag = false;
  }
  frame.id = 0x086;
  EXPECT_EQ(kind_of(frame), MessageKind::kUnknown);
  EXPECT_EQ(zone_of(frame), -1);
}

TEST(Catalogue, FindsEveryJointOnTheBus) {
  for (int zone = 0; zone < kNumZones; ++zone) {
    for (std::size_t i = 0; i < kZoneJoints[zone].size(); ++i) {
      const JointSlot slot = slot_of(kZoneJoints[zone][i]);
      EXPECT_EQ(slot.zone, zone) << kZoneJoints[zone][i];
      EXPECT_EQ(slot.index, static_cast<int>(i));
    }
  }
  for (const char* stranger : {"", "BOOM2", "LF_PAR"}) {
    EXPECT_EQ(slot_of(stranger).zone, -1);
    EXPECT_EQ(slot_of(stranger).index, -1);
  }
}

TEST(Catalogue, StatesTheLimitsOfASlot) {
  const SlotLimits boom = limits_of(slot_of("BOOM"));
  EXPECT_EQ(boom.lower, -0.1);
  EXPECT_EQ(boom.upper, 1.28);
  EXPECT_EQ(boom.max_rate, 0.35);
  EXPECT_EQ(boom.max_acceleration, 0.3);
  const SlotLimits first = limits_of({0, 0});
  EXPECT_EQ(first.lower, -0.49);
  EXPECT_EQ(first.upper, 0.75);
  const SlotLimits yaw = limits_of(slot_of("EE_YAW"));
  EXPECT_EQ(yaw.lower, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(yaw.upper, std::numeric_limits<double>::infinity());
  EXPECT_EQ(yaw.max_rate, 0.5);
}

TEST(Catalogue, HasTheHashOfTheDbc) { EXPECT_NE(dbc_hash(), 0u); }

TEST(Catalogue, ASlotWithoutAJointHasNoLimits) {
  for (const JointSlot slot : {JointSlot{}, JointSlot{0, 4}, JointSlot{0, -1}, JointSlot{6, 0}}) {
    EXPECT_EQ(limits_of(slot).max_rate, 0.0);
    EXPECT_EQ(limits_of(slot).max_acceleration, 0.0);
    EXPECT_EQ(limits_of(slot).lower, 0.0);
    EXPECT_EQ(limits_of(slot).upper, 0.0);
  }
}

TEST(Catalogue, StatesPeriodsAndTimeouts) {
  EXPECT_DOUBLE_EQ(timing_of(MessageKind::kZoneCommand).period_s, 0.01);
  EXPECT_DOUBLE_EQ(timing_of(MessageKind::kZoneCommand).timeout_s, 0.05);
  EXPECT_DOUBLE_EQ(timing_of(MessageKind::kHostHeartbeat).period_s, 0.02);
  EXPECT_DOUBLE_EQ(timing_of(MessageKind::kHostHeartbeat).timeout_s, 0.1);
  EXPECT_EQ(timing_of(MessageKind::kHostStop).timeout_s, 0.0);
  EXPECT_EQ(timing_of(MessageKind::kUnknown).period_s, 0.0);
}

TEST(Words, NameErrorsAndModes) {
  std::set<std::string> words;
  for (int i = 0; i <= static_cast<int>(CodecError::kBadEnumeration); ++i) {
    words.insert(to_string(static_cast<CodecError>(i)));
  }
  EXPECT_EQ(words.size(), 7u);
  EXPECT_FALSE(words.contains("unknown error"));
  EXPECT_STREQ(to_string(static_cast<CodecError>(99)), "unknown error");
  EXPECT_STREQ(to_string(CodecError::kBadCrc), "bad CRC");
  EXPECT_STREQ(to_string(MachineMode::kInit), "Init");
  EXPECT_STREQ(to_string(MachineMode::kEStop), "EStop");
  EXPECT_STREQ(to_string(static_cast<MachineMode>(7)), "unknown");
}

TEST(Describe, TellsValuesWithUnits) {
  const std::string text = describe(encoded(some_command(), 42), 42);
  EXPECT_THAT(text, testing::StartsWith("0x082 ZoneCommandLH #3 "));
  EXPECT_THAT(text, HasSubstr(" LH_HFE_Rate=-0.1 rad/s"));
  EXPECT_THAT(text, HasSubstr(" LH_STEER_Active=0"));
  EXPECT_THAT(text, HasSubstr(" ValidForMs=50 ms"));
  EXPECT_THAT(text, Not(HasSubstr("[")));
  EXPECT_THAT(text, Not(HasSubstr("Crc=")));
  ZoneStatus status;
  status.mode = MachineMode::kHold;
  EXPECT_THAT(describe(encoded(status)), HasSubstr(" Mode=Hold "));
}

TEST(Describe, TellsWhatIsMissingOrWrong) {
  EXPECT_THAT(describe(encoded(some_command(), 42)), HasSubstr("[bad CRC or another session]"));
  CanFrame frame = encoded(HostStop{true, 4});
  frame.data[7] = 1;
  EXPECT_THAT(describe(frame), HasSubstr("[bad CRC] Active=1 Cause=4"));
  frame.data[7] = 0;
  frame.fd = false;
  EXPECT_THAT(describe(frame), HasSubstr("HostStop wrong format "));
  frame.fd = true;
  frame.length = 2;
  EXPECT_THAT(describe(frame), testing::MatchesRegex("0x020 HostStop wrong length [0-9A-F]{4}"));
  BasePose pose;
  EXPECT_THAT(describe(encoded(pose)), HasSubstr("Yaw=n/a Pitch=n/a"));
  frame = encoded(OperatorCommand{});
  frame.data[3] = 15;
  EXPECT_THAT(describe(frame), HasSubstr("Action=15 [out of range]"));
}

TEST(Describe, NamesForeignFrames) {
  CanFrame frame;
  frame.id = 0x123;
  frame.length = 2;
  frame.data[1] = 0xAB;
  EXPECT_EQ(describe(frame), "0x123 unknown id 00AB");
  frame.remote = true;
  EXPECT_EQ(describe(frame), "0x123 remote frame");
  frame.error = true;
  EXPECT_EQ(describe(frame), "0x123 error frame 00AB");
  CanFrame extended;
  extended.id = 0x10;
  extended.extended = true;
  extended.length = 200;  // nothing may be read beyond the payload
  EXPECT_EQ(describe(extended), "0x00000010 unknown id " + std::string(128, '0'));
}

}  // namespace
}  // namespace wex::can
