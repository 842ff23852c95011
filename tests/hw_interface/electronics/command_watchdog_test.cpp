#include "hw_interface/electronics/command_watchdog.hpp"

#include <gtest/gtest.h>

namespace wex::can {
namespace {

ZoneCommand command(int zone, std::uint32_t echo_time_ms, double rate) {
  ZoneCommand command;
  command.zone = zone;
  command.echo_time_ms = echo_time_ms;
  command.valid_for_ms = 60;
  command.active[0] = true;
  command.rate[0] = rate;
  return command;
}

TEST(CommandWatchdog, BeforeTheFirstCommandEveryZoneHolds) {
  const CommandWatchdog watchdog;
  for (int zone = 0; zone < kNumZones; ++zone) {
    EXPECT_EQ(watchdog.in_force(zone, 0), nullptr);
    EXPECT_EQ(watchdog.in_force(zone, -1000), nullptr);
  }
}

TEST(CommandWatchdog, ACommandLastsFromItsEchoNotFromItsArrival) {
  CommandWatchdog watchdog;
  watchdog.accept(command(2, 1000, 0.3), 1025);
  ASSERT_NE(watchdog.in_force(2, 1025), nullptr);
  EXPECT_EQ(watchdog.in_force(2, 1025)->rate[0], 0.3);
  EXPECT_NE(watchdog.in_force(2, 1060), nullptr);
  EXPECT_EQ(watchdog.in_force(2, 1061), nullptr);
}

TEST(CommandWatchdog, TheEchoMayWrapWithTheClock) {
  constexpr std::int64_t kWrapped_ms = (1LL << 32) + 5;
  CommandWatchdog watchdog;
  watchdog.accept(command(0, 0xFFFFFFFFU - 4, 0.1), kWrapped_ms);  // 10 ms ago
  EXPECT_NE(watchdog.in_force(0, kWrapped_ms + 50), nullptr);
  EXPECT_EQ(watchdog.in_force(0, kWrapped_ms + 51), nullptr);
}

TEST(CommandWatchdog, TheNewestCommandCountsForItsZoneOnly) {
  CommandWatchdog watchdog;
  watchdog.accept(command(1, 1000, 0.1), 1000);
  watchdog.accept(command(1, 1010, 0.2), 1010);
  EXPECT_EQ(watchdog.in_force(1, 1010)->rate[0], 0.2);
  for (const int other : {0, 2, 3, 4, 5}) EXPECT_EQ(watchdog.in_force(other, 1010), nullptr);
}

TEST(CommandWatchdog, ClearedEveryZoneHolds) {
  CommandWatchdog watchdog;
  for (int zone = 0; zone < kNumZones; ++zone) watchdog.accept(command(zone, 1000, 0.1), 1000);
  watchdog.clear();
  for (int zone = 0; zone < kNumZones; ++zone) EXPECT_EQ(watchdog.in_force(zone, 1000), nullptr);
}

}  // namespace
}  // namespace wex::can
