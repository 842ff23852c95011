#include "initializer/roadmap/arm_path.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <utility>

#include "initializer/roadmap/internal/limb_motion.hpp"

namespace wex {
namespace {

/// What moving a joint costs beside the time of the slowest: breaks ties, and the pump is shared.
constexpr double kShareOfOthers = 0.1;
constexpr double kNoTurn_rad = 1e-9;
/// Of the checks left, one in so many is for finding a posture to carry the arm in by trial.
constexpr int kShareForCarrying = 5;
/// Of ArmLimb::coordinates, by its contract and custom.
constexpr Eigen::Index kCabin = 0, kBoom = 1;

/// Which way the boom's joint lifts the bucket: the end of its range where the contact is higher.
double raised_boom(const MachineModel& machine, const LimbMotion& motion,
                   const Eigen::VectorXd& transport) {
  KinematicTree::Workspace w = machine.tree.make_workspace();
  Eigen::VectorXd q = Eigen::VectorXd::Zero(machine.num_coordinates());
  q.tail(machine.num_joints()) = machine.transport_posture();
  const auto [lower, upper] = motion.limits(kBoom);
  const auto height_m = [&](double angle) {
    Eigen::VectorXd posture = transport;
    posture[kBoom] = angle;
    motion.write(posture, q);
    machine.tree.update(q, w);
    return machine.tree.position(w, machine.arm->contact_body, machine.arm->p_body_contact).z();
  };
  return height_m(lower) > height_m(upper) ? lower : upper;
}

}  // namespace

/// One query. Vertex numbers: those of the roadmap, then start and goal.
struct ArmPathPlanner::Search {
  Search(const MachineModel& machine, const LimbRoadmap& arm, const ArmPathSettings& path_settings)
      : map(arm), settings(path_settings), motion(machine, arm.coordinates) {
    WEX_EXPECTS(machine.arm && arm.limb == Limb::kArm &&
                arm.coordinates == machine.arm->coordinates);
    WEX_EXPECTS(settings.max_step > 0.0 && settings.nearest_vertices > 0 &&
                settings.heuristic_weight >= 1.0 && settings.max_checks > 0);
    WEX_EXPECTS(motion.size() > kBoom);
    Eigen::VectorXd q = Eigen::VectorXd::Zero(machine.num_coordinates());
    q.tail(machine.num_joints()) = machine.transport_posture();
    transport = motion.read(q);
    boom_up = raised_boom(machine, motion, transport);
    const std::size_t n = static_cast<std::size_t>(arm.num_vertices());
    seen.resize(n + 3);
    by_distance.resize(n);
    step.resize(motion.size());
  }

  /// A way to a vertex, not looked at yet; the vertex is closed by the first that holds.
  struct Candidate {
    double estimate_s = 0.0, cost_s = 0.0;
    int vertex = -1, parent = -1;
    bool operator>(const Candidate& other) const {
      if (estimate_s != other.estimate_s) return estimate_s > other.estimate_s;
      if (vertex != other.vertex) return vertex > other.vertex;
      return parent > other.parent;
    }
  };
  /// One of the two searches, from the start and from the goal.
  struct Front {
    int root = -1, target = -1;  ///< vertices
    std::vector<Candidate> queue;
    std::vector<int> parent;  ///< by vertex, -1: not closed; the root is its own
    std::vector<double> cost_s;
    std::vector<int> ways_out;  ///< vertices the root is tried with
  };
  enum class Seen : std::uint8_t { kNot, kValid, kInvalid };

  int start_vertex() const { return map.num_vertices(); }
  int goal_vertex() const { return map.num_vertices() + 1; }
  int transport_vertex() const { return map.num_vertices() + 2; }
  Eigen::Ref<const Eigen::VectorXd> posture(int v) const {
    if (v == start_vertex()) return start;
    if (v == goal_vertex()) return goal;
    if (v == transport_vertex()) return transport;
    return map.q.col(v);
  }

  /// At the fastest: the slowest joint, and a little of all the others.
  double cost_s(const Eigen::Ref<const Eigen::VectorXd>& from,
                const Eigen::Ref<const Eigen::VectorXd>& to) {
    motion.step(from, to, step);
    return cost_of_step_s();
  }
  double cost_of_step_s() const {
    double slowest = 0.0, sum = 0.0;
    for (Eigen::Index i = 0; i < step.size(); ++i) {
      const double time_s = std::abs(step[i]) / motion.joint(i).max_rate;
      slowest = std::max(slowest, time_s);
      sum += time_s;
    }
    return slowest + kShareOfOthers * sum;
  }

  bool looks_valid(const Eigen::VectorXd& q) {
    exhausted = exhausted || checks >= settings.max_checks;
    if (exhausted) return false;
    ++checks;
    return valid.call(valid.predicate, q);
  }

  bool vertex_valid(int v) {
    if (seen[v] == Seen::kNot) seen[v] = looks_valid(posture(v)) ? Seen::kValid : Seen::kInvalid;
    return seen[v] == Seen::kValid;
  }
  bool valid_between(const Eigen::Ref<const Eigen::VectorXd>& from,
                     const Eigen::Ref<const Eigen::VectorXd>& to) {
    return motion.holds_between(from, to, settings.max_step,
                                [&](const Eigen::VectorXd& q) { return looks_valid(q); });
  }

  Result<ArmPath, ArmPathError> run();
  bool valid_along(const std::vector<Eigen::VectorXd>& postures);
  double duration_s(const std::vector<Eigen::VectorXd>& postures);
  std::vector<Eigen::VectorXd> direct_the_long_way();
  std::vector<Eigen::VectorXd> carried();
  std::vector<Eigen::VectorXd> carried_as(const Eigen::VectorXd& carry, bool long_way);
  void begin(Front& front, int root, int target);
  void push(Front& front, int vertex, int parent, double cost);
  void expand(Front& front, int v);
  int advance(Front& front);
  bool search();
  std::vector<Eigen::VectorXd> way() const;
  std::vector<Eigen::VectorXd> shortened(std::vector<Eigen::VectorXd> postures);
  void cut_short(std::vector<Eigen::VectorXd>& postures);
  ArmPath unwrapped(const std::vector<Eigen::VectorXd>& postures, int closed);

  const LimbRoadmap& map;
  ArmPathSettings settings;
  LimbMotion motion;
  Validity valid{};
  Eigen::VectorXd start, goal, step, transport;
  double boom_up = 0.0;
  std::vector<Seen> seen;  ///< by vertex
  Front from_start, from_goal;
  int meeting = -1;  ///< vertex closed by both
  std::vector<std::pair<double, int>> by_distance;
  int checks = 0, closed = 0;
  bool exhausted = false;  ///< no more checks: everything counts as invalid
};

Result<ArmPath, ArmPathError> ArmPathPlanner::Search::run() {
  checks = closed = 0;
  exhausted = false;
  std::fill(seen.begin(), seen.end(), Seen::kNot);
  if (!vertex_valid(start_vertex())) return tl::unexpected(ArmPathError::kStartInvalid);
  if (!vertex_valid(goal_vertex())) return tl::unexpected(ArmPathError::kGoalInvalid);
  if (valid_between(start, goal)) return unwrapped({start, goal}, 0);
  std::vector<Eigen::VectorXd> postures = direct_the_long_way();
  if (!postures.empty()) return unwrapped(postures, 0);
  postures = carried();
  if (!postures.empty()) return unwrapped(shortened(std::move(postures)), 0);
  if (!search()) {
    return tl::unexpected(exhausted ? ArmPathError::kTooManyChecks : ArmPathError::kNoPath);
  }
  return unwrapped(shortened(way()), closed);
}

bool ArmPathPlanner::Search::valid_along(const std::vector<Eigen::VectorXd>& postures) {
  // Corners first: they say most and cost least.
  for (std::size_t i = 1; i + 1 < postures.size(); ++i) {
    if (!looks_valid(postures[i])) return false;
  }
  for (std::size_t i = 1; i < postures.size(); ++i) {
    if (!valid_between(postures[i - 1], postures[i])) return false;
  }
  return true;
}

double ArmPathPlanner::Search::duration_s(const std::vector<Eigen::VectorXd>& postures) {
  double sum_s = 0.0;
  for (std::size_t i = 1; i < postures.size(); ++i) sum_s += cost_s(postures[i - 1], postures[i]);
  return sum_s;
}

/// The cabin the other way round, by way of a posture half-way; nothing if that is not valid.
std::vector<Eigen::VectorXd> ArmPathPlanner::Search::direct_the_long_way() {
  if (!motion.joint(kCabin).continuous) return {};
  motion.step(start, goal, step);
  if (std::abs(step[kCabin]) < kNoTurn_rad) return {};
  Eigen::VectorXd middle = start + 0.5 * step;
  middle[kCabin] -= std::copysign(std::numbers::pi, step[kCabin]);
  std::vector<Eigen::VectorXd> postures{start, middle, goal};
  if (!valid_along(postures)) postures.clear();
  return postures;
}

/// What an operator does: into a posture that clears everything, slew, and out of it. The quickest
/// valid way of a few such postures; else by the first of the roadmap's vertices that serves, in
/// their order, nearest to the default posture first. Nothing if none does.
std::vector<Eigen::VectorXd> ArmPathPlanner::Search::carried() {
  std::vector<Eigen::VectorXd> carries{transport};
  for (const Eigen::VectorXd* posture : {&transport, &start, &goal}) {
    carries.push_back(*posture);
    carries.back()[kBoom] = boom_up;
  }
  std::vector<std::vector<Eigen::VectorXd>> ways;
  for (const Eigen::VectorXd& carry : carries) {
    for (const bool long_way : {false, true}) {
      std::vector<Eigen::VectorXd> way = carried_as(carry, long_way);
      if (!way.empty()) ways.push_back(std::move(way));
    }
  }
  std::stable_sort(ways.begin(), ways.end(),
                   [&](const auto& a, const auto& b) { return duration_s(a) < duration_s(b); });
  for (std::vector<Eigen::VectorXd>& way : ways) {
    if (valid_along(way)) return std::move(way);
  }
  const int enough = checks + (settings.max_checks - checks) / kShareForCarrying;
  for (int v = 0; v < map.num_vertices() && checks < enough; ++v) {
    for (const bool long_way : {false, true}) {
      std::vector<Eigen::VectorXd> way = carried_as(map.q.col(v), long_way);
      if (!way.empty() && valid_along(way)) return way;
    }
  }
  return {};
}

std::vector<Eigen::VectorXd> ArmPathPlanner::Search::carried_as(const Eigen::VectorXd& carry,
                                                                bool long_way) {
  motion.step(start, goal, step);
  const double turn_rad = step[kCabin];
  Eigen::VectorXd up = carry, there = carry;
  up[kCabin] = start[kCabin];
  there[kCabin] = goal[kCabin];
  if (!long_way) return {start, up, there, goal};
  if (!motion.joint(kCabin).continuous || std::abs(turn_rad) < kNoTurn_rad) return {};
  Eigen::VectorXd half_way = up;
  half_way[kCabin] += 0.5 * turn_rad - std::copysign(std::numbers::pi, turn_rad);
  return {start, up, half_way, there, goal};
}

void ArmPathPlanner::Search::begin(Front& front, int root, int target) {
  front.root = root;
  front.target = target;
  front.queue.clear();
  front.parent.assign(seen.size(), -1);
  front.cost_s.assign(seen.size(), 0.0);
  front.ways_out.clear();
  const int n = map.num_vertices();
  const int count = std::min(settings.nearest_vertices, n);
  for (int v = 0; v < n; ++v) by_distance[v] = {cost_s(posture(root), map.q.col(v)), v};
  std::partial_sort(by_distance.begin(), by_distance.begin() + count, by_distance.end());
  for (int i = 0; i < count; ++i) front.ways_out.push_back(by_distance[i].second);
  front.parent[root] = root;
  expand(front, root);
}

void ArmPathPlanner::Search::push(Front& front, int vertex, int parent, double cost) {
  if (front.parent[vertex] >= 0 || seen[vertex] == Seen::kInvalid) return;
  const double left_s = cost_s(posture(vertex), posture(front.target));
  front.queue.push_back({cost + settings.heuristic_weight * left_s, cost, vertex, parent});
  std::push_heap(front.queue.begin(), front.queue.end(), std::greater<>());
}

void ArmPathPlanner::Search::expand(Front& front, int v) {
  const auto reach = [&](int next) {
    push(front, next, v, front.cost_s[v] + cost_s(posture(v), posture(next)));
  };
  if (v == front.root) {
    for (const int next : front.ways_out) reach(next);
    return;
  }
  for (int i = map.first_edge[v]; i < map.first_edge[v + 1]; ++i) reach(map.neighbours[i]);
  for (int i = map.first_joint_neighbour[v]; i < map.first_joint_neighbour[v + 1]; ++i) {
    reach(map.joint_neighbours[i]);
  }
}

/// Closes the front's next vertex, whose edge is looked at now that it is taken (lazy A*).
///   returns  the vertex, -1 if there is none left
int ArmPathPlanner::Search::advance(Front& front) {
  while (!front.queue.empty() && !exhausted) {
    const Candidate candidate = front.queue.front();
    std::pop_heap(front.queue.begin(), front.queue.end(), std::greater<>());
    front.queue.pop_back();
    const int v = candidate.vertex;
    if (front.parent[v] >= 0 || !vertex_valid(v)) continue;
    if (!valid_between(posture(candidate.parent), posture(v))) continue;
    front.parent[v] = candidate.parent;
    front.cost_s[v] = candidate.cost_s;
    ++closed;
    expand(front, v);
    return v;
  }
  return -1;
}

/// From both ends in turns until they meet, both heading for the transport posture if it is valid:
/// what is in the way is passed with the arm drawn in, and each finds its own way out of a pocket.
bool ArmPathPlanner::Search::search() {
  const bool drawn_in = vertex_valid(transport_vertex());
  begin(from_start, start_vertex(), drawn_in ? transport_vertex() : goal_vertex());
  begin(from_goal, goal_vertex(), drawn_in ? transport_vertex() : start_vertex());
  for (bool turn = true;; turn = !turn) {
    Front& front = turn ? from_start : from_goal;
    const Front& other = turn ? from_goal : from_start;
    meeting = advance(front);
    if (meeting < 0) return false;
    if (other.parent[meeting] >= 0) return true;
  }
}

std::vector<Eigen::VectorXd> ArmPathPlanner::Search::way() const {
  std::vector<Eigen::VectorXd> postures{posture(meeting)};
  for (int v = meeting; v != from_start.root; postures.emplace_back(posture(v))) {
    v = from_start.parent[v];
  }
  std::reverse(postures.begin(), postures.end());
  for (int v = meeting; v != from_goal.root; postures.emplace_back(posture(v))) {
    v = from_goal.parent[v];
  }
  return postures;
}

/// Cut at its postures, then at the middles of what lies between them: corners are blended.
std::vector<Eigen::VectorXd> ArmPathPlanner::Search::shortened(
    std::vector<Eigen::VectorXd> postures) {
  cut_short(postures);
  std::vector<Eigen::VectorXd> finer{postures.front()};
  for (std::size_t i = 1; i < postures.size(); ++i) {
    motion.step(postures[i - 1], postures[i], step);
    finer.emplace_back(postures[i - 1] + 0.5 * step);
    finer.push_back(postures[i]);
  }
  cut_short(finer);
  return finer;
}

/// From every posture on to the farthest that can be reached straight and sooner.
void ArmPathPlanner::Search::cut_short(std::vector<Eigen::VectorXd>& postures) {
  for (std::size_t from = 0; from + 2 < postures.size(); ++from) {
    double along_s = 0.0;
    std::vector<double> arrival_s(postures.size(), 0.0);
    for (std::size_t to = from + 1; to < postures.size(); ++to) {
      arrival_s[to] = along_s += cost_s(postures[to - 1], postures[to]);
    }
    for (std::size_t to = postures.size() - 1; to > from + 1; --to) {
      if (cost_s(postures[from], postures[to]) >= arrival_s[to]) continue;
      if (!valid_between(postures[from], postures[to])) continue;
      postures.erase(postures.begin() + static_cast<std::ptrdiff_t>(from) + 1,
                     postures.begin() + static_cast<std::ptrdiff_t>(to));
      break;
    }
  }
}

ArmPath ArmPathPlanner::Search::unwrapped(const std::vector<Eigen::VectorXd>& postures,
                                          int vertices_closed) {
  ArmPath path;
  path.checks = checks;
  path.vertices = vertices_closed;
  path.postures.push_back(postures.front());
  for (std::size_t i = 1; i < postures.size(); ++i) {
    motion.step(path.postures.back(), postures[i], step);
    path.postures.push_back(path.postures.back() + step);
    double slowest_s = 0.0;
    for (Eigen::Index j = 0; j < step.size(); ++j) {
      slowest_s = std::max(slowest_s, std::abs(step[j]) / motion.joint(j).max_rate);
    }
    path.duration_s += slowest_s;
  }
  return path;
}

ArmPathPlanner::ArmPathPlanner(const MachineModel& machine, const LimbRoadmap& arm,
                               const ArmPathSettings& settings)
    : search_(std::make_unique<Search>(machine, arm, settings)) {}
ArmPathPlanner::~ArmPathPlanner() = default;
ArmPathPlanner::ArmPathPlanner(ArmPathPlanner&&) noexcept = default;
ArmPathPlanner& ArmPathPlanner::operator=(ArmPathPlanner&&) noexcept = default;

Result<ArmPath, ArmPathError> ArmPathPlanner::plan_with(const Eigen::VectorXd& start,
                                                        const Eigen::VectorXd& goal,
                                                        const Validity& valid) {
  WEX_EXPECTS(start.size() == search_->motion.size() && goal.size() == start.size());
  search_->start = start;
  search_->goal = goal;
  search_->valid = valid;
  return search_->run();
}

}  // namespace wex
