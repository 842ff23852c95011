#include "models/excavator/collision_model.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "models/excavator/internal/capsule_cover.hpp"
#include "models/excavator/internal/segments.hpp"
#include "models/types/machine_io_types.hpp"
#include "models/types/result.hpp"

namespace wex {
namespace {

constexpr int kMaxCapsules = 256, kMaxShapes = 64;
constexpr double kAxesCross_m = 1e-9;
/// What is nearer in the default posture is mounted so, like a leg at its hip, and kept apart by
/// the joints' limits.
constexpr double kTouching_m = 0.10;
/// Along the arm, links this many joints apart can meet.
constexpr int kArmJointsApart = 4;

using Bodies = std::vector<KinematicTree::Body>;
using Part = CollisionModel::Part;

/// The bodies from one below the base down to this one.
std::vector<int> chain_of(const Bodies& bodies, int body) {
  std::vector<int> chain;
  for (; body > 0; body = bodies[body].parent) chain.insert(chain.begin(), body);
  return chain;
}

double square(double x) { return x * x; }

/// Moving joints on the way from one body to another.
int joints_between(const Bodies& bodies, int a, int b) {
  std::vector<int> from = chain_of(bodies, a), to = chain_of(bodies, b);
  const auto [split_from, split_to] = std::mismatch(from.begin(), from.end(), to.begin(), to.end());
  const auto moves = [&](int body) { return bodies[body].coordinate >= 0; };
  return static_cast<int>(std::count_if(split_from, from.end(), moves) +
                          std::count_if(split_to, to.end(), moves));
}

Part part_of(const MachineModel& machine, int body) {
  const Bodies& bodies = machine.tree.bodies();
  const std::vector<int> chain = chain_of(bodies, body);
  if (chain.empty()) return Part::kChassis;
  for (const WheeledLeg& leg : machine.legs) {
    if (chain.front() == chain_of(bodies, leg.wheel_body).front()) {
      return static_cast<Part>(static_cast<int>(Part::kLF) + static_cast<int>(leg.limb));
    }
  }
  if (!machine.arm || machine.arm->coordinates.empty()) return Part::kChassis;
  int last_moving = 0;
  bool on_arm = false;
  for (const int b : chain) {
    if (bodies[b].coordinate < 0) continue;
    last_moving = b;
    on_arm = on_arm || bodies[b].coordinate == machine.arm->coordinates.front();
  }
  if (!on_arm) return Part::kChassis;
  return bodies[last_moving].coordinate == machine.arm->coordinates.front() ? Part::kCabin
                                                                            : Part::kArm;
}

/// How the upper carriage clears the roots of the legs below it is a matter of its outline, which
/// is drawn, not measured: only what hangs on the steering is held against it.
bool under_cabin(const MachineModel& machine, int body) {
  const std::vector<int> chain = chain_of(machine.tree.bodies(), body);
  return std::none_of(machine.legs.begin(), machine.legs.end(), [&](const WheeledLeg& leg) {
    return std::find(chain.begin(), chain.end(), leg.carrier_body) != chain.end();
  });
}

bool may_collide(const MachineModel& machine, Part first, int first_body, Part second,
                 int second_body) {
  const int apart = joints_between(machine.tree.bodies(), first_body, second_body);
  if (first == second) return first == Part::kArm && apart >= kArmJointsApart;
  if (apart < 2) return false;
  if (first != Part::kCabin) std::swap(first, second), std::swap(first_body, second_body);
  const bool cabin_and_leg = first == Part::kCabin && second != Part::kArm;
  return !cabin_and_leg || !under_cabin(machine, second_body);
}

}  // namespace

/// One query: poses of capsules as they are needed, and the smallest distance so far.
class CollisionModel::Query {
 public:
  Query(const CollisionModel& model, const KinematicTree::Workspace& w) noexcept
      : model_(model), w_(w) {
    for (std::size_t i = 0; i < model.shapes_.size(); ++i) {
      const Shape& shape = model.shapes_[i];
      const Eigen::Isometry3d& T = w.T_world_body[shape.body];
      centre_[i] = T.linear() * shape.p_body_centre + T.translation();
    }
  }

  /// No distance of the shapes' capsules can be below.
  double lower_bound_m(const ShapePair& pair) const noexcept {
    return (centre_[pair.first] - centre_[pair.second]).norm() -
           model_.shapes_[pair.first].radius_m - model_.shapes_[pair.second].radius_m;
  }

  void look_at(const ShapePair& pair, Proximity& best) noexcept {
    pose(pair.first);
    pose(pair.second);
    const Shape &first = model_.shapes_[pair.first], &second = model_.shapes_[pair.second];
    const Eigen::Vector3d& centre = centre_[pair.second];
    int index = pair.first_pair;
    for (int i = first.first; i < first.last; ++i, index += second.last - second.first) {
      const double reach_m = best.distance_m + model_.capsules_[i].radius_m;
      if (nearest_on_segments(a_[i], b_[i], centre, centre).between.squaredNorm() >
          square(reach_m + second.radius_m)) {
        continue;
      }
      for (int j = second.first; j < second.last; ++j) {
        const double radii = model_.capsules_[i].radius_m + model_.capsules_[j].radius_m;
        const double between =
            nearest_on_segments(a_[i], b_[i], a_[j], b_[j]).between.norm() - radii;
        if (between < best.distance_m) best = {between, index + j - second.first};
      }
    }
  }

  template <typename Wanted>
  Proximity nearest(double at_most_m, double stop_below_m, const Wanted& wanted) noexcept {
    Proximity best{at_most_m, -1};
    for (const ShapePair& pair : model_.shape_pairs_) {
      if (!wanted(pair) || lower_bound_m(pair) >= best.distance_m) continue;
      look_at(pair, best);
      if (best.distance_m < stop_below_m) break;
    }
    return best;
  }

 private:
  void pose(int shape) noexcept {
    if (posed_[shape]) return;
    posed_[shape] = true;
    const Eigen::Isometry3d& T = w_.T_world_body[model_.shapes_[shape].body];
    for (int i = model_.shapes_[shape].first; i < model_.shapes_[shape].last; ++i) {
      a_[i] = T.linear() * model_.capsules_[i].p_body_a + T.translation();
      b_[i] = T.linear() * model_.capsules_[i].p_body_b + T.translation();
    }
  }

  const CollisionModel& model_;
  const KinematicTree::Workspace& w_;
  std::array<Eigen::Vector3d, kMaxShapes> centre_;
  std::array<Eigen::Vector3d, kMaxCapsules> a_, b_;
  std::array<bool, kMaxShapes> posed_{};
};

CollisionModel CollisionModel::build(const MachineModel& machine) {
  CollisionModel model;
  model.add_shapes(machine);
  model.add_pairs(machine);
  return model;
}

void CollisionModel::add_shapes(const MachineModel& machine) {
  const Bodies& bodies = machine.tree.bodies();
  const auto links = shapes::link_shapes(machine);
  for (int body = 0; body < std::ssize(links); ++body) {
    Eigen::Isometry3d T_body_link = Eigen::Isometry3d::Identity();
    int carrier = body;
    for (const WheeledLeg& leg : machine.legs) {
      if (leg.wheel_body != body) continue;
      carrier = leg.carrier_body;
      T_body_link.linear() = bodies[body].T_parent_joint.linear();
      T_body_link.translation() = leg.p_carrier_wheel;
    }
    for (const shapes::Shape& source : links[body]) {
      if (source.use == shapes::Use::kDecoration) continue;
      Shape shape;
      shape.body = carrier;
      shape.part = part_of(machine, body);
      shape.first = static_cast<int>(capsules_.size());
      shape.p_body_centre = T_body_link * source.T_link_shape.translation();
      for (const shapes::CoverCapsule& cover : shapes::capsule_cover(source)) {
        capsules_.push_back({bodies[body].name, carrier, shape.part, T_body_link * cover.p_link_a,
                             T_body_link * cover.p_link_b, cover.radius_m,
                             source.use == shapes::Use::kLoadBearing});
        const Capsule& capsule = capsules_.back();
        for (const Eigen::Vector3d& end : {capsule.p_body_a, capsule.p_body_b}) {
          shape.radius_m =
              std::max(shape.radius_m, (end - shape.p_body_centre).norm() + capsule.radius_m);
        }
      }
      shape.last = static_cast<int>(capsules_.size());
      shapes_.push_back(shape);
    }
  }
  WEX_EXPECTS(capsules_.size() <= kMaxCapsules && shapes_.size() <= kMaxShapes);
}

void CollisionModel::add_pairs(const MachineModel& machine) {
  KinematicTree::Workspace w = machine.tree.make_workspace();
  Eigen::VectorXd q = Eigen::VectorXd::Zero(machine.num_coordinates());
  q.tail(machine.num_joints()) = machine.default_posture();
  machine.tree.update(q, w);
  Query standing(*this, w);
  for (int i = 0; i < std::ssize(shapes_); ++i) {
    for (int j = i + 1; j < std::ssize(shapes_); ++j) {
      const Shape &first = shapes_[i], &second = shapes_[j];
      if (!may_collide(machine, first.part, first.body, second.part, second.body)) continue;
      const ShapePair pair{i, j, static_cast<int>(pairs_.size())};
      Proximity nearest{kTouching_m, -1};
      standing.look_at(pair, nearest);
      if (nearest.pair >= 0) continue;
      for (int a = first.first; a < first.last; ++a) {
        for (int b = second.first; b < second.last; ++b) pairs_.push_back({a, b});
      }
      shape_pairs_.push_back(pair);
    }
  }
}

CollisionModel::Proximity CollisionModel::nearest(const KinematicTree::Workspace& w,
                                                  double stop_below_m) const noexcept {
  return Query(*this, w).nearest(1e9, stop_below_m, [](const ShapePair&) { return true; });
}

CollisionModel::Proximity CollisionModel::nearest(const KinematicTree::Workspace& w, Part part,
                                                  double stop_below_m) const noexcept {
  return Query(*this, w).nearest(1e9, stop_below_m, [&](const ShapePair& pair) {
    return shapes_[pair.first].part == part || shapes_[pair.second].part == part;
  });
}

bool CollisionModel::clear(const KinematicTree::Workspace& w, double margin_m) const noexcept {
  return Query(*this, w).nearest(margin_m, margin_m, [](const ShapePair&) { return true; }).pair <
         0;
}

bool CollisionModel::clear(const KinematicTree::Workspace& w, Part part,
                           double margin_m) const noexcept {
  return Query(*this, w)
             .nearest(margin_m, margin_m,
                      [&](const ShapePair& pair) {
                        return shapes_[pair.first].part == part ||
                               shapes_[pair.second].part == part;
                      })
             .pair < 0;
}

bool CollisionModel::clear(const KinematicTree::Workspace& w, Part part,
                           std::bitset<kNumParts> others, double margin_m) const noexcept {
  const auto wanted = [&](Part one, Part other) {
    return one == part && others[static_cast<std::size_t>(other)];
  };
  return Query(*this, w)
             .nearest(margin_m, margin_m,
                      [&](const ShapePair& pair) {
                        const Part first = shapes_[pair.first].part,
                                   second = shapes_[pair.second].part;
                        return wanted(first, second) || wanted(second, first);
                      })
             .pair < 0;
}

double CollisionModel::distance(const KinematicTree::Workspace& w,
                                const Pair& pair) const noexcept {
  const Capsule &first = capsules_[pair.first], &second = capsules_[pair.second];
  const Eigen::Isometry3d &T = w.T_world_body[first.body], &U = w.T_world_body[second.body];
  return nearest_on_segments(T * first.p_body_a, T * first.p_body_b, U * second.p_body_a,
                             U * second.p_body_b)
             .between.norm() -
         first.radius_m - second.radius_m;
}

double CollisionModel::distance(const KinematicTree& tree, const KinematicTree::Workspace& w,
                                const Pair& pair, Eigen::Ref<Eigen::VectorXd> gradient) const {
  using Jacobian = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3,
                                 kNumBaseCoordinates + kMaxJoints>;
  WEX_EXPECTS(gradient.size() == tree.num_coordinates() &&
              gradient.size() <= Jacobian::MaxColsAtCompileTime);
  const Capsule &first = capsules_[pair.first], &second = capsules_[pair.second];
  const Eigen::Isometry3d &T = w.T_world_body[first.body], &U = w.T_world_body[second.body];
  const NearestOnSegments nearest = nearest_on_segments(T * first.p_body_a, T * first.p_body_b,
                                                        U * second.p_body_a, U * second.p_body_b);
  const double axes_apart_m = nearest.between.norm();
  gradient.setZero();
  if (axes_apart_m > kAxesCross_m) {
    // The nearest points may be taken as fixed in their bodies: sliding them changes nothing to
    // first order.
    const Eigen::Vector3d normal = nearest.between / axes_apart_m;
    Jacobian jacobian(3, gradient.size());
    tree.position_jacobian(
        w, first.body, first.p_body_a + nearest.s * (first.p_body_b - first.p_body_a), jacobian);
    gradient.noalias() += jacobian.transpose() * normal;
    tree.position_jacobian(w, second.body,
                           second.p_body_a + nearest.t * (second.p_body_b - second.p_body_a),
                           jacobian);
    gradient.noalias() -= jacobian.transpose() * normal;
  }
  return axes_apart_m - first.radius_m - second.radius_m;
}

}  // namespace wex
