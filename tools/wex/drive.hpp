#pragma once

#include <functional>

#include "hw_interface/machine_io.hpp"
#include "hw_interface/mujoco/simulated_machine.hpp"
#include "models/excavator/machine_model.hpp"
#include "models/terrain/terrain_map.hpp"
#include "mpc/receding_horizon/receding_horizon.hpp"
#include "tools/wex/drive_record.hpp"

namespace wex::app {

/// The closed loop's timing and what counts as arrived. One set for every terrain.
struct DriveSettings {
  double control_period_s = 0.01;
  double mpc_period_s = 0.1;
  double command_validity_s = 0.08;
  std::optional<double> solve_delay_s;    ///< empty: measured thread CPU time
  double miss_s = 0.1;                    ///< a solve longer than this counts as a miss
  double stale_before_end_s = 1.5;        ///< a trajectory is followed up to its end minus this
  double log_period_s = 0.05;             ///< 20 Hz
  double hold_s = 10.0;                   ///< stands still after stopping, before judging
  double hold_settle_s = 1.0;             ///< of which the vertical rate is not looked at
  double goal_tolerance_m = 0.3;          ///< success
  double goal_tolerance_rad = 0.0872665;  ///< 5 degrees
  double arrival_m = 0.10;                ///< the loop goes on to correct down to these
  double arrival_rad = 0.026;             ///< 1.5 degrees
  double arrival_patience_s = 8.0;        ///< but not longer than this after the reference's end
  double standing_m_s = 0.02;
  double max_tilt_rad = 0.5235988;     ///< 30 degrees: tipped
  double max_duration_factor = 3.0;    ///< of the planned duration
  double least_max_duration_s = 10.0;  ///< but a very short drive gets this long to settle
  double hold_patience_s = 5.0;        ///< how long the machine may hold without being asked to
  double after_loss_s = 1.5;  ///< looked at for so long once the machine is not active any more
  bool solve_beside = false;  ///< solves on a thread of its own: the machine's clock does not wait
};

/// What the loop is connected to. Ground truth serves the record and the judging only. All but
/// `solve` may be empty.
struct DriveInstruments {
  std::function<HorizonResult(const HorizonInput&)> solve;  ///< called from one thread at a time
  std::function<GroundTruth()> ground_truth;
  std::function<Eigen::VectorXd()> scalar_joints;  ///< default: made from the measured coordinates
  std::function<std::string()> cause;              ///< why the machine holds or was stopped
  std::function<void(double fraction, double margin_m)> on_progress;  ///< once per MPC period
};

/// Drives the machine along the refined trajectory by its clock. A machine that holds by itself is
/// waited for, and the reference with it; one that is not active any more ends the drive.
///   returns  always a record; record.failure says why the goal was not reached
[[nodiscard]] DriveRecord drive(const TerrainMap& terrain, const MachineModel& machine,
                                const RefinedTrajectory& reference, const Pose2& goal,
                                MachineIo& io, const DriveInstruments& instruments,
                                const DriveSettings& settings = {});

}  // namespace wex::app
