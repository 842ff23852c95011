#pragma once

#include <array>
#include <string_view>

namespace wex {

/// Limbs in the order of every per-limb array. The first four are wheels.
enum class Limb { kLF = 0, kRF = 1, kLH = 2, kRH = 3, kArm = 4 };

inline constexpr int kNumWheels = 4;
inline constexpr int kNumLimbs = 5;
inline constexpr std::array<std::string_view, kNumLimbs> kLimbNames{"LF", "RF", "LH", "RH", "ARM"};

/// Scheduled contacts, indexed by Limb.
using ContactFlags = std::array<bool, kNumLimbs>;
inline constexpr ContactFlags kDrivingContacts{true, true, true, true, false};

}  // namespace wex
