// Generated from wex.dbc by tools/can_codec/generate. Do not edit.
#include "hw_interface/socketcan/generated/signal_table.hpp"

#include <limits>

#include "hw_interface/socketcan/generated/wex_dbc.h"

namespace wex::can::generated {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr std::array<const char*, 7> kInitReadyEnablingEnabledHoldFaultEStopNames{"Init", "Ready", "Enabling", "Enabled", "Hold", "Fault", "EStop"};
constexpr std::array<const char*, 3> kNoneEnableDisableNames{"None", "Enable", "Disable"};
constexpr std::array<const char*, 3> kNoneStopResetNames{"None", "Stop", "Reset"};
constexpr std::array<const char*, 4> kOkStaleInvalidNotAvailableNames{"Ok", "Stale", "Invalid", "NotAvailable"};

constexpr std::array<SignalRow, 4> kEStopState{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"ChainOpen", "", "", 1.0, 1.0, 0.0, 1.0, 0, 1,
     false, -1, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Cause", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_e_stop_state(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_e_stop_state_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.chain_open = static_cast<decltype(m.chain_open)>(raw[2]);
  m.cause = static_cast<decltype(m.cause)>(raw[3]);
  wex_dbc_e_stop_state_pack(bytes, &m, 8);
}

void unpack_e_stop_state(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_e_stop_state_t m;
  wex_dbc_e_stop_state_unpack(&m, bytes, 8);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.chain_open;
  raw[3] = m.cause;
}


constexpr std::array<SignalRow, 4> kHostStop{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Active", "", "", 1.0, 1.0, 0.0, 1.0, 0, 1,
     false, -1, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Cause", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_host_stop(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_host_stop_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.active = static_cast<decltype(m.active)>(raw[2]);
  m.cause = static_cast<decltype(m.cause)>(raw[3]);
  wex_dbc_host_stop_pack(bytes, &m, 8);
}

void unpack_host_stop(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_host_stop_t m;
  wex_dbc_host_stop_unpack(&m, bytes, 8);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.active;
  raw[3] = m.cause;
}


constexpr std::array<SignalRow, 3> kOperatorCommand{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Action", "", "", 1.0, 1.0, 0.0, 2.0, 0, 2,
     false, -8, kNoneStopResetNames, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_operator_command(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_operator_command_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.action = static_cast<decltype(m.action)>(raw[2]);
  wex_dbc_operator_command_pack(bytes, &m, 8);
}

void unpack_operator_command(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_operator_command_t m;
  wex_dbc_operator_command_unpack(&m, bytes, 8);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.action;
}


constexpr std::array<SignalRow, 7> kHostHeartbeat{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Request", "", "", 1.0, 1.0, 0.0, 2.0, 0, 2,
     false, -8, kNoneEnableDisableNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"Session", "", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Nonce", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"ChallengeEcho", "", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"DbcHash", "", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_host_heartbeat(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_host_heartbeat_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.request = static_cast<decltype(m.request)>(raw[2]);
  m.session = static_cast<decltype(m.session)>(raw[3]);
  m.nonce = static_cast<decltype(m.nonce)>(raw[4]);
  m.challenge_echo = static_cast<decltype(m.challenge_echo)>(raw[5]);
  m.dbc_hash = static_cast<decltype(m.dbc_hash)>(raw[6]);
  wex_dbc_host_heartbeat_pack(bytes, &m, 24);
}

void unpack_host_heartbeat(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_host_heartbeat_t m;
  wex_dbc_host_heartbeat_unpack(&m, bytes, 24);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.request;
  raw[3] = m.session;
  raw[4] = m.nonce;
  raw[5] = m.challenge_echo;
  raw[6] = m.dbc_hash;
}


constexpr std::array<SignalRow, 12> kZoneCommandLF{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"ValidForMs", "ms", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"EchoTimeMs", "ms", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LF_HAA_Rate", "rad/s", "LF_HAA", 1.0, 10000.0, -0.25, 0.25, -2500, 2500,
     true, -32768, {}, 0.25, 0.5, -kInfinity, kInfinity},
    {"LF_HFE_Rate", "rad/s", "LF_HFE", 1.0, 10000.0, -0.25, 0.25, -2500, 2500,
     true, -32768, {}, 0.25, 0.5, -kInfinity, kInfinity},
    {"LF_STEER_Rate", "rad/s", "LF_STEER", 1.0, 10000.0, -0.175, 0.175, -1750, 1750,
     true, -32768, {}, 0.175, 0.5, -kInfinity, kInfinity},
    {"LF_WHEEL_Rate", "rad/s", "LF_WHEEL", 1.0, 10000.0, -2.5, 2.5, -25000, 25000,
     true, -32768, {}, 2.5, 0.8, -kInfinity, kInfinity},
    {"LF_HAA_Active", "", "LF_HAA", 1.0, 1.0, 0.0, 1.0, 0, 1,
     false, -1, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LF_HFE_Active", "", "LF_HFE", 1.0, 1.0, 0.0, 1.0, 0, 1,
     false, -1, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LF_STEER_Active", "", "LF_STEER", 1.0, 1.0, 0.0, 1.0, 0, 1,
     false, -1, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LF_WHEEL_Active", "", "LF_WHEEL", 1.0, 1.0, 0.0, 1.0, 0, 1,
     false, -1, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_zone_command_lf(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_zone_command_lf_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.valid_for_ms = static_cast<decltype(m.valid_for_ms)>(raw[2]);
  m.echo_time_ms = static_cast<decltype(m.echo_time_ms)>(raw[3]);
  m.lf_haa_rate = static_cast<decltype(m.lf_haa_rate)>(raw[4]);
  m.lf_hfe_rate = static_cast<decltype(m.lf_hfe_rate)>(raw[5]);
  m.lf_steer_rate = static_cast<decltype(m.lf_steer_rate)>(raw[6]);
  m.lf_wheel_rate = static_cast<decltype(m.lf_wheel_rate)>(raw[7]);
  m.lf_haa_active = static_cast<decltype(m.lf_haa_active)>(raw[8]);
  m.lf_hfe_active = static_cast<decltype(m.lf_hfe_active)>(raw[9]);
  m.lf_steer_active = static_cast<decltype(m.lf_steer_active)>(raw[10]);
  m.lf_wheel_active = static_cast<decltype(m.lf_wheel_active)>(raw[11]);
  wex_dbc_zone_command_lf_pack(bytes, &m, 24);
}

void unpack_zone_command_lf(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_zone_command_lf_t m;
  wex_dbc_zone_command_lf_unpack(&m, bytes, 24);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.valid_for_ms;
  raw[3] = m.echo_time_ms;
  raw[4] = m.lf_haa_rate;
  raw[5] = m.lf_hfe_rate;
  raw[6] = m.lf_steer_rate;
  raw[7] = m.lf_wheel_rate;
  raw[8] = m.lf_haa_active;
  raw[9] = m.lf_hfe_active;
  raw[10] = m.lf_steer_active;
  raw[11] = m.lf_wheel_active;
}


constexpr std::array<SignalRow, 12> kZoneCommandRF{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"ValidForMs", "ms", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"EchoTimeMs", "ms", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RF_HAA_Rate", "rad/s", "RF_HAA", 1.0, 10000.0, -0.25, 0.25, -2500, 2500,
     true, -32768, {}, 0.25, 0.5, -kInfinity, kInfinity},
    {"RF_HFE_Rate", "rad/s", "RF_HFE", 1.0, 10000.0, -0.25, 0.25, -2500, 2500,
     true, -32768, {}, 0.25, 0.5, -kInfinity, kInfinity},
    {"RF_STEER_Rate", "rad/s", "RF_STEER", 1.0, 10000.0, -0.175, 0.175, -1750, 1750,
     true, -32768, {}, 0.175, 0.5, -kInfinity, kInfinity},
    {"RF_WHEEL_Rate", "rad/s", "RF_WHEEL", 1.0, 10000.0, -2.5, 2.5, -25000, 25000,
     true, -32768, {}, 2.5, 0.8, -kInfinity, kInfinity},
    {"RF_HAA_Active", "", "RF_HAA", 1.0, 1.0, 0.0, 1.0, 0, 1,
     false, -1, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RF_HFE_Active", "", "RF_HFE", 1.0, 1.0, 0.0, 1.0, 0, 1,
     false, -1, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RF_STEER_Active", "", "RF_STEER", 1.0, 1.0, 0.0, 1.0, 0, 1,
     false, -1, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RF_WHEEL_Active", "", "RF_WHEEL", 1.0, 1.0, 0.0, 1.0, 0, 1,
     false, -1, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_zone_command_rf(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_zone_command_rf_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.valid_for_ms = static_cast<decltype(m.valid_for_ms)>(raw[2]);
  m.echo_time_ms = static_cast<decltype(m.echo_time_ms)>(raw[3]);
  m.rf_haa_rate = static_cast<decltype(m.rf_haa_rate)>(raw[4]);
  m.rf_hfe_rate = static_cast<decltype(m.rf_hfe_rate)>(raw[5]);
  m.rf_steer_rate = static_cast<decltype(m.rf_steer_rate)>(raw[6]);
  m.rf_wheel_rate = static_cast<decltype(m.rf_wheel_rate)>(raw[7]);
  m.rf_haa_active = static_cast<decltype(m.rf_haa_active)>(raw[8]);
  m.rf_hfe_active = static_cast<decltype(m.rf_hfe_active)>(raw[9]);
  m.rf_steer_active = static_cast<decltype(m.rf_steer_active)>(raw[10]);
  m.rf_wheel_active = static_cast<decltype(m.rf_wheel_active)>(raw[11]);
  wex_dbc_zone_command_rf_pack(bytes, &m, 24);
}

void unpack_zone_command_rf(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_zone_command_rf_t m;
  wex_dbc_zone_command_rf_unpack(&m, bytes, 24);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.valid_for_ms;
  raw[3] = m.echo_time_ms;
  raw[4] = m.rf_haa_rate;
  raw[5] = m.rf_hfe_rate;
  raw[6] = m.rf_steer_rate;
  raw[7] = m.rf_wheel_rate;
  raw[8] = m.rf_haa_active;
  raw[9] = m.rf_hfe_active;
  raw[10] = m.rf_steer_active;
  raw[11] = m.rf_wheel_active;
}


constexpr std::array<SignalRow, 14> kZoneCommandLH{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"ValidForMs", "ms", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"EchoTimeMs", "ms", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_HAA_Rate", "rad/s", "LH_HAA", 1.0, 10000.0, -0.25, 0.25, -2500, 2500,
     true, -32768, {}, 0.25, 0.5, -kInfinity, kInfinity},
    {"LH_HFE_Rate", "rad/s", "LH_HFE", 1.0, 10000.0, -0.25, 0.25, -2500, 2500,
     true, -32768, {}, 0.25, 0.5, -kInfinity, kInfinity},
    {"LH_STEER_Rate", "rad/s", "LH_STEER", 1.0, 10000.0, -0.175, 0.175, -1750, 1750,
     true, -32768, {}, 0.175, 0.5, -kInfinity, kInfinity},
    {"LH_WHEEL_Rate", "rad/s", "LH_WHEEL", 1.0, 10000.0, -2.5, 2.5, -25000, 25000,
     true, -32768, {}, 2.5, 0.8, -kInfinity, kInfinity},
    {"LH_CLAW_Rate", "rad/s", "LH_CLAW", 1.0, 10000.0, -0.25, 0.25, -2500, 2500,
     true, -32768, {}, 0.25, 0.5, -kInfinity, kInfinity},
    {"LH_HAA_Active", "", "LH_HAA", 1.0, 1.0, 0.0, 1.0, 0, 1,
     false, -1, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_HFE_Active", "", "LH_HFE", 1.0, 1.0, 0.0, 1.0, 0, 1,
     false, -1, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_STEER_Active", "", "LH_STEER", 1.0, 1.0, 0.0, 1.0, 0, 1,
     false, -1, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_WHEEL_Active", "", "LH_WHEEL", 1.0, 1.0, 0.0, 1.0, 0, 1,
     false, -1, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_CLAW_Active", "", "LH_CLAW", 1.0, 1.0, 0.0, 1.0, 0, 1,
     false, -1, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_zone_command_lh(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_zone_command_lh_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.valid_for_ms = static_cast<decltype(m.valid_for_ms)>(raw[2]);
  m.echo_time_ms = static_cast<decltype(m.echo_time_ms)>(raw[3]);
  m.lh_haa_rate = static_cast<decltype(m.lh_haa_rate)>(raw[4]);
  m.lh_hfe_rate = static_cast<decltype(m.lh_hfe_rate)>(raw[5]);
  m.lh_steer_rate = static_cast<decltype(m.lh_steer_rate)>(raw[6]);
  m.lh_wheel_rate = static_cast<decltype(m.lh_wheel_rate)>(raw[7]);
  m.lh_claw_rate = static_cast<decltype(m.lh_claw_rate)>(raw[8]);
  m.lh_haa_active = static_cast<decltype(m.lh_haa_active)>(raw[9]);
  m.lh_hfe_active = static_cast<decltype(m.lh_hfe_active)>(raw[10]);
  m.lh_steer_active = static_cast<decltype(m.lh_steer_active)>(raw[11]);
  m.lh_wheel_active = static_cast<decltype(m.lh_wheel_active)>(raw[12]);
  m.lh_claw_active = static_cast<decltype(m.lh_claw_active)>(raw[13]);
  wex_dbc_zone_command_lh_pack(bytes, &m, 24);
}

void unpack_zone_command_lh(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_zone_command_lh_t m;
  wex_dbc_zone_command_lh_unpack(&m, bytes, 24);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.valid_for_ms;
  raw[3] = m.echo_time_ms;
  raw[4] = m.lh_haa_rate;
  raw[5] = m.lh_hfe_rate;
  raw[6] = m.lh_steer_rate;
  raw[7] = m.lh_wheel_rate;
  raw[8] = m.lh_claw_rate;
  raw[9] = m.lh_haa_active;
  raw[10] = m.lh_hfe_active;
  raw[11] = m.lh_steer_active;
  raw[12] = m.lh_wheel_active;
  raw[13] = m.lh_claw_active;
}


constexpr std::array<SignalRow, 14> kZoneCommandRH{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"ValidForMs", "ms", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"EchoTimeMs", "ms", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_HAA_Rate", "rad/s", "RH_HAA", 1.0, 10000.0, -0.25, 0.25, -2500, 2500,
     true, -32768, {}, 0.25, 0.5, -kInfinity, kInfinity},
    {"RH_HFE_Rate", "rad/s", "RH_HFE", 1.0, 10000.0, -0.25, 0.25, -2500, 2500,
     true, -32768, {}, 0.25, 0.5, -kInfinity, kInfinity},
    {"RH_STEER_Rate", "rad/s", "RH_STEER", 1.0, 10000.0, -0.175, 0.175, -1750, 1750,
     true, -32768, {}, 0.175, 0.5, -kInfinity, kInfinity},
    {"RH_WHEEL_Rate", "rad/s", "RH_WHEEL", 1.0, 10000.0, -2.5, 2.5, -25000, 25000,
     true, -32768, {}, 2.5, 0.8, -kInfinity, kInfinity},
    {"RH_CLAW_Rate", "rad/s", "RH_CLAW", 1.0, 10000.0, -0.25, 0.25, -2500, 2500,
     true, -32768, {}, 0.25, 0.5, -kInfinity, kInfinity},
    {"RH_HAA_Active", "", "RH_HAA", 1.0, 1.0, 0.0, 1.0, 0, 1,
     false, -1, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_HFE_Active", "", "RH_HFE", 1.0, 1.0, 0.0, 1.0, 0, 1,
     false, -1, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_STEER_Active", "", "RH_STEER", 1.0, 1.0, 0.0, 1.0, 0, 1,
     false, -1, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_WHEEL_Active", "", "RH_WHEEL", 1.0, 1.0, 0.0, 1.0, 0, 1,
     false, -1, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_CLAW_Active", "", "RH_CLAW", 1.0, 1.0, 0.0, 1.0, 0, 1,
     false, -1, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_zone_command_rh(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_zone_command_rh_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.valid_for_ms = static_cast<decltype(m.valid_for_ms)>(raw[2]);
  m.echo_time_ms = static_cast<decltype(m.echo_time_ms)>(raw[3]);
  m.rh_haa_rate = static_cast<decltype(m.rh_haa_rate)>(raw[4]);
  m.rh_hfe_rate = static_cast<decltype(m.rh_hfe_rate)>(raw[5]);
  m.rh_steer_rate = static_cast<decltype(m.rh_steer_rate)>(raw[6]);
  m.rh_wheel_rate = static_cast<decltype(m.rh_wheel_rate)>(raw[7]);
  m.rh_claw_rate = static_cast<decltype(m.rh_claw_rate)>(raw[8]);
  m.rh_haa_active = static_cast<decltype(m.rh_haa_active)>(raw[9]);
  m.rh_hfe_active = static_cast<decltype(m.rh_hfe_active)>(raw[10]);
  m.rh_steer_active = static_cast<decltype(m.rh_steer_active)>(raw[11]);
  m.rh_wheel_active = static_cast<decltype(m.rh_wheel_active)>(raw[12]);
  m.rh_claw_active = static_cast<decltype(m.rh_claw_active)>(raw[13]);
  wex_dbc_zone_command_rh_pack(bytes, &m, 24);
}

void unpack_zone_command_rh(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_zone_command_rh_t m;
  wex_dbc_zone_command_rh_unpack(&m, bytes, 24);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.valid_for_ms;
  raw[3] = m.echo_time_ms;
  raw[4] = m.rh_haa_rate;
  raw[5] = m.rh_hfe_rate;
  raw[6] = m.rh_steer_rate;
  raw[7] = m.rh_wheel_rate;
  raw[8] = m.rh_claw_rate;
  raw[9] = m.rh_haa_active;
  raw[10] = m.rh_hfe_active;
  raw[11] = m.rh_steer_active;
  raw[12] = m.rh_wheel_active;
  raw[13] = m.rh_claw_active;
}


constexpr std::array<SignalRow, 12> kZoneCommandARM{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"ValidForMs", "ms", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"EchoTimeMs", "ms", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"TURN_Rate", "rad/s", "TURN", 1.0, 10000.0, -0.8, 0.8, -8000, 8000,
     true, -32768, {}, 0.8, 0.3, -kInfinity, kInfinity},
    {"BOOM_Rate", "rad/s", "BOOM", 1.0, 10000.0, -0.35, 0.35, -3500, 3500,
     true, -32768, {}, 0.35, 0.3, -kInfinity, kInfinity},
    {"DIPPER_Rate", "rad/s", "DIPPER", 1.0, 10000.0, -0.55, 0.55, -5500, 5500,
     true, -32768, {}, 0.55, 0.5, -kInfinity, kInfinity},
    {"TELE_Rate", "m/s", "TELE", 1.0, 10000.0, -0.4, 0.4, -4000, 4000,
     true, -32768, {}, 0.4, 0.3, -kInfinity, kInfinity},
    {"TURN_Active", "", "TURN", 1.0, 1.0, 0.0, 1.0, 0, 1,
     false, -1, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"BOOM_Active", "", "BOOM", 1.0, 1.0, 0.0, 1.0, 0, 1,
     false, -1, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"DIPPER_Active", "", "DIPPER", 1.0, 1.0, 0.0, 1.0, 0, 1,
     false, -1, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"TELE_Active", "", "TELE", 1.0, 1.0, 0.0, 1.0, 0, 1,
     false, -1, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_zone_command_arm(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_zone_command_arm_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.valid_for_ms = static_cast<decltype(m.valid_for_ms)>(raw[2]);
  m.echo_time_ms = static_cast<decltype(m.echo_time_ms)>(raw[3]);
  m.turn_rate = static_cast<decltype(m.turn_rate)>(raw[4]);
  m.boom_rate = static_cast<decltype(m.boom_rate)>(raw[5]);
  m.dipper_rate = static_cast<decltype(m.dipper_rate)>(raw[6]);
  m.tele_rate = static_cast<decltype(m.tele_rate)>(raw[7]);
  m.turn_active = static_cast<decltype(m.turn_active)>(raw[8]);
  m.boom_active = static_cast<decltype(m.boom_active)>(raw[9]);
  m.dipper_active = static_cast<decltype(m.dipper_active)>(raw[10]);
  m.tele_active = static_cast<decltype(m.tele_active)>(raw[11]);
  wex_dbc_zone_command_arm_pack(bytes, &m, 24);
}

void unpack_zone_command_arm(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_zone_command_arm_t m;
  wex_dbc_zone_command_arm_unpack(&m, bytes, 24);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.valid_for_ms;
  raw[3] = m.echo_time_ms;
  raw[4] = m.turn_rate;
  raw[5] = m.boom_rate;
  raw[6] = m.dipper_rate;
  raw[7] = m.tele_rate;
  raw[8] = m.turn_active;
  raw[9] = m.boom_active;
  raw[10] = m.dipper_active;
  raw[11] = m.tele_active;
}


constexpr std::array<SignalRow, 10> kZoneCommandTOOL{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"ValidForMs", "ms", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"EchoTimeMs", "ms", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"EE_PITCH_Rate", "rad/s", "EE_PITCH", 1.0, 10000.0, -0.8, 0.8, -8000, 8000,
     true, -32768, {}, 0.8, 0.5, -kInfinity, kInfinity},
    {"EE_ROLL_Rate", "rad/s", "EE_ROLL", 1.0, 10000.0, -0.25, 0.25, -2500, 2500,
     true, -32768, {}, 0.25, 0.3, -kInfinity, kInfinity},
    {"EE_YAW_Rate", "rad/s", "EE_YAW", 1.0, 10000.0, -0.5, 0.5, -5000, 5000,
     true, -32768, {}, 0.5, 0.5, -kInfinity, kInfinity},
    {"EE_PITCH_Active", "", "EE_PITCH", 1.0, 1.0, 0.0, 1.0, 0, 1,
     false, -1, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"EE_ROLL_Active", "", "EE_ROLL", 1.0, 1.0, 0.0, 1.0, 0, 1,
     false, -1, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"EE_YAW_Active", "", "EE_YAW", 1.0, 1.0, 0.0, 1.0, 0, 1,
     false, -1, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_zone_command_tool(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_zone_command_tool_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.valid_for_ms = static_cast<decltype(m.valid_for_ms)>(raw[2]);
  m.echo_time_ms = static_cast<decltype(m.echo_time_ms)>(raw[3]);
  m.ee_pitch_rate = static_cast<decltype(m.ee_pitch_rate)>(raw[4]);
  m.ee_roll_rate = static_cast<decltype(m.ee_roll_rate)>(raw[5]);
  m.ee_yaw_rate = static_cast<decltype(m.ee_yaw_rate)>(raw[6]);
  m.ee_pitch_active = static_cast<decltype(m.ee_pitch_active)>(raw[7]);
  m.ee_roll_active = static_cast<decltype(m.ee_roll_active)>(raw[8]);
  m.ee_yaw_active = static_cast<decltype(m.ee_yaw_active)>(raw[9]);
  wex_dbc_zone_command_tool_pack(bytes, &m, 24);
}

void unpack_zone_command_tool(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_zone_command_tool_t m;
  wex_dbc_zone_command_tool_unpack(&m, bytes, 24);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.valid_for_ms;
  raw[3] = m.echo_time_ms;
  raw[4] = m.ee_pitch_rate;
  raw[5] = m.ee_roll_rate;
  raw[6] = m.ee_yaw_rate;
  raw[7] = m.ee_pitch_active;
  raw[8] = m.ee_roll_active;
  raw[9] = m.ee_yaw_active;
}


constexpr std::array<SignalRow, 19> kZoneFeedbackLF{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"SampleTimeMs", "ms", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LF_HAA_Quality", "", "LF_HAA", 1.0, 1.0, 0.0, 3.0, 0, 3,
     false, -2, kOkStaleInvalidNotAvailableNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"LF_HFE_Quality", "", "LF_HFE", 1.0, 1.0, 0.0, 3.0, 0, 3,
     false, -2, kOkStaleInvalidNotAvailableNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"LF_STEER_Quality", "", "LF_STEER", 1.0, 1.0, 0.0, 3.0, 0, 3,
     false, -2, kOkStaleInvalidNotAvailableNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"LF_WHEEL_Quality", "", "LF_WHEEL", 1.0, 1.0, 0.0, 3.0, 0, 3,
     false, -2, kOkStaleInvalidNotAvailableNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"LF_HAA_Position", "rad", "LF_HAA", 1.0, 1000000.0, -0.74, 1.0, -740000, 1000000,
     true, -2147483648, {}, 0.0, 0.0, -0.49, 0.75},
    {"LF_HFE_Position", "rad", "LF_HFE", 1.0, 1000000.0, -1.08, 0.54, -1080000, 540000,
     true, -2147483648, {}, 0.0, 0.0, -0.83, 0.29},
    {"LF_STEER_Position", "rad", "LF_STEER", 1.0, 1000000.0, -1.11, 1.0, -1110000, 1000000,
     true, -2147483648, {}, 0.0, 0.0, -0.86, 0.75},
    {"LF_WHEEL_Position", "rad", "LF_WHEEL", 1.0, 1000000.0, -3.141593, 3.141593, -3141593, 3141593,
     true, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LF_HAA_Rate", "rad/s", "LF_HAA", 1.0, 5000.0, -6.0, 6.0, -30000, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LF_HFE_Rate", "rad/s", "LF_HFE", 1.0, 5000.0, -6.0, 6.0, -30000, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LF_STEER_Rate", "rad/s", "LF_STEER", 1.0, 5000.0, -6.0, 6.0, -30000, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LF_WHEEL_Rate", "rad/s", "LF_WHEEL", 1.0, 5000.0, -6.0, 6.0, -30000, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LF_HAA_Spool", "", "LF_HAA", 1.0, 2000.0, -1.0, 1.0, -2000, 2000,
     true, -2048, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LF_HFE_Spool", "", "LF_HFE", 1.0, 2000.0, -1.0, 1.0, -2000, 2000,
     true, -2048, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LF_STEER_Spool", "", "LF_STEER", 1.0, 2000.0, -1.0, 1.0, -2000, 2000,
     true, -2048, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LF_WHEEL_Spool", "", "LF_WHEEL", 1.0, 2000.0, -1.0, 1.0, -2000, 2000,
     true, -2048, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_zone_feedback_lf(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_zone_feedback_lf_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.sample_time_ms = static_cast<decltype(m.sample_time_ms)>(raw[2]);
  m.lf_haa_quality = static_cast<decltype(m.lf_haa_quality)>(raw[3]);
  m.lf_hfe_quality = static_cast<decltype(m.lf_hfe_quality)>(raw[4]);
  m.lf_steer_quality = static_cast<decltype(m.lf_steer_quality)>(raw[5]);
  m.lf_wheel_quality = static_cast<decltype(m.lf_wheel_quality)>(raw[6]);
  m.lf_haa_position = static_cast<decltype(m.lf_haa_position)>(raw[7]);
  m.lf_hfe_position = static_cast<decltype(m.lf_hfe_position)>(raw[8]);
  m.lf_steer_position = static_cast<decltype(m.lf_steer_position)>(raw[9]);
  m.lf_wheel_position = static_cast<decltype(m.lf_wheel_position)>(raw[10]);
  m.lf_haa_rate = static_cast<decltype(m.lf_haa_rate)>(raw[11]);
  m.lf_hfe_rate = static_cast<decltype(m.lf_hfe_rate)>(raw[12]);
  m.lf_steer_rate = static_cast<decltype(m.lf_steer_rate)>(raw[13]);
  m.lf_wheel_rate = static_cast<decltype(m.lf_wheel_rate)>(raw[14]);
  m.lf_haa_spool = static_cast<decltype(m.lf_haa_spool)>(raw[15]);
  m.lf_hfe_spool = static_cast<decltype(m.lf_hfe_spool)>(raw[16]);
  m.lf_steer_spool = static_cast<decltype(m.lf_steer_spool)>(raw[17]);
  m.lf_wheel_spool = static_cast<decltype(m.lf_wheel_spool)>(raw[18]);
  wex_dbc_zone_feedback_lf_pack(bytes, &m, 48);
}

void unpack_zone_feedback_lf(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_zone_feedback_lf_t m;
  wex_dbc_zone_feedback_lf_unpack(&m, bytes, 48);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.sample_time_ms;
  raw[3] = m.lf_haa_quality;
  raw[4] = m.lf_hfe_quality;
  raw[5] = m.lf_steer_quality;
  raw[6] = m.lf_wheel_quality;
  raw[7] = m.lf_haa_position;
  raw[8] = m.lf_hfe_position;
  raw[9] = m.lf_steer_position;
  raw[10] = m.lf_wheel_position;
  raw[11] = m.lf_haa_rate;
  raw[12] = m.lf_hfe_rate;
  raw[13] = m.lf_steer_rate;
  raw[14] = m.lf_wheel_rate;
  raw[15] = m.lf_haa_spool;
  raw[16] = m.lf_hfe_spool;
  raw[17] = m.lf_steer_spool;
  raw[18] = m.lf_wheel_spool;
}


constexpr std::array<SignalRow, 19> kZoneFeedbackRF{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"SampleTimeMs", "ms", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RF_HAA_Quality", "", "RF_HAA", 1.0, 1.0, 0.0, 3.0, 0, 3,
     false, -2, kOkStaleInvalidNotAvailableNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"RF_HFE_Quality", "", "RF_HFE", 1.0, 1.0, 0.0, 3.0, 0, 3,
     false, -2, kOkStaleInvalidNotAvailableNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"RF_STEER_Quality", "", "RF_STEER", 1.0, 1.0, 0.0, 3.0, 0, 3,
     false, -2, kOkStaleInvalidNotAvailableNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"RF_WHEEL_Quality", "", "RF_WHEEL", 1.0, 1.0, 0.0, 3.0, 0, 3,
     false, -2, kOkStaleInvalidNotAvailableNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"RF_HAA_Position", "rad", "RF_HAA", 1.0, 1000000.0, -1.0, 0.74, -1000000, 740000,
     true, -2147483648, {}, 0.0, 0.0, -0.75, 0.49},
    {"RF_HFE_Position", "rad", "RF_HFE", 1.0, 1000000.0, -1.08, 0.54, -1080000, 540000,
     true, -2147483648, {}, 0.0, 0.0, -0.83, 0.29},
    {"RF_STEER_Position", "rad", "RF_STEER", 1.0, 1000000.0, -1.0, 1.11, -1000000, 1110000,
     true, -2147483648, {}, 0.0, 0.0, -0.75, 0.86},
    {"RF_WHEEL_Position", "rad", "RF_WHEEL", 1.0, 1000000.0, -3.141593, 3.141593, -3141593, 3141593,
     true, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RF_HAA_Rate", "rad/s", "RF_HAA", 1.0, 5000.0, -6.0, 6.0, -30000, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RF_HFE_Rate", "rad/s", "RF_HFE", 1.0, 5000.0, -6.0, 6.0, -30000, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RF_STEER_Rate", "rad/s", "RF_STEER", 1.0, 5000.0, -6.0, 6.0, -30000, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RF_WHEEL_Rate", "rad/s", "RF_WHEEL", 1.0, 5000.0, -6.0, 6.0, -30000, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RF_HAA_Spool", "", "RF_HAA", 1.0, 2000.0, -1.0, 1.0, -2000, 2000,
     true, -2048, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RF_HFE_Spool", "", "RF_HFE", 1.0, 2000.0, -1.0, 1.0, -2000, 2000,
     true, -2048, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RF_STEER_Spool", "", "RF_STEER", 1.0, 2000.0, -1.0, 1.0, -2000, 2000,
     true, -2048, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RF_WHEEL_Spool", "", "RF_WHEEL", 1.0, 2000.0, -1.0, 1.0, -2000, 2000,
     true, -2048, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_zone_feedback_rf(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_zone_feedback_rf_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.sample_time_ms = static_cast<decltype(m.sample_time_ms)>(raw[2]);
  m.rf_haa_quality = static_cast<decltype(m.rf_haa_quality)>(raw[3]);
  m.rf_hfe_quality = static_cast<decltype(m.rf_hfe_quality)>(raw[4]);
  m.rf_steer_quality = static_cast<decltype(m.rf_steer_quality)>(raw[5]);
  m.rf_wheel_quality = static_cast<decltype(m.rf_wheel_quality)>(raw[6]);
  m.rf_haa_position = static_cast<decltype(m.rf_haa_position)>(raw[7]);
  m.rf_hfe_position = static_cast<decltype(m.rf_hfe_position)>(raw[8]);
  m.rf_steer_position = static_cast<decltype(m.rf_steer_position)>(raw[9]);
  m.rf_wheel_position = static_cast<decltype(m.rf_wheel_position)>(raw[10]);
  m.rf_haa_rate = static_cast<decltype(m.rf_haa_rate)>(raw[11]);
  m.rf_hfe_rate = static_cast<decltype(m.rf_hfe_rate)>(raw[12]);
  m.rf_steer_rate = static_cast<decltype(m.rf_steer_rate)>(raw[13]);
  m.rf_wheel_rate = static_cast<decltype(m.rf_wheel_rate)>(raw[14]);
  m.rf_haa_spool = static_cast<decltype(m.rf_haa_spool)>(raw[15]);
  m.rf_hfe_spool = static_cast<decltype(m.rf_hfe_spool)>(raw[16]);
  m.rf_steer_spool = static_cast<decltype(m.rf_steer_spool)>(raw[17]);
  m.rf_wheel_spool = static_cast<decltype(m.rf_wheel_spool)>(raw[18]);
  wex_dbc_zone_feedback_rf_pack(bytes, &m, 48);
}

void unpack_zone_feedback_rf(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_zone_feedback_rf_t m;
  wex_dbc_zone_feedback_rf_unpack(&m, bytes, 48);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.sample_time_ms;
  raw[3] = m.rf_haa_quality;
  raw[4] = m.rf_hfe_quality;
  raw[5] = m.rf_steer_quality;
  raw[6] = m.rf_wheel_quality;
  raw[7] = m.rf_haa_position;
  raw[8] = m.rf_hfe_position;
  raw[9] = m.rf_steer_position;
  raw[10] = m.rf_wheel_position;
  raw[11] = m.rf_haa_rate;
  raw[12] = m.rf_hfe_rate;
  raw[13] = m.rf_steer_rate;
  raw[14] = m.rf_wheel_rate;
  raw[15] = m.rf_haa_spool;
  raw[16] = m.rf_hfe_spool;
  raw[17] = m.rf_steer_spool;
  raw[18] = m.rf_wheel_spool;
}


constexpr std::array<SignalRow, 23> kZoneFeedbackLH{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"SampleTimeMs", "ms", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_HAA_Quality", "", "LH_HAA", 1.0, 1.0, 0.0, 3.0, 0, 3,
     false, -2, kOkStaleInvalidNotAvailableNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_HFE_Quality", "", "LH_HFE", 1.0, 1.0, 0.0, 3.0, 0, 3,
     false, -2, kOkStaleInvalidNotAvailableNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_STEER_Quality", "", "LH_STEER", 1.0, 1.0, 0.0, 3.0, 0, 3,
     false, -2, kOkStaleInvalidNotAvailableNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_WHEEL_Quality", "", "LH_WHEEL", 1.0, 1.0, 0.0, 3.0, 0, 3,
     false, -2, kOkStaleInvalidNotAvailableNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_CLAW_Quality", "", "LH_CLAW", 1.0, 1.0, 0.0, 3.0, 0, 3,
     false, -2, kOkStaleInvalidNotAvailableNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_HAA_Position", "rad", "LH_HAA", 1.0, 1000000.0, -0.94, 0.81, -940000, 810000,
     true, -2147483648, {}, 0.0, 0.0, -0.69, 0.56},
    {"LH_HFE_Position", "rad", "LH_HFE", 1.0, 1000000.0, -1.02, 0.52, -1020000, 520000,
     true, -2147483648, {}, 0.0, 0.0, -0.77, 0.27},
    {"LH_STEER_Position", "rad", "LH_STEER", 1.0, 1000000.0, -1.45, 1.45, -1450000, 1450000,
     true, -2147483648, {}, 0.0, 0.0, -1.2, 1.2},
    {"LH_WHEEL_Position", "rad", "LH_WHEEL", 1.0, 1000000.0, -3.141593, 3.141593, -3141593, 3141593,
     true, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_CLAW_Position", "rad", "LH_CLAW", 1.0, 1000000.0, -1.85, 0.26, -1850000, 260000,
     true, -2147483648, {}, 0.0, 0.0, -1.6, 0.01},
    {"LH_HAA_Rate", "rad/s", "LH_HAA", 1.0, 5000.0, -6.0, 6.0, -30000, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_HFE_Rate", "rad/s", "LH_HFE", 1.0, 5000.0, -6.0, 6.0, -30000, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_STEER_Rate", "rad/s", "LH_STEER", 1.0, 5000.0, -6.0, 6.0, -30000, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_WHEEL_Rate", "rad/s", "LH_WHEEL", 1.0, 5000.0, -6.0, 6.0, -30000, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_CLAW_Rate", "rad/s", "LH_CLAW", 1.0, 5000.0, -6.0, 6.0, -30000, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_HAA_Spool", "", "LH_HAA", 1.0, 2000.0, -1.0, 1.0, -2000, 2000,
     true, -2048, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_HFE_Spool", "", "LH_HFE", 1.0, 2000.0, -1.0, 1.0, -2000, 2000,
     true, -2048, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_STEER_Spool", "", "LH_STEER", 1.0, 2000.0, -1.0, 1.0, -2000, 2000,
     true, -2048, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_WHEEL_Spool", "", "LH_WHEEL", 1.0, 2000.0, -1.0, 1.0, -2000, 2000,
     true, -2048, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_CLAW_Spool", "", "LH_CLAW", 1.0, 2000.0, -1.0, 1.0, -2000, 2000,
     true, -2048, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_zone_feedback_lh(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_zone_feedback_lh_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.sample_time_ms = static_cast<decltype(m.sample_time_ms)>(raw[2]);
  m.lh_haa_quality = static_cast<decltype(m.lh_haa_quality)>(raw[3]);
  m.lh_hfe_quality = static_cast<decltype(m.lh_hfe_quality)>(raw[4]);
  m.lh_steer_quality = static_cast<decltype(m.lh_steer_quality)>(raw[5]);
  m.lh_wheel_quality = static_cast<decltype(m.lh_wheel_quality)>(raw[6]);
  m.lh_claw_quality = static_cast<decltype(m.lh_claw_quality)>(raw[7]);
  m.lh_haa_position = static_cast<decltype(m.lh_haa_position)>(raw[8]);
  m.lh_hfe_position = static_cast<decltype(m.lh_hfe_position)>(raw[9]);
  m.lh_steer_position = static_cast<decltype(m.lh_steer_position)>(raw[10]);
  m.lh_wheel_position = static_cast<decltype(m.lh_wheel_position)>(raw[11]);
  m.lh_claw_position = static_cast<decltype(m.lh_claw_position)>(raw[12]);
  m.lh_haa_rate = static_cast<decltype(m.lh_haa_rate)>(raw[13]);
  m.lh_hfe_rate = static_cast<decltype(m.lh_hfe_rate)>(raw[14]);
  m.lh_steer_rate = static_cast<decltype(m.lh_steer_rate)>(raw[15]);
  m.lh_wheel_rate = static_cast<decltype(m.lh_wheel_rate)>(raw[16]);
  m.lh_claw_rate = static_cast<decltype(m.lh_claw_rate)>(raw[17]);
  m.lh_haa_spool = static_cast<decltype(m.lh_haa_spool)>(raw[18]);
  m.lh_hfe_spool = static_cast<decltype(m.lh_hfe_spool)>(raw[19]);
  m.lh_steer_spool = static_cast<decltype(m.lh_steer_spool)>(raw[20]);
  m.lh_wheel_spool = static_cast<decltype(m.lh_wheel_spool)>(raw[21]);
  m.lh_claw_spool = static_cast<decltype(m.lh_claw_spool)>(raw[22]);
  wex_dbc_zone_feedback_lh_pack(bytes, &m, 48);
}

void unpack_zone_feedback_lh(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_zone_feedback_lh_t m;
  wex_dbc_zone_feedback_lh_unpack(&m, bytes, 48);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.sample_time_ms;
  raw[3] = m.lh_haa_quality;
  raw[4] = m.lh_hfe_quality;
  raw[5] = m.lh_steer_quality;
  raw[6] = m.lh_wheel_quality;
  raw[7] = m.lh_claw_quality;
  raw[8] = m.lh_haa_position;
  raw[9] = m.lh_hfe_position;
  raw[10] = m.lh_steer_position;
  raw[11] = m.lh_wheel_position;
  raw[12] = m.lh_claw_position;
  raw[13] = m.lh_haa_rate;
  raw[14] = m.lh_hfe_rate;
  raw[15] = m.lh_steer_rate;
  raw[16] = m.lh_wheel_rate;
  raw[17] = m.lh_claw_rate;
  raw[18] = m.lh_haa_spool;
  raw[19] = m.lh_hfe_spool;
  raw[20] = m.lh_steer_spool;
  raw[21] = m.lh_wheel_spool;
  raw[22] = m.lh_claw_spool;
}


constexpr std::array<SignalRow, 23> kZoneFeedbackRH{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"SampleTimeMs", "ms", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_HAA_Quality", "", "RH_HAA", 1.0, 1.0, 0.0, 3.0, 0, 3,
     false, -2, kOkStaleInvalidNotAvailableNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_HFE_Quality", "", "RH_HFE", 1.0, 1.0, 0.0, 3.0, 0, 3,
     false, -2, kOkStaleInvalidNotAvailableNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_STEER_Quality", "", "RH_STEER", 1.0, 1.0, 0.0, 3.0, 0, 3,
     false, -2, kOkStaleInvalidNotAvailableNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_WHEEL_Quality", "", "RH_WHEEL", 1.0, 1.0, 0.0, 3.0, 0, 3,
     false, -2, kOkStaleInvalidNotAvailableNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_CLAW_Quality", "", "RH_CLAW", 1.0, 1.0, 0.0, 3.0, 0, 3,
     false, -2, kOkStaleInvalidNotAvailableNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_HAA_Position", "rad", "RH_HAA", 1.0, 1000000.0, -0.81, 0.94, -810000, 940000,
     true, -2147483648, {}, 0.0, 0.0, -0.56, 0.69},
    {"RH_HFE_Position", "rad", "RH_HFE", 1.0, 1000000.0, -1.02, 0.52, -1020000, 520000,
     true, -2147483648, {}, 0.0, 0.0, -0.77, 0.27},
    {"RH_STEER_Position", "rad", "RH_STEER", 1.0, 1000000.0, -1.45, 1.45, -1450000, 1450000,
     true, -2147483648, {}, 0.0, 0.0, -1.2, 1.2},
    {"RH_WHEEL_Position", "rad", "RH_WHEEL", 1.0, 1000000.0, -3.141593, 3.141593, -3141593, 3141593,
     true, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_CLAW_Position", "rad", "RH_CLAW", 1.0, 1000000.0, -1.85, 0.26, -1850000, 260000,
     true, -2147483648, {}, 0.0, 0.0, -1.6, 0.01},
    {"RH_HAA_Rate", "rad/s", "RH_HAA", 1.0, 5000.0, -6.0, 6.0, -30000, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_HFE_Rate", "rad/s", "RH_HFE", 1.0, 5000.0, -6.0, 6.0, -30000, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_STEER_Rate", "rad/s", "RH_STEER", 1.0, 5000.0, -6.0, 6.0, -30000, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_WHEEL_Rate", "rad/s", "RH_WHEEL", 1.0, 5000.0, -6.0, 6.0, -30000, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_CLAW_Rate", "rad/s", "RH_CLAW", 1.0, 5000.0, -6.0, 6.0, -30000, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_HAA_Spool", "", "RH_HAA", 1.0, 2000.0, -1.0, 1.0, -2000, 2000,
     true, -2048, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_HFE_Spool", "", "RH_HFE", 1.0, 2000.0, -1.0, 1.0, -2000, 2000,
     true, -2048, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_STEER_Spool", "", "RH_STEER", 1.0, 2000.0, -1.0, 1.0, -2000, 2000,
     true, -2048, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_WHEEL_Spool", "", "RH_WHEEL", 1.0, 2000.0, -1.0, 1.0, -2000, 2000,
     true, -2048, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_CLAW_Spool", "", "RH_CLAW", 1.0, 2000.0, -1.0, 1.0, -2000, 2000,
     true, -2048, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_zone_feedback_rh(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_zone_feedback_rh_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.sample_time_ms = static_cast<decltype(m.sample_time_ms)>(raw[2]);
  m.rh_haa_quality = static_cast<decltype(m.rh_haa_quality)>(raw[3]);
  m.rh_hfe_quality = static_cast<decltype(m.rh_hfe_quality)>(raw[4]);
  m.rh_steer_quality = static_cast<decltype(m.rh_steer_quality)>(raw[5]);
  m.rh_wheel_quality = static_cast<decltype(m.rh_wheel_quality)>(raw[6]);
  m.rh_claw_quality = static_cast<decltype(m.rh_claw_quality)>(raw[7]);
  m.rh_haa_position = static_cast<decltype(m.rh_haa_position)>(raw[8]);
  m.rh_hfe_position = static_cast<decltype(m.rh_hfe_position)>(raw[9]);
  m.rh_steer_position = static_cast<decltype(m.rh_steer_position)>(raw[10]);
  m.rh_wheel_position = static_cast<decltype(m.rh_wheel_position)>(raw[11]);
  m.rh_claw_position = static_cast<decltype(m.rh_claw_position)>(raw[12]);
  m.rh_haa_rate = static_cast<decltype(m.rh_haa_rate)>(raw[13]);
  m.rh_hfe_rate = static_cast<decltype(m.rh_hfe_rate)>(raw[14]);
  m.rh_steer_rate = static_cast<decltype(m.rh_steer_rate)>(raw[15]);
  m.rh_wheel_rate = static_cast<decltype(m.rh_wheel_rate)>(raw[16]);
  m.rh_claw_rate = static_cast<decltype(m.rh_claw_rate)>(raw[17]);
  m.rh_haa_spool = static_cast<decltype(m.rh_haa_spool)>(raw[18]);
  m.rh_hfe_spool = static_cast<decltype(m.rh_hfe_spool)>(raw[19]);
  m.rh_steer_spool = static_cast<decltype(m.rh_steer_spool)>(raw[20]);
  m.rh_wheel_spool = static_cast<decltype(m.rh_wheel_spool)>(raw[21]);
  m.rh_claw_spool = static_cast<decltype(m.rh_claw_spool)>(raw[22]);
  wex_dbc_zone_feedback_rh_pack(bytes, &m, 48);
}

void unpack_zone_feedback_rh(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_zone_feedback_rh_t m;
  wex_dbc_zone_feedback_rh_unpack(&m, bytes, 48);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.sample_time_ms;
  raw[3] = m.rh_haa_quality;
  raw[4] = m.rh_hfe_quality;
  raw[5] = m.rh_steer_quality;
  raw[6] = m.rh_wheel_quality;
  raw[7] = m.rh_claw_quality;
  raw[8] = m.rh_haa_position;
  raw[9] = m.rh_hfe_position;
  raw[10] = m.rh_steer_position;
  raw[11] = m.rh_wheel_position;
  raw[12] = m.rh_claw_position;
  raw[13] = m.rh_haa_rate;
  raw[14] = m.rh_hfe_rate;
  raw[15] = m.rh_steer_rate;
  raw[16] = m.rh_wheel_rate;
  raw[17] = m.rh_claw_rate;
  raw[18] = m.rh_haa_spool;
  raw[19] = m.rh_hfe_spool;
  raw[20] = m.rh_steer_spool;
  raw[21] = m.rh_wheel_spool;
  raw[22] = m.rh_claw_spool;
}


constexpr std::array<SignalRow, 19> kZoneFeedbackARM{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"SampleTimeMs", "ms", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"TURN_Quality", "", "TURN", 1.0, 1.0, 0.0, 3.0, 0, 3,
     false, -2, kOkStaleInvalidNotAvailableNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"BOOM_Quality", "", "BOOM", 1.0, 1.0, 0.0, 3.0, 0, 3,
     false, -2, kOkStaleInvalidNotAvailableNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"DIPPER_Quality", "", "DIPPER", 1.0, 1.0, 0.0, 3.0, 0, 3,
     false, -2, kOkStaleInvalidNotAvailableNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"TELE_Quality", "", "TELE", 1.0, 1.0, 0.0, 3.0, 0, 3,
     false, -2, kOkStaleInvalidNotAvailableNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"TURN_Position", "rad", "TURN", 1.0, 1000000.0, -3.141593, 3.141593, -3141593, 3141593,
     true, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"BOOM_Position", "rad", "BOOM", 1.0, 1000000.0, -0.35, 1.53, -350000, 1530000,
     true, -2147483648, {}, 0.0, 0.0, -0.1, 1.28},
    {"DIPPER_Position", "rad", "DIPPER", 1.0, 1000000.0, -1.35, 1.25856, -1350000, 1258560,
     true, -2147483648, {}, 0.0, 0.0, -1.1, 1.00856},
    {"TELE_Position", "m", "TELE", 1.0, 1000000.0, -0.281, 2.019, -281000, 2019000,
     true, -2147483648, {}, 0.0, 0.0, -0.031, 1.769},
    {"TURN_Rate", "rad/s", "TURN", 1.0, 5000.0, -6.0, 6.0, -30000, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"BOOM_Rate", "rad/s", "BOOM", 1.0, 5000.0, -6.0, 6.0, -30000, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"DIPPER_Rate", "rad/s", "DIPPER", 1.0, 5000.0, -6.0, 6.0, -30000, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"TELE_Rate", "m/s", "TELE", 1.0, 5000.0, -6.0, 6.0, -30000, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"TURN_Spool", "", "TURN", 1.0, 2000.0, -1.0, 1.0, -2000, 2000,
     true, -2048, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"BOOM_Spool", "", "BOOM", 1.0, 2000.0, -1.0, 1.0, -2000, 2000,
     true, -2048, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"DIPPER_Spool", "", "DIPPER", 1.0, 2000.0, -1.0, 1.0, -2000, 2000,
     true, -2048, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"TELE_Spool", "", "TELE", 1.0, 2000.0, -1.0, 1.0, -2000, 2000,
     true, -2048, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_zone_feedback_arm(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_zone_feedback_arm_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.sample_time_ms = static_cast<decltype(m.sample_time_ms)>(raw[2]);
  m.turn_quality = static_cast<decltype(m.turn_quality)>(raw[3]);
  m.boom_quality = static_cast<decltype(m.boom_quality)>(raw[4]);
  m.dipper_quality = static_cast<decltype(m.dipper_quality)>(raw[5]);
  m.tele_quality = static_cast<decltype(m.tele_quality)>(raw[6]);
  m.turn_position = static_cast<decltype(m.turn_position)>(raw[7]);
  m.boom_position = static_cast<decltype(m.boom_position)>(raw[8]);
  m.dipper_position = static_cast<decltype(m.dipper_position)>(raw[9]);
  m.tele_position = static_cast<decltype(m.tele_position)>(raw[10]);
  m.turn_rate = static_cast<decltype(m.turn_rate)>(raw[11]);
  m.boom_rate = static_cast<decltype(m.boom_rate)>(raw[12]);
  m.dipper_rate = static_cast<decltype(m.dipper_rate)>(raw[13]);
  m.tele_rate = static_cast<decltype(m.tele_rate)>(raw[14]);
  m.turn_spool = static_cast<decltype(m.turn_spool)>(raw[15]);
  m.boom_spool = static_cast<decltype(m.boom_spool)>(raw[16]);
  m.dipper_spool = static_cast<decltype(m.dipper_spool)>(raw[17]);
  m.tele_spool = static_cast<decltype(m.tele_spool)>(raw[18]);
  wex_dbc_zone_feedback_arm_pack(bytes, &m, 48);
}

void unpack_zone_feedback_arm(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_zone_feedback_arm_t m;
  wex_dbc_zone_feedback_arm_unpack(&m, bytes, 48);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.sample_time_ms;
  raw[3] = m.turn_quality;
  raw[4] = m.boom_quality;
  raw[5] = m.dipper_quality;
  raw[6] = m.tele_quality;
  raw[7] = m.turn_position;
  raw[8] = m.boom_position;
  raw[9] = m.dipper_position;
  raw[10] = m.tele_position;
  raw[11] = m.turn_rate;
  raw[12] = m.boom_rate;
  raw[13] = m.dipper_rate;
  raw[14] = m.tele_rate;
  raw[15] = m.turn_spool;
  raw[16] = m.boom_spool;
  raw[17] = m.dipper_spool;
  raw[18] = m.tele_spool;
}


constexpr std::array<SignalRow, 15> kZoneFeedbackTOOL{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"SampleTimeMs", "ms", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"EE_PITCH_Quality", "", "EE_PITCH", 1.0, 1.0, 0.0, 3.0, 0, 3,
     false, -2, kOkStaleInvalidNotAvailableNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"EE_ROLL_Quality", "", "EE_ROLL", 1.0, 1.0, 0.0, 3.0, 0, 3,
     false, -2, kOkStaleInvalidNotAvailableNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"EE_YAW_Quality", "", "EE_YAW", 1.0, 1.0, 0.0, 3.0, 0, 3,
     false, -2, kOkStaleInvalidNotAvailableNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"EE_PITCH_Position", "rad", "EE_PITCH", 1.0, 1000000.0, -2.545, 0.8917, -2545000, 891700,
     true, -2147483648, {}, 0.0, 0.0, -2.295, 0.6417},
    {"EE_ROLL_Position", "rad", "EE_ROLL", 1.0, 1000000.0, -0.93, 0.93, -930000, 930000,
     true, -2147483648, {}, 0.0, 0.0, -0.68, 0.68},
    {"EE_YAW_Position", "rad", "EE_YAW", 1.0, 1000000.0, -3.141593, 3.141593, -3141593, 3141593,
     true, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"EE_PITCH_Rate", "rad/s", "EE_PITCH", 1.0, 5000.0, -6.0, 6.0, -30000, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"EE_ROLL_Rate", "rad/s", "EE_ROLL", 1.0, 5000.0, -6.0, 6.0, -30000, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"EE_YAW_Rate", "rad/s", "EE_YAW", 1.0, 5000.0, -6.0, 6.0, -30000, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"EE_PITCH_Spool", "", "EE_PITCH", 1.0, 2000.0, -1.0, 1.0, -2000, 2000,
     true, -2048, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"EE_ROLL_Spool", "", "EE_ROLL", 1.0, 2000.0, -1.0, 1.0, -2000, 2000,
     true, -2048, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"EE_YAW_Spool", "", "EE_YAW", 1.0, 2000.0, -1.0, 1.0, -2000, 2000,
     true, -2048, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_zone_feedback_tool(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_zone_feedback_tool_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.sample_time_ms = static_cast<decltype(m.sample_time_ms)>(raw[2]);
  m.ee_pitch_quality = static_cast<decltype(m.ee_pitch_quality)>(raw[3]);
  m.ee_roll_quality = static_cast<decltype(m.ee_roll_quality)>(raw[4]);
  m.ee_yaw_quality = static_cast<decltype(m.ee_yaw_quality)>(raw[5]);
  m.ee_pitch_position = static_cast<decltype(m.ee_pitch_position)>(raw[6]);
  m.ee_roll_position = static_cast<decltype(m.ee_roll_position)>(raw[7]);
  m.ee_yaw_position = static_cast<decltype(m.ee_yaw_position)>(raw[8]);
  m.ee_pitch_rate = static_cast<decltype(m.ee_pitch_rate)>(raw[9]);
  m.ee_roll_rate = static_cast<decltype(m.ee_roll_rate)>(raw[10]);
  m.ee_yaw_rate = static_cast<decltype(m.ee_yaw_rate)>(raw[11]);
  m.ee_pitch_spool = static_cast<decltype(m.ee_pitch_spool)>(raw[12]);
  m.ee_roll_spool = static_cast<decltype(m.ee_roll_spool)>(raw[13]);
  m.ee_yaw_spool = static_cast<decltype(m.ee_yaw_spool)>(raw[14]);
  wex_dbc_zone_feedback_tool_pack(bytes, &m, 48);
}

void unpack_zone_feedback_tool(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_zone_feedback_tool_t m;
  wex_dbc_zone_feedback_tool_unpack(&m, bytes, 48);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.sample_time_ms;
  raw[3] = m.ee_pitch_quality;
  raw[4] = m.ee_roll_quality;
  raw[5] = m.ee_yaw_quality;
  raw[6] = m.ee_pitch_position;
  raw[7] = m.ee_roll_position;
  raw[8] = m.ee_yaw_position;
  raw[9] = m.ee_pitch_rate;
  raw[10] = m.ee_roll_rate;
  raw[11] = m.ee_yaw_rate;
  raw[12] = m.ee_pitch_spool;
  raw[13] = m.ee_roll_spool;
  raw[14] = m.ee_yaw_spool;
}


constexpr std::array<SignalRow, 9> kImu{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"SampleTimeMs", "ms", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"AngularVelocityX", "rad/s", "", 1.0, 1000000.0, -10.0, 10.0, -10000000, 10000000,
     true, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"AngularVelocityY", "rad/s", "", 1.0, 1000000.0, -10.0, 10.0, -10000000, 10000000,
     true, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"AngularVelocityZ", "rad/s", "", 1.0, 1000000.0, -10.0, 10.0, -10000000, 10000000,
     true, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"AccelerationX", "m/s^2", "", 1.0, 100000.0, -100.0, 100.0, -10000000, 10000000,
     true, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"AccelerationY", "m/s^2", "", 1.0, 100000.0, -100.0, 100.0, -10000000, 10000000,
     true, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"AccelerationZ", "m/s^2", "", 1.0, 100000.0, -100.0, 100.0, -10000000, 10000000,
     true, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_imu(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_imu_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.sample_time_ms = static_cast<decltype(m.sample_time_ms)>(raw[2]);
  m.angular_velocity_x = static_cast<decltype(m.angular_velocity_x)>(raw[3]);
  m.angular_velocity_y = static_cast<decltype(m.angular_velocity_y)>(raw[4]);
  m.angular_velocity_z = static_cast<decltype(m.angular_velocity_z)>(raw[5]);
  m.acceleration_x = static_cast<decltype(m.acceleration_x)>(raw[6]);
  m.acceleration_y = static_cast<decltype(m.acceleration_y)>(raw[7]);
  m.acceleration_z = static_cast<decltype(m.acceleration_z)>(raw[8]);
  wex_dbc_imu_pack(bytes, &m, 32);
}

void unpack_imu(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_imu_t m;
  wex_dbc_imu_unpack(&m, bytes, 32);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.sample_time_ms;
  raw[3] = m.angular_velocity_x;
  raw[4] = m.angular_velocity_y;
  raw[5] = m.angular_velocity_z;
  raw[6] = m.acceleration_x;
  raw[7] = m.acceleration_y;
  raw[8] = m.acceleration_z;
}


constexpr std::array<SignalRow, 13> kBasePose{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Quality", "", "", 1.0, 1.0, 0.0, 3.0, 0, 3,
     false, -8, kOkStaleInvalidNotAvailableNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"SampleTimeMs", "ms", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"PositionX", "m", "", 1.0, 10000.0, -20000000.0, 20000000.0, -200000000000, 200000000000,
     true, -549755813888, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"PositionY", "m", "", 1.0, 10000.0, -20000000.0, 20000000.0, -200000000000, 200000000000,
     true, -549755813888, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"PositionZ", "m", "", 1.0, 10000.0, -1000.0, 10000.0, -10000000, 100000000,
     true, -549755813888, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Yaw", "rad", "", 1.0, 1000000.0, -3.141593, 3.141593, -3141593, 3141593,
     true, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Pitch", "rad", "", 1.0, 1000000.0, -3.141593, 3.141593, -3141593, 3141593,
     true, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Roll", "rad", "", 1.0, 1000000.0, -3.141593, 3.141593, -3141593, 3141593,
     true, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"VelocityX", "m/s", "", 1.0, 1000000.0, -20.0, 20.0, -20000000, 20000000,
     true, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"VelocityY", "m/s", "", 1.0, 1000000.0, -20.0, 20.0, -20000000, 20000000,
     true, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"VelocityZ", "m/s", "", 1.0, 1000000.0, -20.0, 20.0, -20000000, 20000000,
     true, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_base_pose(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_base_pose_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.quality = static_cast<decltype(m.quality)>(raw[2]);
  m.sample_time_ms = static_cast<decltype(m.sample_time_ms)>(raw[3]);
  m.position_x = static_cast<decltype(m.position_x)>(raw[4]);
  m.position_y = static_cast<decltype(m.position_y)>(raw[5]);
  m.position_z = static_cast<decltype(m.position_z)>(raw[6]);
  m.yaw = static_cast<decltype(m.yaw)>(raw[7]);
  m.pitch = static_cast<decltype(m.pitch)>(raw[8]);
  m.roll = static_cast<decltype(m.roll)>(raw[9]);
  m.velocity_x = static_cast<decltype(m.velocity_x)>(raw[10]);
  m.velocity_y = static_cast<decltype(m.velocity_y)>(raw[11]);
  m.velocity_z = static_cast<decltype(m.velocity_z)>(raw[12]);
  wex_dbc_base_pose_pack(bytes, &m, 48);
}

void unpack_base_pose(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_base_pose_t m;
  wex_dbc_base_pose_unpack(&m, bytes, 48);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.quality;
  raw[3] = m.sample_time_ms;
  raw[4] = m.position_x;
  raw[5] = m.position_y;
  raw[6] = m.position_z;
  raw[7] = m.yaw;
  raw[8] = m.pitch;
  raw[9] = m.roll;
  raw[10] = m.velocity_x;
  raw[11] = m.velocity_y;
  raw[12] = m.velocity_z;
}


constexpr std::array<SignalRow, 9> kZoneStatusLF{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Mode", "", "", 1.0, 1.0, 0.0, 6.0, 0, 6,
     false, -8, kInitReadyEnablingEnabledHoldFaultEStopNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"FaultBits", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LastAcceptedCounter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RejectedFrames", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Challenge", "", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Session", "", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"DbcHash", "", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_zone_status_lf(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_zone_status_lf_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.mode = static_cast<decltype(m.mode)>(raw[2]);
  m.fault_bits = static_cast<decltype(m.fault_bits)>(raw[3]);
  m.last_accepted_counter = static_cast<decltype(m.last_accepted_counter)>(raw[4]);
  m.rejected_frames = static_cast<decltype(m.rejected_frames)>(raw[5]);
  m.challenge = static_cast<decltype(m.challenge)>(raw[6]);
  m.session = static_cast<decltype(m.session)>(raw[7]);
  m.dbc_hash = static_cast<decltype(m.dbc_hash)>(raw[8]);
  wex_dbc_zone_status_lf_pack(bytes, &m, 24);
}

void unpack_zone_status_lf(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_zone_status_lf_t m;
  wex_dbc_zone_status_lf_unpack(&m, bytes, 24);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.mode;
  raw[3] = m.fault_bits;
  raw[4] = m.last_accepted_counter;
  raw[5] = m.rejected_frames;
  raw[6] = m.challenge;
  raw[7] = m.session;
  raw[8] = m.dbc_hash;
}


constexpr std::array<SignalRow, 9> kZoneStatusRF{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Mode", "", "", 1.0, 1.0, 0.0, 6.0, 0, 6,
     false, -8, kInitReadyEnablingEnabledHoldFaultEStopNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"FaultBits", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LastAcceptedCounter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RejectedFrames", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Challenge", "", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Session", "", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"DbcHash", "", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_zone_status_rf(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_zone_status_rf_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.mode = static_cast<decltype(m.mode)>(raw[2]);
  m.fault_bits = static_cast<decltype(m.fault_bits)>(raw[3]);
  m.last_accepted_counter = static_cast<decltype(m.last_accepted_counter)>(raw[4]);
  m.rejected_frames = static_cast<decltype(m.rejected_frames)>(raw[5]);
  m.challenge = static_cast<decltype(m.challenge)>(raw[6]);
  m.session = static_cast<decltype(m.session)>(raw[7]);
  m.dbc_hash = static_cast<decltype(m.dbc_hash)>(raw[8]);
  wex_dbc_zone_status_rf_pack(bytes, &m, 24);
}

void unpack_zone_status_rf(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_zone_status_rf_t m;
  wex_dbc_zone_status_rf_unpack(&m, bytes, 24);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.mode;
  raw[3] = m.fault_bits;
  raw[4] = m.last_accepted_counter;
  raw[5] = m.rejected_frames;
  raw[6] = m.challenge;
  raw[7] = m.session;
  raw[8] = m.dbc_hash;
}


constexpr std::array<SignalRow, 9> kZoneStatusLH{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Mode", "", "", 1.0, 1.0, 0.0, 6.0, 0, 6,
     false, -8, kInitReadyEnablingEnabledHoldFaultEStopNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"FaultBits", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LastAcceptedCounter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RejectedFrames", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Challenge", "", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Session", "", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"DbcHash", "", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_zone_status_lh(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_zone_status_lh_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.mode = static_cast<decltype(m.mode)>(raw[2]);
  m.fault_bits = static_cast<decltype(m.fault_bits)>(raw[3]);
  m.last_accepted_counter = static_cast<decltype(m.last_accepted_counter)>(raw[4]);
  m.rejected_frames = static_cast<decltype(m.rejected_frames)>(raw[5]);
  m.challenge = static_cast<decltype(m.challenge)>(raw[6]);
  m.session = static_cast<decltype(m.session)>(raw[7]);
  m.dbc_hash = static_cast<decltype(m.dbc_hash)>(raw[8]);
  wex_dbc_zone_status_lh_pack(bytes, &m, 24);
}

void unpack_zone_status_lh(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_zone_status_lh_t m;
  wex_dbc_zone_status_lh_unpack(&m, bytes, 24);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.mode;
  raw[3] = m.fault_bits;
  raw[4] = m.last_accepted_counter;
  raw[5] = m.rejected_frames;
  raw[6] = m.challenge;
  raw[7] = m.session;
  raw[8] = m.dbc_hash;
}


constexpr std::array<SignalRow, 9> kZoneStatusRH{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Mode", "", "", 1.0, 1.0, 0.0, 6.0, 0, 6,
     false, -8, kInitReadyEnablingEnabledHoldFaultEStopNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"FaultBits", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LastAcceptedCounter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RejectedFrames", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Challenge", "", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Session", "", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"DbcHash", "", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_zone_status_rh(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_zone_status_rh_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.mode = static_cast<decltype(m.mode)>(raw[2]);
  m.fault_bits = static_cast<decltype(m.fault_bits)>(raw[3]);
  m.last_accepted_counter = static_cast<decltype(m.last_accepted_counter)>(raw[4]);
  m.rejected_frames = static_cast<decltype(m.rejected_frames)>(raw[5]);
  m.challenge = static_cast<decltype(m.challenge)>(raw[6]);
  m.session = static_cast<decltype(m.session)>(raw[7]);
  m.dbc_hash = static_cast<decltype(m.dbc_hash)>(raw[8]);
  wex_dbc_zone_status_rh_pack(bytes, &m, 24);
}

void unpack_zone_status_rh(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_zone_status_rh_t m;
  wex_dbc_zone_status_rh_unpack(&m, bytes, 24);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.mode;
  raw[3] = m.fault_bits;
  raw[4] = m.last_accepted_counter;
  raw[5] = m.rejected_frames;
  raw[6] = m.challenge;
  raw[7] = m.session;
  raw[8] = m.dbc_hash;
}


constexpr std::array<SignalRow, 9> kZoneStatusARM{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Mode", "", "", 1.0, 1.0, 0.0, 6.0, 0, 6,
     false, -8, kInitReadyEnablingEnabledHoldFaultEStopNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"FaultBits", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LastAcceptedCounter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RejectedFrames", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Challenge", "", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Session", "", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"DbcHash", "", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_zone_status_arm(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_zone_status_arm_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.mode = static_cast<decltype(m.mode)>(raw[2]);
  m.fault_bits = static_cast<decltype(m.fault_bits)>(raw[3]);
  m.last_accepted_counter = static_cast<decltype(m.last_accepted_counter)>(raw[4]);
  m.rejected_frames = static_cast<decltype(m.rejected_frames)>(raw[5]);
  m.challenge = static_cast<decltype(m.challenge)>(raw[6]);
  m.session = static_cast<decltype(m.session)>(raw[7]);
  m.dbc_hash = static_cast<decltype(m.dbc_hash)>(raw[8]);
  wex_dbc_zone_status_arm_pack(bytes, &m, 24);
}

void unpack_zone_status_arm(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_zone_status_arm_t m;
  wex_dbc_zone_status_arm_unpack(&m, bytes, 24);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.mode;
  raw[3] = m.fault_bits;
  raw[4] = m.last_accepted_counter;
  raw[5] = m.rejected_frames;
  raw[6] = m.challenge;
  raw[7] = m.session;
  raw[8] = m.dbc_hash;
}


constexpr std::array<SignalRow, 9> kZoneStatusTOOL{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Mode", "", "", 1.0, 1.0, 0.0, 6.0, 0, 6,
     false, -8, kInitReadyEnablingEnabledHoldFaultEStopNames, 0.0, 0.0, -kInfinity, kInfinity},
    {"FaultBits", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LastAcceptedCounter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RejectedFrames", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Challenge", "", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Session", "", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"DbcHash", "", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_zone_status_tool(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_zone_status_tool_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.mode = static_cast<decltype(m.mode)>(raw[2]);
  m.fault_bits = static_cast<decltype(m.fault_bits)>(raw[3]);
  m.last_accepted_counter = static_cast<decltype(m.last_accepted_counter)>(raw[4]);
  m.rejected_frames = static_cast<decltype(m.rejected_frames)>(raw[5]);
  m.challenge = static_cast<decltype(m.challenge)>(raw[6]);
  m.session = static_cast<decltype(m.session)>(raw[7]);
  m.dbc_hash = static_cast<decltype(m.dbc_hash)>(raw[8]);
  wex_dbc_zone_status_tool_pack(bytes, &m, 24);
}

void unpack_zone_status_tool(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_zone_status_tool_t m;
  wex_dbc_zone_status_tool_unpack(&m, bytes, 24);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.mode;
  raw[3] = m.fault_bits;
  raw[4] = m.last_accepted_counter;
  raw[5] = m.rejected_frames;
  raw[6] = m.challenge;
  raw[7] = m.session;
  raw[8] = m.dbc_hash;
}


constexpr std::array<SignalRow, 10> kZonePressureLF{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LF_HAA_PressureA", "Pa", "LF_HAA", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LF_HAA_PressureB", "Pa", "LF_HAA", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LF_HFE_PressureA", "Pa", "LF_HFE", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LF_HFE_PressureB", "Pa", "LF_HFE", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LF_STEER_PressureA", "Pa", "LF_STEER", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LF_STEER_PressureB", "Pa", "LF_STEER", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LF_WHEEL_PressureA", "Pa", "LF_WHEEL", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LF_WHEEL_PressureB", "Pa", "LF_WHEEL", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_zone_pressure_lf(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_zone_pressure_lf_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.lf_haa_pressure_a = static_cast<decltype(m.lf_haa_pressure_a)>(raw[2]);
  m.lf_haa_pressure_b = static_cast<decltype(m.lf_haa_pressure_b)>(raw[3]);
  m.lf_hfe_pressure_a = static_cast<decltype(m.lf_hfe_pressure_a)>(raw[4]);
  m.lf_hfe_pressure_b = static_cast<decltype(m.lf_hfe_pressure_b)>(raw[5]);
  m.lf_steer_pressure_a = static_cast<decltype(m.lf_steer_pressure_a)>(raw[6]);
  m.lf_steer_pressure_b = static_cast<decltype(m.lf_steer_pressure_b)>(raw[7]);
  m.lf_wheel_pressure_a = static_cast<decltype(m.lf_wheel_pressure_a)>(raw[8]);
  m.lf_wheel_pressure_b = static_cast<decltype(m.lf_wheel_pressure_b)>(raw[9]);
  wex_dbc_zone_pressure_lf_pack(bytes, &m, 24);
}

void unpack_zone_pressure_lf(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_zone_pressure_lf_t m;
  wex_dbc_zone_pressure_lf_unpack(&m, bytes, 24);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.lf_haa_pressure_a;
  raw[3] = m.lf_haa_pressure_b;
  raw[4] = m.lf_hfe_pressure_a;
  raw[5] = m.lf_hfe_pressure_b;
  raw[6] = m.lf_steer_pressure_a;
  raw[7] = m.lf_steer_pressure_b;
  raw[8] = m.lf_wheel_pressure_a;
  raw[9] = m.lf_wheel_pressure_b;
}


constexpr std::array<SignalRow, 10> kZonePressureRF{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RF_HAA_PressureA", "Pa", "RF_HAA", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RF_HAA_PressureB", "Pa", "RF_HAA", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RF_HFE_PressureA", "Pa", "RF_HFE", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RF_HFE_PressureB", "Pa", "RF_HFE", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RF_STEER_PressureA", "Pa", "RF_STEER", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RF_STEER_PressureB", "Pa", "RF_STEER", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RF_WHEEL_PressureA", "Pa", "RF_WHEEL", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RF_WHEEL_PressureB", "Pa", "RF_WHEEL", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_zone_pressure_rf(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_zone_pressure_rf_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.rf_haa_pressure_a = static_cast<decltype(m.rf_haa_pressure_a)>(raw[2]);
  m.rf_haa_pressure_b = static_cast<decltype(m.rf_haa_pressure_b)>(raw[3]);
  m.rf_hfe_pressure_a = static_cast<decltype(m.rf_hfe_pressure_a)>(raw[4]);
  m.rf_hfe_pressure_b = static_cast<decltype(m.rf_hfe_pressure_b)>(raw[5]);
  m.rf_steer_pressure_a = static_cast<decltype(m.rf_steer_pressure_a)>(raw[6]);
  m.rf_steer_pressure_b = static_cast<decltype(m.rf_steer_pressure_b)>(raw[7]);
  m.rf_wheel_pressure_a = static_cast<decltype(m.rf_wheel_pressure_a)>(raw[8]);
  m.rf_wheel_pressure_b = static_cast<decltype(m.rf_wheel_pressure_b)>(raw[9]);
  wex_dbc_zone_pressure_rf_pack(bytes, &m, 24);
}

void unpack_zone_pressure_rf(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_zone_pressure_rf_t m;
  wex_dbc_zone_pressure_rf_unpack(&m, bytes, 24);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.rf_haa_pressure_a;
  raw[3] = m.rf_haa_pressure_b;
  raw[4] = m.rf_hfe_pressure_a;
  raw[5] = m.rf_hfe_pressure_b;
  raw[6] = m.rf_steer_pressure_a;
  raw[7] = m.rf_steer_pressure_b;
  raw[8] = m.rf_wheel_pressure_a;
  raw[9] = m.rf_wheel_pressure_b;
}


constexpr std::array<SignalRow, 12> kZonePressureLH{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_HAA_PressureA", "Pa", "LH_HAA", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_HAA_PressureB", "Pa", "LH_HAA", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_HFE_PressureA", "Pa", "LH_HFE", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_HFE_PressureB", "Pa", "LH_HFE", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_STEER_PressureA", "Pa", "LH_STEER", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_STEER_PressureB", "Pa", "LH_STEER", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_WHEEL_PressureA", "Pa", "LH_WHEEL", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_WHEEL_PressureB", "Pa", "LH_WHEEL", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_CLAW_PressureA", "Pa", "LH_CLAW", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"LH_CLAW_PressureB", "Pa", "LH_CLAW", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_zone_pressure_lh(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_zone_pressure_lh_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.lh_haa_pressure_a = static_cast<decltype(m.lh_haa_pressure_a)>(raw[2]);
  m.lh_haa_pressure_b = static_cast<decltype(m.lh_haa_pressure_b)>(raw[3]);
  m.lh_hfe_pressure_a = static_cast<decltype(m.lh_hfe_pressure_a)>(raw[4]);
  m.lh_hfe_pressure_b = static_cast<decltype(m.lh_hfe_pressure_b)>(raw[5]);
  m.lh_steer_pressure_a = static_cast<decltype(m.lh_steer_pressure_a)>(raw[6]);
  m.lh_steer_pressure_b = static_cast<decltype(m.lh_steer_pressure_b)>(raw[7]);
  m.lh_wheel_pressure_a = static_cast<decltype(m.lh_wheel_pressure_a)>(raw[8]);
  m.lh_wheel_pressure_b = static_cast<decltype(m.lh_wheel_pressure_b)>(raw[9]);
  m.lh_claw_pressure_a = static_cast<decltype(m.lh_claw_pressure_a)>(raw[10]);
  m.lh_claw_pressure_b = static_cast<decltype(m.lh_claw_pressure_b)>(raw[11]);
  wex_dbc_zone_pressure_lh_pack(bytes, &m, 24);
}

void unpack_zone_pressure_lh(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_zone_pressure_lh_t m;
  wex_dbc_zone_pressure_lh_unpack(&m, bytes, 24);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.lh_haa_pressure_a;
  raw[3] = m.lh_haa_pressure_b;
  raw[4] = m.lh_hfe_pressure_a;
  raw[5] = m.lh_hfe_pressure_b;
  raw[6] = m.lh_steer_pressure_a;
  raw[7] = m.lh_steer_pressure_b;
  raw[8] = m.lh_wheel_pressure_a;
  raw[9] = m.lh_wheel_pressure_b;
  raw[10] = m.lh_claw_pressure_a;
  raw[11] = m.lh_claw_pressure_b;
}


constexpr std::array<SignalRow, 12> kZonePressureRH{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_HAA_PressureA", "Pa", "RH_HAA", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_HAA_PressureB", "Pa", "RH_HAA", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_HFE_PressureA", "Pa", "RH_HFE", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_HFE_PressureB", "Pa", "RH_HFE", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_STEER_PressureA", "Pa", "RH_STEER", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_STEER_PressureB", "Pa", "RH_STEER", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_WHEEL_PressureA", "Pa", "RH_WHEEL", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_WHEEL_PressureB", "Pa", "RH_WHEEL", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_CLAW_PressureA", "Pa", "RH_CLAW", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RH_CLAW_PressureB", "Pa", "RH_CLAW", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_zone_pressure_rh(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_zone_pressure_rh_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.rh_haa_pressure_a = static_cast<decltype(m.rh_haa_pressure_a)>(raw[2]);
  m.rh_haa_pressure_b = static_cast<decltype(m.rh_haa_pressure_b)>(raw[3]);
  m.rh_hfe_pressure_a = static_cast<decltype(m.rh_hfe_pressure_a)>(raw[4]);
  m.rh_hfe_pressure_b = static_cast<decltype(m.rh_hfe_pressure_b)>(raw[5]);
  m.rh_steer_pressure_a = static_cast<decltype(m.rh_steer_pressure_a)>(raw[6]);
  m.rh_steer_pressure_b = static_cast<decltype(m.rh_steer_pressure_b)>(raw[7]);
  m.rh_wheel_pressure_a = static_cast<decltype(m.rh_wheel_pressure_a)>(raw[8]);
  m.rh_wheel_pressure_b = static_cast<decltype(m.rh_wheel_pressure_b)>(raw[9]);
  m.rh_claw_pressure_a = static_cast<decltype(m.rh_claw_pressure_a)>(raw[10]);
  m.rh_claw_pressure_b = static_cast<decltype(m.rh_claw_pressure_b)>(raw[11]);
  wex_dbc_zone_pressure_rh_pack(bytes, &m, 24);
}

void unpack_zone_pressure_rh(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_zone_pressure_rh_t m;
  wex_dbc_zone_pressure_rh_unpack(&m, bytes, 24);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.rh_haa_pressure_a;
  raw[3] = m.rh_haa_pressure_b;
  raw[4] = m.rh_hfe_pressure_a;
  raw[5] = m.rh_hfe_pressure_b;
  raw[6] = m.rh_steer_pressure_a;
  raw[7] = m.rh_steer_pressure_b;
  raw[8] = m.rh_wheel_pressure_a;
  raw[9] = m.rh_wheel_pressure_b;
  raw[10] = m.rh_claw_pressure_a;
  raw[11] = m.rh_claw_pressure_b;
}


constexpr std::array<SignalRow, 10> kZonePressureARM{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"TURN_PressureA", "Pa", "TURN", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"TURN_PressureB", "Pa", "TURN", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"BOOM_PressureA", "Pa", "BOOM", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"BOOM_PressureB", "Pa", "BOOM", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"DIPPER_PressureA", "Pa", "DIPPER", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"DIPPER_PressureB", "Pa", "DIPPER", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"TELE_PressureA", "Pa", "TELE", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"TELE_PressureB", "Pa", "TELE", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_zone_pressure_arm(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_zone_pressure_arm_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.turn_pressure_a = static_cast<decltype(m.turn_pressure_a)>(raw[2]);
  m.turn_pressure_b = static_cast<decltype(m.turn_pressure_b)>(raw[3]);
  m.boom_pressure_a = static_cast<decltype(m.boom_pressure_a)>(raw[4]);
  m.boom_pressure_b = static_cast<decltype(m.boom_pressure_b)>(raw[5]);
  m.dipper_pressure_a = static_cast<decltype(m.dipper_pressure_a)>(raw[6]);
  m.dipper_pressure_b = static_cast<decltype(m.dipper_pressure_b)>(raw[7]);
  m.tele_pressure_a = static_cast<decltype(m.tele_pressure_a)>(raw[8]);
  m.tele_pressure_b = static_cast<decltype(m.tele_pressure_b)>(raw[9]);
  wex_dbc_zone_pressure_arm_pack(bytes, &m, 24);
}

void unpack_zone_pressure_arm(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_zone_pressure_arm_t m;
  wex_dbc_zone_pressure_arm_unpack(&m, bytes, 24);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.turn_pressure_a;
  raw[3] = m.turn_pressure_b;
  raw[4] = m.boom_pressure_a;
  raw[5] = m.boom_pressure_b;
  raw[6] = m.dipper_pressure_a;
  raw[7] = m.dipper_pressure_b;
  raw[8] = m.tele_pressure_a;
  raw[9] = m.tele_pressure_b;
}


constexpr std::array<SignalRow, 8> kZonePressureTOOL{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"EE_PITCH_PressureA", "Pa", "EE_PITCH", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"EE_PITCH_PressureB", "Pa", "EE_PITCH", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"EE_ROLL_PressureA", "Pa", "EE_ROLL", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"EE_ROLL_PressureB", "Pa", "EE_ROLL", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"EE_YAW_PressureA", "Pa", "EE_YAW", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"EE_YAW_PressureB", "Pa", "EE_YAW", 2000.0, 1.0, -100000.0, 60000000.0, -50, 30000,
     true, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_zone_pressure_tool(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_zone_pressure_tool_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.ee_pitch_pressure_a = static_cast<decltype(m.ee_pitch_pressure_a)>(raw[2]);
  m.ee_pitch_pressure_b = static_cast<decltype(m.ee_pitch_pressure_b)>(raw[3]);
  m.ee_roll_pressure_a = static_cast<decltype(m.ee_roll_pressure_a)>(raw[4]);
  m.ee_roll_pressure_b = static_cast<decltype(m.ee_roll_pressure_b)>(raw[5]);
  m.ee_yaw_pressure_a = static_cast<decltype(m.ee_yaw_pressure_a)>(raw[6]);
  m.ee_yaw_pressure_b = static_cast<decltype(m.ee_yaw_pressure_b)>(raw[7]);
  wex_dbc_zone_pressure_tool_pack(bytes, &m, 24);
}

void unpack_zone_pressure_tool(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_zone_pressure_tool_t m;
  wex_dbc_zone_pressure_tool_unpack(&m, bytes, 24);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.ee_pitch_pressure_a;
  raw[3] = m.ee_pitch_pressure_b;
  raw[4] = m.ee_roll_pressure_a;
  raw[5] = m.ee_roll_pressure_b;
  raw[6] = m.ee_yaw_pressure_a;
  raw[7] = m.ee_yaw_pressure_b;
}


constexpr std::array<SignalRow, 3> kLockStep{{
    {"Crc", "", "", 1.0, 1.0, 0.0, 65535.0, 0, 65535,
     false, -32768, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"Counter", "", "", 1.0, 1.0, 0.0, 255.0, 0, 255,
     false, -128, {}, 0.0, 0.0, -kInfinity, kInfinity},
    {"RunUntilMs", "ms", "", 1.0, 1.0, 0.0, 4294967295.0, 0, 4294967295,
     false, -2147483648, {}, 0.0, 0.0, -kInfinity, kInfinity},
}};

void pack_lock_step(const std::int64_t* raw, std::uint8_t* bytes) noexcept {
  wex_dbc_lock_step_t m;
  m.crc = static_cast<decltype(m.crc)>(raw[0]);
  m.counter = static_cast<decltype(m.counter)>(raw[1]);
  m.run_until_ms = static_cast<decltype(m.run_until_ms)>(raw[2]);
  wex_dbc_lock_step_pack(bytes, &m, 8);
}

void unpack_lock_step(const std::uint8_t* bytes, std::int64_t* raw) noexcept {
  wex_dbc_lock_step_t m;
  wex_dbc_lock_step_unpack(&m, bytes, 8);
  raw[0] = m.crc;
  raw[1] = m.counter;
  raw[2] = m.run_until_ms;
}

}  // namespace

constinit const std::array<MessageRow, 31> kMessages{{
    {0x010, MessageKind::kEStopState, -1, "EStopState", "SAFETY", 8, true,
     E2eProfile::kCrc16Counter8, 0x5710, false, 10, 50, 0,
     kEStopState, pack_e_stop_state, unpack_e_stop_state},
    {0x020, MessageKind::kHostStop, -1, "HostStop", "HOST", 8, true,
     E2eProfile::kCrc16Counter8, 0x5720, false, 10, 0, 0,
     kHostStop, pack_host_stop, unpack_host_stop},
    {0x030, MessageKind::kOperatorCommand, -1, "OperatorCommand", "TERMINAL", 8, true,
     E2eProfile::kCrc16Counter8, 0x5730, false, 50, 0, 0,
     kOperatorCommand, pack_operator_command, unpack_operator_command},
    {0x040, MessageKind::kHostHeartbeat, -1, "HostHeartbeat", "HOST", 24, true,
     E2eProfile::kCrc16Counter8, 0x5740, false, 20, 100, 0,
     kHostHeartbeat, pack_host_heartbeat, unpack_host_heartbeat},
    {0x080, MessageKind::kZoneCommand, 0, "ZoneCommandLF", "HOST", 24, true,
     E2eProfile::kCrc16Counter8, 0x5780, true, 10, 50, 4,
     kZoneCommandLF, pack_zone_command_lf, unpack_zone_command_lf},
    {0x081, MessageKind::kZoneCommand, 1, "ZoneCommandRF", "HOST", 24, true,
     E2eProfile::kCrc16Counter8, 0x5781, true, 10, 50, 4,
     kZoneCommandRF, pack_zone_command_rf, unpack_zone_command_rf},
    {0x082, MessageKind::kZoneCommand, 2, "ZoneCommandLH", "HOST", 24, true,
     E2eProfile::kCrc16Counter8, 0x5782, true, 10, 50, 5,
     kZoneCommandLH, pack_zone_command_lh, unpack_zone_command_lh},
    {0x083, MessageKind::kZoneCommand, 3, "ZoneCommandRH", "HOST", 24, true,
     E2eProfile::kCrc16Counter8, 0x5783, true, 10, 50, 5,
     kZoneCommandRH, pack_zone_command_rh, unpack_zone_command_rh},
    {0x084, MessageKind::kZoneCommand, 4, "ZoneCommandARM", "HOST", 24, true,
     E2eProfile::kCrc16Counter8, 0x5784, true, 10, 50, 4,
     kZoneCommandARM, pack_zone_command_arm, unpack_zone_command_arm},
    {0x085, MessageKind::kZoneCommand, 5, "ZoneCommandTOOL", "HOST", 24, true,
     E2eProfile::kCrc16Counter8, 0x5785, true, 10, 50, 3,
     kZoneCommandTOOL, pack_zone_command_tool, unpack_zone_command_tool},
    {0x100, MessageKind::kZoneFeedback, 0, "ZoneFeedbackLF", "MACHINE", 48, true,
     E2eProfile::kCrc16Counter8, 0x5800, false, 10, 50, 4,
     kZoneFeedbackLF, pack_zone_feedback_lf, unpack_zone_feedback_lf},
    {0x101, MessageKind::kZoneFeedback, 1, "ZoneFeedbackRF", "MACHINE", 48, true,
     E2eProfile::kCrc16Counter8, 0x5801, false, 10, 50, 4,
     kZoneFeedbackRF, pack_zone_feedback_rf, unpack_zone_feedback_rf},
    {0x102, MessageKind::kZoneFeedback, 2, "ZoneFeedbackLH", "MACHINE", 48, true,
     E2eProfile::kCrc16Counter8, 0x5802, false, 10, 50, 5,
     kZoneFeedbackLH, pack_zone_feedback_lh, unpack_zone_feedback_lh},
    {0x103, MessageKind::kZoneFeedback, 3, "ZoneFeedbackRH", "MACHINE", 48, true,
     E2eProfile::kCrc16Counter8, 0x5803, false, 10, 50, 5,
     kZoneFeedbackRH, pack_zone_feedback_rh, unpack_zone_feedback_rh},
    {0x104, MessageKind::kZoneFeedback, 4, "ZoneFeedbackARM", "MACHINE", 48, true,
     E2eProfile::kCrc16Counter8, 0x5804, false, 10, 50, 4,
     kZoneFeedbackARM, pack_zone_feedback_arm, unpack_zone_feedback_arm},
    {0x105, MessageKind::kZoneFeedback, 5, "ZoneFeedbackTOOL", "MACHINE", 48, true,
     E2eProfile::kCrc16Counter8, 0x5805, false, 10, 50, 3,
     kZoneFeedbackTOOL, pack_zone_feedback_tool, unpack_zone_feedback_tool},
    {0x180, MessageKind::kImu, -1, "Imu", "MACHINE", 32, true,
     E2eProfile::kCrc16Counter8, 0x5880, false, 10, 50, 0,
     kImu, pack_imu, unpack_imu},
    {0x188, MessageKind::kBasePose, -1, "BasePose", "LOCALISATION", 48, true,
     E2eProfile::kCrc16Counter8, 0x5888, false, 10, 50, 0,
     kBasePose, pack_base_pose, unpack_base_pose},
    {0x200, MessageKind::kZoneStatus, 0, "ZoneStatusLF", "MACHINE", 24, true,
     E2eProfile::kCrc16Counter8, 0x5900, false, 50, 250, 0,
     kZoneStatusLF, pack_zone_status_lf, unpack_zone_status_lf},
    {0x201, MessageKind::kZoneStatus, 1, "ZoneStatusRF", "MACHINE", 24, true,
     E2eProfile::kCrc16Counter8, 0x5901, false, 50, 250, 0,
     kZoneStatusRF, pack_zone_status_rf, unpack_zone_status_rf},
    {0x202, MessageKind::kZoneStatus, 2, "ZoneStatusLH", "MACHINE", 24, true,
     E2eProfile::kCrc16Counter8, 0x5902, false, 50, 250, 0,
     kZoneStatusLH, pack_zone_status_lh, unpack_zone_status_lh},
    {0x203, MessageKind::kZoneStatus, 3, "ZoneStatusRH", "MACHINE", 24, true,
     E2eProfile::kCrc16Counter8, 0x5903, false, 50, 250, 0,
     kZoneStatusRH, pack_zone_status_rh, unpack_zone_status_rh},
    {0x204, MessageKind::kZoneStatus, 4, "ZoneStatusARM", "MACHINE", 24, true,
     E2eProfile::kCrc16Counter8, 0x5904, false, 50, 250, 0,
     kZoneStatusARM, pack_zone_status_arm, unpack_zone_status_arm},
    {0x205, MessageKind::kZoneStatus, 5, "ZoneStatusTOOL", "MACHINE", 24, true,
     E2eProfile::kCrc16Counter8, 0x5905, false, 50, 250, 0,
     kZoneStatusTOOL, pack_zone_status_tool, unpack_zone_status_tool},
    {0x300, MessageKind::kZonePressure, 0, "ZonePressureLF", "MACHINE", 24, true,
     E2eProfile::kCrc16Counter8, 0x5A00, false, 20, 200, 4,
     kZonePressureLF, pack_zone_pressure_lf, unpack_zone_pressure_lf},
    {0x301, MessageKind::kZonePressure, 1, "ZonePressureRF", "MACHINE", 24, true,
     E2eProfile::kCrc16Counter8, 0x5A01, false, 20, 200, 4,
     kZonePressureRF, pack_zone_pressure_rf, unpack_zone_pressure_rf},
    {0x302, MessageKind::kZonePressure, 2, "ZonePressureLH", "MACHINE", 24, true,
     E2eProfile::kCrc16Counter8, 0x5A02, false, 20, 200, 5,
     kZonePressureLH, pack_zone_pressure_lh, unpack_zone_pressure_lh},
    {0x303, MessageKind::kZonePressure, 3, "ZonePressureRH", "MACHINE", 24, true,
     E2eProfile::kCrc16Counter8, 0x5A03, false, 20, 200, 5,
     kZonePressureRH, pack_zone_pressure_rh, unpack_zone_pressure_rh},
    {0x304, MessageKind::kZonePressure, 4, "ZonePressureARM", "MACHINE", 24, true,
     E2eProfile::kCrc16Counter8, 0x5A04, false, 20, 200, 4,
     kZonePressureARM, pack_zone_pressure_arm, unpack_zone_pressure_arm},
    {0x305, MessageKind::kZonePressure, 5, "ZonePressureTOOL", "MACHINE", 24, true,
     E2eProfile::kCrc16Counter8, 0x5A05, false, 20, 200, 3,
     kZonePressureTOOL, pack_zone_pressure_tool, unpack_zone_pressure_tool},
    {0x7F0, MessageKind::kLockStep, -1, "LockStep", "HOST", 8, true,
     E2eProfile::kCrc16Counter8, 0x5EF0, false, 10, 0, 0,
     kLockStep, pack_lock_step, unpack_lock_step},
}};

}  // namespace wex::can::generated
