#include "hw_interface/electronics/random_source.hpp"

#include <sys/random.h>

#include <cstdlib>

namespace wex::can {

std::uint32_t SystemRandom::next() noexcept {
  std::uint32_t value = 0;
  // Up to 256 bytes come whole once the generator is seeded, and the call waits for that. A machine
  // without it must not run on sessions that can be guessed.
  if (getrandom(&value, sizeof(value), 0) != sizeof(value)) std::abort();
  return value;
}

std::uint32_t SeededRandom::next() noexcept {
  state_ += 0x9E3779B97F4A7C15ULL;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return static_cast<std::uint32_t>((z ^ (z >> 31)) >> 32);
}

}  // namespace wex::can
