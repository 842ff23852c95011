#include "models/types/contact_schedule.hpp"

#include <gtest/gtest.h>

namespace wex {
namespace {

WholeBodyNode node(double t_s, const ContactFlags& contacts) { return {t_s, {}, contacts}; }

// LF is lifted twice, RF once and not put down again, the arm supports once.
std::vector<WholeBodyNode> stepping() {
  return {node(0.0, {true, true, true, true, false}),  node(1.0, {false, true, true, true, true}),
          node(2.0, {true, true, true, true, true}),   node(3.0, {false, false, true, true, false}),
          node(4.0, {true, false, true, true, false}), node(5.0, {true, false, true, true, false})};
}

TEST(ContactSchedule, HoldsANodesContactsUntilTheNext) {
  const ContactSchedule schedule = contact_schedule(stepping());
  EXPECT_EQ(schedule[0], (std::vector<ContactInterval>{{0.0, 1.0}, {2.0, 3.0}, {4.0, 5.0}}));
  EXPECT_EQ(schedule[1], (std::vector<ContactInterval>{{0.0, 3.0}}));
  EXPECT_EQ(schedule[2], (std::vector<ContactInterval>{{0.0, 5.0}}));
  EXPECT_EQ(schedule[4], (std::vector<ContactInterval>{{1.0, 3.0}}));
}

TEST(ContactSchedule, OfNothingIsEmpty) {
  for (const auto& limb : contact_schedule(std::vector<WholeBodyNode>{})) EXPECT_TRUE(limb.empty());
}

TEST(Lifts, AreCountedWhereContactEnds) {
  const auto nodes = stepping();
  EXPECT_EQ(num_lifts(nodes, Limb::kLF), 2);
  EXPECT_EQ(num_lifts(nodes, Limb::kRF), 1);
  EXPECT_EQ(num_lifts(nodes, Limb::kLH), 0);
  EXPECT_EQ(num_lifts(nodes, Limb::kArm), 1);
  EXPECT_EQ(num_wheel_lifts(nodes), 3);
}

}  // namespace
}  // namespace wex
