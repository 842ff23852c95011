#include <cmath>
#include <cstdio>

#include "tests/support/host_bench.hpp"

// T6 without a bus: how often random loss of frames makes either side hold. A side holds when 50 ms
// pass without one of the frames it needs, so only five losses in a row of one sender do it.

namespace wex::can {
namespace {

constexpr double kInARow = 5.0;

struct Outcome {
  double enabled_s = 0.0;
  long holds = 0;
  bool faulted = false;
};

/// Drives on through `duration_s`; each frame of a direction is lost with its probability.
Outcome drive_through(double loss_sending, double loss_receiving, double duration_s) {
  HostBench bench(true, 6);
  bench.drive();
  bench.port.set_sending({.loss = loss_sending});
  bench.port.set_receiving({.loss = loss_receiving});
  Outcome outcome;
  HostPhase before = bench.host->phase();
  for (int i = 0; i < static_cast<int>(duration_s / 0.01); ++i) {
    if (bench.host->health().level != HealthLevel::kOk) {
      (void)bench.host->write(bench.drive_command(0.8));
    }
    bench.wait_one();
    const HostPhase phase = bench.host->phase();
    if (phase == HostPhase::kActive) outcome.enabled_s += 0.01;
    if (phase == HostPhase::kHold && before == HostPhase::kActive) ++outcome.holds;
    before = phase;
  }
  outcome.faulted = bench.host->lifecycle() != Lifecycle::kActive;
  return outcome;
}

struct Case {
  const char* name;
  double loss_sending, loss_receiving, duration_s;
  /// Frames per second of the streams that have a time-out of five periods: to the machine 6 x 100
  /// commands, 50 heartbeats; to the host 6 x 100 feedback, 100 base pose, 6 x 20 status.
  double frames_per_s;
};

class FrameLossTest : public ::testing::TestWithParam<Case> {};

TEST_P(FrameLossTest, HoldsComeAsOftenAsFiveLossesInARow) {
  const Case& which = GetParam();
  const double p = std::max(which.loss_sending, which.loss_receiving);
  const Outcome outcome = drive_through(which.loss_sending, which.loss_receiving, which.duration_s);
  const double expected = which.frames_per_s * std::pow(p, kInARow) * (1.0 - p) * outcome.enabled_s;
  std::printf("T6 (simulated): %s, %.0f %% lost: %ld holds in %.0f s enabled, %.1f by p^5\n",
              which.name, 100.0 * p, outcome.holds, outcome.enabled_s, expected);
  EXPECT_FALSE(outcome.faulted);
  EXPECT_NEAR(static_cast<double>(outcome.holds), expected, 3.5 * std::sqrt(expected) + 1.0);
}

INSTANTIATE_TEST_SUITE_P(, FrameLossTest,
                         ::testing::Values(Case{"to the machine", 0.2, 0.0, 600.0, 650.0},
                                           Case{"to the host", 0.0, 0.2, 600.0, 820.0},
                                           Case{"to the machine", 0.1, 0.0, 600.0, 650.0},
                                           Case{"to the host", 0.0, 0.1, 600.0, 820.0}),
                         [](const auto& info) {
                           const int percent =
                               static_cast<int>(100.0 * std::max(info.param.loss_sending,
                                                                 info.param.loss_receiving));
                           return std::string(info.param.loss_sending > 0.0 ? "ToTheMachine"
                                                                            : "ToTheHost") +
                                  std::to_string(percent) + "Percent";
                         });

}  // namespace
}  // namespace wex::can
