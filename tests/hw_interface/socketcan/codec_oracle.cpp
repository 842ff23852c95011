#include <cstdio>
#include <cstring>
#include <iostream>
#include <random>
#include <sstream>

#include "tests/hw_interface/socketcan/codec_fields.hpp"
#include "tests/hw_interface/socketcan/dbc_text.hpp"

// The C++ half of the comparison with cantools; codec_oracle.py is the other half.
//   codec_oracle write COUNT SEED   random messages: encodes them, prints frames and values
//   codec_oracle read               decodes the frames on standard input, prints frames and values
// A line is NAME ID(hex) SESSION(hex) COUNTER PAYLOAD(hex) SIGNAL=VALUE ...; values that were sent,
// or `refused REASON` for a frame that is not accepted.

namespace wex::can {
namespace {

std::string hex_of(const CanFrame& frame) {
  std::string text;
  char byte[3];
  for (int i = 0; i < frame.length; ++i) {
    std::snprintf(byte, sizeof byte, "%02x", frame.data[i]);
    text += byte;
  }
  return text;
}

void print(const std::string& name, const CanFrame& frame, std::uint32_t session, int counter,
           AnyMessage& message) {
  std::printf("%s %x %x %d %s", name.c_str(), frame.id, session, counter, hex_of(frame).c_str());
  for (const Field& field : fields(message)) {
    std::printf(" %s=%.17g", field.signal.c_str(), field.get());
  }
  std::puts("");
}

int write(long count, unsigned long seed) {
  std::mt19937_64 random(seed);
  const auto dbc = read_wex_dbc();
  auto messages = every_message();
  for (long i = 0; i < count; ++i) {
    auto& [name, message] = messages[random() % messages.size()];
    for (const Field& field : fields(message)) {
      const DbcSignal& signal = dbc.at(name).signal(field.signal);
      std::uniform_real_distribution<double> between(signal.minimum, signal.maximum);
      const double real = between(random);
      if (field.signal.ends_with("Quality")) {
        field.set(random() % 2 == 0 ? 0.0 : 1.0);  // with a value; `read` tries the others
      } else {
        field.set(field.is_real ? real : std::nearbyint(real));
      }
    }
    SendContext context{static_cast<std::uint32_t>(random()), static_cast<std::uint8_t>(random())};
    const int counter = context.counter;
    CanFrame frame;
    if (!encode_any(message, context, frame)) {
      std::cerr << "codec_oracle: " << name << " was refused\n";
      return 1;
    }
    print(name, frame, context.session, counter, message);
  }
  return 0;
}

int read() {
  auto all = every_message();
  std::map<std::string, AnyMessage> messages(all.begin(), all.end());
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream words(line);
    std::string name, hex;
    CanFrame frame;
    std::uint32_t session = 0;
    int counter = 0;
    words >> name >> std::hex >> frame.id >> session >> std::dec >> counter >> hex;
    frame.fd = true;
    frame.length = static_cast<std::uint8_t>(hex.size() / 2);
    for (int i = 0; i < frame.length; ++i) {
      frame.data[i] = static_cast<std::uint8_t>(std::stoi(hex.substr(2 * i, 2), nullptr, 16));
    }
    AnyMessage& message = messages.at(name);
    const auto meta = decode_any(frame, session, message);
    if (meta) {
      print(name, frame, session, meta->counter, message);
    } else {
      std::printf("%s refused %s\n", name.c_str(), to_string(meta.error()));
    }
  }
  return 0;
}

}  // namespace
}  // namespace wex::can

int main(int argc, char** argv) {
  if (argc == 4 && std::strcmp(argv[1], "write") == 0) {
    return wex::can::write(std::atol(argv[2]), std::strtoul(argv[3], nullptr, 10));
  }
  if (argc == 2 && std::strcmp(argv[1], "read") == 0) return wex::can::read();
  std::cerr << "usage: codec_oracle write COUNT SEED | read\n";
  return 2;
}
