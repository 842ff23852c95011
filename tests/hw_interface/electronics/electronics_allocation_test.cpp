#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "hw_interface/electronics/electronics.hpp"
#include "tests/support/fake_plant.hpp"

namespace {
std::atomic<long> num_allocations{0};
}  // namespace

// Counts what C++ code allocates in this process. Not inlined, or the compiler sees free() meet
// new.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++num_allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace wex::can {
namespace {

/// Hands out one frame of every kind per period, swallows what is sent.
class NoisyPort final : public FramePort {
 public:
  SocketStatus send(const CanFrame& frame) noexcept override {
    last = frame;
    return SocketStatus::kOk;
  }
  SocketStatus receive(CanFrame& frame) noexcept override {
    if (next >= frames.size()) return SocketStatus::kWouldBlock;
    frame = frames[next++];
    return SocketStatus::kOk;
  }
  SocketStatus wait_readable(double) noexcept override { return SocketStatus::kOk; }
  SocketStatus reopen() noexcept override { return SocketStatus::kOk; }
  bool purge() noexcept override { return false; }
  std::uint32_t dropped() const noexcept override { return 0; }

  std::array<CanFrame, 10> frames{};
  std::size_t next = 0;
  CanFrame last;
};

TEST(Electronics, APeriodAllocatesNothing) {
  const MachineModel machine = load_machine().value();
  FakePlant plant(machine);
  NoisyPort port;
  SeededRandom random(1);
  const auto electronics = Electronics::create(machine, plant, port, random).value();
  SendContext heartbeat_context, stop_context, operator_context;
  std::array<SendContext, kNumZones> command_context{};
  const long before = num_allocations;
  EXPECT_GT(before, 0) << "the count must count";
  for (std::int64_t now_ms = 1000; now_ms < 2000; now_ms += 10) {
    HostHeartbeat heartbeat;
    heartbeat.dbc_hash = dbc_hash();
    heartbeat.request = now_ms < 1100 ? HostRequest::kNone : HostRequest::kEnable;
    heartbeat.nonce = 1;
    heartbeat.challenge_echo = electronics->automaton().challenge();
    heartbeat.session = electronics->automaton().session();
    std::size_t count = 0;
    ASSERT_TRUE(encode(heartbeat, heartbeat_context, port.frames[count++]).has_value());
    for (int zone = 0; zone < kNumZones; ++zone) {
      ZoneCommand command;
      command.zone = zone;
      command.echo_time_ms = static_cast<std::uint32_t>(now_ms);
      command.valid_for_ms = 60;
      command_context[zone].session = heartbeat.session;
      ASSERT_TRUE(encode(command, command_context[zone], port.frames[count++]).has_value());
    }
    ASSERT_TRUE(encode(HostStop{}, stop_context, port.frames[count++]).has_value());
    ASSERT_TRUE(encode(OperatorCommand{}, operator_context, port.frames[count++]).has_value());
    port.next = 0;
    electronics->tick(now_ms);
  }
  EXPECT_EQ(num_allocations - before, 0);
  EXPECT_EQ(electronics->automaton().mode(), MachineMode::kEnabled);
  EXPECT_GT(electronics->counters().commands_accepted, 0);
}

}  // namespace
}  // namespace wex::can
