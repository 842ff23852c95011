#pragma once

#include <algorithm>
#include <cmath>

namespace wex {

// How fast the machine may roll and its cabin may slew, so that all stands 150 ms after the last
// good command, of which 50 ms pass until the loss is noticed. Applied by the host's joint loop and
// by the electronics; a planner that times motions may ask the same functions.

/// Downhill, weight acts against the wheel motors' 12 kN m and the uphill wheels lose their load:
/// no brake of this model stops it in time from the speed that is allowed on level ground. Measured
/// in the simulated plant, transport posture, friction 0.9: just in time from 0.70, 0.60, 0.51,
/// 0.37, 0.25 m/s at 0, 5, 10, 15, 20 degrees downhill (electronics/README.md), a little less with
/// the arm stretched out; this line stays below those.
struct StoppingSpeed {
  double most_m_s = 0.63;
  double level_m_s = 0.69;
  double per_grade_m_s = 1.45;  ///< less for every unit of the sine of the descent
  double side_m_s = 0.75;       ///< on a side slope a stop takes load off the uphill wheels:
  double per_side_m_s = 0.75;   ///< less for every unit of the sine of the roll
  double least_m_s = 0.05;      ///< so that one can leave any slope

  /// descent_rad > 0: the way goes down. Uphill as on level ground. Not finite: the least.
  [[nodiscard]] double at(double descent_rad, double roll_rad = 0.0) const noexcept {
    const double down = level_m_s - per_grade_m_s * std::sin(descent_rad);
    const double side = side_m_s - per_side_m_s * std::abs(std::sin(roll_rad));
    return down > least_m_s && side > least_m_s ? std::min({down, side, most_m_s}) : least_m_s;
  }
  /// What is left of the wheels' rates when their mean is `travel_m_s` (forward > 0) and the base
  /// is pitched (nose down > 0) and rolled: at most 1.
  [[nodiscard]] double share_of(double travel_m_s, double pitch_rad,
                                double roll_rad = 0.0) const noexcept {
    const double limit = at(travel_m_s < 0.0 ? -pitch_rad : pitch_rad, roll_rad);
    return std::abs(travel_m_s) > limit ? limit / std::abs(travel_m_s) : 1.0;
  }
};

/// Angle between the base's vertical axis and the world's.
[[nodiscard]] inline double tilt_of(double pitch_rad, double roll_rad) noexcept {
  return std::acos(std::cos(pitch_rad) * std::cos(roll_rad));
}

/// Joints of the arm that decide how far it reaches out: positions [rad, TELE m] or their rates.
struct ReachingJoints {
  double boom = 0.0, dipper = 0.0, tele = 0.0, ee_pitch = 0.0;
};

/// How far the m545's arm reaches out from the slew axis, along the base's floor; behind it < 0.
struct ArmReach {
  double elbow_m = 0.0, wrist_m = 0.0, bucket_m = 0.0;  ///< joints DIPPER, EE_PITCH; centre of mass

  [[nodiscard]] static ArmReach of(const ReachingJoints& q) noexcept {
    const double stick_rad = q.boom + q.dipper, bucket_rad = stick_rad + 0.14 + q.ee_pitch;
    ArmReach reach;
    reach.elbow_m = 0.698 + 2.85 * std::cos(q.boom);
    reach.wrist_m =
        reach.elbow_m + 0.366 * std::cos(stick_rad) + (2.0 + q.tele) * std::sin(stick_rad);
    reach.bucket_m = reach.wrist_m + 0.5 * (std::cos(bucket_rad) + std::sin(bucket_rad));
    return reach;
  }
};

/// The swing motor's 52 kN m against the inertia of cabin and arm, less what the arm's weight takes
/// of it on a slope, whichever way it turns. Masses at elbow, wrist and bucket bound the model's
/// inertia (empty bucket) from above, by 6 % on average. Measured in the simulated plant: just in
/// time from 0.37 rad/s in transport posture, 0.147 with the arm stretched out, i.e. 130 ms of the
/// full torque.
struct StoppingSlew {
  double most_rad_s = 0.8;
  double least_rad_s = 0.03;  ///< so that the arm can be brought back from anywhere
  double torque_nm = 52e3;
  double braking_s = 0.12;
  double look_ahead_s = 0.5;  ///< dead time and lag, with which the cabin follows a falling limit
  double cabin_kg_m2 = 6.2e3;
  double elbow_kg = 700.0, wrist_kg = 500.0, bucket_kg = 1100.0;

  [[nodiscard]] double inertia_kg_m2(const ArmReach& reach) const noexcept {
    return cabin_kg_m2 + elbow_kg * reach.elbow_m * reach.elbow_m +
           wrist_kg * reach.wrist_m * reach.wrist_m + bucket_kg * reach.bucket_m * reach.bucket_m;
  }
  /// Of the weight about the slew axis, per m/s^2 across it.
  [[nodiscard]] double moment_kg_m(const ArmReach& reach) const noexcept {
    return elbow_kg * std::abs(reach.elbow_m) + wrist_kg * std::abs(reach.wrist_m) +
           bucket_kg * std::abs(reach.bucket_m);
  }
  /// Largest slew rate in either direction [rad/s]. Not finite: the least.
  [[nodiscard]] double at(const ArmReach& reach, double tilt_rad = 0.0) const noexcept {
    constexpr double kGravity_m_s2 = 9.81;
    const double left_nm =
        torque_nm - kGravity_m_s2 * std::abs(std::sin(tilt_rad)) * moment_kg_m(reach);
    const double rate = braking_s * left_nm / inertia_kg_m2(reach);
    return rate > least_rad_s ? std::min(rate, most_rad_s) : least_rad_s;
  }
  /// The same while the arm moves: an arm that goes out counts as being there.
  [[nodiscard]] double at(const ReachingJoints& q, const ReachingJoints& rate,
                          double tilt_rad) const noexcept {
    const ReachingJoints soon{
        q.boom + look_ahead_s * rate.boom, q.dipper + look_ahead_s * rate.dipper,
        q.tele + look_ahead_s * rate.tele, q.ee_pitch + look_ahead_s * rate.ee_pitch};
    return std::min(at(ArmReach::of(q), tilt_rad), at(ArmReach::of(soon), tilt_rad));
  }
};

}  // namespace wex
