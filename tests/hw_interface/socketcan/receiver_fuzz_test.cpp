#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <random>

#include "hw_interface/socketcan/frame_fields.hpp"
#include "hw_interface/socketcan/protection.hpp"
#include "tests/hw_interface/electronics/electronics_bench.hpp"
#include "tests/support/host_bench.hpp"

// Random frames into both ends of the bus, a third of them with a CRC that is right: whatever they
// say, nothing crashes, nothing is enabled and nothing moves. WEX_FUZZ_FRAMES sets how many
// (default 1,000,000, half for either end).

namespace wex::can {
namespace {

long num_frames_for_an_end() {
  const char* wanted = std::getenv("WEX_FUZZ_FRAMES");
  return (wanted == nullptr ? 1'000'000 : std::atol(wanted)) / 2;
}

class RandomFrames {
 public:
  CanFrame next() {
    CanFrame frame;
    for (std::size_t i = 0; i < frame.data.size(); i += 8) {
      const std::uint64_t bits = random_();
      std::memcpy(&frame.data[i], &bits, 8);
    }
    const std::uint64_t dice = random_();
    const auto& row = generated::kMessages[(dice >> 8) % generated::kMessages.size()];
    frame.id = row.id;
    frame.length = row.length;
    frame.fd = true;
    if ((dice & 3) == 0) {  // any id, length and flags
      frame.id = static_cast<std::uint32_t>((dice & 4) != 0 ? dice >> 53 : dice >> 32);
      frame.length = static_cast<std::uint8_t>(dice >> 24);
      frame.fd = (dice & 8) != 0;
      frame.extended = (dice & 0x30) == 0;
      frame.remote = (dice & 0xC0) == 0;
      frame.error = (dice & 0x700) == 0;
    } else if ((dice & 4) != 0) {
      sign(frame);
    }
    return frame;
  }
  /// Bytes 0 and 1: CRC over the others, data id and session 0, as somebody who knows the DBC can.
  static void sign(CanFrame& frame) {
    const std::uint16_t data_id = static_cast<std::uint16_t>(0x5700 + frame.id);
    const std::array<std::uint8_t, 6> hidden{static_cast<std::uint8_t>(data_id),
                                             static_cast<std::uint8_t>(data_id >> 8)};
    const auto payload = std::span(frame.data).subspan(2, frame.length - std::size_t{2});
    const std::uint16_t crc = crc16(hidden, crc16(payload));
    frame.data[0] = static_cast<std::uint8_t>(crc);
    frame.data[1] = static_cast<std::uint8_t>(crc >> 8);
  }

 private:
  std::mt19937_64 random_{20240608};
};

TEST(RandomFramesWithARightCrc, GetBeyondTheCrc) {
  HostHeartbeat heartbeat;
  SendContext context;
  CanFrame frame;
  ASSERT_TRUE(encode(heartbeat, context, frame));
  frame.data[0] ^= 0x5A;
  EXPECT_FALSE(decode(frame, 0, heartbeat));
  RandomFrames::sign(frame);
  EXPECT_TRUE(decode(frame, 0, heartbeat));
}

TEST(FuzzedElectronics, AreNeitherEnabledNorMoved) {
  constexpr long kPerPeriod = 50;  // several times what a bus can carry
  ElectronicsBench bench;
  bench.steps(50);
  ASSERT_EQ(bench.mode(), MachineMode::kReady);
  bench.send_heartbeat = bench.send_commands = false;
  const long wanted = num_frames_for_an_end();
  const long frames_before = bench.electronics->counters().frames;
  const long used_before = bench.electronics->counters().commands_accepted +
                           bench.electronics->counters().commands_bumpless;
  RandomFrames random;
  int periods_enabled = 0;
  double fastest = 0.0;
  for (long i = 0; i < wanted; i += kPerPeriod) {
    for (long k = 0; k < kPerPeriod; ++k) bench.port.inbox.push_back(random.next());
    bench.step();
    periods_enabled +=
        bench.mode() == MachineMode::kEnabling || bench.mode() == MachineMode::kEnabled;
    fastest = std::max(fastest, bench.plant.fastest_rate());
  }
  const ElectronicsCounters& counters = bench.electronics->counters();
  const long used = counters.commands_accepted + counters.commands_bumpless - used_before;
  std::cout << wanted << " random frames into the electronics: " << counters.crc_errors
            << " wrong CRCs, " << counters.malformed << " malformed, commands used " << used
            << ", periods enabled " << periods_enabled << "\n";
  EXPECT_EQ(counters.frames - frames_before, wanted);
  EXPECT_GT(counters.crc_errors, wanted / 50);  // most ids are the machine's own
  EXPECT_GT(counters.malformed, wanted / 10);
  EXPECT_EQ(used, 0);
  EXPECT_EQ(periods_enabled, 0);
  EXPECT_EQ(fastest, 0.0);
}

/// Feeds the host while its cycle goes on.
struct HostFuzz {
  long active_cycles = 0, writes_taken = 0, not_finite = 0;

  void feed(HostBench& bench, RandomFrames& random, long frames) {
    constexpr long kPerCycle = 50;
    for (long i = 0; i < frames; i += kPerCycle) {
      for (long k = 0; k < kPerCycle; ++k) bench.pipe.machine().send(random.next());
      bench.wait_one();
      const MachineState state = bench.host->read();
      for (int j = 0; j < state.num_joints; ++j) not_finite += !std::isfinite(state.position[j]);
      active_cycles += bench.host->lifecycle() == Lifecycle::kActive;
      writes_taken += taken(bench.host->write(bench.drive_command(0.5)));
    }
  }
};

TEST(FuzzedHost, IsNeitherEnabledNorLedToSendMotion) {
  HostBench bench(false);
  bench.connect();
  RandomFrames random;
  HostFuzz fuzz;
  const long wanted = num_frames_for_an_end();
  fuzz.feed(bench, random, wanted);
  std::cout << wanted << " random frames into the host: " << bench.host->statistics().crc_errors
            << " wrong CRCs, cycles active " << fuzz.active_cycles << ", writes taken "
            << fuzz.writes_taken << "\n";
  EXPECT_GT(bench.host->statistics().crc_errors, wanted / 10);
  EXPECT_EQ(fuzz.active_cycles, 0);
  EXPECT_EQ(fuzz.writes_taken, 0);
  EXPECT_EQ(fuzz.not_finite, 0);
  EXPECT_NE(bench.far.mode(), MachineMode::kEnabled);
  EXPECT_EQ(bench.plant.fastest_rate(), 0.0);
}

TEST(FuzzedHost, WhileDrivingStopsAndStaysStopped) {
  HostBench bench(false);
  bench.drive();
  RandomFrames random;
  HostFuzz fuzz;
  fuzz.feed(bench, random, 50);  // more wrong CRCs than chance can explain
  EXPECT_NE(bench.host->lifecycle(), Lifecycle::kActive);
  EXPECT_GE(bench.time_to_stand(0.5), 0.0);
  fuzz = {};
  fuzz.feed(bench, random, 20'000);
  EXPECT_EQ(fuzz.active_cycles + fuzz.writes_taken + fuzz.not_finite, 0);
  EXPECT_LT(bench.plant.fastest_rate(), 0.02);
}

}  // namespace
}  // namespace wex::can
