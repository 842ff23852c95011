#include "tools/wex/reference_progress.hpp"

#include <algorithm>

#include "models/types/result.hpp"

namespace wex::app {

ReferenceProgress::ReferenceProgress(std::vector<WholeBodyNode> nodes,
                                     const ReferenceProgressSettings& settings)
    : nodes_(std::move(nodes)), settings_(settings) {
  WEX_EXPECTS(!nodes_.empty());
  time_s_ = nodes_.front().t_s - settings_.head_start_s;
}

double ReferenceProgress::lag_m(const BaseCoordinates& base) const {
  const Eigen::Vector2d reference = sample(nodes_, time_s_).q.head<2>();
  const Eigen::Vector2d behind = reference - base.head<2>();
  // Direction of travel around now. Where the reference stands (steering, cusps) it is undefined;
  // the component along the heading then counts whatever its sign.
  const Eigen::Vector2d travel = sample(nodes_, time_s_ + settings_.tangent_window_s).q.head<2>() -
                                 sample(nodes_, time_s_ - settings_.tangent_window_s).q.head<2>();
  constexpr double kStandingTravelM = 0.02;
  if (travel.norm() > kStandingTravelM) return behind.dot(travel.normalized());
  const Eigen::Vector2d heading(std::cos(base[kBaseYaw]), std::sin(base[kBaseYaw]));
  return std::abs(behind.dot(heading));
}

double ReferenceProgress::error_m(const BaseCoordinates& base) const {
  return (sample(nodes_, time_s_).q.head<2>() - base.head<2>()).norm();
}

void ReferenceProgress::advance(double dt_s, const BaseCoordinates& base) {
  WEX_EXPECTS(dt_s >= 0.0);
  const double excess =
      (lag_m(base) - settings_.free_lag_m) / (settings_.full_stop_m - settings_.free_lag_m);
  const double speed = 1.0 - std::clamp(excess, 0.0, 1.0);
  time_s_ = std::min(time_s_ + speed * dt_s, nodes_.back().t_s);
}

double ReferenceProgress::fraction() const noexcept {
  const double duration_s = nodes_.back().t_s - nodes_.front().t_s;
  return duration_s > 0.0 ? std::max(0.0, time_s_ - nodes_.front().t_s) / duration_s : 1.0;
}

}  // namespace wex::app
