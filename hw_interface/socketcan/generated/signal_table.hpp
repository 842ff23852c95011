// Generated from wex.dbc by tools/can_codec/generate. Do not edit.
#pragma once

#include <array>
#include <cstdint>

#include "hw_interface/socketcan/signal_row.hpp"

namespace wex::can::generated {

/// First 32 bits of the SHA-256 of wex.dbc.
inline constexpr std::uint32_t kDbcHash = 0xc2c01d5d;

/// Most signals in a message.
inline constexpr int kMaxSignals = 23;

/// All messages by ascending id.
extern const std::array<MessageRow, 31> kMessages;

}  // namespace wex::can::generated
