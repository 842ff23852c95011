#pragma once

#include <algorithm>
#include <cmath>

namespace wex {

/// How fast the machine may roll, so that it stands 150 ms after the last good command, of which
/// 50 ms pass until the loss is noticed. Downhill, weight acts against the wheel motors' 12 kN m
/// and the uphill wheels lose their load: no brake of this model stops it in time from the speed
/// that is allowed on level ground. Measured in the simulated plant, transport posture, friction
/// 0.9: just in time from 0.70, 0.60, 0.51, 0.37, 0.25 m/s at 0, 5, 10, 15, 20 degrees downhill
/// (electronics/README.md), a little less with the arm stretched out; this line stays below those.
struct StoppingSpeed {
  double most_m_s = 0.63;  ///< beyond it a wheel lifts off in a stop on a side slope of 20 degrees
  double level_m_s = 0.69;
  double per_grade_m_s = 1.45;  ///< less for every unit of the sine of the descent
  double least_m_s = 0.05;      ///< so that one can leave any slope

  /// descent_rad > 0: the way goes down. Uphill as on level ground. Not finite: the least.
  [[nodiscard]] double at(double descent_rad) const noexcept {
    const double speed = level_m_s - per_grade_m_s * std::sin(descent_rad);
    return speed > least_m_s ? std::min(speed, most_m_s) : least_m_s;
  }
  /// What is left of the wheels' rates when their mean is `travel_m_s` (forward > 0) and the base
  /// is pitched (nose down > 0): at most 1.
  [[nodiscard]] double share_of(double travel_m_s, double pitch_rad) const noexcept {
    const double limit = at(travel_m_s < 0.0 ? -pitch_rad : pitch_rad);
    return std::abs(travel_m_s) > limit ? limit / std::abs(travel_m_s) : 1.0;
  }
};

}  // namespace wex
