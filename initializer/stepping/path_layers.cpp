#include "initializer/stepping/path_layers.hpp"

#include <algorithm>
#include <cmath>

#include "initializer/stepping/stepping_motion.hpp"

namespace wex {
namespace {

constexpr double kUsableDropM = 1.2;     // below the highest ground under a wheel
constexpr double kProfileWindowM = 2.0;  // roll and pitch of the ground are averaged over
constexpr double kBeginFadeM = 2.0;      // a given first roll fades into the ground's
constexpr double kMaxAxleTwistM = 0.8;   // left against right: more is an edge, not a slope
constexpr double kMaxPitchDropM = 1.0;   // front against rear
constexpr double kLowestStanceM = 0.2, kHighestStanceM = 1.75;  // base above the ground of an axle
constexpr double kBucketBeyondM = 8.0;  // bucket points before the start and after the end
constexpr double kBucketApartM = 0.3;   // two points closer than this are one
constexpr double kHeadingSpacingM =
    0.8;  // stations that look for bucket points along their heading
constexpr double kHeadingTurnRad = 0.04;  // ... or have turned by this
constexpr double kMinBucketM = 3.0;       // ahead of the base
constexpr double kMaxBucketLateralM = 0.5;

double heading_x(const Pose2& pose, double forward, double left) {
  return pose.x_m + std::cos(pose.yaw_rad) * forward - std::sin(pose.yaw_rad) * left;
}
double heading_y(const Pose2& pose, double forward, double left) {
  return pose.y_m + std::sin(pose.yaw_rad) * forward + std::cos(pose.yaw_rad) * left;
}

const Eigen::Vector3d& nominal_wheel(const StanceTables& tables, std::size_t leg) {
  constexpr std::size_t kMiddle = LegSweep::kSamples / 2;
  return tables.legs[leg][kSteeredStraight].samples[kMiddle].p_base_wheel;
}

class BucketPoints {
 public:
  BucketPoints(const StanceCheck& check, double edge_m) : check_(&check), edge_m_(edge_m) {}
  void offer(const Pose2& pose, double forward_m) {
    const double x = heading_x(pose, forward_m, 0.0), y = heading_y(pose, forward_m, 0.0);
    for (const Eigen::Vector3d& p : points) {
      if (std::hypot(p.x() - x, p.y() - y) < kBucketApartM) return;
    }
    if (!check_->bucket_spot(x, y, pose.yaw_rad, edge_m_)) return;
    points.emplace_back(x, y, check_->ground().height_m(x, y));
  }
  std::vector<Eigen::Vector3d> points;

 private:
  const StanceCheck* check_;
  double edge_m_;
};

std::vector<Eigen::Vector3d> places_for_bucket(const StanceCheck& check,
                                               const std::vector<Station>& stations,
                                               double spacing_m, double edge_m) {
  BucketPoints found(check, edge_m);
  for (double d = kBucketBeyondM; d > 0.0; d -= spacing_m) found.offer(stations.front().pose, -d);
  double last_m = -spacing_m;
  for (const Station& station : stations) {
    if (station.s_m - last_m < spacing_m - 1e-6) continue;
    found.offer(station.pose, 0.0);
    last_m = station.s_m;
  }
  for (double d = spacing_m; d < kBucketBeyondM; d += spacing_m)
    found.offer(stations.back().pose, d);
  // On arcs the path leaves the heading, which is what the bucket follows.
  last_m = -kHeadingSpacingM;
  double last_yaw_rad = stations.front().pose.yaw_rad;
  for (const Station& station : stations) {
    if (station.s_m - last_m < kHeadingSpacingM - 1e-6 &&
        std::abs(station.pose.yaw_rad - last_yaw_rad) < kHeadingTurnRad) {
      continue;
    }
    last_m = station.s_m;
    last_yaw_rad = station.pose.yaw_rad;
    for (double d = kMinBucketM + spacing_m; d < kBucketBeyondM; d += spacing_m) {
      found.offer(station.pose, d);
      found.offer(station.pose, -d);
    }
  }
  return std::move(found.points);
}

std::vector<double> smoothed(const std::vector<Station>& stations,
                             const std::vector<double>& values) {
  std::vector<double> s;
  s.reserve(stations.size());
  for (const Station& station : stations) s.push_back(station.s_m);
  return moving_average(s, values, kProfileWindowM);
}

// Stations at the usual spacing, and at a quarter of it in the fine part.
std::vector<Station> stations_of(const DrivePath& path, double spacing_m, const FinePart& fine) {
  constexpr double kFineShare = 0.25, kSamePlaceM = 1e-6;
  const std::vector<Station> coarse = path_stations(path, spacing_m);
  if (fine.to_m < fine.from_m) return coarse;
  const auto inside = [&](const Station& station) {
    return station.s_m >= fine.from_m && station.s_m <= fine.to_m;
  };
  std::vector<Station> stations;
  const auto add = [&](const Station& station) {
    if (stations.empty() || station.s_m > stations.back().s_m + kSamePlaceM) {
      stations.push_back(station);
    }
  };
  const std::vector<Station> dense = path_stations(path, kFineShare * spacing_m);
  auto next = dense.begin();
  for (const Station& station : coarse) {
    for (; next != dense.end() && next->s_m < station.s_m - kSamePlaceM; ++next) {
      if (inside(*next)) add(*next);
    }
    if (!inside(station) || station.stop) add(station);
  }
  return stations;
}

}  // namespace

Eigen::Vector2d bucket_in_heading(const Pose2& pose, const Eigen::Vector3d& point) noexcept {
  const double c = std::cos(pose.yaw_rad), s = std::sin(pose.yaw_rad);
  const double dx = point.x() - pose.x_m, dy = point.y() - pose.y_m;
  return {c * dx + s * dy, -s * dx + c * dy};
}

GroundUnder ground_under(const StanceCheck& check, const Pose2& pose) noexcept {
  const StanceGround& ground = check.ground();
  const StanceTables& tables = check.tables();
  const double c = std::cos(pose.yaw_rad), s = std::sin(pose.yaw_rad);
  constexpr int kAlong = 4;
  constexpr double kAlongStepM = 0.2;
  std::array<double, kNumWheels> height{};
  std::array<bool, kNumWheels> usable{};
  double lowest = 1e9, highest = -1e9;
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    const Eigen::Vector3d& p = nominal_wheel(tables, i);
    for (int k = -kAlong; k <= kAlong; ++k) {
      const double forward = p.x() + k * kAlongStepM;
      const double x = pose.x_m + c * forward - s * p.y(), y = pose.y_m + s * forward + c * p.y();
      const bool good = ground.clear_m(x, y) > 0.0;
      if (!good && k != 0) continue;
      const double h = ground.height_m(x, y);
      if (!good && h >= StanceGround::kNowhere_m * 0.1) continue;
      if (good) {
        lowest = std::min(lowest, h);
        highest = std::max(highest, h);
      }
      if (k == 0) {
        height[i] = h;
        usable[i] = true;
      }
    }
  }
  GroundUnder under;
  under.any = highest >= lowest;
  if (!under.any) return under;
  // Ground far below the rest is a pit.
  double top = -1e9;
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    if (usable[i]) top = std::max(top, height[i]);
  }
  int count = 0;
  for (std::size_t i = 0; i < kNumWheels; ++i) {
    usable[i] = usable[i] && height[i] >= top - kUsableDropM;
    if (!usable[i]) continue;
    under.height_m += height[i];
    ++count;
  }
  under.height_m = count > 0 ? under.height_m / count : highest;
  std::array<double, 2> axle_height{};
  std::array<bool, 2> axle{};
  double roll = 0.0;
  int num_rolls = 0;
  for (std::size_t a = 0; a < 2; ++a) {
    const std::size_t left = 2 * a, right = 2 * a + 1;
    if (!usable[left] || !usable[right]) continue;
    const double difference = height[left] - height[right];
    if (std::abs(difference) > kMaxAxleTwistM) continue;
    axle[a] = true;
    axle_height[a] = 0.5 * (height[left] + height[right]);
    roll += std::atan(difference /
                      (nominal_wheel(tables, left).y() - nominal_wheel(tables, right).y()));
    ++num_rolls;
  }
  if (num_rolls > 0) under.roll_rad = roll / num_rolls;
  const double drop = axle_height[1] - axle_height[0];
  if (axle[0] && axle[1] && std::abs(drop) < kMaxPitchDropM) {
    under.pitch_rad =
        std::atan(drop / (nominal_wheel(tables, 0).x() - nominal_wheel(tables, 2).x()));
  }
  const double belly = ground.highest_m(pose.x_m, pose.y_m) + tables.belly_below_base_m;
  under.lowest_base_m = std::max(lowest + kLowestStanceM, belly);
  under.highest_base_m = highest + kHighestStanceM;
  return under;
}

PathGrid PathGrid::of(const StanceCheck& check, const DrivePath& path, const PlanSettings& plan,
                      const CertificateSettings& settings,
                      const std::optional<BaseCoordinates>& begin, const FinePart& fine) {
  PathGrid grid;
  grid.stations = stations_of(path, plan.subnode_spacing_m, fine);
  const std::size_t n = grid.stations.size();
  std::vector<GroundUnder> under;
  std::vector<double> roll, pitch, height;
  under.reserve(n);
  for (const Station& station : grid.stations) {
    under.push_back(ground_under(check, station.pose));
    roll.push_back(under.back().roll_rad);
    pitch.push_back(under.back().pitch_rad);
    height.push_back(under.back().any || height.empty() ? under.back().height_m : height.back());
  }
  roll = smoothed(grid.stations, roll);
  pitch = smoothed(grid.stations, pitch);
  height = smoothed(grid.stations, height);
  grid.z_step_m = settings.height_step_m;
  grid.pitch_step_rad = settings.pitch_step_rad;
  grid.z_m = height.front() + check.tables().default_base_height_m;
  if (begin) {
    grid.z_m = (*begin)[kBaseZ];
    grid.pitch_rad = (*begin)[kBasePitch];
    const double shift = (*begin)[kBaseRoll] - roll.front();
    for (std::size_t k = 0; k < n; ++k) {
      roll[k] += shift * std::max(0.0, 1.0 - grid.stations[k].s_m / kBeginFadeM);
    }
  }
  grid.bucket_points =
      check.tables().arm.empty()
          ? std::vector<Eigen::Vector3d>{}
          : places_for_bucket(check, grid.stations, settings.bucket_spacing_m,
                              plan.min_signed_distance_m + 2.0 * settings.inflation_m);

  const std::vector<double> curvature =
      steered_curvature_1_m(path, grid.stations, SteppingMotionSettings{}.steering_window_m);
  const double tilt_rad = plan.max_tilt_rad + 1e-9;
  const double reach_m = check.tables().arm.empty() ? 0.0 : check.tables().arm.max_reach_m() + 0.5;
  std::size_t num_poses = 0;
  for (std::size_t k = 0; k < n; ++k) {
    PathLayer layer;
    layer.pose = grid.stations[k].pose;
    layer.curvature_1_m = curvature[k];
    layer.step_m = k > 0 ? grid.stations[k].s_m - grid.stations[k - 1].s_m : 0.0;
    layer.roll_rad = roll[k];
    const auto z_cell = [&](double z) {
      return static_cast<int>(std::lround((z - grid.z_m) / grid.z_step_m));
    };
    const auto pitch_cell = [&](double p) {
      return static_cast<int>(std::lround((p - grid.pitch_rad) / grid.pitch_step_rad));
    };
    layer.nominal_z = z_cell(height[k] + check.tables().default_base_height_m);
    layer.nominal_pitch = pitch_cell(std::clamp(pitch[k], -plan.max_tilt_rad, plan.max_tilt_rad));
    if (under[k].any && std::abs(layer.roll_rad) <= tilt_rad) {
      layer.first_z = std::min(z_cell(under[k].lowest_base_m), z_cell(under[k].highest_base_m));
      layer.num_z = z_cell(under[k].highest_base_m) - layer.first_z + 1;
      const double low = std::min(0.0, pitch[k]) - settings.max_pitch_offset_rad,
                   high = std::max(0.0, pitch[k]) + settings.max_pitch_offset_rad;
      int first = pitch_cell(low), last = pitch_cell(high);
      while (grid.pitch_rad + first * grid.pitch_step_rad < -tilt_rad) ++first;
      while (grid.pitch_rad + last * grid.pitch_step_rad > tilt_rad) --last;
      layer.first_pitch = first;
      layer.num_pitch = std::max(0, last - first + 1);
    }
    for (std::size_t j = 0; j < grid.bucket_points.size(); ++j) {
      const Eigen::Vector2d at = bucket_in_heading(layer.pose, grid.bucket_points[j]);
      if (std::abs(at.y()) > kMaxBucketLateralM || std::abs(at.x()) < kMinBucketM ||
          std::abs(at.x()) > reach_m) {
        continue;
      }
      layer.buckets[at.x() > 0.0 ? 0 : 1].push_back(static_cast<int>(j));
    }
    layer.first_pose = num_poses;
    num_poses += layer.num_poses();
    grid.layers.push_back(layer);
  }
  return grid;
}

}  // namespace wex
