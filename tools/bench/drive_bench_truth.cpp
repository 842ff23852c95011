#include "tools/bench/drive_bench_truth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <string_view>

namespace wex {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kSettle_s = 1.0;  ///< of a hold, not looked at

enum Column {
  kTime,
  kMode,
  kX,
  kY,
  kYaw,
  kPitch,
  kRoll,
  kVerticalRate,
  kSink,
  kSideSlip,
  kTravel,
  kLiftOff,
  kBodyContact,
  kBrakes,
  kAccepted,
  kRejected,
  kNumColumns
};
constexpr std::array<std::string_view, kNumColumns> kNames{
    "t",        "mode",    "base_x",    "base_y", "base_yaw", "base_pitch",   "base_roll",
    "base_dz",  "sink",    "side_slip", "travel", "lift_off", "body_contact", "brakes",
    "accepted", "rejected"};

/// The cells of a line that are asked for.
class Row {
 public:
  /// `place`: position of each column in the line. False if the line is cut off.
  bool split(const std::string& line, const std::array<int, kNumColumns>& place) {
    std::size_t begin = 0;
    std::array<bool, kNumColumns> found{};
    for (int cell = 0; begin <= line.size(); ++cell) {
      const std::size_t end = std::min(line.find(',', begin), line.size());
      for (int column = 0; column < kNumColumns; ++column) {
        if (place[column] != cell) continue;
        cells_[column].assign(line, begin, end - begin);
        found[column] = true;
      }
      begin = end + 1;
    }
    return std::all_of(found.begin(), found.end(), [](bool there) { return there; });
  }
  [[nodiscard]] const std::string& text(Column column) const { return cells_[column]; }
  [[nodiscard]] double number(Column column) const {
    return std::strtod(cells_[column].c_str(), nullptr);
  }

 private:
  std::array<std::string, kNumColumns> cells_;
};

/// Where the columns are; false if one is missing.
bool find_columns(const std::string& header, std::array<int, kNumColumns>& place) {
  place.fill(-1);
  std::size_t begin = 0;
  for (int cell = 0; begin <= header.size(); ++cell) {
    const std::size_t end = std::min(header.find(',', begin), header.size());
    const std::string_view name(header.data() + begin, end - begin);
    const auto* known = std::find(kNames.begin(), kNames.end(), name);
    if (known != kNames.end()) place[static_cast<std::size_t>(known - kNames.begin())] = cell;
    begin = end + 1;
  }
  return std::all_of(place.begin(), place.end(), [](int cell) { return cell >= 0; });
}

void take(const Row& row, const std::string& mode_before, double& hold_begin_s, DriveTruth& truth) {
  const auto raise = [&](double& value, Column column) {
    value = std::max(value, std::abs(row.number(column)));
  };
  const std::string& mode = row.text(kMode);
  truth.end = {row.number(kX), row.number(kY), row.number(kYaw)};
  truth.end_time_s = row.number(kTime);
  raise(truth.max_roll_rad, kRoll);
  raise(truth.max_pitch_rad, kPitch);
  raise(truth.penetration_m, kSink);
  const double travel_m = row.number(kTravel);
  truth.side_slip_ratio = travel_m > 0.0 ? row.number(kSideSlip) / travel_m : 0.0;
  truth.lift_off_s = row.number(kLiftOff);
  truth.body_contact = row.text(kBodyContact) != "0";
  truth.was_enabled = truth.was_enabled || mode == "enabled";
  truth.was_stopped = truth.was_stopped || mode == "fault" || mode == "estop";
  truth.stands = mode != "enabled" && mode != "hold" && row.text(kBrakes) == "1";
  truth.commands_accepted = std::lround(row.number(kAccepted));
  truth.commands_rejected = std::lround(row.number(kRejected));
  if (mode != "hold") return;
  if (mode_before != "hold") {
    ++truth.holds;
    hold_begin_s = truth.end_time_s;
    truth.hold_rate_m_s = 0.0;
  }
  if (truth.end_time_s - hold_begin_s > kSettle_s) raise(truth.hold_rate_m_s, kVerticalRate);
}

}  // namespace

Result<DriveTruth> read_drive_truth(const std::filesystem::path& log) {
  std::ifstream stream(log);
  std::string line, mode;
  std::array<int, kNumColumns> place{};
  if (!std::getline(stream, line) || !find_columns(line, place)) {
    return fail(ErrorCode::kBadInput,
                log.string() + " is not the log of a machine: columns are missing");
  }
  DriveTruth truth;
  Row row;
  double hold_begin_s = 0.0;
  bool any = false;
  while (std::getline(stream, line)) {
    if (!row.split(line, place)) break;  // the machine was killed while it wrote
    take(row, mode, hold_begin_s, truth);
    mode = row.text(kMode);
    any = true;
  }
  if (!any) return fail(ErrorCode::kBadInput, log.string() + " has no rows");
  return truth;
}

double goal_error_m(const DriveTruth& truth, const Pose2& goal) noexcept {
  return std::hypot(truth.end.x_m - goal.x_m, truth.end.y_m - goal.y_m);
}

double goal_error_rad(const DriveTruth& truth, const Pose2& goal) noexcept {
  return std::abs(wrap_angle(truth.end.yaw_rad - goal.yaw_rad));
}

std::string objection(const DriveTruth& truth, const Pose2& goal, const DriveCriteria& criteria) {
  if (!truth.was_enabled) return "the machine was never enabled";
  if (truth.was_stopped) return "the machine went to fault or emergency stop";
  if (std::max(truth.max_roll_rad, truth.max_pitch_rad) > criteria.max_tilt_rad) return "tipped";
  if (truth.body_contact) return "the body touched the ground";
  if (!truth.stands) return "the machine was not left disabled with closed brakes";
  if (goal_error_m(truth, goal) <= criteria.goal_tolerance_m &&
      goal_error_rad(truth, goal) <= criteria.goal_tolerance_rad) {
    return "";
  }
  char text[120];
  std::snprintf(text, sizeof(text), "the machine stands %.2f m and %.1f degrees from the goal",
                goal_error_m(truth, goal), goal_error_rad(truth, goal) * kDegrees);
  return text;
}

}  // namespace wex
