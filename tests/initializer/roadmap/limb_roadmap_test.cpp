#include "initializer/roadmap/limb_roadmap.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "initializer/roadmap/roadmap_statistics.hpp"

namespace wex {
namespace {

using Part = CollisionModel::Part;

constexpr double kRounding = 1e-9;
/// Between the configurations checked while building, no capsule moves by more than this.
constexpr double kBetweenChecks_m = 0.06;

Eigen::VectorXd standing(const MachineModel& machine) {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(machine.num_coordinates());
  q.tail(machine.num_joints()) = machine.default_posture();
  return q;
}

Eigen::VectorXd with_vertex(const MachineModel& machine, const LimbRoadmap& map,
                            const Eigen::VectorXd& configuration) {
  Eigen::VectorXd q = standing(machine);
  for (std::size_t i = 0; i < map.coordinates.size(); ++i) {
    q[map.coordinates[i]] = configuration[static_cast<Eigen::Index>(i)];
  }
  return q;
}

/// Built once: every test reads it.
struct M545 {
  MachineModel machine = load_machine("m545").value();
  CollisionModel collision = CollisionModel::build(machine);
  Roadmaps roadmaps = build_roadmaps(machine, collision);
};
const M545& m545() {
  static const M545 built;
  return built;
}

class EveryLimb : public ::testing::TestWithParam<int> {
 protected:
  const MachineModel& machine_ = m545().machine;
  const LimbRoadmap& map_ = m545().roadmaps.limbs.at(GetParam());
  KinematicTree::Workspace w_ = machine_.tree.make_workspace();
  bool arm() const { return map_.limb == Limb::kArm; }
};
INSTANTIATE_TEST_SUITE_P(M545, EveryLimb, ::testing::Range(0, kNumLimbs), [](const auto& limb) {
  return std::string(kLimbNames[static_cast<std::size_t>(limb.param)]);
});

TEST_P(EveryLimb, HasTheVerticesAskedForWithinLimitsSortedFromTheDefaultPosture) {
  EXPECT_EQ(static_cast<int>(map_.limb), GetParam());
  ASSERT_EQ(map_.num_vertices(), arm() ? 3000 : 300);
  EXPECT_EQ(map_.distance_from_default[0], 0.0);
  EXPECT_EQ(with_vertex(machine_, map_, map_.q.col(0)), standing(machine_));
  EXPECT_TRUE(std::is_sorted(map_.distance_from_default.begin(), map_.distance_from_default.end()));
  for (int v = 0; v < map_.num_vertices(); ++v) {
    EXPECT_EQ(map_.distance_from_default[v],
              joint_distance_s(machine_, map_.coordinates, map_.q.col(0), map_.q.col(v)));
    for (std::size_t i = 0; i < map_.coordinates.size(); ++i) {
      const Joint& joint = machine_.joints[map_.coordinates[i] - kNumBaseCoordinates];
      EXPECT_GE(map_.q(static_cast<Eigen::Index>(i), v), std::max(joint.lower, -3.15));
      EXPECT_LE(map_.q(static_cast<Eigen::Index>(i), v), std::min(joint.upper, 3.15));
    }
  }
}

TEST_P(EveryLimb, VerticesSayWhereContactAndMassAre) {
  for (int v = 0; v < map_.num_vertices(); v += 7) {
    machine_.tree.update(with_vertex(machine_, map_, map_.q.col(v)), w_);
    const Eigen::Vector3d contact =
        arm() ? machine_.tree.position(w_, machine_.arm->contact_body, machine_.arm->p_body_contact)
              : machine_.tree.position(w_, machine_.legs[GetParam()].carrier_body,
                                       machine_.legs[GetParam()].p_carrier_wheel);
    EXPECT_NEAR((map_.p_base_contact.col(v) - contact).norm(), 0.0, kRounding);
    // The chassis and the other limbs stand as they do: what is left over is this limb.
    Eigen::Vector3d rest = w_.subtree_mass_times_com[0];
    for (const LimbRoadmap& other : m545().roadmaps.limbs) {
      if (other.limb != map_.limb) rest -= other.moment_base.col(0);
    }
    const KinematicTree::Body& base = machine_.tree.bodies()[0];
    rest -= base.mass_kg * base.p_body_com;
    EXPECT_NEAR((map_.moment_base.col(v) - rest).norm(), 0.0, 1e-6);
  }
}

TEST_P(EveryLimb, EdgesKeepToTheirReachAndClearTheChassisAllAlong) {
  const double reach_m = arm() ? 1.0 : 0.3;
  const Part part =
      arm() ? Part::kArm : static_cast<Part>(static_cast<int>(Part::kLF) + GetParam());
  std::bitset<CollisionModel::kNumParts> fixed;
  fixed.set(static_cast<std::size_t>(Part::kChassis));
  if (arm()) fixed.set(static_cast<std::size_t>(Part::kCabin));
  if (arm()) fixed.set(static_cast<std::size_t>(Part::kArm));
  ASSERT_GT(map_.edges.size(), 3U * map_.num_vertices());
  constexpr int kPieces = 37;
  for (std::size_t e = 0; e < map_.edges.size(); e += 11) {
    const LimbRoadmap::Edge& edge = map_.edges[e];
    ASSERT_LT(edge.a, edge.b);
    EXPECT_NEAR(edge.length_m,
                (map_.p_base_contact.col(edge.a) - map_.p_base_contact.col(edge.b)).norm(),
                kRounding);
    EXPECT_LE(edge.length_m, reach_m);
    Eigen::VectorXd step = map_.q.col(edge.b) - map_.q.col(edge.a);
    if (arm()) step[0] = wrap_angle(step[0]);
    for (int k = 0; k <= kPieces; ++k) {
      const Eigen::VectorXd between = map_.q.col(edge.a) + step * k / kPieces;
      machine_.tree.update(with_vertex(machine_, map_, between), w_);
      ASSERT_TRUE(m545().collision.clear(w_, part, fixed, 0.10 - kBetweenChecks_m));
    }
  }
}

TEST_P(EveryLimb, EdgesJoinNearestNeighboursInSpace) {
  const auto rank = [&](int a, int b) {
    const double length = (map_.p_base_contact.col(a) - map_.p_base_contact.col(b)).norm();
    int nearer = 0;
    for (int v = 0; v < map_.num_vertices(); ++v) {
      const double other = (map_.p_base_contact.col(a) - map_.p_base_contact.col(v)).norm();
      if (v != a && other < length - kRounding) ++nearer;
    }
    return nearer;
  };
  for (std::size_t e = 0; e < map_.edges.size(); e += 13) {
    const LimbRoadmap::Edge& edge = map_.edges[e];
    EXPECT_LT(std::min(rank(edge.a, edge.b), rank(edge.b, edge.a)), 10);
  }
}

TEST_P(EveryLimb, AdjacencyHasEveryEdgeFromBothEnds) {
  std::set<std::pair<int, int>> from_edges, from_lists;
  for (const LimbRoadmap::Edge& edge : map_.edges) {
    EXPECT_TRUE(from_edges.insert({edge.a, edge.b}).second);
    from_edges.insert({edge.b, edge.a});
  }
  ASSERT_EQ(std::ssize(map_.first_edge), map_.num_vertices() + 1);
  for (int v = 0; v < map_.num_vertices(); ++v) {
    for (int i = map_.first_edge[v]; i < map_.first_edge[v + 1]; ++i) {
      from_lists.insert({v, map_.neighbours.at(i)});
    }
  }
  EXPECT_EQ(from_edges, from_lists);
}

TEST_P(EveryLimb, IsNearlyInOnePiece) {
  const RoadmapStatistics s = statistics(map_);
  EXPECT_GT(s.largest_component, 0.95 * s.vertices);
  EXPECT_EQ(s.edges, std::ssize(map_.edges));
}

TEST(LimbRoadmap, StandingWheelIsAtItsRadiusAboveTheGround) {
  for (int leg = 0; leg < kNumWheels; ++leg) {
    const LimbRoadmap& map = m545().roadmaps.limbs[leg];
    EXPECT_NEAR(map.p_base_contact(2, 0), 0.6 - 0.95, 0.005);
    EXPECT_EQ(map.coordinates.size(), 3U);  // not the wheel's own turning
  }
}

TEST(LimbRoadmap, ArmHasNeighboursInJointSpaceToo) {
  const LimbRoadmap& map = m545().roadmaps.limbs.back();
  ASSERT_EQ(std::ssize(map.first_joint_neighbour), map.num_vertices() + 1);
  const auto distance_s = [&](int a, int b) {
    return joint_distance_s(m545().machine, map.coordinates, map.q.col(a), map.q.col(b));
  };
  const auto rank = [&](int a, int b) {
    const double d = distance_s(a, b);
    int nearer = 0;
    for (int v = 0; v < map.num_vertices(); ++v) nearer += v != a && distance_s(a, v) < d;
    return nearer;
  };
  int looked_at = 0;
  for (int v = 0; v < map.num_vertices(); v += 97) {
    for (int i = map.first_joint_neighbour[v]; i < map.first_joint_neighbour[v + 1]; ++i) {
      ++looked_at;
      EXPECT_LT(std::min(rank(v, map.joint_neighbours[i]), rank(map.joint_neighbours[i], v)), 10);
    }
  }
  EXPECT_GT(looked_at, 150);
  for (int leg = 0; leg < kNumWheels; ++leg) {
    EXPECT_TRUE(m545().roadmaps.limbs[leg].joint_neighbours.empty());
  }
}

// Joints that only turn the bucket about itself are not spent vertices on.
TEST(LimbRoadmap, ArmVariesCabinBoomDipperTelescopeAndBucketPitch) {
  const LimbRoadmap& map = m545().roadmaps.limbs.back();
  ASSERT_EQ(map.q.rows(), 7);
  for (Eigen::Index i = 0; i < map.q.rows(); ++i) {
    const double spread = map.q.row(i).maxCoeff() - map.q.row(i).minCoeff();
    EXPECT_EQ(spread > 0.1, i < 5) << i;
  }
  const RoadmapStatistics s = statistics(map);
  EXPECT_GT(s.highest.x(), 7.5);
  EXPECT_LT(s.lowest.x(), -7.5);  // all round
  EXPECT_LT(s.lowest.z(), -2.0);
}

RoadmapSettings small() {
  RoadmapSettings settings;
  settings.leg_vertices = 30;
  settings.arm_vertices = 60;
  return settings;
}

TEST(LimbRoadmap, IsTheSameForTheSameSeedAndAnotherForAnother) {
  RoadmapSettings settings = small();
  const auto build = [&] { return build_roadmaps(m545().machine, m545().collision, settings); };
  const Roadmaps once = build(), again = build();
  ASSERT_EQ(once.limbs.size(), 5U);
  for (std::size_t i = 0; i < once.limbs.size(); ++i) {
    EXPECT_EQ(once.limbs[i].q, again.limbs[i].q);
    EXPECT_EQ(once.limbs[i].edges, again.limbs[i].edges);
  }
  settings.seed = 2;
  EXPECT_NE(build().limbs[0].q, once.limbs[0].q);
}

TEST(LimbRoadmap, LongerReachGivesMoreEdges) {
  RoadmapSettings settings = small();
  const auto edges = [&] {
    return build_roadmap(m545().machine, m545().collision, Limb::kLF, settings).edges.size();
  };
  const std::size_t by_default = edges();
  settings.max_leg_edge_m = 1.0;
  EXPECT_GT(edges(), by_default);
  settings.max_leg_edge_m = 1e-6;
  EXPECT_EQ(edges(), 0U);
}

TEST(LimbRoadmap, TakesAMachineWithoutArmAndHipAbduction) {
  const MachineModel walker = load_machine(WEX_TEST_DATA_DIR "/small_walker").value();
  const Roadmaps roadmaps = build_roadmaps(walker, CollisionModel::build(walker), small());
  ASSERT_EQ(roadmaps.limbs.size(), 4U);
  for (const LimbRoadmap& map : roadmaps.limbs) {
    EXPECT_EQ(map.coordinates.size(), 2U);
    EXPECT_EQ(map.num_vertices(), 30);
  }
}

TEST(LimbRoadmap, WithoutRoomAnywhereHasNoVertices) {
  RoadmapSettings settings = small();
  settings.self_collision_m = 50.0;
  const LimbRoadmap map = build_roadmap(m545().machine, m545().collision, Limb::kArm, settings);
  EXPECT_EQ(map.num_vertices(), 0);
  EXPECT_EQ(map.edges.size(), 0U);
  EXPECT_EQ(statistics(map).components, 0);
}

TEST(LimbRoadmap, RefusesSettingsThatMakeNoSense) {
  RoadmapSettings settings;
  settings.leg_vertices = 0;
  EXPECT_THROW((void)build_roadmaps(m545().machine, m545().collision, settings), std::logic_error);
  const MachineModel walker = load_machine(WEX_TEST_DATA_DIR "/small_walker").value();
  EXPECT_THROW((void)build_roadmap(walker, CollisionModel::build(walker), Limb::kArm),
               std::logic_error);
}

TEST(JointDistance, IsTheTimeOfTheJointsTheShorterWayRound) {
  const MachineModel& machine = m545().machine;
  const std::vector<int>& arm = machine.arm->coordinates;
  Eigen::VectorXd from = Eigen::VectorXd::Zero(7), to = from;
  from[0] = 3.0;
  to[0] = -3.0;
  const double turn_rad = 2.0 * std::numbers::pi - 6.0;
  EXPECT_NEAR(joint_distance_s(machine, arm, from, to), turn_rad / 0.8, 1e-12);
  to[3] = 0.4;  // a second of telescope
  EXPECT_NEAR(joint_distance_s(machine, arm, from, to), std::hypot(turn_rad / 0.8, 1.0), 1e-12);
}

}  // namespace
}  // namespace wex
