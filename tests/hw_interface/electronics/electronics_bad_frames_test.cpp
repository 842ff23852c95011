#include <algorithm>

#include "hw_interface/electronics/electronics.hpp"
#include "hw_interface/socketcan/frame_fields.hpp"
#include "tests/hw_interface/electronics/electronics_bench.hpp"

// Frames that are damaged, misshapen or forged: not used, counted, and a fault where it says so.

namespace wex::can {
namespace {

constexpr int kLeftFront = 0, kHfe = 1;  // a zone and a place in it

class ElectronicsBadFramesTest : public ::testing::Test {
 protected:
  const ElectronicsCounters& counters() const { return bench_.electronics->counters(); }

  ElectronicsBench bench_;
};

TEST_F(ElectronicsBadFramesTest, CorruptedFramesAreDroppedAndTheFourthIsAFault) {
  bench_.enable();
  int to_corrupt = 3;
  bench_.on_the_wire = [&](CanFrame& frame) {
    if (kind_of(frame) == MessageKind::kZoneCommand && zone_of(frame) == 2 && to_corrupt-- > 0) {
      frame.data[9] ^= 0x10;
    }
    return true;
  };
  bench_.steps(20);
  EXPECT_EQ(counters().crc_errors, 3);
  EXPECT_EQ(bench_.mode(), MachineMode::kEnabled);
  to_corrupt = 1;
  bench_.steps(2);
  EXPECT_EQ(counters().crc_errors, 4);
  EXPECT_EQ(bench_.mode(), MachineMode::kFault);
  EXPECT_EQ(bench_.status.fault_bits, kFaultCrcErrors);
}

TEST_F(ElectronicsBadFramesTest, IntactCommandsOutsideTheDbcsRangeAreAFaultToo) {
  bench_.enable();
  // What no codec of ours would send: 3 rad/s for a hip, with a right CRC.
  bench_.on_the_wire = [&](CanFrame& frame) {
    if (kind_of(frame) != MessageKind::kZoneCommand || zone_of(frame) != kLeftFront) return true;
    constexpr std::int16_t kRaw = 30'000;
    frame.data[8] = kRaw & 0xFF;
    frame.data[9] = kRaw >> 8;
    const MessageRow* row = row_of(MessageKind::kZoneCommand, kLeftFront);
    const std::uint16_t crc = protection_crc(*row, frame.data.data(), bench_.status.session);
    frame.data[0] = static_cast<std::uint8_t>(crc & 0xFF);
    frame.data[1] = static_cast<std::uint8_t>(crc >> 8);
    return true;
  };
  bench_.steps(3);
  EXPECT_EQ(counters().limits[static_cast<std::size_t>(LimitVerdict::kRate)], 3);
  EXPECT_EQ(counters().crc_errors, 0);
  EXPECT_EQ(bench_.mode(), MachineMode::kFault);
  EXPECT_EQ(bench_.status.fault_bits, kFaultRangeRejects);
  EXPECT_EQ(counters().commands_rejected() - counters().not_enabled - counters().other_session, 3);
}

TEST_F(ElectronicsBadFramesTest, CorruptedOrRepeatedHeartbeatsAndOperatorFramesAreNotUsed) {
  const CanFrame heartbeat = bench_.frame_of(bench_.heartbeat, bench_.heartbeat_context);
  bench_.send_heartbeat = bench_.send_commands = false;
  bench_.step();
  ASSERT_EQ(bench_.mode(), MachineMode::kInit);
  CanFrame corrupted = heartbeat;
  corrupted.data[10] ^= 1;
  bench_.port.inbox.push_back(corrupted);
  bench_.step();
  EXPECT_EQ(bench_.mode(), MachineMode::kInit);
  EXPECT_EQ(counters().crc_errors, 1);
  for (int i = 0; i < 12; ++i) {
    bench_.port.inbox.push_back(heartbeat);  // the first is good, the others repeat it
    bench_.step();
  }
  EXPECT_EQ(bench_.mode(), MachineMode::kInit) << "a repetition does not keep the host alive";
  EXPECT_EQ(counters().sequence_errors, 11);

  CanFrame stop = bench_.frame_of(OperatorCommand{OperatorAction::kStop}, bench_.operator_context);
  stop.data[3] ^= 1;
  bench_.port.inbox.push_back(stop);
  bench_.step();
  EXPECT_NE(bench_.mode(), MachineMode::kEStop);
  EXPECT_EQ(counters().crc_errors, 2);
}

// T15: somebody else sends what only the machine may send.
TEST_F(ElectronicsBadFramesTest, ASecondSenderOfTheirOwnFramesIsAFault) {
  for (const std::uint32_t id : {0x010u, 0x100u, 0x105u, 0x180u, 0x188u, 0x200u, 0x303u}) {
    ElectronicsBench bench;
    bench.enable();
    bench.ramp(kLeftFront, kHfe, 0.1);
    const auto own = std::find_if(bench.last_sent.begin(), bench.last_sent.end(),
                                  [&](const CanFrame& frame) { return frame.id == id; });
    CanFrame forged;
    if (own != bench.last_sent.end()) forged = *own;
    forged.id = id;
    bench.port.inbox.push_back(forged);
    bench.step();
    EXPECT_EQ(bench.mode(), MachineMode::kFault) << id;
    EXPECT_EQ(bench.status.fault_bits, kFaultMasquerade);
    bench.steps(20);
    EXPECT_LT(bench.plant.fastest_rate(), 1e-6);
  }
}

TEST_F(ElectronicsBadFramesTest, ForgedErrorFramesNeitherEnableNorResume) {
  CanFrame forged;
  forged.id = 0x40;
  forged.error = true;
  forged.length = 8;
  bench_.steps(10);
  for (int i = 0; i < 50; ++i) {
    bench_.port.inbox.push_back(forged);
    bench_.step();
    ASSERT_EQ(bench_.mode(), MachineMode::kReady);
  }
  bench_.enable();
  bench_.send_commands = false;
  bench_.steps(8);
  ASSERT_EQ(bench_.mode(), MachineMode::kHold);
  for (int i = 0; i < 30; ++i) {
    bench_.port.inbox.push_back(forged);
    bench_.step();
    ASSERT_EQ(bench_.mode(), MachineMode::kHold);
  }
  EXPECT_EQ(counters().malformed, 80);
}

TEST_F(ElectronicsBadFramesTest, FramesOfAWrongShapeAreDroppedAndCounted) {
  bench_.enable();
  CanFrame good;
  bench_.on_the_wire = [&](CanFrame& frame) {
    if (kind_of(frame) == MessageKind::kHostHeartbeat) good = frame;
    return true;
  };
  bench_.steps(2);
  const long before = counters().malformed;
  CanFrame bad = good;
  bad.length = 12;
  bench_.port.inbox.push_back(bad);
  bad = good;
  bad.fd = false;
  bench_.port.inbox.push_back(bad);
  bad = good;
  bad.extended = true;
  bench_.port.inbox.push_back(bad);
  bad = good;
  bad.remote = true;
  bench_.port.inbox.push_back(bad);
  bad = good;
  bad.id = 0x555;
  bench_.port.inbox.push_back(bad);
  bench_.step();
  EXPECT_EQ(counters().malformed - before, 5);
  EXPECT_EQ(bench_.mode(), MachineMode::kEnabled);
}

}  // namespace
}  // namespace wex::can
