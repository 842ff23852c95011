#include <algorithm>
#include <cmath>

#include "initializer/stepping/layered_graph.hpp"

// What is left to pay from every pose and class: the layered graph's heuristic.

namespace wex {

// Cost to go from each pose and class by what legs allow. Where four wheels stand in the nominal
// pose, every pose and class is taken to be possible: the cost is a lower bound all the same.
void LayeredGraph::estimate_costs(bool reach_the_end) {
  std::array<float, kNumSupportClasses> start;
  start.fill(reach_the_end ? kNever : 0.0F);
  rest_cost_.assign(record_of_pose_.size(), start);
  if (!reach_the_end) return;
  for (std::size_t k = last_layer_ + 1; k-- > 0;) {
    estimate_layer(k);
    const PathLayer& layer = grid_->layers[k];
    const auto first = rest_cost_.begin() + static_cast<std::ptrdiff_t>(layer.first_pose);
    const bool alive = std::any_of(
        first, first + static_cast<std::ptrdiff_t>(layer.num_poses()),
        [](const auto& costs) { return *std::min_element(costs.begin(), costs.end()) < kNever; });
    if (!alive) {
      dead_layer_ = k;
      return;
    }
  }
}

void LayeredGraph::estimate_layer(std::size_t k) {
  const PathLayer& layer = grid_->layers[k];
  const std::int32_t nominal = record_at(k, layer.nominal_z, layer.nominal_pitch);
  const bool open = nominal >= 0 && stance_of(nominal).allows(0);
  std::array<float, kNumSupportClasses>* const costs = rest_cost_.data() + layer.first_pose;
  const int num_pitch = layer.num_pitch;
  const auto allowed = [&](int i, int j) {
    std::array<bool, kNumSupportClasses> allowed;
    for (std::size_t c = 0; c < kNumSupportClasses; ++c) {
      const int side = kSupportClasses[c].bucket_side;
      allowed[c] = (side < 0 || !layer.buckets[static_cast<std::size_t>(side)].empty()) &&
                   (open || stance_of(record_at(k, layer.first_z + i, layer.first_pitch + j))
                                .allows(kSupportClasses[c].lifted));
    }
    return allowed;
  };
  std::vector<std::array<bool, kNumSupportClasses>> possible(layer.num_poses());
  for (int i = 0; i < layer.num_z; ++i) {
    for (int j = 0; j < num_pitch; ++j) {
      const auto pose = static_cast<std::size_t>(i * num_pitch + j);
      possible[pose] = allowed(i, j);
      if (k == last_layer_) {
        if (possible[pose][0]) costs[pose][0] = 0.0F;
        continue;
      }
      const PathLayer& next = grid_->layers[k + 1];
      const double off = off_nominal_cost(layer, layer.first_z + i, layer.first_pitch + j);
      for (int dz = -1; dz <= 1; ++dz) {
        for (int dp = -1; dp <= 1; ++dp) {
          const int z = layer.first_z + i + dz - next.first_z;
          const int p = layer.first_pitch + j + dp - next.first_pitch;
          if (z < 0 || p < 0 || z >= next.num_z || p >= next.num_pitch) continue;
          const auto& rest =
              rest_cost_[next.first_pose + static_cast<std::size_t>(z * next.num_pitch + p)];
          const double change =
              QuietCosts::kHeightChange * std::abs(dz) + QuietCosts::kPitchChange * std::abs(dp);
          for (std::size_t c = 0; c < kNumSupportClasses; ++c) {
            if (!possible[pose][c]) continue;
            const double share = c == 0 ? 1.0 : 1.0 + settings_.stepping_share;
            costs[pose][c] = std::min(
                costs[pose][c], rest[c] + static_cast<float>(next.step_m * (share + off) + change));
          }
        }
      }
    }
  }
  // Within the layer: changes of support and of pose, until nothing gets cheaper.
  const auto relax = [&](std::size_t to, std::size_t from, double cost) {
    bool better = false;
    for (std::size_t c = 0; c < kNumSupportClasses; ++c) {
      const float through = costs[from][c] + static_cast<float>(cost);
      if (!possible[to][c] || through >= costs[to][c] - kTolerance) continue;
      costs[to][c] = through;
      better = true;
    }
    return better;
  };
  for (bool better = true; better;) {
    better = false;
    for (std::size_t pose = 0; pose < layer.num_poses(); ++pose) {
      auto& cost = costs[pose];
      if (!possible[pose][0]) continue;
      for (std::size_t c = 1; c < kNumSupportClasses; ++c) {
        if (!possible[pose][c]) continue;
        const auto lift = static_cast<float>(
            kSupportClasses[c].bucket_side >= 0 ? settings_.bucket_cost_m : settings_.lift_cost_m);
        cost[0] = std::min(cost[0], cost[c] + lift);
      }
      for (std::size_t c = 1; c < kNumSupportClasses; ++c) {
        if (!possible[pose][c]) continue;
        cost[c] = std::min(cost[c], cost[0] + static_cast<float>(settings_.lift_cost_m));
      }
    }
    const auto at = [&](int i, int j) { return static_cast<std::size_t>(i * num_pitch + j); };
    for (int i = 0; i < layer.num_z; ++i) {
      for (int j = 0; j < num_pitch; ++j) {
        if (i > 0) better |= relax(at(i, j), at(i - 1, j), QuietCosts::kHeightChange);
        if (j > 0) better |= relax(at(i, j), at(i, j - 1), QuietCosts::kPitchChange);
        // A diagonal move costs as much as two straight ones, but needs no pose in between.
        if (i > 0 && j > 0) {
          better |= relax(at(i, j), at(i - 1, j - 1),
                          QuietCosts::kHeightChange + QuietCosts::kPitchChange);
          better |= relax(at(i, j - 1), at(i - 1, j),
                          QuietCosts::kHeightChange + QuietCosts::kPitchChange);
        }
      }
    }
    for (int i = layer.num_z; i-- > 0;) {
      for (int j = num_pitch; j-- > 0;) {
        if (i + 1 < layer.num_z) better |= relax(at(i, j), at(i + 1, j), QuietCosts::kHeightChange);
        if (j + 1 < num_pitch) better |= relax(at(i, j), at(i, j + 1), QuietCosts::kPitchChange);
        if (i + 1 < layer.num_z && j + 1 < num_pitch) {
          better |= relax(at(i, j), at(i + 1, j + 1),
                          QuietCosts::kHeightChange + QuietCosts::kPitchChange);
          better |= relax(at(i, j + 1), at(i + 1, j),
                          QuietCosts::kHeightChange + QuietCosts::kPitchChange);
        }
      }
    }
  }
}

double LayeredGraph::off_nominal_cost(const PathLayer& layer, int z, int pitch) const {
  return QuietCosts::kOffHeight * grid_->z_step_m * std::abs(z - layer.nominal_z) +
         QuietCosts::kOffPitch * std::abs(pitch - layer.nominal_pitch);
}

}  // namespace wex
