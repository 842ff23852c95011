#pragma once

#include <random>

namespace wex {

/// From 0 up to but not 1, the same on every standard library.
inline double uniform(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11U) * 0x1.0p-53;
}

}  // namespace wex
