#include <gtest/gtest.h>

#include <array>
#include <iostream>
#include <map>
#include <set>
#include <vector>

#include "hw_interface/socketcan/frame_fields.hpp"
#include "tests/hw_interface/socketcan/codec_fields.hpp"

// What wrong bits the decoder notices, over every frame of the protocol.

namespace wex::can {
namespace {

constexpr std::uint32_t kSession = 0xC0FFEE11;

struct Sample {
  std::string name;
  AnyMessage message;
  CanFrame frame;
};

std::vector<Sample> samples() {
  std::vector<Sample> all;
  SendContext context{kSession, 0x5A};
  for (auto& [name, message] : every_message()) {
    CanFrame frame;
    EXPECT_TRUE(encode_any(message, context, frame)) << name;
    all.push_back({name, message, frame});
  }
  return all;
}

bool accepted(const Sample& sample) {
  AnyMessage message = sample.message;
  return decode_any(sample.frame, kSession, message).has_value();
}

void flip(Sample& sample, int bit) {
  sample.frame.data[bit / 8] ^= static_cast<std::uint8_t>(1 << (bit % 8));
}

TEST(BitFlips, AllOneAndTwoBitFlipsOfEveryFrameAreDetected) {
  long tried = 0, undetected = 0;
  for (Sample& sample : samples()) {
    ASSERT_TRUE(accepted(sample)) << sample.name;
    const int bits = 8 * sample.frame.length;
    for (int i = 0; i < bits; ++i) {
      flip(sample, i);
      ++tried;
      undetected += accepted(sample);
      for (int j = i + 1; j < bits; ++j) {
        flip(sample, j);
        ++tried;
        undetected += accepted(sample);
        flip(sample, j);
      }
      flip(sample, i);
    }
    ASSERT_TRUE(accepted(sample)) << sample.name;
  }
  std::cout << tried << " patterns of one and two flipped bits, " << undetected << " undetected\n";
  EXPECT_EQ(undetected, 0);
}

TEST(BitFlips, AllThreeBitFlipsOfEightByteFramesAreDetected) {
  long all_tried = 0, all_undetected = 0;
  for (Sample& sample : samples()) {
    if (sample.frame.length != 8) continue;
    int tried = 0, undetected = 0;
    for (int i = 0; i < 64; ++i) {
      for (int j = i + 1; j < 64; ++j) {
        for (int k = j + 1; k < 64; ++k) {
          for (const int bit : {i, j, k}) flip(sample, bit);
          ++tried;
          undetected += accepted(sample);
          for (const int bit : {i, j, k}) flip(sample, bit);
        }
      }
    }
    EXPECT_EQ(tried, 41664);
    EXPECT_EQ(undetected, 0) << sample.name;
    all_tried += tried;
    all_undetected += undetected;
  }
  std::cout << all_tried << " of three in 8 bytes, " << all_undetected << " undetected\n";
}

// The CRC is linear: a pattern of flips goes unseen exactly if the changes that its bits make to
// "CRC computed xor CRC sent" cancel. Three cancel if the third is the xor of the first two, which
// is looked up for all pairs: the same as trying all patterns (9,363,584 for 48 bytes).
TEST(BitFlips, AllThreeBitFlipsOfLongerFramesAreDetected) {
  std::size_t covered = 0;
  long all_undetected = 0;
  for (Sample& sample : samples()) {
    const MessageRow& row = *row_of(sample.frame.id);
    const auto disagreement = [&] {
      const unsigned sent = sample.frame.data[0] | (sample.frame.data[1] << 8);
      return sent ^ protection_crc(row, sample.frame.data.data(), kSession);
    };
    ASSERT_EQ(disagreement(), 0u);
    std::vector<unsigned> change;
    for (int i = 0; i < 8 * sample.frame.length; ++i) {
      flip(sample, i);
      change.push_back(disagreement());
      flip(sample, i);
    }
    const std::set<unsigned> single(change.begin(), change.end());
    ASSERT_EQ(single.size(), change.size()) << sample.name << ": two bits change the same";
    long undetected = 0;
    for (std::size_t i = 0; i < change.size(); ++i) {
      for (std::size_t j = i + 1; j < change.size(); ++j) {
        undetected += single.count(change[i] ^ change[j]);
      }
    }
    EXPECT_EQ(undetected, 0) << sample.name;
    all_undetected += undetected;
    covered += change.size() * (change.size() - 1) * (change.size() - 2) / 6;
  }
  std::cout << covered << " of three in 8 to 48 bytes by the CRC's linearity, " << all_undetected
            << " undetected\n";
}

TEST(Protection, NoFrameIsAcceptedUnderAnotherId) {
  for (const Sample& sample : samples()) {
    for (const Sample& other : samples()) {
      if (other.name == sample.name) continue;
      Sample disguised = other;
      disguised.frame.data = sample.frame.data;
      EXPECT_FALSE(accepted(disguised)) << sample.name << " as " << other.name;
    }
  }
}

TEST(Protection, CommandsOfAnotherSessionAreRefused) {
  for (const Sample& sample : samples()) {
    AnyMessage message = sample.message;
    for (const std::uint32_t other : {0u, 1u, kSession ^ 1u, kSession ^ 0x80000000u}) {
      const auto result = decode_any(sample.frame, other, message);
      if (std::holds_alternative<ZoneCommand>(message)) {
        ASSERT_FALSE(result);
        EXPECT_EQ(result.error(), CodecError::kBadCrc);
      } else {
        EXPECT_TRUE(result) << sample.name;
      }
    }
  }
}

}  // namespace
}  // namespace wex::can
