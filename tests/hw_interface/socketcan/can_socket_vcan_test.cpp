#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "hw_interface/socketcan/can_socket.hpp"
#include "hw_interface/socketcan/socketcan_machine.hpp"
#include "models/excavator/machine_model.hpp"

// On a real kernel's CAN, as root (tools/with_vcan --faults).

namespace wex::can {
namespace {

constexpr double kSoon_s = 0.5;

void run(const std::string& command) {
  ASSERT_EQ(std::system(command.c_str()), 0) << command;  // NOLINT(cert-env33-c)
}
void create(const std::string& name, int mtu = 72) {
  run("ip link add dev " + name + " type vcan");
  run("ip link set " + name + " mtu " + std::to_string(mtu));
  run("ip link set " + name + " up");
}

CanSocket open(const std::string& name) {
  auto socket = CanSocket::open(name);
  EXPECT_TRUE(socket) << socket.error().message;
  return std::move(*socket);
}

CanFrame frame_of(std::uint32_t id, std::uint8_t length = 64) {
  CanFrame frame;
  frame.id = id;
  frame.fd = true;
  frame.length = length;
  for (int i = 0; i < length; ++i) frame.data[i] = static_cast<std::uint8_t>(3 * i + 1);
  return frame;
}

SocketStatus receive_soon(CanSocket& socket, CanFrame& frame) {
  const SocketStatus status = socket.receive(frame);
  if (status != SocketStatus::kWouldBlock) return status;
  socket.wait_readable(kSoon_s);
  return socket.receive(frame);
}

class CanSocketOnVcan : public ::testing::Test {
 protected:
  void SetUp() override { create(kName); }
  void TearDown() override {
    std::system("ip link del wexcan0 2>/dev/null");  // NOLINT: a test may have deleted it
  }
  static constexpr const char* kName = "wexcan0";
  CanFrame heard_;
};

TEST_F(CanSocketOnVcan, FramesCrossTheBusAsTheyWere) {
  CanSocket a = open(kName), b = open(kName);
  EXPECT_TRUE(a.takes_fd_frames());
  EXPECT_EQ(a.interface_name(), kName);
  CanFrame classic = frame_of(0x123, 8);
  classic.fd = false;
  for (const CanFrame& sent : {frame_of(0x123), frame_of(0x7FF, 0), frame_of(0, 24), classic}) {
    EXPECT_EQ(a.send(sent), SocketStatus::kOk);
    ASSERT_EQ(receive_soon(b, heard_), SocketStatus::kOk);
    EXPECT_EQ(heard_.id, sent.id);
    EXPECT_EQ(heard_.length, sent.length);
    EXPECT_EQ(heard_.data, sent.data);
    EXPECT_EQ(heard_.fd, sent.fd);
    EXPECT_FALSE(heard_.extended || heard_.remote || heard_.error);
    EXPECT_GT(heard_.kernel_time_ns, 1'000'000'000'000'000'000) << "stamped by the kernel";
  }
  EXPECT_EQ(b.receive(heard_), SocketStatus::kWouldBlock);
}

TEST_F(CanSocketOnVcan, ItsOwnFramesAreNotHeard) {
  CanSocket a = open(kName);
  EXPECT_EQ(a.send(frame_of(0x80)), SocketStatus::kOk);
  EXPECT_EQ(receive_soon(a, heard_), SocketStatus::kWouldBlock);
}

TEST_F(CanSocketOnVcan, TwentyNineBitAndRemoteFramesAreFilteredByTheKernel) {
  CanSocket a = open(kName), b = open(kName);
  CanFrame extended = frame_of(0x80), remote = frame_of(0x80, 0);
  extended.extended = true;
  remote.fd = false;
  remote.remote = true;
  EXPECT_EQ(a.send(extended), SocketStatus::kOk);
  EXPECT_EQ(a.send(remote), SocketStatus::kOk);
  EXPECT_EQ(a.send(frame_of(0x81)), SocketStatus::kOk);
  ASSERT_EQ(receive_soon(b, heard_), SocketStatus::kOk);
  EXPECT_EQ(heard_.id, 0x81U) << "the only one that gets through";
}

TEST_F(CanSocketOnVcan, ErrorFramesAreHeardButForLostArbitration) {
  CanSocket a = open(kName), b = open(kName);
  CanFrame error = frame_of(0x002, 8);  // lost arbitration: everyday life
  error.fd = false;
  error.error = true;
  EXPECT_EQ(a.send(error), SocketStatus::kOk);
  error.id = 0x040;
  EXPECT_EQ(a.send(error), SocketStatus::kOk);
  ASSERT_EQ(receive_soon(b, heard_), SocketStatus::kOk);
  EXPECT_TRUE(heard_.error);
  EXPECT_EQ(heard_.id, 0x040U);
}

TEST_F(CanSocketOnVcan, TheReceiveBufferHoldsSecondsAndTellsWhatItLost) {
  CanSocket a = open(kName), b = open(kName);
  constexpr int kTwoSeconds = 3000, kTooMany = 30'000;
  for (int i = 0; i < kTwoSeconds; ++i) ASSERT_EQ(a.send(frame_of(0x100)), SocketStatus::kOk);
  int count = 0;
  while (b.receive(heard_) == SocketStatus::kOk) ++count;
  EXPECT_EQ(count, kTwoSeconds);
  EXPECT_EQ(b.dropped(), 0U);
  for (int i = 0; i < kTooMany; ++i) a.send(frame_of(0x100));
  for (count = 0; b.receive(heard_) == SocketStatus::kOk;) ++count;
  a.send(frame_of(0x101));
  ASSERT_EQ(receive_soon(b, heard_), SocketStatus::kOk);
  EXPECT_EQ(static_cast<int>(b.dropped()), kTooMany - count) << "told with the next frame";
  ASSERT_EQ(b.reopen(), SocketStatus::kOk);
  EXPECT_EQ(static_cast<int>(b.dropped()), kTooMany - count) << "the count goes on";
}

TEST_F(CanSocketOnVcan, ALinkThatGoesDownAndUpIsUsedAgain) {
  CanSocket a = open(kName), b = open(kName);
  run("ip link set wexcan0 down");
  EXPECT_EQ(a.send(frame_of(1)), SocketStatus::kInterfaceDown);
  EXPECT_EQ(b.receive(heard_), SocketStatus::kInterfaceDown) << "told once";
  EXPECT_EQ(b.receive(heard_), SocketStatus::kWouldBlock);
  run("ip link set wexcan0 up");
  EXPECT_EQ(a.send(frame_of(2)), SocketStatus::kOk);
  ASSERT_EQ(receive_soon(b, heard_), SocketStatus::kOk);
  EXPECT_EQ(heard_.id, 2U);
  run("ip link set wexcan0 down");
  run("ip link set wexcan0 up");
  EXPECT_EQ(a.send(frame_of(3)), SocketStatus::kOk) << "the past is not reported as the present";
}

TEST_F(CanSocketOnVcan, ADeletedInterfaceIsGoneUntilItIsThereAgainAndReopened) {
  CanSocket a = open(kName);
  run("ip link del wexcan0");
  EXPECT_EQ(a.send(frame_of(1)), SocketStatus::kGone);
  EXPECT_EQ(a.reopen(), SocketStatus::kGone);
  EXPECT_EQ(a.send(frame_of(1)), SocketStatus::kGone);
  EXPECT_EQ(a.receive(heard_), SocketStatus::kGone);
  EXPECT_EQ(a.wait_readable(0.01), SocketStatus::kWouldBlock) << "waits, does not spin";
  EXPECT_FALSE(a.purge());
  create(kName);
  ASSERT_EQ(a.reopen(), SocketStatus::kOk);
  CanSocket b = open(kName);
  EXPECT_EQ(a.send(frame_of(2)), SocketStatus::kOk);
  EXPECT_EQ(receive_soon(b, heard_), SocketStatus::kOk);
}

TEST_F(CanSocketOnVcan, AReceiverLearnsOfADeletedInterfaceThatASenderWasToldOfFirst) {
  CanSocket a = open(kName);
  run("ip link del wexcan0");
  EXPECT_EQ(a.send(frame_of(1)), SocketStatus::kGone);
  create(kName);
  EXPECT_EQ(a.receive(heard_), SocketStatus::kGone) << "the old socket stays deaf";
  ASSERT_EQ(a.reopen(), SocketStatus::kOk);
  EXPECT_EQ(a.receive(heard_), SocketStatus::kWouldBlock);
}

TEST_F(CanSocketOnVcan, APurgeTakesTheLinkDownAndUp) {
  CanSocket a = open(kName), b = open(kName);
  EXPECT_TRUE(a.purge());
  EXPECT_EQ(b.receive(heard_), SocketStatus::kInterfaceDown) << "others on the link see it";
  EXPECT_EQ(a.send(frame_of(4)), SocketStatus::kOk) << "and it is up again";
}

TEST_F(CanSocketOnVcan, ReopeningManyTimesLeaksNoDescriptor) {
  CanSocket a = open(kName);
  for (int i = 0; i < 1100; ++i) ASSERT_EQ(a.reopen(), SocketStatus::kOk) << i;
}

TEST_F(CanSocketOnVcan, MovingASocketKeepsItOpen) {
  CanSocket a = open(kName);
  CanSocket b = std::move(a);
  CanSocket c = open(kName);
  c = std::move(b);
  EXPECT_EQ(c.send(frame_of(5)), SocketStatus::kOk);
}

TEST_F(CanSocketOnVcan, AnInterfaceForClassicCanIsRefusedForTheMachineWithTheRemedy) {
  run("ip link set wexcan0 down");
  run("ip link set wexcan0 mtu 16");
  run("ip link set wexcan0 up");
  EXPECT_FALSE(open(kName).takes_fd_frames());
  const auto machine = SocketCanMachine::open(kName, load_machine().value(), {0.0, 0.0});
  ASSERT_FALSE(machine);
  EXPECT_NE(machine.error().message.find("fd on"), std::string::npos) << machine.error().message;
}

TEST_F(CanSocketOnVcan, AMissingInterfaceIsNamed) {
  const auto socket = CanSocket::open("nosuchcan0");
  ASSERT_FALSE(socket);
  EXPECT_NE(socket.error().message.find("'nosuchcan0'"), std::string::npos);
  EXPECT_FALSE(CanSocket::open("a_name_that_is_far_too_long_for_an_interface"));
}

}  // namespace
}  // namespace wex::can
