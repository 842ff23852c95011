#include "hw_interface/socketcan/protection.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace wex::can {
namespace {

constexpr std::uint16_t kPolynomial16 = 0x1021;
constexpr std::uint8_t kPolynomial8 = 0x2F;

/// Remainders of all bytes, most significant bit first.
template <typename Crc>
constexpr std::array<Crc, 256> crc_table(Crc polynomial) {
  constexpr unsigned kTop = sizeof(Crc) * 8 - 1;
  std::array<Crc, 256> table{};
  for (unsigned byte = 0; byte < 256; ++byte) {
    unsigned crc = byte << (kTop - 7);
    for (int bit = 0; bit < 8; ++bit) {
      crc = ((crc >> kTop) & 1u) != 0 ? (crc << 1) ^ polynomial : crc << 1;
    }
    table[byte] = static_cast<Crc>(crc);
  }
  return table;
}

constexpr auto kTable16 = crc_table<std::uint16_t>(kPolynomial16);
constexpr auto kTable8 = crc_table<std::uint8_t>(kPolynomial8);

}  // namespace

std::uint16_t crc16(std::span<const std::uint8_t> bytes, std::uint16_t start) noexcept {
  std::uint16_t crc = start;
  for (const std::uint8_t byte : bytes) {
    crc = static_cast<std::uint16_t>((crc << 8) ^ kTable16[(crc >> 8) ^ byte]);
  }
  return crc;
}

std::uint8_t crc8(std::span<const std::uint8_t> bytes) noexcept {
  std::uint8_t crc = 0xFF;
  for (const std::uint8_t byte : bytes) crc = kTable8[crc ^ byte];
  return crc ^ 0xFF;
}

SequenceVerdict SequenceCheck::update(std::uint8_t counter, int missing) noexcept {
  last_verdict_ = judge(counter, missing);
  return last_verdict_;
}

int SequenceCheck::missing_after(double elapsed_ms, double period_ms) noexcept {
  constexpr double kTolerance_ms = 0.5;  // stamps are whole milliseconds
  constexpr double kMany = 255.0;        // of more, a counter knows nothing
  if (!(elapsed_ms > 0.0 && period_ms > 0.0)) return 0;
  const double due = std::floor(std::min(kMany, (elapsed_ms + kTolerance_ms) / period_ms));
  return std::max(0, static_cast<int>(due) - 1);
}

SequenceVerdict SequenceCheck::judge(std::uint8_t counter, int missing) noexcept {
  const int delta = (counter - last_ + settings_.modulus) % settings_.modulus;
  last_ = counter;
  if (!seen_) {
    seen_ = true;
    return SequenceVerdict::kFirst;
  }
  if (delta == 0) return SequenceVerdict::kRepeated;
  // Never more than half of the circle: behind it are the old ones.
  const int allowed = std::min(settings_.max_delta + std::max(0, missing),
                               std::max(settings_.max_delta, settings_.modulus / 2 - 1));
  if (delta > allowed) {
    good_needed_ = settings_.good_to_recover;
    return SequenceVerdict::kWrongSequence;
  }
  lost_ += delta - 1;
  if (good_needed_ > 0) --good_needed_;
  return delta == 1 ? SequenceVerdict::kOk : SequenceVerdict::kLostSome;
}

void SequenceCheck::reset() noexcept {
  seen_ = false;
  good_needed_ = 0;
}

}  // namespace wex::can
