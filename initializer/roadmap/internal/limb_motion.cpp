#include "initializer/roadmap/internal/limb_motion.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "models/types/result.hpp"

namespace wex {

std::vector<int> limb_coordinates(const MachineModel& machine, Limb limb) {
  if (limb == Limb::kArm) {
    WEX_EXPECTS(machine.arm);
    return machine.arm->coordinates;
  }
  const WheeledLeg& leg = machine.legs[static_cast<std::size_t>(limb)];
  std::vector<int> coordinates;
  for (const int coordinate : {leg.haa, leg.hfe, leg.steer}) {
    if (coordinate >= 0) coordinates.push_back(coordinate);
  }
  return coordinates;
}

LimbMotion::LimbMotion(const MachineModel& machine, std::vector<int> coordinates)
    : machine_(&machine), coordinates_(std::move(coordinates)), seconds_per_unit_(size()) {
  for (Eigen::Index i = 0; i < size(); ++i) {
    continuous_.push_back(joint(i).continuous);
    seconds_per_unit_[i] = 1.0 / joint(i).max_rate;
  }
}

std::pair<double, double> LimbMotion::limits(Eigen::Index i) const noexcept {
  if (continuous_[i]) return {-std::numbers::pi, std::numbers::pi};
  return {joint(i).lower, joint(i).upper};
}

Eigen::VectorXd LimbMotion::read(const Eigen::VectorXd& q) const {
  Eigen::VectorXd configuration(size());
  for (Eigen::Index i = 0; i < size(); ++i) configuration[i] = q[coordinates_[i]];
  return configuration;
}

void LimbMotion::write(const Eigen::Ref<const Eigen::VectorXd>& configuration,
                       Eigen::VectorXd& q) const {
  for (Eigen::Index i = 0; i < size(); ++i) q[coordinates_[i]] = configuration[i];
}

void LimbMotion::step(const Eigen::Ref<const Eigen::VectorXd>& from,
                      const Eigen::Ref<const Eigen::VectorXd>& to,
                      Eigen::VectorXd& step) const noexcept {
  step = to - from;
  for (Eigen::Index i = 0; i < size(); ++i) {
    if (continuous_[i]) step[i] = wrap_angle(step[i]);
  }
}

double LimbMotion::distance_s(const Eigen::Ref<const Eigen::VectorXd>& from,
                              const Eigen::Ref<const Eigen::VectorXd>& to) const noexcept {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < size(); ++i) {
    const double difference = continuous_[i] ? wrap_angle(to[i] - from[i]) : to[i] - from[i];
    const double time_s = difference * seconds_per_unit_[i];
    sum += time_s * time_s;
  }
  return std::sqrt(sum);
}

}  // namespace wex
