#pragma once

#include <cmath>
#include <cstdint>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "hw_interface/socketcan/can_frame.hpp"

// Reads what tests need of wex.dbc straight from its text, and sets bits by hand: no generated
// code.

namespace wex::can {

struct DbcSignal {
  std::string name;
  int start = 0, bits = 0;
  bool is_signed = false;
  double scale = 1.0, minimum = 0.0, maximum = 0.0;
  std::map<std::string, std::string> attributes;
  std::map<std::int64_t, std::string> table;  ///< VAL_: raw value -> name
  [[nodiscard]] std::int64_t raw_minimum() const { return std::llround(minimum / scale); }
  [[nodiscard]] std::int64_t raw_maximum() const { return std::llround(maximum / scale); }
  [[nodiscard]] std::int64_t not_available() const { return -(std::int64_t{1} << (bits - 1)); }
  [[nodiscard]] bool is_enumeration() const { return table.contains(0); }
};

struct DbcMessage {
  std::uint32_t id = 0;
  std::string name;
  int length = 0;
  std::vector<DbcSignal> signals;  ///< in the order of the text
  std::map<std::string, std::string> attributes;
  [[nodiscard]] const DbcSignal& signal(const std::string& signal_name) const {
    for (const DbcSignal& s : signals) {
      if (s.name == signal_name) return s;
    }
    throw std::runtime_error(name + " has no signal " + signal_name);
  }
};

inline std::string wex_dbc_text() {
  std::ifstream file(WEX_SOCKETCAN_DIR "/wex.dbc", std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Messages of wex.dbc by name.
inline std::map<std::string, DbcMessage> read_wex_dbc() {
  static const std::regex message_line(R"(BO_ (\d+) (\w+): (\d+) \w+)");
  static const std::regex signal_line(
      R"( SG_ (\w+) : (\d+)\|(\d+)@1([+-]) \(([^,]+),0\) \[([^|]+)\|([^\]]+)\].*)");
  static const std::regex message_attribute(R"re(BA_ "(\w+)" BO_ (\d+) "?([^";]*)"?;)re");
  static const std::regex signal_attribute(R"re(BA_ "(\w+)" SG_ (\d+) (\w+) "?([^";]*)"?;)re");
  static const std::regex table_line(R"(VAL_ (\d+) (\w+) (.*) ;)");
  static const std::regex table_entry(R"re((-?\d+) "([^"]*)")re");
  std::map<unsigned long, DbcMessage> by_id;
  std::uint32_t id = 0;
  std::istringstream lines(wex_dbc_text());
  const auto find = [&](const std::string& message, const std::string& name) -> DbcSignal& {
    return const_cast<DbcSignal&>(by_id.at(std::stoul(message)).signal(name));
  };
  for (std::string line; std::getline(lines, line);) {
    std::smatch m;
    if (std::regex_match(line, m, message_line)) {
      id = static_cast<std::uint32_t>(std::stoul(m[1]));
      by_id[id] = {id, m[2], std::stoi(m[3]), {}, {}};
    } else if (std::regex_match(line, m, signal_line)) {
      by_id.at(id).signals.push_back({m[1],
                                      std::stoi(m[2]),
                                      std::stoi(m[3]),
                                      m[4] == "-",
                                      std::stod(m[5]),
                                      std::stod(m[6]),
                                      std::stod(m[7]),
                                      {},
                                      {}});
    } else if (std::regex_match(line, m, message_attribute)) {
      by_id.at(std::stoul(m[2])).attributes[m[1]] = m[3];
    } else if (std::regex_match(line, m, signal_attribute)) {
      find(m[2], m[3]).attributes[m[1]] = m[4];
    } else if (std::regex_match(line, m, table_line)) {
      const std::string entries = m[3];
      DbcSignal& signal = find(m[1], m[2]);
      for (std::sregex_iterator e(entries.begin(), entries.end(), table_entry), end; e != end;
           ++e) {
        signal.table[std::stoll((*e)[1])] = (*e)[2];
      }
    }
  }
  std::map<std::string, DbcMessage> by_name;
  for (auto& [_, message] : by_id) by_name[message.name] = message;
  return by_name;
}

/// Bits of a little-endian signal, as they stand in the payload.
inline std::int64_t raw_of(const CanFrame& frame, const DbcSignal& signal) {
  std::uint64_t raw = 0;
  for (int i = 0; i < signal.bits; ++i) {
    const int bit = signal.start + i;
    raw |= static_cast<std::uint64_t>((frame.data[bit / 8] >> (bit % 8)) & 1) << i;
  }
  const bool negative = signal.is_signed && ((raw >> (signal.bits - 1)) & 1) != 0;
  return static_cast<std::int64_t>(negative ? raw - (std::uint64_t{1} << signal.bits) : raw);
}

inline void set_raw(CanFrame& frame, const DbcSignal& signal, std::int64_t raw) {
  for (int i = 0; i < signal.bits; ++i) {
    const int bit = signal.start + i;
    const auto mask = static_cast<std::uint8_t>(1u << (bit % 8));
    frame.data[bit / 8] = static_cast<std::uint8_t>(
        ((static_cast<std::uint64_t>(raw) >> i) & 1) != 0 ? frame.data[bit / 8] | mask
                                                          : frame.data[bit / 8] & ~mask);
  }
}

/// CRC-16 0x1021 bit by bit over the payload behind the CRC, the data id and the session.
inline std::uint16_t slow_crc(const CanFrame& frame, const DbcMessage& message,
                              std::uint32_t session) {
  std::vector<std::uint8_t> bytes(frame.data.begin() + 2, frame.data.begin() + frame.length);
  const auto data_id = std::stoul(message.attributes.at("E2EDataId"));
  for (int i = 0; i < 2; ++i) bytes.push_back(static_cast<std::uint8_t>(data_id >> (8 * i)));
  for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(session >> (8 * i)));
  unsigned crc = 0xFFFF;
  for (const std::uint8_t byte : bytes) {
    crc ^= static_cast<unsigned>(byte) << 8;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x8000) ? (crc << 1) ^ 0x1021 : crc << 1;
  }
  return static_cast<std::uint16_t>(crc);
}

/// Puts the right CRC into a frame that a test has altered.
inline void protect(CanFrame& frame, const DbcMessage& message, std::uint32_t session = 0) {
  const std::uint16_t crc = slow_crc(frame, message, session);
  frame.data[0] = static_cast<std::uint8_t>(crc);
  frame.data[1] = static_cast<std::uint8_t>(crc >> 8);
}

}  // namespace wex::can
