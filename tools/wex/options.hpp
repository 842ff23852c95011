#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "initializer/make_plan.hpp"
#include "models/types/pose.hpp"
#include "models/types/result.hpp"

namespace wex::app {

/// How far `run_pipeline` goes.
enum class Depth { kPlanOnly, kDrive };

/// Whose clock a run on a CAN bus follows.
enum class CanPace { kAsAnnounced, kRealTime, kLockStep };

/// What the user asks of `wex run` and `wex plan`. Poses are in the map's own frame.
struct RunOptions {
  Depth depth = Depth::kDrive;
  std::filesystem::path map;
  std::optional<Pose2> start, goal;  ///< default: the JSON beside the map
  std::uint64_t seed = 1;
  std::filesystem::path out = "out/run";
  std::optional<int> iterations;        ///< planner iterations instead of time_budget_s
  std::optional<double> solve_delay_s;  ///< empty: measured thread CPU time
  std::string machine = "m545";
  double time_budget_s = 4.0;
  PlanSettings planning;      ///< but for seed, iterations and budget, which stand above
  int frames = 12;            ///< off-screen pictures of the drive (simulation only)
  std::string can_interface;  ///< empty: the simulation within the process
  CanPace can_pace = CanPace::kAsAnnounced;
};

/// "X,Y,YAW" in metres, metres, radians.
///   errors  kBadInput naming the text and what was expected; never a partial value
[[nodiscard]] Result<Pose2> parse_pose(const std::string& text);

/// "measured" (nullopt) or a number of milliseconds in [0, 2000].
[[nodiscard]] Result<std::optional<double>> parse_solve_delay(const std::string& text);

/// A name that Linux allows for a network interface.
[[nodiscard]] Result<void> check_interface_name(const std::string& text);

/// Exit code of the program for an error, as the decisions list them.
[[nodiscard]] int exit_code(ErrorCode code) noexcept;

}  // namespace wex::app
