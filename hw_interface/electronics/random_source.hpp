#pragma once

#include <cstdint>

namespace wex::can {

/// Where challenges and sessions come from. Allocation-free.
class RandomSource {
 public:
  virtual ~RandomSource() = default;
  [[nodiscard]] virtual std::uint32_t next() noexcept = 0;
};

/// The kernel's generator (getrandom): cannot be guessed.
class SystemRandom final : public RandomSource {
 public:
  [[nodiscard]] std::uint32_t next() noexcept override;
};

/// Repeatable, for tests and lock step only (splitmix64).
class SeededRandom final : public RandomSource {
 public:
  explicit SeededRandom(std::uint64_t seed) noexcept : state_(seed) {}
  [[nodiscard]] std::uint32_t next() noexcept override;

 private:
  std::uint64_t state_;
};

}  // namespace wex::can
