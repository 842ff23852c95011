#pragma once

#include <cmath>
#include <functional>

#include "models/excavator/machine_model.hpp"
#include "models/terrain/terrain_map.hpp"

namespace wex {

/// A map of 20 x 16 m around the origin, cells of 0.1 m.
inline TerrainMap ground_of(const std::function<double(double x_m, double y_m)>& height_m) {
  Grid grid;
  grid.size_x = 201;
  grid.size_y = 161;
  grid.origin_m = {-10.0, -8.0};
  for (int j = 0; j < grid.size_y; ++j) {
    for (int i = 0; i < grid.size_x; ++i) {
      grid.values.push_back(static_cast<float>(
          height_m(grid.origin_m.x() + i * grid.cell_m, grid.origin_m.y() + j * grid.cell_m)));
    }
  }
  return TerrainMap::build(std::move(grid)).value();
}

inline TerrainMap flat_ground() {
  return ground_of([](double, double) { return 0.0; });
}

/// Default base height above a plane that rises by slope_x and slope_y (tangents), the base along
/// the plane, everything else in transport posture.
inline Eigen::VectorXd standing_on_plane(const MachineModel& machine, double slope_x = 0.0,
                                         double slope_y = 0.0, double x_m = 0.0) {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(machine.num_coordinates());
  q.tail(machine.num_joints()) = machine.transport_posture();
  const Eigen::Vector3d normal = Eigen::Vector3d(-slope_x, -slope_y, 1.0).normalized();
  Eigen::Isometry3d T_world_base = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d forward = Eigen::Vector3d(1.0, 0.0, slope_x).normalized();
  T_world_base.linear() << forward, normal.cross(forward), normal;
  T_world_base.translation() =
      Eigen::Vector3d(x_m, 0.0, slope_x * x_m) + machine.default_base_height_m * normal;
  q.head<kNumBaseCoordinates>() = base_coordinates_from(T_world_base);
  return q;
}

}  // namespace wex
