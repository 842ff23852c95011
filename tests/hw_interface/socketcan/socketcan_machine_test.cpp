#include "hw_interface/socketcan/socketcan_machine.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/host_bench.hpp"

namespace wex::can {
namespace {

constexpr double kStandsWithin_s = 1.0;  ///< the wheels' ramp at three times their acceleration

/// Both rhythms: the machine's clock waits for the host, or runs beside it.
class SocketCanMachineTest : public ::testing::TestWithParam<bool> {
 protected:
  HostBench bench_{GetParam()};
  SocketCanMachine& host() { return *bench_.host; }
};

INSTANTIATE_TEST_SUITE_P(, SocketCanMachineTest, ::testing::Bool(),
                         [](const auto& info) { return info.param ? "InLockStep" : "InRealTime"; });

TEST_P(SocketCanMachineTest, EnablesDrivesAndStops) {
  bench_.drive();
  EXPECT_EQ(host().lock_step(), GetParam());
  EXPECT_EQ(host().lifecycle(), Lifecycle::kActive);
  EXPECT_EQ(host().health().level, HealthLevel::kOk);
  EXPECT_EQ(host().health().holds, 0);
  EXPECT_FALSE(host().health().degraded);
  host().stop();
  EXPECT_GE(bench_.time_to_stand(kStandsWithin_s), 0.0);
  EXPECT_EQ(bench_.far.mode(), MachineMode::kHold);
  EXPECT_EQ(host().lifecycle(), Lifecycle::kActive);
  EXPECT_EQ(host().health().level, HealthLevel::kHolding);
  EXPECT_EQ(host().health().holds, 0) << "asked for";
}

TEST_P(SocketCanMachineTest, WritesBeforeActivationAreRejected) {
  bench_.connect();
  EXPECT_EQ(host().lifecycle(), Lifecycle::kInactive);
  EXPECT_EQ(host().write(bench_.drive_command(0.8)), WriteOutcome::kRejectedNotActive);
  bench_.wait(1.0);
  EXPECT_EQ(bench_.plant.fastest_rate(), 0.0);
  EXPECT_NE(bench_.far.mode(), MachineMode::kEnabled) << "nobody has asked for it";
  EXPECT_EQ(host().statistics().of(MessageKind::kZoneCommand).sent, 0);
}

TEST_P(SocketCanMachineTest, ActivationDoesNotMoveTheMachine) {
  bench_.connect();
  double fastest = 0.0;
  bench_.far.on_tick = [&] { fastest = std::max(fastest, bench_.plant.fastest_rate()); };
  ASSERT_TRUE(host().activate());
  bench_.wait(1.0);
  EXPECT_EQ(fastest, 0.0);
}

TEST_P(SocketCanMachineTest, DeactivationStopsTheMachineThenEndsTheSession) {
  bench_.drive();
  host().deactivate();
  EXPECT_EQ(host().lifecycle(), Lifecycle::kInactive);
  EXPECT_LT(bench_.plant.fastest_rate(), 0.05);
  EXPECT_EQ(bench_.far.electronics().automaton().session(), 0U);
  EXPECT_EQ(host().write(bench_.drive_command(0.8)), WriteOutcome::kRejectedNotActive);
  const auto again = host().activate();
  ASSERT_TRUE(again) << again.error().message;
  bench_.wait(0.5);
  EXPECT_LT(bench_.plant.fastest_rate(), 0.02) << "the command of before must not come back";
  EXPECT_EQ(host().write(bench_.drive_command(0.8)), WriteOutcome::kAccepted);
}

TEST_P(SocketCanMachineTest, AStopBeforeActivationComesFirst) {
  bench_.connect();
  host().stop();
  const auto refused = host().activate();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kStoppedSafely);
  host().release();
  EXPECT_TRUE(host().activate());
}

TEST_P(SocketCanMachineTest, StopIsOnTheBusAtOnceThreeTimesThenAt100Hz) {
  bench_.drive();
  const long before = host().statistics().of(MessageKind::kHostStop).sent;
  EXPECT_EQ(before, 0);
  host().stop();
  EXPECT_EQ(host().statistics().of(MessageKind::kHostStop).sent, 3);
  bench_.wait(0.5);
  EXPECT_NEAR(static_cast<double>(host().statistics().of(MessageKind::kHostStop).sent), 53.0, 2.0);
  host().release();
  bench_.wait(0.5);
  EXPECT_EQ(bench_.far.mode(), MachineMode::kEnabled);
  EXPECT_EQ(host().write(bench_.drive_command(0.8)), WriteOutcome::kAccepted);
}

TEST_P(SocketCanMachineTest, AnEStopStopsTheCommandsIsLatchedAndLeftByAPersonOnly) {
  bench_.drive();
  const long sent = host().statistics().of(MessageKind::kZoneCommand).sent;
  bench_.far.electronics().set_estop_chain(true);
  bench_.wait(0.03);
  EXPECT_LE(host().statistics().of(MessageKind::kZoneCommand).sent - sent, 2 * kNumZones)
      << "commands end within 20 ms";
  EXPECT_EQ(host().lifecycle(), Lifecycle::kEStop);
  EXPECT_EQ(host().health().level, HealthLevel::kFault);
  EXPECT_EQ(host().write(bench_.drive_command(0.8)), WriteOutcome::kRejectedNotActive);
  EXPECT_GE(bench_.time_to_stand(kStandsWithin_s), 0.0);
  bench_.operator_resets();
  EXPECT_EQ(host().lifecycle(), Lifecycle::kEStop) << "the chain is still open";
  bench_.far.electronics().set_estop_chain(false);
  bench_.wait(2.0);
  EXPECT_EQ(host().lifecycle(), Lifecycle::kEStop) << "nobody has reset";
  EXPECT_FALSE(host().activate());
  host().release();
  bench_.operator_does(OperatorAction::kReset);
  bench_.wait(0.1);
  EXPECT_EQ(host().lifecycle(), Lifecycle::kEStop) << "a level is no edge";
  bench_.operator_resets();
  bench_.wait(0.2);
  EXPECT_EQ(host().lifecycle(), Lifecycle::kInactive);
  bench_.wait(1.0);
  EXPECT_LT(bench_.plant.fastest_rate(), 1e-3) << "and nothing resumes by itself";
  EXPECT_TRUE(host().activate());
}

// T13: at random phase.
TEST_P(SocketCanMachineTest, EStopsAtRandomPhaseAllLatch) {
  bench_.activate();
  std::mt19937 random(13);
  for (int i = 0; i < 40; ++i) {
    ASSERT_TRUE(taken(host().write(bench_.drive_command(0.5))));
    bench_.wait(0.01 * static_cast<double>(random() % 40));
    bench_.far.electronics().set_estop_chain(true);
    bench_.wait(0.03);
    ASSERT_EQ(host().lifecycle(), Lifecycle::kEStop) << i;
    bench_.far.electronics().set_estop_chain(false);
    bench_.wait(0.7);
    ASSERT_EQ(host().lifecycle(), Lifecycle::kEStop) << i;
    ASSERT_LT(bench_.plant.fastest_rate(), 0.02);
    bench_.operator_resets();
    bench_.wait(0.05);
    const auto again = host().activate();
    ASSERT_TRUE(again) << i << ": " << again.error().message;
  }
}

TEST_P(SocketCanMachineTest, AnOperatorsStopAtTheTerminalIsFollowed) {
  bench_.drive();
  bench_.operator_does(OperatorAction::kStop);
  bench_.wait(0.1);
  EXPECT_EQ(host().lifecycle(), Lifecycle::kEStop) << "the machine latches it as an e-stop";
  EXPECT_GE(bench_.time_to_stand(kStandsWithin_s), 0.0);
}

TEST_P(SocketCanMachineTest, WithoutCommandsTheMachineHoldsAndTheHostGoesOnWithNeutralOnes) {
  bench_.drive();
  bench_.port.set_sending({.loss = 1.0});
  bench_.wait(0.1);
  bench_.port.set_sending({});
  EXPECT_EQ(bench_.far.mode(), MachineMode::kHold);
  bench_.wait(0.3);
  EXPECT_EQ(bench_.far.mode(), MachineMode::kEnabled) << "ten neutral commands later";
  EXPECT_EQ(host().lifecycle(), Lifecycle::kActive);
  EXPECT_EQ(host().health().holds, 1);
  EXPECT_GE(bench_.time_to_stand(kStandsWithin_s), 0.0) << "the old command is forgotten";
}

// T17 at the planner's end.
TEST_P(SocketCanMachineTest, AFrozenJointIsShownStaleThenHoldsThenFaults) {
  bench_.drive();
  const int dipper = bench_machine().coordinate("DIPPER").value() - kNumBaseCoordinates;
  bench_.port.freeze_joint(slot_of("DIPPER"));
  double stale_after_s = -1.0, hold_after_s = -1.0, fault_after_s = -1.0;
  const double begin_s = 1e-3 * static_cast<double>(bench_.far.now_ms());
  for (int i = 0; i < 40; ++i) {
    bench_.wait_one();
    const double now_s = 1e-3 * static_cast<double>(bench_.far.now_ms()) - begin_s;
    const MachineState state = host().read();
    if (stale_after_s < 0.0 && state.joint_quality[dipper] == SignalQuality::kStale) {
      stale_after_s = now_s;
    }
    if (hold_after_s < 0.0 && host().phase() == HostPhase::kHold) hold_after_s = now_s;
    if (fault_after_s < 0.0 && host().lifecycle() == Lifecycle::kFault) fault_after_s = now_s;
    EXPECT_EQ(state.joint_quality[bench_.wheel(0)], SignalQuality::kOk);
  }
  EXPECT_NEAR(stale_after_s, 0.03, 0.0101);
  EXPECT_NEAR(hold_after_s, 0.05, 0.0151);
  EXPECT_NEAR(fault_after_s, 0.2, 0.0151);
  EXPECT_EQ(host().cause(), HostCause::kLostFeedback);
  EXPECT_EQ(host().write(bench_.drive_command(0.8)), WriteOutcome::kRejectedNotActive);
}

TEST_P(SocketCanMachineTest, AShortSilenceOfAJointHoldsAndTheSessionGoesOn) {
  bench_.drive();
  bench_.port.freeze_joint(slot_of("DIPPER"));
  bench_.wait(0.08);
  EXPECT_EQ(host().phase(), HostPhase::kHold);
  EXPECT_EQ(host().write(bench_.drive_command(0.8)), WriteOutcome::kRejectedStale);
  bench_.port.freeze_joint(std::nullopt);
  bench_.wait(0.4);
  EXPECT_EQ(host().phase(), HostPhase::kActive);
  EXPECT_EQ(host().write(bench_.drive_command(0.8)), WriteOutcome::kAccepted);
}

TEST_P(SocketCanMachineTest, ASecondSenderOfOurFramesIsAFault) {
  bench_.drive();
  SendContext context{0, 99};
  CanFrame forged;
  ASSERT_TRUE(encode(ZoneCommand{}, context, forged));
  bench_.pipe.machine().send(forged);
  bench_.wait(0.02);
  EXPECT_EQ(host().lifecycle(), Lifecycle::kFault);
  EXPECT_EQ(host().cause(), HostCause::kMasquerade);
  EXPECT_EQ(host().statistics().own_ids, 1);
  EXPECT_GE(bench_.time_to_stand(kStandsWithin_s), 0.0);
  EXPECT_EQ(bench_.far.electronics().automaton().session(), 0U) << "the machine was told";
  bench_.operator_resets();
  bench_.wait(0.2);
  EXPECT_EQ(host().lifecycle(), Lifecycle::kInactive);
}

TEST_P(SocketCanMachineTest, AForgedBusOffAloneChangesNothing) {
  bench_.drive();
  CanFrame forged;
  forged.id = 0x40;
  forged.error = true;
  forged.length = 8;
  bench_.pipe.machine().send(forged);
  bench_.wait(0.5);
  EXPECT_EQ(host().phase(), HostPhase::kActive);
  EXPECT_TRUE(host().health().degraded) << "but it is told";
  EXPECT_EQ(host().statistics().error_frames, 1);
  bench_.wait(GetParam() ? 60.0 : 1.0);  // a second of wall time
  EXPECT_FALSE(host().health().degraded);
}

TEST_P(SocketCanMachineTest, AForgedSessionOrModeEnablesNothing) {
  bench_.connect();
  bench_.wait(0.1);
  SendContext context;
  for (int i = 0; i < 20; ++i) {
    for (int zone = 0; zone < kNumZones; ++zone) {
      ZoneStatus forged;
      forged.zone = zone;
      forged.mode = MachineMode::kEnabled;
      forged.session = 0xBAD;
      forged.dbc_hash = dbc_hash();
      context.counter = static_cast<std::uint8_t>(200 + i);
      CanFrame frame;
      ASSERT_TRUE(encode(forged, context, frame));
      bench_.pipe.machine().send(frame);
    }
    bench_.wait_one();
    EXPECT_NE(host().lifecycle(), Lifecycle::kActive);
  }
  EXPECT_EQ(host().statistics().of(MessageKind::kZoneCommand).sent, 0);
}

TEST_P(SocketCanMachineTest, AMachineThatIsSwitchedOffIsAFaultAndNothingHangs) {
  bench_.drive();
  bench_.far.set_frozen(true);
  const std::int64_t begin_ns = bench_.clock.time_ns;
  for (int i = 0; i < 100; ++i) bench_.wait_one();
  EXPECT_LT(1e-9 * static_cast<double>(bench_.clock.time_ns - begin_ns), 4.0);
  EXPECT_EQ(host().lifecycle(), Lifecycle::kFault);
  EXPECT_GT(host().read().age_s, 0.2);
  EXPECT_FALSE(host().activate());
}

TEST_P(SocketCanMachineTest, TheProgramsPauseMakesTheMachineHoldNotTheOldCommandGoOn) {
  if (GetParam()) return;  // in lock step the machine's clock waits for the program
  bench_.drive();
  // As a program that hangs: the machine lives on, the host sends nothing.
  for (int i = 0; i < 20; ++i) bench_.pipe.host().on_wait(0.01);
  EXPECT_EQ(bench_.far.mode(), MachineMode::kHold);
  bench_.wait(0.3);
  EXPECT_EQ(host().lifecycle(), Lifecycle::kActive);
  EXPECT_GE(bench_.time_to_stand(kStandsWithin_s), 0.0);
  EXPECT_EQ(host().write(bench_.drive_command(0.8)), WriteOutcome::kAccepted);
}

// T9: what the bus took during a stall goes out afterwards and moves nothing.
TEST_P(SocketCanMachineTest, AStallHoldsAndItsOldFramesAreRefused) {
  bench_.drive();
  bench_.port.set_stalled(true);
  // In lock step time stands with the bus at first, until the machine runs free.
  bench_.wait(0.08);
  EXPECT_EQ(host().phase(), HostPhase::kHold);
  EXPECT_EQ(host().cause(), HostCause::kBusStalled);
  EXPECT_EQ(host().write(bench_.drive_command(0.8)), WriteOutcome::kBusStalled);
  EXPECT_EQ(host().statistics().stalls, 1);
  bench_.wait(2.0);
  EXPECT_EQ(bench_.far.mode(), MachineMode::kFault) << "no heartbeat for 500 ms";
  EXPECT_LT(bench_.plant.fastest_rate(), 0.02);
  const auto& counters = bench_.far.electronics().counters();
  const long accepted = counters.commands_accepted;
  double fastest = 0.0;
  bench_.far.on_tick = [&] { fastest = std::max(fastest, bench_.plant.fastest_rate()); };
  bench_.port.set_stalled(false);
  bench_.wait(1.0);
  EXPECT_LE(bench_.port.counters().replayed_after_stall, 5);
  EXPECT_EQ(counters.commands_accepted, accepted) << "none of the old ones";
  EXPECT_LT(fastest, 0.02);
  EXPECT_NE(host().lifecycle(), Lifecycle::kActive) << "no resume";
}

TEST_P(SocketCanMachineTest, AShortStallHoldsAndTheSessionGoesOn) {
  if (GetParam()) return;  // in lock step a short stall only makes time stand
  bench_.drive();
  bench_.port.set_stalled(true);
  bench_.wait(0.06);
  EXPECT_EQ(host().cause(), HostCause::kBusStalled);
  bench_.port.set_stalled(false);
  bench_.wait(0.5);
  EXPECT_EQ(host().phase(), HostPhase::kActive);
  EXPECT_GE(bench_.time_to_stand(kStandsWithin_s), 0.0);
}

TEST_P(SocketCanMachineTest, APurgeEmptiesTheSendQueueOfAStalledBus) {
  if (GetParam()) return;
  bench_.drive();
  bench_.port.set_purge_possible(true);
  bench_.port.set_stalled(true);
  bench_.wait(0.5);
  EXPECT_GE(host().statistics().purges, 1);
  bench_.wait(8.0);
  EXPECT_LE(host().statistics().purges, 5) << "once per second, five times at most";
}

TEST_P(SocketCanMachineTest, AnInterfaceThatGoesDownOrAwayIsAFaultAndIsReopened) {
  if (GetParam()) return;  // lock step is lost with the bus; see the stall
  for (const auto state : {FaultyPort::Interface::kDown, FaultyPort::Interface::kGone}) {
    HostBench bench(false);
    bench.drive();
    bench.port.set_interface(state);
    bench.wait(0.05);
    EXPECT_EQ(bench.host->lifecycle(), Lifecycle::kFault);
    EXPECT_EQ(bench.host->cause(), HostCause::kInterfaceLost);
    bench.wait(10.0);
    EXPECT_LT(bench.plant.fastest_rate(), 0.02);
    bench.port.set_interface(FaultyPort::Interface::kUp);
    bench.wait(2.1);
    EXPECT_GE(bench.host->statistics().reopens, 1);
    EXPECT_GE(bench.port.reopens(), 1);
    EXPECT_LT(bench.host->read().age_s, 0.05) << "it hears again";
    EXPECT_EQ(bench.host->lifecycle(), Lifecycle::kFault) << "and stays in its fault";
    bench.operator_resets();
    bench.wait(0.3);
    const auto again = bench.host->activate();
    ASSERT_TRUE(again) << again.error().message;
  }
}

TEST_P(SocketCanMachineTest, LostReceivedFramesDegradeAndTwiceInASecondHold) {
  bench_.drive();
  bench_.port.add_dropped(3);
  bench_.wait(0.05);
  EXPECT_TRUE(host().health().degraded);
  EXPECT_EQ(host().phase(), HostPhase::kActive);
  bench_.port.add_dropped(3);
  bench_.wait(0.05);
  EXPECT_EQ(host().phase(), HostPhase::kHold);
  EXPECT_EQ(host().cause(), HostCause::kReceiveOverflow);
  EXPECT_EQ(host().statistics().receive_overflows, 6);
}

TEST_P(SocketCanMachineTest, LossUpToFivePercentIsNoFault) {
  bench_.activate();
  bench_.port.set_sending({.loss = 0.05});
  bench_.port.set_receiving({.loss = 0.05});
  long accepted = 0, written = 0;
  for (int i = 0; i < 3000; ++i) {
    ++written;
    if (taken(host().write(bench_.drive_command(0.5, 0.2)))) ++accepted;
    bench_.wait_one();
    ASSERT_NE(host().lifecycle(), Lifecycle::kFault)
        << describe(host().cause()) << ", bits "
        << bench_.far.electronics().automaton().fault_bits();
  }
  EXPECT_GT(accepted, written * 8 / 10);
  EXPECT_GT(host().statistics().frames_lost(), 1000);
  RecordProperty("holds", std::to_string(host().statistics().holds));
}

TEST_P(SocketCanMachineTest, AlteredFramesAreNeverUsed) {
  bench_.drive();
  bench_.port.set_receiving({.corrupt = 0.2});
  for (int i = 0; i < 200; ++i) {
    bench_.wait_one();
    const MachineState state = host().read();
    for (int joint = 0; joint < state.num_joints; ++joint) {
      ASSERT_LT(std::abs(state.rate[joint]), 1.0);
    }
  }
  EXPECT_GT(bench_.port.counters().corrupted, 100);
  EXPECT_GT(host().statistics().crc_errors, 100);
  EXPECT_EQ(host().lifecycle(), Lifecycle::kFault) << "more than three within a second";
  EXPECT_EQ(host().cause(), HostCause::kCrcErrors);
}

TEST_P(SocketCanMachineTest, DuplicatesAndReorderAreHarmless) {
  bench_.drive();
  bench_.port.set_receiving({.duplicate = 0.05, .reorder = 0.002});
  bench_.port.set_sending({.duplicate = 0.05});
  bench_.wait(5.0);
  EXPECT_NE(host().lifecycle(), Lifecycle::kFault);
  EXPECT_GT(host().statistics().repeated, 50);
}

TEST_P(SocketCanMachineTest, ClockJumpsOfTheMachineEndTheSession) {
  bench_.drive();
  SendContext context = {0, 7};
  BasePose far_away;
  far_away.sample_time_ms = static_cast<std::uint32_t>(bench_.far.now_ms() - 3'600'000);
  CanFrame frame;
  ASSERT_TRUE(encode(far_away, context, frame));
  const double before_s = host().read().t_s;
  bench_.pipe.machine().send(frame);
  bench_.wait(GetParam() ? 4.0 : 0.3);  // lock step is lost with the clock, after two seconds
  EXPECT_NE(host().lifecycle(), Lifecycle::kActive);
  EXPECT_GT(host().read().t_s, before_s) << "the host's time goes on";
  EXPECT_LT(host().read().t_s, before_s + 10.0);
}

TEST_P(SocketCanMachineTest, CountsWhatIsOnTheBus) {
  bench_.drive();
  bench_.wait(10.0);
  const BusStatistics& s = host().statistics();
  const double seconds = static_cast<double>(s.of(MessageKind::kZoneFeedback).received) / 600.0;
  EXPECT_NEAR(static_cast<double>(s.of(MessageKind::kHostHeartbeat).sent), 50.0 * seconds, 60.0);
  EXPECT_NEAR(static_cast<double>(s.of(MessageKind::kZonePressure).received), 300.0 * seconds,
              30.0);
  EXPECT_GT(s.of(MessageKind::kZoneStatus).received, 0);
  EXPECT_EQ(s.frames_lost(), 0);
  EXPECT_EQ(s.crc_errors + s.malformed + s.unknown + s.repeated + s.wrong_sequence, 0);
  EXPECT_EQ(s.holds + s.faults + s.stalls + s.reopens + s.not_taken, 0);
  EXPECT_EQ(s.refused_by_codec, 0);
  EXPECT_LE(s.max_feedback_age_s, 0.0201);
  EXPECT_GT(s.command_to_report.count(), 100);
  if (!GetParam()) {  // the pipe's clock is only real in real time
    EXPECT_GT(s.bus_load, 0.2);
    EXPECT_LT(s.bus_load, 0.6);
    EXPECT_LE(s.command_to_report.percentile_ms(0.99), 50.0);
  }
  RecordProperty("bus_load", std::to_string(s.bus_load));
}

}  // namespace
}  // namespace wex::can
