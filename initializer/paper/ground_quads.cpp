#include "initializer/paper/ground_quads.hpp"

#include <cstddef>
#include <limits>

namespace wex {

GroundQuads::GroundQuads(const Grid& grid)
    : stride_(grid.size_x + 1),
      max_u_(static_cast<float>(grid.size_x)),
      max_v_(static_cast<float>(grid.size_y)),
      x_m_(grid.origin_m.x() - grid.cell_m),
      y_m_(grid.origin_m.y() - grid.cell_m),
      per_m_(1.0 / grid.cell_m) {
  const auto sample = [&](int i, int j) {
    const bool on_map = i >= 0 && j >= 0 && i < grid.size_x && j < grid.size_y;
    return on_map ? grid.at(i, j) : std::numeric_limits<float>::quiet_NaN();
  };
  quads_.reserve(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(grid.size_y + 1));
  for (int j = -1; j < grid.size_y; ++j) {
    for (int i = -1; i < grid.size_x; ++i) {
      quads_.push_back({{sample(i, j), sample(i + 1, j), sample(i, j + 1), sample(i + 1, j + 1)}});
    }
  }
}

CellPose::CellPose(const Eigen::Isometry3d& T_world_base, const GroundQuads& ground) noexcept {
  const CellPoint origin = ground.cells(T_world_base.translation().head<2>());
  const Eigen::Matrix3d& R = T_world_base.linear();
  const Eigen::Matrix<float, 2, 3> in_cells = (ground.cells_per_m() * R.topRows<2>()).cast<float>();
  u = origin.u;
  v = origin.v;
  ux = in_cells(0, 0);
  uy = in_cells(0, 1);
  uz = in_cells(0, 2);
  vx = in_cells(1, 0);
  vy = in_cells(1, 1);
  vz = in_cells(1, 2);
  h = static_cast<float>(T_world_base.translation().z());
  hx = static_cast<float>(R(2, 0));
  hy = static_cast<float>(R(2, 1));
  hz = static_cast<float>(R(2, 2));
}

}  // namespace wex
