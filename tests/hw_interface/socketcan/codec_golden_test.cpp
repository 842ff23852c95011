#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "tests/hw_interface/socketcan/codec_fields.hpp"

// codec_golden.txt: frames made once without this code. Both directions must reproduce them.

namespace wex::can {
namespace {

struct Golden {
  std::string name, hex;
  std::uint32_t id = 0, session = 0;
  std::uint8_t counter = 0;
  std::map<std::string, double> values;
};

std::vector<Golden> read_golden() {
  std::ifstream file(WEX_TEST_DATA_DIR "/codec_golden.txt");
  std::vector<Golden> all;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    Golden golden;
    unsigned counter = 0;
    words >> golden.name >> std::hex >> golden.id >> golden.session >> std::dec >> counter >>
        golden.hex;
    golden.counter = static_cast<std::uint8_t>(counter);
    for (std::string word; words >> word;) {
      const auto equals = word.find('=');
      golden.values[word.substr(0, equals)] = std::stod(word.substr(equals + 1));
    }
    all.push_back(golden);
  }
  return all;
}

std::string hex_of(const CanFrame& frame) {
  std::string text;
  char byte[3];
  for (int i = 0; i < frame.length; ++i) {
    std::snprintf(byte, sizeof byte, "%02x", frame.data[i]);
    text += byte;
  }
  return text;
}

CanFrame frame_of(const Golden& golden) {
  CanFrame frame;
  frame.id = golden.id;
  frame.fd = true;
  frame.length = static_cast<std::uint8_t>(golden.hex.size() / 2);
  for (int i = 0; i < frame.length; ++i) {
    frame.data[i] = static_cast<std::uint8_t>(std::stoi(golden.hex.substr(2 * i, 2), nullptr, 16));
  }
  return frame;
}

AnyMessage message_of(const std::string& name) {
  for (auto& [known, message] : every_message()) {
    if (known == name) return message;
  }
  throw std::runtime_error("no message " + name);
}

TEST(GoldenFrames, AreEncodedBitForBit) {
  for (const Golden& golden : read_golden()) {
    SCOPED_TRACE(golden.name);
    AnyMessage message = message_of(golden.name);
    const auto all = fields(message);
    ASSERT_EQ(all.size(), golden.values.size());
    for (const Field& field : all) field.set(golden.values.at(field.signal));
    SendContext context{golden.session, golden.counter};
    CanFrame frame;
    ASSERT_TRUE(encode_any(message, context, frame));
    EXPECT_EQ(frame.id, golden.id);
    EXPECT_EQ(hex_of(frame), golden.hex);
  }
}

TEST(GoldenFrames, AreDecodedToTheirValues) {
  for (const Golden& golden : read_golden()) {
    SCOPED_TRACE(golden.name);
    AnyMessage message = message_of(golden.name);
    const auto meta = decode_any(frame_of(golden), golden.session, message);
    ASSERT_TRUE(meta) << to_string(meta.error());
    EXPECT_EQ(meta->counter, golden.counter);
    for (const Field& field : fields(message)) {
      EXPECT_EQ(field.get(), golden.values.at(field.signal)) << field.signal;
    }
  }
}

TEST(GoldenFrames, CoverEveryKindOfMessage) {
  std::set<std::size_t> types;
  for (const Golden& golden : read_golden()) types.insert(message_of(golden.name).index());
  EXPECT_EQ(types.size(), std::variant_size_v<AnyMessage>);
}

}  // namespace
}  // namespace wex::can
