#include "initializer/stepping/motion_nodes.hpp"

#include <gmock/gmock.h>

#include "initializer/make_plan.hpp"
#include "models/excavator/collision_model.hpp"
#include "test_worlds.hpp"

namespace wex {
namespace {

using testing::EndsWith;

constexpr double kAnyMargin = -10.0, kSwingM = 0.1;
constexpr std::size_t kLF = 0;

/// A block on flat ground, at its full height where cells lie within.
HeightFunction block(const Eigen::Vector2d& min_m, const Eigen::Vector2d& max_m, double height_m) {
  return [=](double x, double y) {
    constexpr double kRounding = 1e-6;
    const Eigen::Vector2d p(x, y);
    const bool inside =
        ((p - min_m).array() >= -kRounding).all() && ((max_m - p).array() >= -kRounding).all();
    return inside ? height_m : 0.0;
  };
}

class MotionNodes : public testing::Test {
 protected:
  void SetUp() override {
    const auto standing = standing_posture(flat_map(), machine_, {0.0, 0.0, 0.0});
    ASSERT_TRUE(standing) << standing.error().message;
    q_ = *standing;
  }
  [[nodiscard]] static MotionNode node(const Eigen::VectorXd& q, const ContactFlags& contacts) {
    MotionNode node;
    node.q = q;
    node.contacts = contacts;
    return node;
  }
  [[nodiscard]] std::string fault(const HeightFunction& height,
                                  const std::vector<MotionNode>& nodes) const {
    const TerrainMap map = make_map(30.0, 20.0, height);
    const auto found =
        find_fault(map, StanceGround(map), machine_, collision_, nodes, kAnyMargin, kSwingM);
    return found ? found->why : "";
  }
  [[nodiscard]] Eigen::Vector3d wheel(std::size_t k, const Eigen::VectorXd& q) const {
    KinematicTree::Workspace w = machine_.tree.make_workspace();
    machine_.tree.update(q, w);
    return machine_.tree.position(w, machine_.legs[k].carrier_body,
                                  machine_.legs[k].p_carrier_wheel);
  }
  /// Lifts LF, then goes 1.2 m ahead.
  [[nodiscard]] std::vector<MotionNode> swing() const {
    ContactFlags on_three = kDrivingContacts;
    on_three[kLF] = false;
    std::vector<MotionNode> nodes{node(q_, kDrivingContacts), node(q_, on_three)};
    Eigen::VectorXd q = q_;
    q[machine_.legs[kLF].hfe] += 0.3;  // up
    nodes.push_back(node(q, on_three));
    for (int k = 1; k <= 6; ++k) {
      q[kBaseX] += 0.2;
      nodes.push_back(node(q, on_three));
    }
    return nodes;
  }

  const MachineModel& machine_ = test_machine();
  const CollisionModel collision_ = CollisionModel::build(machine_);
  Eigen::VectorXd q_;
};

TEST_F(MotionNodes, StandingOnFlatGroundHasNoFault) {
  EXPECT_EQ(fault([](double, double) { return 0.0; }, {node(q_, kDrivingContacts)}), "");
}

TEST_F(MotionNodes, ALegBesideAWallTouchesItWithItsFlankBeforeItsAxisDoes) {
  KinematicTree::Workspace w = machine_.tree.make_workspace();
  machine_.tree.update(q_, w);
  // The outermost ball of a beam of LF that is wider than a cell of the map.
  const CollisionModel::Capsule* beam = nullptr;
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  for (const CollisionModel::Capsule& capsule : collision_.capsules()) {
    if (capsule.part != CollisionModel::Part::kLF || capsule.load_bearing) continue;
    if (capsule.radius_m < 0.13) continue;
    for (const Eigen::Vector3d& end : {capsule.p_body_a, capsule.p_body_b}) {
      const Eigen::Vector3d at = w.T_world_body[static_cast<std::size_t>(capsule.body)] * end;
      if (beam == nullptr || at.y() > p.y()) {
        beam = &capsule;
        p = at;
      }
    }
  }
  ASSERT_NE(beam, nullptr);
  // A wall as high as the ball's middle, from the next cell on: the slope of the map's last cell
  // ends a cell before it.
  const auto wall = [&](double beside_m) {
    const Eigen::Vector2d edge(p.x(), std::ceil(10.0 * (p.y() + beside_m)) / 10.0);
    return block(edge - Eigen::Vector2d(0.3, 0.0), edge + Eigen::Vector2d(0.3, 0.3), p.z());
  };
  const double beside_m = std::ceil(10.0 * p.y()) / 10.0 - p.y();  // of the next cell
  ASSERT_LT(beside_m, beam->radius_m);
  ContactFlags without_wheel = kDrivingContacts;  // which would stand on the wall
  without_wheel[kLF] = false;
  EXPECT_THAT(fault(wall(0.0), {node(q_, without_wheel)}), EndsWith("is in the ground"));
  EXPECT_EQ(fault(wall(0.4), {node(q_, without_wheel)}), "");
}

TEST_F(MotionNodes, ALiftedWheelKeepsItsClearanceOverABlockAhead) {
  const std::vector<MotionNode> nodes = swing();
  const Eigen::Vector3d p = wheel(kLF, nodes[5].q);  // 0.6 m from both ends
  ASSERT_GT(p.z(), wheel(kLF, q_).z() + 0.2) << "it is not lifted";
  const double underside_m = p.z() - machine_.legs[kLF].radius_m;
  const auto with_block = [&](double height_m) {
    const Eigen::Vector2d half(0.1, 0.6);
    return block(p.head<2>() - half, p.head<2>() + half, height_m);
  };
  EXPECT_EQ(fault(with_block(underside_m - 0.11), nodes), "");
  EXPECT_EQ(fault(with_block(underside_m - 0.09), nodes),
            "wheel LF swings too close to the ground");
}

TEST_F(MotionNodes, BetweenNodesALiftedWheelIsLookedAtHalfWay) {
  std::vector<MotionNode> nodes = swing();
  nodes.erase(nodes.begin() + 3, nodes.end() - 1);
  const Eigen::Vector3d from = wheel(kLF, nodes[2].q), to = wheel(kLF, nodes[3].q);
  ASSERT_NEAR(to.x() - from.x(), 1.2, 1e-9);
  // Below the middle: from 0.6 m away the tyre's tread is half a metre higher than its underside.
  const Eigen::Vector2d middle = 0.5 * (from + to).head<2>(), half(0.15, 0.6);
  const double underside_m = to.z() - machine_.legs[kLF].radius_m;
  EXPECT_EQ(fault(block(middle - half, middle + half, underside_m - 0.05), nodes),
            "wheel LF swings too close to the ground");
}

}  // namespace
}  // namespace wex
