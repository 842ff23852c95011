#pragma once

#include <memory>

#include "hw_interface/machine_io.hpp"
#include "hw_interface/mujoco/simulated_plant.hpp"
#include "models/excavator/machine_model.hpp"
#include "models/terrain/terrain_map.hpp"
#include "models/types/result.hpp"

namespace wex {

/// The MuJoCo machine on a terrain: default implementation of MachineIo, lock step (wait_until
/// simulates). Valve dead time and lag, dead band with its inverse, shared pump flow, wheel drives
/// with stall stop and brake latch as in the decisions. Position targets are taken as they are at
/// every tick of the joint loop, not extrapolated: write at 100 Hz, or let the rates carry.
/// Hip flexions are read and commanded without what the load balance adds to them.
class SimulatedMachine final : public MachineIo {
 public:
  /// Places the machine in posture q (num_coordinates, local world frame; tyres at static sag) and
  /// lets it settle; machine time is then 0. The control period is a multiple of the time step
  /// (contract).
  ///   errors  kInternal with MuJoCo's message, or if the simulation breaks up while settling
  [[nodiscard]] static Result<std::unique_ptr<SimulatedMachine>> create(
      const MachineModel& machine, const TerrainMap& terrain, const Eigen::VectorXd& q,
      const SimulationSettings& settings = {});
  ~SimulatedMachine() override;

  MachineState read() noexcept override;
  WriteOutcome write(const JointCommand& command) noexcept override;
  void stop() noexcept override;
  void release() noexcept override;
  MachineHealth health() const noexcept override;
  void wait_until(double t_s) override;
  /// kActive from the start: there is nobody to protect. kFault: the state is not finite any more.
  Lifecycle lifecycle() const noexcept override;
  Result<void> activate() override;
  void deactivate() noexcept override;

  [[nodiscard]] GroundTruth ground_truth() const;
  /// What the load balance has added to each hip flexion, by Limb; not part of read()'s positions.
  [[nodiscard]] std::array<double, kNumWheels> load_balance_offset_rad() const noexcept;
  /// Values of every scalar joint of model.xml in its order (passive and tyres included).
  [[nodiscard]] Eigen::VectorXd scalar_joint_positions() const;
  /// Writes a PNG of the scene from behind and above the machine (off screen).
  [[nodiscard]] Result<void> render(const std::string& png_file, int width_px = 960,
                                    int height_px = 600);
  /// CPU seconds spent inside the simulation so far.
  [[nodiscard]] double cpu_time_s() const noexcept;

 private:
  struct Impl;
  explicit SimulatedMachine(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace wex
