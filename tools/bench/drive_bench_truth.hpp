#pragma once

#include <filesystem>
#include <string>

#include "models/types/pose.hpp"
#include "models/types/result.hpp"

namespace wex {

/// What a machine's own log (`wex machine --log`) says of a drive. Map frame.
struct DriveTruth {
  Pose2 end;                ///< where it stands at the end
  double end_time_s = 0.0;  ///< machine time
  double max_roll_rad = 0.0, max_pitch_rad = 0.0;
  double side_slip_ratio = 0.0, penetration_m = 0.0, lift_off_s = 0.0;
  double hold_rate_m_s = 0.0;  ///< largest vertical rate in the last hold, after its first second
  bool body_contact = false;
  bool was_enabled = false, was_stopped = false;  ///< by a fault or an e-stop
  bool stands = false;                            ///< disabled, all brakes closed
  int holds = 0;                                  ///< times it held; the last one is the arrival
  long commands_accepted = 0, commands_rejected = 0;
};

/// The criteria of a drive within one process (DriveSettings), applied to the machine's log.
struct DriveCriteria {
  double goal_tolerance_m = 0.3, goal_tolerance_rad = 0.0872665;
  double max_tilt_rad = 0.5235988;
};

/// errors  kBadInput: no such log, or not one of a machine
[[nodiscard]] Result<DriveTruth> read_drive_truth(const std::filesystem::path& log);

[[nodiscard]] double goal_error_m(const DriveTruth& truth, const Pose2& goal) noexcept;
[[nodiscard]] double goal_error_rad(const DriveTruth& truth, const Pose2& goal) noexcept;

/// Why the drive did not succeed by the machine's own account; empty: it did.
[[nodiscard]] std::string objection(const DriveTruth& truth, const Pose2& goal,
                                    const DriveCriteria& criteria = {});

}  // namespace wex
