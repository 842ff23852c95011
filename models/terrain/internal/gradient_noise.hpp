#pragma once

#include <cstdint>

namespace wex::terrain_internal {

/// One step of SplitMix64 [Steele, Lea and Flood 2014]: a well mixed function of its argument.
[[nodiscard]] std::uint64_t mix_bits(std::uint64_t value);

/// Random numbers that are the same on every platform (the standard's distributions are not).
class RandomStream {
 public:
  /// Streams of one seed are independent of each other.
  RandomStream(std::uint64_t seed, std::uint64_t stream);
  /// Uniform in [low, high).
  [[nodiscard]] double uniform(double low, double high);

 private:
  std::uint64_t state_;
};

/// Gradient noise [Perlin 2002, "Improving Noise"] with unit lattice distance: C2, zero on the
/// lattice, about +-0.7 at most. The same on every platform up to round-off.
class GradientNoise {
 public:
  explicit GradientNoise(std::uint64_t seed) : seed_(seed) {}
  [[nodiscard]] double at(double x, double y) const;

 private:
  /// Random unit vector of a lattice point, times the offset (dx, dy) from it.
  [[nodiscard]] double corner(std::int64_t i, std::int64_t j, double dx, double dy) const;
  std::uint64_t seed_;
};

}  // namespace wex::terrain_internal
