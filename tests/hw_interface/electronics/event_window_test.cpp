#include "hw_interface/electronics/event_window.hpp"

#include <gtest/gtest.h>

namespace wex::can {
namespace {

TEST(EventWindow, IsFullWithTheLastOfItsEventsIfTheFirstIsNotTooOld) {
  EventWindow window(3, 100);
  EXPECT_FALSE(window.add(1000));
  EXPECT_FALSE(window.add(1050));
  EXPECT_TRUE(window.add(1100)) << "three within exactly 100 ms";
  EXPECT_FALSE(window.add(1151)) << "1050, 1100, 1151";
  EXPECT_TRUE(window.add(1199)) << "1100, 1151, 1199";
}

TEST(EventWindow, DoesNotCountWhatNeverWas) {
  EventWindow window(3, 100);
  EXPECT_FALSE(window.add(0)) << "the clock has just begun: nothing happened at 0 before";
  EXPECT_FALSE(window.add(0));
  EXPECT_TRUE(window.add(0));
}

TEST(EventWindow, OneEventMayBeEnough) {
  EventWindow window(1, 100);
  EXPECT_TRUE(window.add(5000));
  EXPECT_TRUE(window.add(9000));
}

TEST(EventWindow, TellsAsManyApartAsItSays) {
  EventWindow window(EventWindow::kMaxCount, 100);
  ASSERT_EQ(EventWindow::kMaxCount, 16);
  for (int i = 0; i < 15; ++i) EXPECT_FALSE(window.add(1000 + i)) << i;
  EXPECT_TRUE(window.add(1015));
  EXPECT_TRUE(window.add(1101)) << "1001 .. 1101";
  EXPECT_FALSE(window.add(1103)) << "1002 .. 1103";
}

TEST(EventWindow, ClearedItCountsAnew) {
  EventWindow window(2, 100);
  window.add(1000);
  window.clear();
  EXPECT_FALSE(window.add(1001));
  EXPECT_TRUE(window.add(1002));
}

}  // namespace
}  // namespace wex::can
