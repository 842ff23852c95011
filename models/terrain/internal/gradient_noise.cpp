#include "models/terrain/internal/gradient_noise.hpp"

#include <cmath>

namespace wex::terrain_internal {
namespace {

constexpr std::uint64_t kGoldenGamma = 0x9e3779b97f4a7c15ULL;

/// The upper 53 bits as a number in [0, 1).
double unit_interval(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

}  // namespace

std::uint64_t mix_bits(std::uint64_t value) {
  value += kGoldenGamma;
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9ULL;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebULL;
  return value ^ (value >> 31);
}

RandomStream::RandomStream(std::uint64_t seed, std::uint64_t stream)
    : state_(mix_bits(mix_bits(seed) ^ stream)) {}

double RandomStream::uniform(double low, double high) {
  const double unit = unit_interval(mix_bits(state_));
  state_ += kGoldenGamma;
  return low + (high - low) * unit;
}

double GradientNoise::corner(std::int64_t i, std::int64_t j, double dx, double dy) const {
  std::uint64_t bits =
      mix_bits(mix_bits(seed_ ^ static_cast<std::uint64_t>(i)) ^ static_cast<std::uint64_t>(j));
  // A direction without sine and cosine, which differ between maths libraries: the first point of
  // the sequence that falls into the unit disc.
  while (true) {
    const double u = 2.0 * unit_interval(bits) - 1.0;
    bits = mix_bits(bits);
    const double v = 2.0 * unit_interval(bits) - 1.0;
    bits = mix_bits(bits);
    const double squared = u * u + v * v;
    if (squared > 0.01 && squared <= 1.0) return (u * dx + v * dy) / std::sqrt(squared);
  }
}

double GradientNoise::at(double x, double y) const {
  const double floor_x = std::floor(x);
  const double floor_y = std::floor(y);
  const auto i = static_cast<std::int64_t>(floor_x);
  const auto j = static_cast<std::int64_t>(floor_y);
  const double dx = x - floor_x;
  const double dy = y - floor_y;
  const auto fade = [](double t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); };
  const double weight_x = fade(dx);
  const double weight_y = fade(dy);
  const auto mix = [](double a, double b, double weight) { return a + weight * (b - a); };
  return mix(
      mix(corner(i, j, dx, dy), corner(i + 1, j, dx - 1.0, dy), weight_x),
      mix(corner(i, j + 1, dx, dy - 1.0), corner(i + 1, j + 1, dx - 1.0, dy - 1.0), weight_x),
      weight_y);
}

}  // namespace wex::terrain_internal
