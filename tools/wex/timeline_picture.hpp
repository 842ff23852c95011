#pragma once

#include <filesystem>

#include "tools/wex/run_report.hpp"

namespace wex::app {

/// timeline.png: contacts per limb, roll and pitch, stability margin, tracking error, solve times
/// over the time of the drive, with the limits that apply.
///   report.drive  has samples (contract)
///   errors        kBadInput if the file cannot be written
[[nodiscard]] Result<void> draw_timeline(const RunReport& report,
                                         const std::filesystem::path& file);

/// Of a plan: its contact schedule, way, tilt and stability margin over time.
///   plan    takes time (contract)
///   errors  kBadInput if the file cannot be written
[[nodiscard]] Result<void> draw_plan_timeline(const Plan& plan, const MachineModel& machine,
                                              const std::string& title,
                                              const std::filesystem::path& file);

}  // namespace wex::app
