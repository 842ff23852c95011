#pragma once

#include <memory>
#include <string>

#include "hw_interface/electronics/plant.hpp"
#include "hw_interface/joint_loop.hpp"
#include "models/excavator/machine_model.hpp"
#include "models/terrain/terrain_map.hpp"
#include "models/types/result.hpp"

namespace wex {

struct SimulationSettings {
  double timestep_s = 0.002;
  double control_period_s = 0.01;  ///< 100 Hz joint loop
  double ground_friction = 0.9;
  double settle_time_s = 2.0;  ///< simulated before the first read, machine holding
  bool load_balance = true;    ///< slow correction of the diagonal wheel loads
};

/// The truth about contacts and motion, for reports only: no controller may read it.
struct GroundTruth {
  double t_s = 0.0;
  BaseCoordinates base = BaseCoordinates::Zero();
  double base_vertical_rate_m_s = 0.0;
  std::array<double, kNumWheels> wheel_load_n{};         ///< vertical, mean over the last 10 ms
  std::array<double, kNumWheels> wheel_penetration_m{};  ///< disc below the ground, > 0 is into it
  std::array<double, kNumWheels> tyre_deflection_m{};
  std::array<double, kNumWheels>
      side_slip_m{};  ///< integral of |patch velocity along the axle| while loaded
  std::array<double, kNumWheels> wheel_travel_m{};
  std::array<double, kNumWheels> airborne_s{};  ///< time without load
  double stability_margin_m = 0.0;              ///< CoM to the nearest edge of the loaded wheels
  bool body_contact = false;  ///< anything but wheels and bucket has touched the ground so far
};

/// The machine's hydraulics and mechanics on a terrain, without any controller: valves with dead
/// band, dead time and lag, oil columns with relief valves, MuJoCo physics. In front of it stands
/// the host's joint loop (SimulatedMachine) or the electronics of a machine on the bus
/// (can::Plant). One period per call; after construction these calls are noexcept and
/// allocation-free.
class SimulatedPlant final : public can::Plant {
 public:
  /// Places the machine in posture q (num_coordinates, local world frame; tyres at static sag) at
  /// time 0; it has not settled yet. The control period is a multiple of the time step (contract).
  ///   errors  kInternal with MuJoCo's message
  [[nodiscard]] static Result<std::unique_ptr<SimulatedPlant>> create(
      const MachineModel& machine, const TerrainMap& terrain, const Eigen::VectorXd& q,
      const SimulationSettings& settings = {});
  ~SimulatedPlant() override;

  /// One control period with the valves and drives as commanded.
  void tick(const ActuatorCommand& command) noexcept;
  /// The same from the electronics; valves shut within 50 ms where motion is not released.
  void act(const can::PlantInput& input) noexcept override;
  /// Lets it stand for settings.settle_time_s with shut valves and braked wheels; time is then 0.
  ///   errors  kInternal: the simulation broke up
  [[nodiscard]] Result<void> settle();
  /// Time 0, and the truth starts anew.
  void restart_clock() noexcept;

  [[nodiscard]] can::PlantState sense() noexcept override;
  [[nodiscard]] JointMeasurement measure() const noexcept;
  /// Yaw unwrapped against the last call of sense().
  [[nodiscard]] BaseCoordinates base() const noexcept;
  [[nodiscard]] double time_s() const noexcept;
  /// The state is not finite any more; time goes on, nothing else does.
  [[nodiscard]] bool broken() const noexcept;

  [[nodiscard]] GroundTruth ground_truth() const;
  /// Values of every scalar joint of model.xml in its order (passive and tyres included).
  [[nodiscard]] Eigen::VectorXd scalar_joint_positions() const;
  /// Writes a PNG of the scene from behind and above the machine (off screen).
  [[nodiscard]] Result<void> render(const std::string& png_file, int width_px = 960,
                                    int height_px = 600);

 private:
  struct Impl;
  explicit SimulatedPlant(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace wex
