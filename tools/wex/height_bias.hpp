#pragma once

#include <array>

#include "models/excavator/machine_model.hpp"
#include "models/terrain/terrain_map.hpp"

namespace wex::app {

/// On-line estimate of how far each wheel centre really is above where the planners' model puts it
/// (tyre sag under the present load, map error): without it the measured state is infeasible for
/// the receding horizon. A first-order low-pass, started at the first sample.
///
/// The four heights lie in one plane. What the base rides higher or more tilted than planned is
/// measured and stays; warp, one diagonal of wheels against the other, is where the hips were told
/// to be. Taken for ground it would be commanded again, drift without bound and bend the machine.
/// The ground's own warp is the load balance's to find.
class HeightBias {
 public:
  HeightBias(const TerrainMap& terrain, const MachineModel& machine, double time_constant_s = 0.5);

  /// Takes the coordinates measured at t_s (not before the last one's: contract).
  void update(double t_s, const Eigen::VectorXd& q);
  [[nodiscard]] const std::array<double, kNumWheels>& value_m() const noexcept { return bias_m_; }

 private:
  const TerrainMap* terrain_;
  const MachineModel* machine_;
  double time_constant_s_;
  KinematicTree::Workspace workspace_;
  std::array<double, kNumWheels> low_passed_m_{}, bias_m_{};
  std::optional<double> last_t_s_;
};

}  // namespace wex::app
