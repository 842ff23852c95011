#include "hw_interface/socketcan/protection.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace wex::can {
namespace {

std::vector<std::uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

TEST(Crc, MeetsThePublishedCheckValues) {
  EXPECT_EQ(crc16(bytes_of("123456789")), 0x29B1);
  EXPECT_EQ(crc8(bytes_of("123456789")), 0xDF);
  EXPECT_EQ(crc16({}), 0xFFFF);
  EXPECT_EQ(crc8({}), 0x00);
}

TEST(Crc, ContinuesFromAnEarlierResult) {
  EXPECT_EQ(crc16(bytes_of("6789"), crc16(bytes_of("12345"))), 0x29B1);
}

// All patterns of one to three wrong bits in a classic frame: seven protected bytes and their CRC.
TEST(Crc, EightBitsDetectEveryFlipOfUpToThreeBitsInAClassicFrame) {
  const std::array<std::uint8_t, 2> data_id{0x80, 0x57};
  std::array<std::uint8_t, 8> frame{0, 0x35, 0x12, 0xEF, 0x80, 0x00, 0xFF, 0x7A};
  const auto right = [&] {
    std::array<std::uint8_t, 9> covered{};
    std::copy(frame.begin() + 1, frame.end(), covered.begin());
    std::copy(data_id.begin(), data_id.end(), covered.begin() + 7);
    return crc8(covered) == frame[0];
  };
  const auto flip = [&](int bit) { frame[bit / 8] ^= static_cast<std::uint8_t>(1 << (bit % 8)); };
  while (!right()) ++frame[0];
  std::array<int, 4> tried{}, undetected{};
  const auto judge = [&](int bits) {
    ++tried[bits];
    if (right()) ++undetected[bits];
  };
  for (int i = 0; i < 64; ++i) {
    flip(i);
    judge(1);
    for (int j = i + 1; j < 64; ++j) {
      flip(j);
      judge(2);
      for (int k = j + 1; k < 64; ++k) {
        flip(k);
        judge(3);
        flip(k);
      }
      flip(j);
    }
    flip(i);
  }
  EXPECT_THAT(tried, testing::ElementsAre(0, 64, 2016, 41664));
  EXPECT_THAT(undetected, testing::ElementsAre(0, 0, 0, 0));
}

SequenceCheck started_at(int counter, SequenceCheck::Settings settings = {}) {
  SequenceCheck check(settings);
  EXPECT_EQ(check.update(static_cast<std::uint8_t>(counter)), SequenceVerdict::kFirst);
  return check;
}

// What the settings say of a step of the counter.
SequenceVerdict verdict_of(int delta) {
  if (delta == 0) return SequenceVerdict::kRepeated;
  if (delta == 1) return SequenceVerdict::kOk;
  return delta <= 3 ? SequenceVerdict::kLostSome : SequenceVerdict::kWrongSequence;
}

TEST(SequenceCheck, JudgesEveryStepFromEveryCounter) {
  for (const int modulus : {16, 256}) {
    const SequenceCheck::Settings settings{.modulus = modulus};
    for (int first = 0; first < modulus; ++first) {
      for (int delta = 0; delta < modulus; ++delta) {
        SequenceCheck check = started_at(first, settings);
        const int second = (first + delta) % modulus;
        ASSERT_EQ(check.update(static_cast<std::uint8_t>(second)), verdict_of(delta))
            << "modulus " << modulus << ", " << first << " then " << second;
        ASSERT_EQ(check.trusted(), delta >= 1 && delta <= 3);
        ASSERT_EQ(check.lost_frames(), delta == 2 ? 1 : delta == 3 ? 2 : 0);
      }
    }
  }
}

TEST(SequenceCheck, AJumpThatTimeExplainsIsALoss) {
  for (int missing = 0; missing < 200; ++missing) {
    for (int delta = 1; delta < 256; ++delta) {
      SequenceCheck check = started_at(250);
      const auto counter = static_cast<std::uint8_t>(250 + delta);
      // Half of the circle is the past, however long the silence was.
      const bool loss = delta <= std::min(3 + missing, 127);
      const SequenceVerdict expected = !loss        ? SequenceVerdict::kWrongSequence
                                       : delta == 1 ? SequenceVerdict::kOk
                                                    : SequenceVerdict::kLostSome;
      ASSERT_EQ(check.update(counter, missing), expected) << missing << " " << delta;
      ASSERT_EQ(check.trusted(), loss);
      ASSERT_EQ(check.lost_frames(), loss ? delta - 1 : 0);
    }
  }
  EXPECT_EQ(started_at(7).update(7, 100), SequenceVerdict::kRepeated);
  EXPECT_EQ(started_at(7).update(11, -5), SequenceVerdict::kWrongSequence);
  EXPECT_EQ(started_at(7).update(10, -5), SequenceVerdict::kLostSome);
}

TEST(SequenceCheck, CountsTheFramesThatWereDueAndDidNotCome) {
  EXPECT_EQ(SequenceCheck::missing_after(10.0, 10.0), 0);
  EXPECT_EQ(SequenceCheck::missing_after(19.4, 10.0), 0);
  EXPECT_EQ(SequenceCheck::missing_after(19.6, 10.0), 1) << "stamps are whole milliseconds";
  EXPECT_EQ(SequenceCheck::missing_after(19.55, 10.0), 1);
  EXPECT_EQ(SequenceCheck::missing_after(5.0, 10.0), 0) << "it came early";
  EXPECT_EQ(SequenceCheck::missing_after(0.55, 0.1), 9);
  EXPECT_EQ(SequenceCheck::missing_after(0.0, 0.1), 0);
  EXPECT_EQ(SequenceCheck::missing_after(50.0, 10.0), 4);
  EXPECT_EQ(SequenceCheck::missing_after(100.0, 20.0), 4);
  EXPECT_EQ(SequenceCheck::missing_after(0.0, 10.0), 0);
  EXPECT_EQ(SequenceCheck::missing_after(-30.0, 10.0), 0);
  EXPECT_EQ(SequenceCheck::missing_after(1e12, 10.0), 254);
  EXPECT_EQ(SequenceCheck::missing_after(1000.0, 0.0), 0) << "sent upon events only";
  EXPECT_EQ(SequenceCheck::missing_after(std::nan(""), 10.0), 0);
}

TEST(SequenceCheck, TrustsNothingBeforeTheFirstFrame) {
  SequenceCheck check({});
  EXPECT_FALSE(check.trusted());
  EXPECT_EQ(check.update(77), SequenceVerdict::kFirst);
  EXPECT_TRUE(check.trusted());
}

TEST(SequenceCheck, WrapsWithoutALoss) {
  SequenceCheck check = started_at(254);
  for (const int counter : {255, 0, 1}) {
    EXPECT_EQ(check.update(static_cast<std::uint8_t>(counter)), SequenceVerdict::kOk);
  }
  EXPECT_EQ(check.lost_frames(), 0);
}

TEST(SequenceCheck, CountsLossesOverTheWrap) {
  SequenceCheck check = started_at(14, {.modulus = 16});
  EXPECT_EQ(check.update(1), SequenceVerdict::kLostSome);
  EXPECT_EQ(check.lost_frames(), 2);
  EXPECT_EQ(check.update(3), SequenceVerdict::kLostSome);
  EXPECT_EQ(check.lost_frames(), 3);
}

TEST(SequenceCheck, DistrustsAnOldFrameAndNeedsThreeGoodOnes) {
  SequenceCheck check = started_at(5);
  check.update(6);
  EXPECT_EQ(check.update(4), SequenceVerdict::kWrongSequence);  // overtaken by 5 and 6
  EXPECT_FALSE(check.trusted());
  EXPECT_EQ(check.update(7), SequenceVerdict::kLostSome);
  EXPECT_FALSE(check.trusted());
  EXPECT_EQ(check.update(8), SequenceVerdict::kOk);
  EXPECT_FALSE(check.trusted());
  EXPECT_EQ(check.update(9), SequenceVerdict::kOk);
  EXPECT_TRUE(check.trusted());
}

TEST(SequenceCheck, StartsCountingGoodFramesAnewAfterAnotherJump) {
  SequenceCheck check = started_at(0);
  check.update(100);
  check.update(101);
  check.update(102);
  EXPECT_EQ(check.update(50), SequenceVerdict::kWrongSequence);
  check.update(51);
  check.update(52);
  EXPECT_FALSE(check.trusted());
  check.update(53);
  EXPECT_TRUE(check.trusted());
}

TEST(SequenceCheck, RepetitionsAreNeitherUsedNorProofOfRecovery) {
  SequenceCheck check = started_at(9);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(check.update(9), SequenceVerdict::kRepeated);
    EXPECT_FALSE(check.trusted());
  }
  EXPECT_EQ(check.update(10), SequenceVerdict::kOk);
  EXPECT_TRUE(check.trusted());

  check.update(60);
  for (int i = 0; i < 5; ++i) check.update(60);
  EXPECT_EQ(check.update(61), SequenceVerdict::kOk);
  EXPECT_FALSE(check.trusted());
}

TEST(SequenceCheck, ARestartedSenderIsNotTrustedAtOnce) {
  SequenceCheck check = started_at(200);
  EXPECT_EQ(check.update(0), SequenceVerdict::kWrongSequence);
  EXPECT_FALSE(check.trusted());
}

TEST(SequenceCheck, ResetForgetsTheSequenceAndKeepsTheCount) {
  SequenceCheck check = started_at(1);
  check.update(4);
  check.update(90);
  check.reset();
  EXPECT_FALSE(check.trusted());
  EXPECT_EQ(check.update(33), SequenceVerdict::kFirst);
  EXPECT_TRUE(check.trusted());
  EXPECT_EQ(check.lost_frames(), 2);
  EXPECT_EQ(check.update(34), SequenceVerdict::kOk);
}

}  // namespace
}  // namespace wex::can
