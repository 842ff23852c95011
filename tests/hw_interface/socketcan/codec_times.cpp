#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "hw_interface/socketcan/signal_row.hpp"
#include "tests/hw_interface/socketcan/codec_fields.hpp"

// codec_times: how long packing, unpacking, encoding and decoding take, by message. The time is the
// least of several runs, since other programs only ever add to it; the last line is the longest.

namespace wex::can {
namespace {

/// Keeps the compiler from leaving out what nobody looks at.
template <typename T>
void keep(T& value) {
  asm volatile("" : : "g"(&value) : "memory");
}

template <typename Action>
double nanoseconds(Action action) {
  constexpr int kRuns = 15, kCalls = 4000;
  double least = std::numeric_limits<double>::infinity();
  for (int run = 0; run < kRuns; ++run) {
    const auto start = std::chrono::steady_clock::now();
    for (int call = 0; call < kCalls; ++call) action();
    const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - start;
    least = std::min(least, taken.count() / kCalls);
  }
  return least;
}

struct Times {
  double pack = 0.0, unpack = 0.0, encode = 0.0, decode = 0.0;
};

Times times_of(const AnyMessage& message) {
  Times times;
  SendContext context{77, 0};
  CanFrame frame;
  times.encode = nanoseconds([&] {
    keep(frame);
    if (!encode_any(message, context, frame)) std::abort();
  });
  AnyMessage read = message;
  times.decode = nanoseconds([&] {
    keep(frame);
    if (!decode_any(frame, context.session, read)) std::abort();
    keep(read);
  });
  const MessageRow& row = *row_of(frame.id);
  std::array<std::int64_t, 64> raw{};
  times.unpack = nanoseconds([&] {
    row.unpack(frame.data.data(), raw.data());
    keep(raw);
  });
  times.pack = nanoseconds([&] {
    row.pack(raw.data(), frame.data.data());
    keep(frame);
  });
  return times;
}

int run() {
  Times most;
  std::printf("%-22s %8s %8s %8s %8s  ns\n", "message", "pack", "unpack", "encode", "decode");
  for (const auto& [name, message] : every_message()) {
    const Times times = times_of(message);
    std::printf("%-22s %8.1f %8.1f %8.1f %8.1f\n", name.c_str(), times.pack, times.unpack,
                times.encode, times.decode);
    most = {std::max(most.pack, times.pack), std::max(most.unpack, times.unpack),
            std::max(most.encode, times.encode), std::max(most.decode, times.decode)};
  }
  std::printf("longest: pack %.0f ns, unpack %.0f ns, encode %.0f ns, decode %.0f ns\n", most.pack,
              most.unpack, most.encode, most.decode);
  return 0;
}

}  // namespace
}  // namespace wex::can

int main() { return wex::can::run(); }
