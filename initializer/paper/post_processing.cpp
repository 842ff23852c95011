#include "initializer/paper/post_processing.hpp"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <optional>
#include <utility>

#include "initializer/paper/body_poser.hpp"
#include "initializer/paper/bucket_point.hpp"
#include "initializer/paper/contact_schedule.hpp"
#include "initializer/roadmap/arm_path.hpp"
#include "initializer/stepping/arm_motion.hpp"
#include "initializer/stepping/motion_nodes.hpp"

namespace wex {
namespace {

constexpr auto kArmIndex = static_cast<std::size_t>(Limb::kArm);
constexpr double kLimbStep = 0.1;  // rad or m from node to node
constexpr double kRounding = 1e-9;

std::string name_of(std::size_t leg) { return "wheel " + std::string(kLimbNames[leg]); }

}  // namespace

const char* describe(PaperStage stage) noexcept {
  switch (stage) {
    case PaperStage::kStance:
      return "stances";
    case PaperStage::kSchedule:
      return "contact schedule";
    case PaperStage::kLegs:
      return "legs";
    case PaperStage::kBucket:
      return "bucket point";
    case PaperStage::kArm:
      return "arm motion";
    case PaperStage::kVerified:
      return "verification";
  }
  return "an unnamed stage";
}

struct PostProcessing::Impl {
  using Done = Result<void, PaperFailure>;

  Impl(const TerrainMap& terrain_map, const MachineModel& machine_model, const Roadmaps& maps,
       const PaperCheck& paper_check, const PlanSettings& plan_settings, BodyPoser body_poser)
      : machine(machine_model),
        check(paper_check),
        settings(plan_settings),
        poser(std::move(body_poser)),
        collision(CollisionModel::build(machine_model)),
        mover(machine_model, poser.arm(), collision, poser.ground(),
              plan_settings.min_stability_margin_m, motion),
        planner(machine_model, maps.limbs.back()),
        buckets(terrain_map, maps, paper_check, poser.arm(), plan_settings),
        workspace(machine_model.tree.make_workspace()) {}

  const MachineModel& machine;
  const PaperCheck& check;
  PlanSettings settings;
  SteppingMotionSettings motion;
  BodyPoser poser;
  CollisionModel collision;
  ArmMover mover;
  ArmPathPlanner planner;
  BucketPoints buckets;
  KinematicTree::Workspace workspace;

  // Of the path in hand.
  std::vector<Station> stations;
  std::vector<double> curvature;
  std::vector<PaperStance> stances;
  std::vector<MotionNode> nodes;
  ContactFlags contacts{};
  std::optional<BucketPoint> bucket;
  std::size_t station = 0;
  std::optional<std::size_t> stuck_leg;  ///< that could not roll on when the last drive failed

  [[nodiscard]] tl::unexpected<PaperFailure> failure(PaperStage stage, std::string why) const {
    const bool stepping = std::any_of(stances.begin(), stances.end(), [](const PaperStance& s) {
      return s.ok() && s.contacts != kDrivingContacts;
    });
    return tl::unexpected<PaperFailure>({stage, stations[station].pose, std::move(why), stepping});
  }
  [[nodiscard]] const Eigen::VectorXd& now() const { return nodes.back().q; }
  [[nodiscard]] bool four_wheels() const { return contacts == kDrivingContacts; }

  void add(const Eigen::VectorXd& q, double duration_s = 0.0) {
    if (!nodes.empty()) nodes.back().min_duration_s = duration_s;
    MotionNode node;
    node.q = q;
    node.contacts = contacts;
    node.base_speed_m_s = four_wheels() ? settings.nominal_speed_m_s : motion.stepping_speed_m_s;
    node.state = station;
    nodes.push_back(std::move(node));
  }
  /// Straight in joint space.
  void add_line(const Eigen::VectorXd& to) {
    const Eigen::VectorXd from = now();
    const double step = (to - from).cwiseAbs().maxCoeff();
    const int count = std::max(1, static_cast<int>(std::ceil(step / kLimbStep - kRounding)));
    for (int k = 1; k <= count; ++k) add(from + (to - from) * (static_cast<double>(k) / count));
  }
  void break_contact(std::size_t limb) {
    nodes.back().stop = true;
    contacts[limb] = false;
    add(Eigen::VectorXd(now()), motion.contact_change_pause_s);
    nodes.back().stop = true;
  }
  void make_contact(std::size_t limb) {
    contacts[limb] = true;
    nodes.back().contacts = contacts;
    nodes.back().stop = true;
  }

  Result<LegJoints, const char*> standing(std::size_t k, std::size_t leg, Eigen::VectorXd q,
                                          const std::optional<StandingLeg>& before = std::nullopt);
  Done place_legs(std::size_t k, const ContactFlags& on_ground, Eigen::VectorXd& q);
  Done drive_to(std::size_t k);
  Done change_contacts(std::size_t from);
  Done step_over(std::size_t from, std::size_t leg);
  bool can_change_at(std::size_t k, std::size_t from);
  std::optional<LegJoints> swing_joints(std::size_t k, std::size_t leg, int vertex);
  Done change_here(std::size_t k, std::size_t from);
  Done move_arm(const ArmPosture& to);
  Done lower_bucket(std::size_t k);
  Done raise_bucket();
  ArmPosture counterweight(std::size_t k, const Footing& footing, const Eigen::VectorXd& q);
  Done balance(std::size_t k, std::size_t leg, const LegJoints& swung);
  void move_leg(std::size_t leg, const LegJoints& to, bool lifting);
  void write_arm(ArmPosture posture, Eigen::VectorXd& q) const;
  [[nodiscard]] double margin_m(const Eigen::VectorXd& q, const ContactFlags& on_ground);
  Result<std::vector<WholeBodyNode>, PaperFailure> run(const DrivePath& path);
};

void PostProcessing::Impl::write_arm(ArmPosture posture, Eigen::VectorXd& q) const {
  const double turn_rad = poser.arm().posture_of(q).turn_rad;
  posture.turn_rad = turn_rad + wrap_angle(posture.turn_rad - turn_rad);
  poser.arm().write(posture, q);
}

double PostProcessing::Impl::margin_m(const Eigen::VectorXd& q, const ContactFlags& on_ground) {
  return poser.footing(q, on_ground).margin_m(poser.arm().moment_base(poser.arm().posture_of(q)));
}

// A leg on the ground of a station, away from the chassis and the other legs as they are in q.
Result<LegJoints, const char*> PostProcessing::Impl::standing(
    std::size_t k, std::size_t leg, Eigen::VectorXd q, const std::optional<StandingLeg>& before) {
  using Part = CollisionModel::Part;
  constexpr auto kFirstLeg = static_cast<std::size_t>(Part::kLF);
  std::bitset<CollisionModel::kNumParts> others;
  for (std::size_t i = 0; i < kNumWheels; ++i) others[kFirstLeg + i] = i != leg;
  others[static_cast<std::size_t>(Part::kChassis)] = true;
  const auto clear = [&](const LegJoints& joints) {
    poser.write_leg(joints, leg, q);
    machine.tree.update(q, workspace);
    return collision.clear(workspace, static_cast<Part>(kFirstLeg + leg), others, 0.0);
  };
  return poser.standing(stances[k].base, curvature[k], leg, clear, before);
}

// Base of a station; standing legs on the ground, swinging ones as they are as long as that is
// clear, else at the station's own vertex.
PostProcessing::Impl::Done PostProcessing::Impl::place_legs(std::size_t k,
                                                            const ContactFlags& on_ground,
                                                            Eigen::VectorXd& q) {
  const PaperStance& stance = stances[k];
  q.head<kNumBaseCoordinates>() = stance.base;
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    if (on_ground[i]) {
      std::optional<StandingLeg> before;
      if (!nodes.empty()) before = {now().head<kNumBaseCoordinates>(), poser.read_leg(now(), i)};
      const auto joints = standing(k, i, q, before);
      if (!joints) {
        stuck_leg = i;
        return failure(PaperStage::kLegs, name_of(i) + " " + joints.error());
      }
      poser.write_leg(*joints, i, q);
      continue;
    }
    const double clear_m = check.paper().swing_clearance_m;
    if (poser.clearance_m(stance.base, i, poser.read_leg(q, i)) >= clear_m) continue;
    const int vertex = stance.contacts[i] ? check.swing_vertex(stance.base, i) : stance.vertex[i];
    if (vertex < 0) {
      return failure(PaperStage::kLegs, name_of(i) + " would swing through the ground");
    }
    poser.write_leg(poser.vertex_joints(i, vertex), i, q);
  }
  return {};
}

PostProcessing::Impl::Done PostProcessing::Impl::drive_to(std::size_t k) {
  Eigen::VectorXd q = now();
  if (auto placed = place_legs(k, contacts, q); !placed) return placed;
  if (contacts[kArmIndex]) {
    ContactFlags wheels = contacts;
    wheels[kArmIndex] = false;
    const Footing footing = poser.footing(q, wheels);
    const auto posture = buckets.reach(*bucket, footing, poser.arm().posture_of(q), mover, q);
    if (!posture) return failure(PaperStage::kBucket, posture.error());
    write_arm(*posture, q);
  } else if (!four_wheels() && !(margin_m(q, contacts) >= settings.min_stability_margin_m)) {
    // The counterweight goes where this station wants it while the last one stands.
    if (stances[k].contacts == contacts) {
      if (auto moved = move_arm(counterweight(k, poser.footing(q, contacts), q)); !moved) {
        return moved;
      }
    }
    poser.arm().write(poser.arm().posture_of(now()), q);
  }
  station = k;
  add(q);
  nodes.back().stop = stations[k].stop;
  return {};
}

PostProcessing::Impl::Done PostProcessing::Impl::move_arm(const ArmPosture& to) {
  Eigen::VectorXd q = now();
  const auto& coordinates = machine.arm->coordinates;
  const auto arm_of = [&](const Eigen::VectorXd& whole) {
    Eigen::VectorXd part(static_cast<Eigen::Index>(coordinates.size()));
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
      part[static_cast<Eigen::Index>(i)] = whole[coordinates[i]];
    }
    return part;
  };
  const auto write = [&](const Eigen::VectorXd& part, Eigen::VectorXd& whole) {
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
      whole[coordinates[i]] = part[static_cast<Eigen::Index>(i)];
    }
  };
  Eigen::VectorXd goal = q;
  write_arm(to, goal);
  if ((goal - q).cwiseAbs().maxCoeff() < kRounding) return {};
  const Footing footing = poser.footing(q, contacts);
  Eigen::VectorXd tried = q;
  const auto why_not = [&](ArmPathError error) -> std::string {
    if (error == ArmPathError::kStartInvalid || error == ArmPathError::kGoalInvalid) {
      const bool start = error == ArmPathError::kStartInvalid;
      const char* fault =
          mover.fault(footing, tried, poser.arm().posture_of(start ? q : goal), false);
      return std::string(start ? "the arm's motion would begin where "
                               : "the arm's motion would end where ") +
             (fault != nullptr ? fault : "it collides");
    }
    return error == ArmPathError::kNoPath ? "the arm finds no way over its roadmap"
                                          : "the arm finds no way over its roadmap in time";
  };
  const auto path = planner.plan(arm_of(q), arm_of(goal), [&](const Eigen::VectorXd& part) {
    write(part, tried);
    return mover.fault(footing, tried, poser.arm().posture_of(tried), false) == nullptr;
  });
  if (!path) return failure(PaperStage::kArm, why_not(path.error()));
  nodes.back().stop = true;
  for (std::size_t i = 1; i < path->postures.size(); ++i) {
    write(path->postures[i], q);
    add_line(q);
  }
  nodes.back().stop = true;
  return {};
}

// Up by hip flexion before the hip spreads or the wheel turns; down in the reverse order.
void PostProcessing::Impl::move_leg(std::size_t leg, const LegJoints& to, bool lifting) {
  const LegJoints from = poser.read_leg(now(), leg);
  LegJoints between = lifting ? from : to;
  between.hfe_rad = std::max(from.hfe_rad, to.hfe_rad);
  for (const LegJoints& joints : {between, to}) {
    Eigen::VectorXd q = now();
    poser.write_leg(joints, leg, q);
    if ((q - now()).cwiseAbs().maxCoeff() > kRounding) add_line(q);
  }
}

PostProcessing::Impl::Done PostProcessing::Impl::lower_bucket(std::size_t k) {
  const Footing footing = poser.footing(now(), contacts);
  const auto standing = buckets.reach(*bucket, footing, bucket->posture, mover, now());
  if (!standing) return failure(PaperStage::kBucket, standing.error());
  station = k;
  const auto lowering = mover.lowering(footing, now(), *standing);
  if (!lowering) return failure(PaperStage::kArm, lowering.error());
  if (auto moved = move_arm(lowering->front()); !moved) return moved;
  for (std::size_t i = 1; i < lowering->size(); ++i) {
    Eigen::VectorXd q = now();
    write_arm((*lowering)[i], q);
    add(q, motion.bucket_approach_m / motion.bucket_lowering_m_s /
               static_cast<double>(lowering->size() - 1));
  }
  make_contact(kArmIndex);
  return {};
}

PostProcessing::Impl::Done PostProcessing::Impl::raise_bucket() {
  ContactFlags without = contacts;
  without[kArmIndex] = false;
  const auto rising =
      mover.lowering(poser.footing(now(), without), now(), poser.arm().posture_of(now()));
  if (!rising) return failure(PaperStage::kArm, rising.error());
  break_contact(kArmIndex);
  for (auto posture = rising->rbegin() + 1; posture != rising->rend(); ++posture) {
    Eigen::VectorXd q = now();
    write_arm(*posture, q);
    add(q);
  }
  bucket.reset();
  return {};
}

// Of the vertices that balance a station the most central one with nothing in its way; Algorithm 2
// knows of the bucket's contact point alone.
ArmPosture PostProcessing::Impl::counterweight(std::size_t k, const Footing& footing,
                                               const Eigen::VectorXd& q) {
  Eigen::VectorXd tried = q;
  if (num_contacts(stances[k].contacts) == 3 && !stances[k].contacts[kArmIndex]) {
    for (const int vertex : check.counterweights(stances[k])) {
      const ArmPosture posture = poser.vertex_posture(vertex);
      if (mover.fault(footing, tried, posture, false) == nullptr) return posture;
    }
  }
  return poser.vertex_posture(stances[k].vertex[kArmIndex]);
}

// The arm as counterweight before a wheel leaves the ground, if it does not balance as it is: with
// the leg where it stands and where it is going to be.
PostProcessing::Impl::Done PostProcessing::Impl::balance(std::size_t k, std::size_t leg,
                                                         const LegJoints& swung) {
  ContactFlags next = contacts;
  next[leg] = false;
  Eigen::VectorXd q = now();
  poser.write_leg(swung, leg, q);
  const double least_m = settings.min_stability_margin_m;
  if (next[kArmIndex] || (margin_m(now(), next) >= least_m && margin_m(q, next) >= least_m)) {
    return {};
  }
  return move_arm(counterweight(k, poser.footing(q, next), q));
}

// A leg in the air at a station: at the given vertex, or at the first that is clear there.
std::optional<LegJoints> PostProcessing::Impl::swing_joints(std::size_t k, std::size_t leg,
                                                            int vertex) {
  const LegJoints wanted = poser.vertex_joints(leg, vertex);
  if (poser.clearance_m(stances[k].base, leg, wanted) >= check.paper().swing_clearance_m) {
    return wanted;
  }
  const int other = check.swing_vertex(stances[k].base, leg);
  if (other < 0) return std::nullopt;
  return poser.vertex_joints(leg, other);
}

// Whether everything that stands before or after can stand at a station, and what swings before or
// after is clear there.
bool PostProcessing::Impl::can_change_at(std::size_t k, std::size_t from) {
  const ContactFlags all = both(stances[from].contacts, stances[from + 1].contacts);
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    if (all[i] && !standing(k, i, now())) return false;
    for (const PaperStance* side : {&stances[from], &stances[from + 1]}) {
      if (side->contacts[i]) continue;
      if (!swing_joints(k, i, side->vertex[i])) return false;
    }
  }
  return true;
}

PostProcessing::Impl::Done PostProcessing::Impl::change_here(std::size_t k, std::size_t from) {
  const PaperStance& after = stances[from + 1];
  for (const ContactFlags& next : contact_changes(contacts, after.contacts)) {
    const auto limb = static_cast<std::size_t>(
        std::mismatch(next.begin(), next.end(), contacts.begin()).first - next.begin());
    if (limb == kArmIndex) {
      if (auto moved = next[limb] ? lower_bucket(k) : raise_bucket(); !moved) return moved;
    } else if (next[limb]) {
      const auto joints = standing(k, limb, now());
      if (!joints) return failure(PaperStage::kLegs, name_of(limb) + " " + joints.error());
      move_leg(limb, *joints, false);
      make_contact(limb);
    } else {
      const auto swing = swing_joints(k, limb, after.vertex[limb]);
      WEX_EXPECTS(swing.has_value());  // that is what can_change_at made sure of
      if (auto balanced = balance(from + 1, limb, *swing); !balanced) return balanced;
      break_contact(limb);
      move_leg(limb, *swing, true);
    }
  }
  nodes.back().stop = true;
  if (!four_wheels()) return {};
  return move_arm(poser.arm().transport());
}

// Between two stations with different contacts: at the first of them, or at the second.
PostProcessing::Impl::Done PostProcessing::Impl::change_contacts(std::size_t from) {
  const std::size_t to = from + 1;
  if (stances[to].contacts[kArmIndex] && !contacts[kArmIndex]) {
    std::size_t end = to;
    while (end + 1 < stances.size() && stances[end + 1].contacts[kArmIndex]) ++end;
    auto point = buckets.common(stances[to], stances[end]);
    if (!point) return failure(PaperStage::kBucket, point.error());
    bucket = *std::move(point);
  }
  if (can_change_at(from, from)) {
    if (auto changed = change_here(from, from); !changed) return changed;
    return drive_to(to);
  }
  if (!can_change_at(to, from)) {
    return failure(PaperStage::kSchedule, "no full contact phase between two sets of contacts");
  }
  if (auto driven = drive_to(to); !driven) return driven;
  return change_here(to, from);
}

// On four wheels a leg whose vertex at the next station cannot be rolled to changes its contact all
// the same: lifted from where it stands, over three wheels and the counterweight, and put down.
PostProcessing::Impl::Done PostProcessing::Impl::step_over(std::size_t from, std::size_t leg) {
  const PaperStance lifted = check.stand(stances[from + 1].base, static_cast<int>(leg));
  if (!lifted.ok()) {
    return failure(PaperStage::kLegs, name_of(leg) +
                                          " cannot be lifted over what it cannot roll "
                                          "over: " +
                                          wex::describe(lifted.rejection));
  }
  stances[from + 1] = lifted;
  return change_contacts(from);
}

Result<std::vector<WholeBodyNode>, PaperFailure> PostProcessing::Impl::run(const DrivePath& path) {
  stations = path_stations(path, settings.subnode_spacing_m);
  curvature = steered_curvature_1_m(path, stations, motion.steering_window_m);
  stances.clear();
  nodes.clear();
  bucket.reset();
  contacts = kDrivingContacts;
  for (station = 0; station < stations.size(); ++station) {
    stances.push_back(check.stand(stations[station].pose));
    if (!stances.back().ok()) {
      return failure(PaperStage::kStance, wex::describe(stances.back().rejection));
    }
  }
  station = 0;
  if (stances.front().contacts != kDrivingContacts || stances.back().contacts != kDrivingContacts) {
    return failure(PaperStage::kSchedule, "start and goal are not on four wheels alone");
  }
  Eigen::VectorXd q = Eigen::VectorXd::Zero(machine.num_coordinates());
  q.tail(machine.num_joints()) = machine.transport_posture();
  if (auto placed = place_legs(0, contacts, q); !placed) {
    return tl::unexpected<PaperFailure>(placed.error());
  }
  add(q);
  nodes.back().stop = true;
  for (std::size_t i = 0; i + 1 < stations.size(); ++i) {
    stuck_leg.reset();
    Done done = stances[i + 1].contacts == contacts ? drive_to(i + 1) : change_contacts(i);
    if (!done && stuck_leg && four_wheels() && i + 2 < stations.size() &&
        stances[i + 1].contacts == kDrivingContacts) {
      done = step_over(i, *stuck_leg);
    }
    if (!done) return tl::unexpected<PaperFailure>(done.error());
  }
  for (const MotionNode& node : nodes) {
    machine.tree.update(node.q, workspace);
    station = node.state;
    if (!collision.clear(workspace, 0.0)) {
      return failure(PaperStage::kLegs, "limbs would touch each other");
    }
  }
  turn_wheels(machine, nodes);
  SteppingTimingSettings timing;
  timing.rate_fraction = settings.rate_fraction;
  const std::vector<double> t_s = node_times_s(machine, nodes, timing);
  std::vector<WholeBodyNode> timed(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    timed[i] = {t_s[i], std::move(nodes[i].q), nodes[i].contacts};
  }
  return timed;
}

Result<PostProcessing> PostProcessing::build(const TerrainMap& terrain, const MachineModel& machine,
                                             const Roadmaps& roadmaps, const PaperCheck& check,
                                             const PlanSettings& settings) {
  auto poser = BodyPoser::build(terrain, machine, roadmaps, check, settings);
  if (!poser) return tl::unexpected<Error>(poser.error());
  return PostProcessing(
      std::make_unique<Impl>(terrain, machine, roadmaps, check, settings, *std::move(poser)));
}

PostProcessing::PostProcessing(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
PostProcessing::~PostProcessing() = default;
PostProcessing::PostProcessing(PostProcessing&&) noexcept = default;

Result<std::vector<WholeBodyNode>, PaperFailure> PostProcessing::nodes(const DrivePath& path) {
  return impl_->run(path);
}

}  // namespace wex
