#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "hw_interface/electronics/electronics.hpp"
#include "hw_interface/mujoco/simulated_plant.hpp"
#include "models/excavator/machine_model.hpp"

namespace wex::app {

/// The machine's own log, 100 Hz: the truth by which a run over the bus is judged. CSV, map frame:
///   t                        machine time [s]
///   mode, session, faults    MachineMode by name, hexadecimal session, fault bits
///   base_x .. base_roll      m, rad
///   q_NAME, dq_NAME          every actuated joint (rad or m, and per second)
///   load_LF .. load_RH       vertical wheel loads [N]
///   bucket_x, _y, _z         middle of the cutting edge [m]; NaN without arm
///   accepted, rejected       ZoneCommands so far
///   moving, travelling       1 while a joint other than a wheel is faster than 0.06 rad/s (m/s), a
///                            wheel faster than 5 cm/s at the tyre; less is the swing of oil
///                            columns
///   driven                   1 while the electronics let a spool open or a wheel turn
///   brakes                   1 while all parking brakes and the swing brake are closed
///   base_dz                  vertical rate of the base [m/s]
///   sink                     deepest wheel disc below the ground [m]
///   side_slip, travel        sums over the wheels so far [m]: integral of |patch velocity along
///   the
///                            axle| while loaded; way rolled
///   lift_off                 sum over the wheels of the time without load so far [s]
///   margin                   centre of mass to the edge of the loaded wheels [m]
///   body_contact             1 once anything but wheels and bucket has touched the ground
class MachineLog {
 public:
  /// errors  kBadInput: the file cannot be written
  [[nodiscard]] static Result<MachineLog> open(const std::filesystem::path& file,
                                               const MachineModel& machine,
                                               const Eigen::Vector2d& map_origin_m);

  void row(std::int64_t now_ms, const can::Electronics& electronics, const SimulatedPlant& plant);
  /// Writes what is buffered. errors  kInternal: the disk did not take it
  [[nodiscard]] Result<void> close();

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };
  MachineLog(std::filesystem::path name, std::FILE* file, const MachineModel& machine,
             const Eigen::Vector2d& map_origin_m);

  std::filesystem::path name_;
  std::unique_ptr<std::FILE, CloseFile> file_;
  MachineModel machine_;
  Eigen::Vector2d map_origin_m_;
  KinematicTree::Workspace workspace_;
  Eigen::VectorXd q_;
};

/// kInit -> "init" and so on.
[[nodiscard]] const char* name_of(can::MachineMode mode) noexcept;

}  // namespace wex::app
