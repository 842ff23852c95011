#include "initializer/stepping/stepping_timing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "models/types/result.hpp"

namespace wex {
namespace {

constexpr double kShortestS = 1e-3;  // so that times increase strictly
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Limits of acceleration per coordinate; those of the base as the settings say.
Eigen::VectorXd acceleration_limits(const MachineModel& machine,
                                    const SteppingTimingSettings& settings) {
  Eigen::VectorXd limit(machine.num_coordinates());
  limit.head<3>().setConstant(settings.max_base_acceleration_m_s2);
  limit.segment<3>(3).setConstant(settings.max_base_turn_acceleration_rad_s2);
  for (int j = 0; j < machine.num_joints(); ++j) {
    limit[kNumBaseCoordinates + j] = machine.joints[static_cast<std::size_t>(j)].max_acceleration;
  }
  return limit;
}

}  // namespace

double shortest_duration_s(const MachineModel& machine, const Eigen::VectorXd& from,
                           const Eigen::VectorXd& to, double rate_fraction) {
  double duration_s = 0.0, flow_m3 = 0.0;
  for (int j = 0; j < machine.num_joints(); ++j) {
    const Joint& joint = machine.joints[static_cast<std::size_t>(j)];
    const double step = std::abs(to[kNumBaseCoordinates + j] - from[kNumBaseCoordinates + j]);
    duration_s = std::max(duration_s, step / (rate_fraction * joint.max_rate));
    if (joint.role != JointRole::kWheel) {
      flow_m3 += step * joint.max_effort / machine.pump_pressure_pa;
    }
  }
  return std::max(duration_s, flow_m3 / machine.pump_flow_limit_w_over_pa);
}

std::vector<double> node_times_s(const MachineModel& machine, const std::vector<MotionNode>& nodes,
                                 const SteppingTimingSettings& settings) {
  WEX_EXPECTS(!nodes.empty());
  const std::size_t n = nodes.size();
  const Eigen::VectorXd limit = acceleration_limits(machine, settings);

  // Every interval has a length in seconds: its duration at the highest speed, which then is 1.
  std::vector<double> length_s(n, 0.0), acceleration(n, kInfinity);
  std::vector<Eigen::VectorXd> rate(n);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const Eigen::VectorXd step = nodes[i + 1].q - nodes[i].q;
    length_s[i] = std::max(
        {kShortestS, nodes[i].min_duration_s, step.head<3>().norm() / nodes[i].base_speed_m_s,
         shortest_duration_s(machine, nodes[i].q, nodes[i + 1].q, settings.rate_fraction)});
    rate[i] = step / length_s[i];
    const double fastest = (rate[i].array().abs() / limit.array()).maxCoeff();
    if (fastest > 0.0) acceleration[i] = 1.0 / fastest;
  }

  // Where rates change between intervals, the change has half of both to happen in.
  std::vector<double> speed(n, 1.0);
  for (std::size_t i = 0; i < n; ++i) {
    if (nodes[i].stop || i == 0 || i + 1 == n) {
      speed[i] = 0.0;
      continue;
    }
    const double jump = ((rate[i] - rate[i - 1]).array().abs() / limit.array()).maxCoeff();
    if (jump > 0.0) {
      speed[i] = std::min(1.0, std::sqrt(0.5 * (length_s[i - 1] + length_s[i]) / jump));
    }
  }
  const auto reachable = [&](double from, std::size_t interval) {
    return std::sqrt(from * from + 2.0 * acceleration[interval] * length_s[interval]);
  };
  for (std::size_t i = 1; i < n; ++i) {
    speed[i] = std::min(speed[i], reachable(speed[i - 1], i - 1));
  }
  for (std::size_t i = n - 1; i > 0; --i) {
    speed[i - 1] = std::min(speed[i - 1], reachable(speed[i], i - 1));
  }

  std::vector<double> t_s(n, 0.0);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    // Speeds up from both ends towards the middle as far as acceleration and speed 1 allow.
    const double a = acceleration[i], v_0 = speed[i], v_1 = speed[i + 1], length = length_s[i];
    double duration_s = length;
    if (std::isfinite(a)) {
      const double peak = std::min(1.0, std::sqrt(0.5 * (v_0 * v_0 + v_1 * v_1) + a * length));
      const double ramps = (2.0 * peak * peak - v_0 * v_0 - v_1 * v_1) / (2.0 * a);
      duration_s = (2.0 * peak - v_0 - v_1) / a + (length - ramps) / peak;
    }
    t_s[i + 1] = t_s[i] + std::max(duration_s, length);
  }
  return t_s;
}

}  // namespace wex
