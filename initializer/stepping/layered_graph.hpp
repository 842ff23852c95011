#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <unordered_set>
#include <vector>

#include "initializer/stepping/path_layers.hpp"

namespace wex {

/// Which limbs carry, without saying which bucket point.
struct SupportClass {
  std::uint8_t lifted = 0;
  int bucket_side = -1;  ///< 0: bucket ahead, 1: behind, -1: in the air
};
/// Four wheels; one wheel lifted, the arm as counterweight; a pair lifted, the bucket down.
inline constexpr std::array<SupportClass, 7> kSupportClasses{{{0b0000, -1},
                                                              {0b0001, -1},
                                                              {0b0010, -1},
                                                              {0b0100, -1},
                                                              {0b1000, -1},
                                                              {0b0011, 0},
                                                              {0b1100, 1}}};
inline constexpr std::size_t kNumSupportClasses = kSupportClasses.size();

/// Small costs of the graph, in metres of driving: they break ties towards quiet motion.
struct QuietCosts {
  static constexpr double kHeightChange = 0.15, kPitchChange = 0.1;  ///< per cell
  static constexpr double kOffHeight = 0.2;  ///< per metre off the nominal height and metre driven
  static constexpr double kOffPitch = 0.05;  ///< per cell off the nominal pitch and metre driven
};

/// One state of an answer.
struct GraphState {
  std::size_t layer = 0;
  int z = 0, pitch = 0;  ///< grid cells
  std::size_t support_class = 0;
  int bucket = -1;  ///< index into PathGrid::bucket_points
};

/// A* over layer x height x pitch x support. Poses are judged when the search takes them up, not
/// before, with clearances inflated; the answer's edges are checked at poses in between with the
/// plain ones, bad edges are banned and the search repeated. The heuristic is the cost of the same
/// graph by the legs alone: without stability, without bucket points.
class LayeredGraph {
 public:
  LayeredGraph(const StanceCheck& check, const PathGrid& grid, const PlanSettings& plan,
               const CertificateSettings& settings);

  struct Answer {
    std::vector<GraphState> states;  ///< empty: none
    double cost = 0.0;
    std::size_t furthest_layer = 0;  ///< reached on whatever support
    bool hopeless = false;           ///< legs alone cannot get past that layer
    int num_stances = 0, num_expanded = 0, num_rounds = 0;
  };
  /// From the first layer to the last.
  ///   from_nominal  start anywhere near the nominal base; else at cell (0, 0)
  ///   or_furthest   instead of no answer: up to the furthest state on four wheels
  [[nodiscard]] Answer search(bool from_nominal, bool or_furthest);

  /// Never again this state on its support, or its bucket point with these wheels lifted.
  void ban(const GraphState& state, bool bucket);

  /// Why nothing goes beyond a layer, as part of a sentence.
  [[nodiscard]] std::string why_not_beyond(std::size_t layer);

 private:
  static constexpr float kNever = std::numeric_limits<float>::infinity();
  static constexpr float kTolerance = 1e-4F;
  struct Node {
    float cost;
    std::int32_t parent;
    std::int32_t record;
    std::int16_t slot;
    std::int8_t feasible;  // -1: not judged yet
    bool closed;
  };
  struct Record {
    std::int32_t layer, pose;
    std::int16_t z, pitch;
    bool judged;
    std::uint16_t banned;                    // bit c: support class c
    std::array<std::int32_t, 3> first_node;  // without bucket; bucket ahead; behind
    Stance stance;
  };
  struct Entry {
    float estimate, cost;
    std::int32_t node, parent;
  };

  struct Demand {
    StanceClearances clearances;
    double margin_m = 0.0;
  };
  /// Where the path begins and ends the pose is not the graph's to choose.
  [[nodiscard]] const Demand& demand_at(std::int32_t layer) const noexcept {
    const bool end = layer == 0 || static_cast<std::size_t>(layer) == last_layer_;
    return end ? plain_ : inflated_;
  }
  [[nodiscard]] double margin_m(const BaseFrame& base, const Stance& stance,
                                const SupportClass& support, int bucket, double enough_m) const;

  [[nodiscard]] std::int32_t record_at(std::size_t layer, int z, int pitch);  // -1: off the grid
  [[nodiscard]] std::int32_t node_at(std::int32_t record, std::size_t support_class, int bucket);
  [[nodiscard]] std::size_t class_of(const Node& node) const;
  [[nodiscard]] int bucket_of(const Node& node) const;
  const Stance& stance_of(std::int32_t record);
  [[nodiscard]] BaseFrame frame_of(const Record& record) const;
  [[nodiscard]] bool feasible(std::int32_t node);
  [[nodiscard]] bool is_banned(const Node& node) const;
  [[nodiscard]] bool stretched_feasible(std::int32_t record, std::size_t support_class, int bucket);
  void estimate_costs(bool reach_the_end);
  void estimate_layer(std::size_t layer);
  [[nodiscard]] std::int32_t run(bool from_nominal, bool or_furthest, Answer& answer);
  void push(std::int32_t node, float cost, std::int32_t parent, bool support_change);
  void expand(std::int32_t node);
  void push_start(bool from_nominal);
  [[nodiscard]] std::uint64_t edge_between(std::int32_t from, std::int32_t to) const;
  int ban_tyres_off_the_ground(std::int32_t end);  ///< of an answer; how many states
  [[nodiscard]] bool edge_is_good(const Node& from, const Node& to) const;
  /// Of a metre on four wheels, beside the metre itself.
  [[nodiscard]] double off_nominal_cost(const PathLayer& layer, int z, int pitch) const;

  const StanceCheck* check_;
  const PathGrid* grid_;
  CertificateSettings settings_;
  Demand plain_, inflated_;

  std::vector<std::int32_t> record_of_pose_;
  std::vector<Record> records_;
  std::vector<Node> nodes_;
  std::vector<Entry> queue_;
  std::unordered_set<std::uint64_t> banned_;
  std::vector<std::pair<std::size_t, int>> banned_buckets_;       // support class, bucket point
  std::vector<std::array<float, kNumSupportClasses>> rest_cost_;  // per pose and class
  std::size_t dead_layer_ = 0;  // the last from which no support leads to the end
  std::size_t last_layer_ = 0;
  int num_stances_ = 0, num_expanded_ = 0;
};

}  // namespace wex
