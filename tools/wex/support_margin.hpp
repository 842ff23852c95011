#pragma once

#include "models/excavator/machine_model.hpp"

namespace wex::app {

/// Static stability of a posture for reports: smallest distance from the vertical projection of the
/// centre of mass to an edge of the convex hull of the limbs in contact, > 0 inside [m].
///   q         num_coordinates entries (contract)
///   contacts  limbs that count; fewer than three support nothing: -infinity
[[nodiscard]] double support_margin_m(const MachineModel& machine, const Eigen::VectorXd& q,
                                      const ContactFlags& contacts);

}  // namespace wex::app
