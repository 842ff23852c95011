#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>

#include "hw_interface/socketcan/signal_row.hpp"
#include "tests/hw_interface/socketcan/codec_fields.hpp"
#include "tests/hw_interface/socketcan/dbc_text.hpp"

// Every signal at and beyond its ends, in both directions, against the text of wex.dbc.

namespace wex::can {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint32_t kSession = 0x12345678;

class SignalRanges : public testing::Test {
 protected:
  const std::map<std::string, DbcMessage> dbc = read_wex_dbc();

  /// Calls `check(dbc message, dbc signal, message, its field)` for every field of every message.
  template <typename Check>
  void for_every_field(Check check) {
    int num_fields = 0;
    for (auto& [name, initial] : every_message()) {
      const std::size_t count = fields(initial).size();
      for (std::size_t i = 0; i < count; ++i) {
        AnyMessage message = initial;
        const Field field = fields(message)[i];
        SCOPED_TRACE(name + "." + field.signal);
        check(dbc.at(name), dbc.at(name).signal(field.signal), message, field);
        ++num_fields;
      }
    }
    EXPECT_GT(num_fields, 250);
  }
};

void expect_refused(const AnyMessage& message, CodecError reason) {
  SendContext context{kSession, 7};
  CanFrame frame;
  frame.id = 0x7FF;
  frame.data.fill(0xAA);
  const auto result = encode_any(message, context, frame);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error(), reason) << to_string(result.error());
  EXPECT_EQ(context.counter, 7);
  EXPECT_EQ(frame.id, 0x7FFu);
  EXPECT_EQ(frame.data[5], 0xAA);
}

TEST_F(SignalRanges, TheEndsGoOverTheBusAsTheyAre) {
  for_every_field(
      [](const DbcMessage& dbc, const DbcSignal& signal, AnyMessage& message, const Field& field) {
        for (const std::int64_t raw : {signal.raw_minimum(), signal.raw_maximum()}) {
          if (signal.name.ends_with("Quality") && raw > 1) continue;  // without value: tested below
          const double value =
              raw == signal.raw_minimum() ? signal.minimum : signal.maximum;  // as the DBC says it
          field.set(value);
          SendContext context{kSession, 255};
          CanFrame frame;
          ASSERT_TRUE(encode_any(message, context, frame));
          EXPECT_EQ(context.counter, 0);
          EXPECT_EQ(raw_of(frame, signal), raw);
          EXPECT_EQ(frame.id, dbc.id);
          EXPECT_EQ(frame.length, dbc.length);
          EXPECT_TRUE(frame.fd);
          AnyMessage back = message;
          fields(back);
          const auto meta = decode_any(frame, kSession, back);
          ASSERT_TRUE(meta) << to_string(meta.error());
          EXPECT_EQ(meta->counter, 255);
          for (const Field& read : fields(back)) {
            if (read.signal == field.signal) {
              EXPECT_EQ(read.get(), value);
            }
          }
        }
      });
}

TEST_F(SignalRanges, ValuesBeyondTheEndsAreRefusedWithTheReason) {
  for_every_field(
      [](const DbcMessage&, const DbcSignal& signal, AnyMessage& message, const Field& field) {
        if (field.is_real) {
          for (const double beyond : {signal.minimum - signal.scale, signal.maximum + signal.scale,
                                      std::nextafter(signal.minimum, -kInfinity),
                                      std::nextafter(signal.maximum, kInfinity), -1e300, 1e300}) {
            field.set(beyond);
            expect_refused(message, CodecError::kOutOfRange);
          }
          for (const double value : {kNan, -kNan, kInfinity, -kInfinity}) {
            field.set(value);
            expect_refused(message, CodecError::kNotFinite);
          }
        } else if (signal.is_enumeration()) {
          for (const double unlisted : {signal.maximum + 1.0, 255.0}) {
            field.set(unlisted);
            expect_refused(message, CodecError::kBadEnumeration);
          }
        } else {
          // The field's own type holds exactly the signal's range, so that nothing can lie beyond.
          field.set(signal.maximum);
          EXPECT_EQ(field.get(), signal.maximum);
          EXPECT_EQ(signal.minimum, 0.0);
          EXPECT_EQ(signal.maximum, std::exp2(signal.bits) - 1.0);
        }
      });
}

TEST_F(SignalRanges, ValuesInBetweenAreRoundedToTheNearestCount) {
  for_every_field([](const DbcMessage&, const DbcSignal& signal, AnyMessage& message,
                     const Field& field) {
    if (!field.is_real) return;
    for (const double fraction : {-0.49, -0.3, 0.0, 0.3, 0.49}) {
      for (const std::int64_t raw :
           {signal.raw_minimum() + 1, std::int64_t{0}, std::int64_t{1}, signal.raw_maximum() - 1}) {
        field.set((static_cast<double>(raw) + fraction) * signal.scale);
        SendContext context{kSession, 0};
        CanFrame frame;
        ASSERT_TRUE(encode_any(message, context, frame));
        EXPECT_EQ(raw_of(frame, signal), raw) << field.get();
      }
    }
  });
}

TEST_F(SignalRanges, ReceivedNumbersBeyondTheEndsAreRefused) {
  for_every_field([](const DbcMessage& dbc, const DbcSignal& signal, AnyMessage& message,
                     const Field&) {
    SendContext context{kSession, 0};
    CanFrame good;
    ASSERT_TRUE(encode_any(message, context, good));
    const std::int64_t top = (std::int64_t{1} << (signal.bits - (signal.is_signed ? 1 : 0))) - 1;
    const std::int64_t bottom = signal.is_signed ? -top : 0;
    std::vector<std::int64_t> beyond;
    if (signal.raw_maximum() < top) beyond.insert(beyond.end(), {signal.raw_maximum() + 1, top});
    if (signal.raw_minimum() > bottom) {
      beyond.insert(beyond.end(), {signal.raw_minimum() - 1, bottom});
    }
    const bool may_be_absent = signal.name.find("_Pressure") != std::string::npos;
    if (signal.is_signed && !may_be_absent) beyond.push_back(signal.not_available());
    for (const std::int64_t raw : beyond) {
      CanFrame frame = good;
      set_raw(frame, signal, raw);
      protect(frame, dbc, std::holds_alternative<ZoneCommand>(message) ? kSession : 0);
      AnyMessage read = message;
      fields(read)[0].set(1.0);
      const auto result = decode_any(frame, kSession, read);
      ASSERT_FALSE(result) << raw;
      EXPECT_EQ(result.error(),
                signal.is_enumeration() ? CodecError::kBadEnumeration : CodecError::kOutOfRange);
      EXPECT_EQ(fields(read)[0].get(), 1.0) << "the message must stay untouched";
    }
  });
}

TEST_F(SignalRanges, ValuesWithoutQualityGoAndComeAsNotAvailable) {
  const std::vector<JointQuality> without{JointQuality::kInvalid, JointQuality::kNotAvailable};
  for (const JointQuality quality : without) {
    ZoneFeedback feedback;
    feedback.zone = 4;
    feedback.position[1] = feedback.rate[1] = feedback.spool[1] = kNan;
    feedback.quality[1] = quality;
    SendContext context;
    CanFrame frame;
    ASSERT_TRUE(encode(feedback, context, frame));
    const DbcMessage& message = dbc.at("ZoneFeedbackARM");
    for (const char* signal : {"BOOM_Position", "BOOM_Rate", "BOOM_Spool"}) {
      EXPECT_EQ(raw_of(frame, message.signal(signal)), message.signal(signal).not_available());
    }
    // A sender that leaves a number there is not believed either.
    set_raw(frame, message.signal("BOOM_Position"), 1000);
    protect(frame, message);
    ZoneFeedback read;
    ASSERT_TRUE(decode(frame, 0, read));
    EXPECT_EQ(read.quality[1], quality);
    EXPECT_TRUE(std::isnan(read.position[1]));
    EXPECT_TRUE(std::isnan(read.rate[1]));
    EXPECT_TRUE(std::isnan(read.spool[1]));
    EXPECT_EQ(read.quality[0], JointQuality::kOk);
    EXPECT_EQ(read.position[0], 0.0);

    BasePose pose;
    pose.p_map_base_m.x() = kInfinity;
    pose.quality = quality;
    ASSERT_TRUE(encode(pose, context, frame));
    BasePose read_pose;
    read_pose.sample_time_ms = 9;
    ASSERT_TRUE(decode(frame, 0, read_pose));
    EXPECT_EQ(read_pose.quality, quality);
    EXPECT_EQ(read_pose.sample_time_ms, 0u);
    EXPECT_TRUE(read_pose.p_map_base_m.array().isNaN().all());
    EXPECT_TRUE(read_pose.velocity_m_s.array().isNaN().all());
    EXPECT_TRUE(std::isnan(read_pose.yaw_rad + read_pose.pitch_rad + read_pose.roll_rad));
  }
}

TEST_F(SignalRanges, StaleValuesAreStillValues) {
  ZoneFeedback feedback;
  feedback.zone = 5;
  feedback.quality[2] = JointQuality::kStale;
  feedback.position[2] = 1.5;
  SendContext context;
  CanFrame frame;
  ASSERT_TRUE(encode(feedback, context, frame));
  ZoneFeedback read;
  ASSERT_TRUE(decode(frame, 0, read));
  EXPECT_EQ(read.quality[2], JointQuality::kStale);
  EXPECT_EQ(read.position[2], 1.5);
  feedback.position[2] = kNan;
  EXPECT_FALSE(encode(feedback, context, frame));
}

TEST_F(SignalRanges, AMissingPressureSensorIsNotAZero) {
  SendContext context;
  CanFrame frame;
  ASSERT_TRUE(encode(ZonePressure{}, context, frame));
  const DbcMessage& message = dbc.at("ZonePressureLF");
  set_raw(frame, message.signal("LF_HFE_PressureB"), -32768);
  protect(frame, message);
  ZonePressure read;
  ASSERT_TRUE(decode(frame, 0, read));
  EXPECT_TRUE(std::isnan(read.pressure_b_pa[1]));
  EXPECT_EQ(read.pressure_a_pa[1], 0.0);
}

TEST(Quantize, RefusesWhatTheRawRangeCannotHoldEvenIfTheTableAllowsIt) {
  SignalRow row{};
  row.numerator = 1.0;
  row.denominator = 10.0;
  row.minimum = -10.0;  // a table gone wrong: 100 counts wanted, 5 allowed
  row.maximum = 10.0;
  row.raw_min = -5;
  row.raw_max = 5;
  EXPECT_EQ(quantize(row, 0.5).value(), 5);
  EXPECT_EQ(quantize(row, -0.5).value(), -5);
  EXPECT_EQ(quantize(row, 0.56).error(), CodecError::kOutOfRange);
  EXPECT_EQ(quantize(row, -0.56).error(), CodecError::kOutOfRange);
}

}  // namespace
}  // namespace wex::can
