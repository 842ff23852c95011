#include "hw_interface/socketcan/socketcan_machine.hpp"

#include <gtest/gtest.h>

#include "tests/support/host_bench.hpp"

namespace wex::can {
namespace {

TEST(SocketCanMachine, EnablesDrivesAndStops) {
  HostBench bench;
  bench.drive();
  EXPECT_EQ(bench.host->lifecycle(), Lifecycle::kActive);
  EXPECT_EQ(bench.host->health().level, HealthLevel::kOk);
  bench.host->stop();
  EXPECT_GE(bench.time_to_stand(1.0), 0.0);
}

}  // namespace
}  // namespace wex::can
