#include <gtest/gtest.h>

#include "hw_interface/socketcan/socketcan_machine.hpp"
#include "tests/support/host_bench.hpp"

// What is refused on opening and why, and a clock that must not be fooled by a busy program.

namespace wex::can {
namespace {

/// Reading takes time, in which the machine goes on sending.
class SlowPort final : public FramePort {
 public:
  SlowPort(HostBench& bench, double read_s) : bench_(bench), read_s_(read_s) {}
  SocketStatus send(const CanFrame& frame) noexcept override { return bench_.port.send(frame); }
  SocketStatus receive(CanFrame& frame) noexcept override {
    bench_.pipe.host().on_wait(read_s_);
    return bench_.port.receive(frame);
  }
  SocketStatus wait_readable(double timeout_s) noexcept override {
    return bench_.port.wait_readable(timeout_s);
  }
  SocketStatus reopen() noexcept override { return bench_.port.reopen(); }
  bool purge() noexcept override { return bench_.port.purge(); }
  std::uint32_t dropped() const noexcept override { return bench_.port.dropped(); }

 private:
  HostBench& bench_;
  double read_s_;
};

TEST(SocketCanMachineClock, FramesThatComeWhileALongQueueIsReadDoNotAgeTheFeedback) {
  HostBench bench(false);
  SlowPort port(bench, 50e-6);
  const auto opened = SocketCanMachine::open_on(port, bench.clock, bench_machine(), {0.0, 0.0});
  ASSERT_TRUE(opened) << opened.error().message;
  SocketCanMachine& host = **opened;
  for (int i = 0; i < 5000; ++i) bench.pipe.host().on_wait(1e-3);  // the program is busy
  EXPECT_LE(host.read().age_s, 0.021);
  const auto activated = host.activate();
  ASSERT_TRUE(activated) << activated.error().message;
  host.wait_until(host.read().t_s + 1.0);
  EXPECT_EQ(host.phase(), HostPhase::kActive);
  EXPECT_LE(host.statistics().max_feedback_age_s, 0.021);
}

TEST(SocketCanMachineOpen, SaysWhenNothingIsHeard) {
  HostBench bench(false);
  bench.far.set_frozen(true);
  const auto opened = SocketCanMachine::open_on(bench.port, bench.clock, bench_machine(), {0, 0});
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::kBadInput);
  EXPECT_NE(opened.error().message.find("no machine is heard"), std::string::npos);
}

TEST(SocketCanMachineOpen, SaysWhenTheBasePoseIsMissing) {
  HostBench bench(false);
  bench.plant.state().base_pose_valid = false;
  const auto opened = SocketCanMachine::open_on(bench.port, bench.clock, bench_machine(), {0, 0});
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().message.find("base pose"), std::string::npos) << opened.error().message;
}

TEST(SocketCanMachineOpen, RefusesAMachineOfAnotherBuild) {
  HostBench bench(false);
  // Every status says another hash; its CRC is right.
  class OtherBuild final : public FramePort {
   public:
    explicit OtherBuild(FramePort& inner) : inner_(inner) {}
    SocketStatus send(const CanFrame& frame) noexcept override { return inner_.send(frame); }
    SocketStatus receive(CanFrame& frame) noexcept override {
      const SocketStatus status = inner_.receive(frame);
      ZoneStatus zone_status;
      if (status == SocketStatus::kOk) {
        if (const auto meta = decode(frame, 0, zone_status)) {
          zone_status.dbc_hash ^= 1U;
          SendContext context{0, meta->counter};
          EXPECT_TRUE(encode(zone_status, context, frame));
        }
      }
      return status;
    }
    SocketStatus wait_readable(double s) noexcept override { return inner_.wait_readable(s); }
    SocketStatus reopen() noexcept override { return inner_.reopen(); }
    bool purge() noexcept override { return false; }
    std::uint32_t dropped() const noexcept override { return 0; }

   private:
    FramePort& inner_;
  } port(bench.pipe.host());
  const auto opened = SocketCanMachine::open_on(port, bench.clock, bench_machine(), {0, 0});
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().message.find("wex.dbc"), std::string::npos) << opened.error().message;
}

TEST(SocketCanMachineOpen, RefusesSettingsThatDoNotFitTheBus) {
  HostBench bench(false);
  SocketCanSettings settings;
  settings.host.command_valid_s = 0.3;
  EXPECT_FALSE(
      SocketCanMachine::open_on(bench.port, bench.clock, bench_machine(), {0, 0}, settings));
  settings = {};
  settings.host.period_s = 0.0;
  EXPECT_FALSE(
      SocketCanMachine::open_on(bench.port, bench.clock, bench_machine(), {0, 0}, settings));
}

TEST(SocketCanMachineOpen, AnInterfaceThatDoesNotExistIsNamedWithARemedy) {
  const auto opened = SocketCanMachine::open("nosuchcan0", bench_machine(), {0, 0});
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::kBadInput);
  EXPECT_NE(opened.error().message.find("tools/with_vcan"), std::string::npos)
      << opened.error().message;
}

}  // namespace
}  // namespace wex::can
