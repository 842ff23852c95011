#include "initializer/timing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "models/types/result.hpp"

namespace wex {
namespace {

// Shortest time between two postures by the joints' rates alone.
double shortest_time_s(const MachineModel& machine, const Eigen::VectorXd& q_0,
                       const Eigen::VectorXd& q_1, double rate_fraction) {
  double time_s = 0.0;
  for (int j = 0; j < machine.num_joints(); ++j) {
    const double step = std::abs(q_1[kNumBaseCoordinates + j] - q_0[kNumBaseCoordinates + j]);
    const double rate = rate_fraction * machine.joints[static_cast<std::size_t>(j)].max_rate;
    if (step > 0.0) time_s = std::max(time_s, step / rate);
  }
  return time_s;
}

}  // namespace

void assign_times(const MachineModel& machine, const std::vector<Station>& stations,
                  const TimingSettings& settings, std::vector<WholeBodyNode>& nodes) {
  WEX_EXPECTS(stations.size() == nodes.size() && !nodes.empty());
  const std::size_t n = nodes.size();
  const auto step_m = [&](std::size_t i) { return stations[i + 1].s_m - stations[i].s_m; };

  // A node may be passed no faster than the slower of its two intervals allows.
  std::vector<double> speed(n, settings.nominal_speed_m_s);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double time_s =
        shortest_time_s(machine, nodes[i].q, nodes[i + 1].q, settings.rate_fraction);
    const double limit =
        time_s > 0.0 ? step_m(i) / time_s : std::numeric_limits<double>::infinity();
    speed[i] = std::min(speed[i], limit);
    speed[i + 1] = std::min(speed[i + 1], limit);
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (stations[i].stop) speed[i] = 0.0;
  }

  const auto reachable = [&](double from_m_s, double distance_m) {
    return std::sqrt(from_m_s * from_m_s + 2.0 * settings.max_acceleration_m_s2 * distance_m);
  };
  for (std::size_t i = 1; i < n; ++i) {
    speed[i] = std::min(speed[i], reachable(speed[i - 1], step_m(i - 1)));
  }
  for (std::size_t i = n - 1; i > 0; --i) {
    speed[i - 1] = std::min(speed[i - 1], reachable(speed[i], step_m(i - 1)));
  }

  nodes.front().t_s = 0.0;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    nodes[i + 1].t_s = nodes[i].t_s + 2.0 * step_m(i) / (speed[i] + speed[i + 1]);
  }
}

}  // namespace wex
