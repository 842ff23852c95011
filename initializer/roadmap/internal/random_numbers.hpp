#pragma once

#include <cstdint>

namespace wex {

/// SplitMix64 [Steele, Lea, Flood 2014]: the same numbers with every standard library, which its
/// distributions do not promise.
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed, std::uint64_t stream = 0)
      : state_(seed ^ (stream * 0xD1B54A32D192ED03ULL)) {}

  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ULL);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
  }

  /// In [lower, upper).
  double between(double lower, double upper) {
    const double unit = static_cast<double>(next() >> 11) * 0x1p-53;
    return lower + unit * (upper - lower);
  }

 private:
  std::uint64_t state_;
};

}  // namespace wex
