#include "mpc/nlp/driving_constraints.hpp"

#include "mpc/nlp/joint_rates.hpp"
#include "mpc/nlp/rolling_slip.hpp"
#include "mpc/nlp/static_stability.hpp"
#include "mpc/nlp/wheel_height.hpp"
#include "mpc/nlp/wheel_speed.hpp"
#include "mpc/nlp/wheel_traversability.hpp"

namespace wex {

void add_driving_constraints(TrajectorySetup& setup, const TerrainMap& terrain,
                             const DrivingConstraintSettings& settings) {
  const MachineModel& machine = *setup.machine;
  const NlpLayout& layout = setup.layout;
  const double dt_s = setup.dt_s, fraction = settings.rate_fraction;
  setup.node_constraints = {
      {std::make_shared<WheelHeight>(terrain, machine, layout, settings.height_bias_m),
       settings.height},
      {std::make_shared<StaticStability>(layout, settings.min_stability_margin_m),
       settings.stability},
      {std::make_shared<WheelTraversability>(terrain, machine, layout,
                                             settings.min_signed_distance_m),
       settings.traversability}};
  setup.interval_constraints = {std::make_shared<RollingSlip>(machine, layout, dt_s),
                                std::make_shared<WheelSpeed>(machine, layout, dt_s, fraction),
                                std::make_shared<JointRates>(machine, layout, dt_s, fraction)};
}

}  // namespace wex
