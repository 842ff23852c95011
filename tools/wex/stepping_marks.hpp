#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "models/excavator/machine_model.hpp"
#include "models/types/plan.hpp"

namespace wex::app {

/// A piece of a way seen from above, local xy.
struct TrackPiece {
  bool lifted = false;
  std::vector<Eigen::Vector2d> points;
};

/// Where a stepping plan goes on which limbs, for a picture from above.
struct SteppingMarks {
  std::vector<TrackPiece> base;  ///< lifted: at least one wheel is
  std::array<std::vector<TrackPiece>, kNumWheels> wheels;
  std::vector<Eigen::Vector2d> lift_offs, touch_downs;  ///< of wheels
  std::vector<Eigen::Vector2d> bucket_points;           ///< one for each time it is put down
};

[[nodiscard]] SteppingMarks stepping_marks(const MachineModel& machine,
                                           const std::vector<WholeBodyNode>& nodes);

}  // namespace wex::app
