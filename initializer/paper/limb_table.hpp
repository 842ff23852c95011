#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "initializer/paper/ground_quads.hpp"
#include "initializer/roadmap/limb_roadmap.hpp"

namespace wex {

/// Vertices of a limb's roadmap as columns of floats in the roadmap's order, nearest to the default
/// posture first, for loops over blocks of eight. The last block is filled up with points so high
/// that nothing is near them; their moments are never asked for.
class LimbTable {
 public:
  static constexpr int kBlock = 8;

  LimbTable() = default;
  ///   wanted  which vertices; all if empty
  explicit LimbTable(const LimbRoadmap& map, const std::function<bool(int vertex)>& wanted = {});

  [[nodiscard]] int size() const noexcept { return static_cast<int>(vertex_.size()); }
  [[nodiscard]] int num_blocks() const noexcept { return (size() + kBlock - 1) / kBlock; }
  /// Row of the roadmap.
  [[nodiscard]] int vertex(int row) const noexcept {
    return vertex_[static_cast<std::size_t>(row)];
  }
  [[nodiscard]] CellPoint cells(const CellPose& pose, int row) const noexcept {
    return pose.cells(x_[at(row)], y_[at(row)], z_[at(row)]);
  }
  [[nodiscard]] float height_m(const CellPose& pose, int row) const noexcept {
    return pose.height_m(x_[at(row)], y_[at(row)], z_[at(row)]);
  }

  /// Heights of a block's contact points above the ground, less `offset_m`; NaN where unknown.
  void gaps_m(const CellPose& pose, const GroundQuads& ground, float offset_m, int block,
              float* gap_m) const noexcept {
    const float* x = x_.data() + block * kBlock;
    const float* y = y_.data() + block * kBlock;
    const float* z = z_.data() + block * kBlock;
    const CellPose here = pose;
    const GroundQuads::View quads = ground.view();
    for (int i = 0; i < kBlock; ++i) {
      const CellPoint p = here.cells(x[i], y[i], z[i]);
      gap_m[i] = here.height_m(x[i], y[i], z[i]) - offset_m - quads.at(p.u, p.v);
    }
  }

  /// Columns of the moments [kg m], padded like the points.
  [[nodiscard]] const float* moment_x() const noexcept { return moment_x_.data(); }
  [[nodiscard]] const float* moment_y() const noexcept { return moment_y_.data(); }
  [[nodiscard]] const float* moment_z() const noexcept { return moment_z_.data(); }
  [[nodiscard]] Eigen::Vector3d moment_base(int row) const noexcept {
    return {moment_x_[at(row)], moment_y_[at(row)], moment_z_[at(row)]};
  }
  [[nodiscard]] Eigen::Vector3d p_base_contact(int row) const noexcept {
    return {x_[at(row)], y_[at(row)], z_[at(row)]};
  }

 private:
  static std::size_t at(int row) noexcept { return static_cast<std::size_t>(row); }
  std::vector<int> vertex_;
  std::vector<float> x_, y_, z_, moment_x_, moment_y_, moment_z_;
};

}  // namespace wex
