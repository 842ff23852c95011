#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <random>

#include "hw_interface/socketcan/frame_fields.hpp"
#include "hw_interface/socketcan/protection.hpp"
#include "tests/hw_interface/socketcan/codec_fields.hpp"

// Random frames into the decoder: nothing crashes, and no more is let through than the CRC must let
// through by chance. WEX_FUZZ_FRAMES sets how many (default 1,000,000).

namespace wex::can {
namespace {

long num_frames() {
  const char* wanted = std::getenv("WEX_FUZZ_FRAMES");
  return wanted == nullptr ? 1'000'000 : std::atol(wanted);
}

/// Six standard deviations above the mean of a rare event's count.
double upper_bound(double mean) { return mean + 6.0 * std::sqrt(mean) + 1.0; }

class Fuzz {
 public:
  CanFrame random_frame() {
    CanFrame frame;
    for (std::size_t i = 0; i < frame.data.size(); i += 8) {
      const std::uint64_t bits = random_();
      std::memcpy(&frame.data[i], &bits, 8);
    }
    const std::uint64_t dice = random_();
    if ((dice & 3) != 0) {  // three in four get through to the CRC
      const auto& row = generated::kMessages[(dice >> 8) % generated::kMessages.size()];
      frame.id = row.id;
      frame.length = row.length;
      frame.fd = true;
    } else {
      frame.id = static_cast<std::uint32_t>((dice & 4) != 0 ? dice >> 53 : dice >> 32);
      frame.length = static_cast<std::uint8_t>(dice >> 24);
      frame.fd = (dice & 8) != 0;
      frame.extended = (dice & 0x30) == 0;
      frame.remote = (dice & 0xC0) == 0;
      frame.error = (dice & 0x700) == 0;
    }
    return frame;
  }

 private:
  std::mt19937_64 random_{20240607};
};

TEST(FuzzedDecoder, LetsThroughNoMoreThanChance) {
  std::vector<AnyMessage> messages;  // one of each type; zones share their type
  for (auto& [name, message] : every_message()) {
    if (!name.starts_with("Zone") || name.ends_with("LF")) messages.push_back(message);
  }
  ASSERT_EQ(messages.size(), std::variant_size_v<AnyMessage>);
  Fuzz fuzz;
  const long wanted = num_frames();
  long well_formed = 0, right_crc = 0, accepted = 0;
  std::size_t described = 0;
  for (long i = 0; i < wanted; ++i) {
    const CanFrame frame = fuzz.random_frame();
    bool formed = false, crc = false, taken = false;
    for (AnyMessage& message : messages) {
      const auto result = decode_any(frame, 0, message);
      formed |= result || result.error() == CodecError::kBadCrc ||
                result.error() == CodecError::kOutOfRange ||
                result.error() == CodecError::kBadEnumeration;
      crc |= result || result.error() == CodecError::kOutOfRange ||
             result.error() == CodecError::kBadEnumeration;
      taken |= result.has_value();
    }
    well_formed += formed;
    right_crc += crc;
    accepted += taken;
    if (i % 100 == 0) described += describe(frame).size();
  }
  std::cout << wanted << " random frames: " << well_formed << " of known id, format and length, "
            << right_crc << " of them with a right CRC (expected "
            << static_cast<double>(well_formed) / 65536.0 << "), " << accepted << " accepted\n";
  EXPECT_GT(well_formed, wanted / 2);
  EXPECT_LT(well_formed, wanted * 4 / 5);
  EXPECT_LE(right_crc, upper_bound(static_cast<double>(well_formed) / 65536.0));
  EXPECT_LE(accepted, right_crc);
  EXPECT_GT(described, 0u);
}

TEST(FuzzedClassicFrames, PassTheCrcAsOftenAsChanceAllows) {
  Fuzz fuzz;
  const long wanted = num_frames();
  long passed = 0;
  for (long i = 0; i < wanted; ++i) {
    const CanFrame frame = fuzz.random_frame();
    passed += crc8(std::span(frame.data).subspan(1, 9)) == frame.data[0];
  }
  EXPECT_LE(passed, upper_bound(static_cast<double>(wanted) / 256.0));
  EXPECT_GE(passed, wanted / 256 / 2);
}

}  // namespace
}  // namespace wex::can
