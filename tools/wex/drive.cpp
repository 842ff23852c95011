#include "tools/wex/drive.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>

#include "models/types/cpu_clock.hpp"
#include "tools/wex/height_bias.hpp"
#include "tools/wex/reference_progress.hpp"
#include "tools/wex/support_margin.hpp"
#include "tools/wex/trajectory_execution.hpp"

namespace wex::app {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  char text[320];
  std::snprintf(text, sizeof(text), pattern, values...);
  return text;
}

/// One closed loop, from the first read to the end of the hold. Time is counted in control ticks
/// since the first read, so that nothing depends on rounding.
class Loop {
 public:
  Loop(const TerrainMap& terrain, const MachineModel& machine, const RefinedTrajectory& reference,
       const Pose2& goal, MachineIo& io, const DriveInstruments& instruments,
       const DriveSettings& settings)
      : machine_(machine),
        goal_(goal),
        io_(io),
        instruments_(instruments),
        settings_(settings),
        bias_(terrain, machine),
        progress_(reference.nodes),
        planned_duration_s_(reference.nodes.back().t_s - reference.nodes.front().t_s),
        workspace_(machine.tree.make_workspace()) {
    const MachineState first = io_.read();
    t0_s_ = first.t_s + first.age_s;
    // The reference's yaw and the machine's may differ by whole turns; the reference's is kept.
    const double yaw_difference = reference.nodes.front().q[kBaseYaw] - first.base[kBaseYaw];
    yaw_turns_rad_ = yaw_difference - wrap_angle(yaw_difference);
    truth_at_start_ = instruments_.ground_truth();
    record_.extremes.min_scheduled_margin_m = record_.extremes.min_loaded_margin_m =
        std::numeric_limits<double>::infinity();
  }

  DriveRecord run() {
    io_.release();
    while (!finished_) {
      observe();
      check_limits();
      if (!finished_) check_arrival();
      if (finished_) break;
      take_pending_result();
      if (tick_ > 0) {
        progress_.advance(settings_.control_period_s, q_.head<kNumBaseCoordinates>());
      }
      if (tick_ >= next_solve_tick_) solve();
      check_trajectory_age();
      if (finished_) break;
      if (!trajectory_.empty()) {
        io_.write(command_at(machine_, trajectory_, now_s(), settings_.command_validity_s));
      }
      next_tick();
    }
    record_.duration_s = elapsed_s();
    const GroundTruth truth = instruments_.ground_truth();
    for (int i = 0; i < kNumWheels; ++i) {
      record_.extremes.side_slip_m[i] = truth.side_slip_m[i] - truth_at_start_.side_slip_m[i];
      record_.extremes.travel_m[i] = truth.wheel_travel_m[i] - truth_at_start_.wheel_travel_m[i];
      record_.extremes.airborne_s[i] = truth.airborne_s[i] - truth_at_start_.airborne_s[i];
    }
    hold();
    judge();
    record_.simulated_s = elapsed_s();
    record_.health = io_.health();
    return std::move(record_);
  }

 private:
  double elapsed_s() const { return tick_ * settings_.control_period_s; }
  double now_s() const { return t0_s_ + elapsed_s(); }
  int ticks(double duration_s) const {
    constexpr double kRounding = 1e-6;
    return static_cast<int>(std::ceil(duration_s / settings_.control_period_s - kRounding));
  }
  void next_tick() {
    ++tick_;
    io_.wait_until(now_s());
  }
  void end(ErrorCode code, std::string reason) {
    record_.failure = Error{code, std::move(reason)};
    finished_ = true;
  }

  void observe() {
    state_ = io_.read();
    q_ = coordinates(machine_, state_);
    q_[kBaseYaw] += yaw_turns_rad_;
    bias_.update(state_.t_s, q_);
    truth_ = instruments_.ground_truth();
    DriveExtremes& x = record_.extremes;
    x.max_roll_rad = std::max(x.max_roll_rad, std::abs(q_[kBaseRoll]));
    x.max_pitch_rad = std::max(x.max_pitch_rad, std::abs(q_[kBasePitch]));
    for (int i = 0; i < kNumWheels; ++i) {
      x.max_wheel_penetration_m =
          std::max(x.max_wheel_penetration_m, truth_.wheel_penetration_m[i]);
      x.max_tyre_deflection_m = std::max(x.max_tyre_deflection_m, truth_.tyre_deflection_m[i]);
    }
    if (tick_ % ticks(settings_.log_period_s) == 0) log();
  }

  void log() {
    DriveSample sample_now;
    sample_now.t_s = elapsed_s();
    sample_now.base = q_.head<kNumBaseCoordinates>();
    sample_now.scalar_joints = instruments_.scalar_joints();
    sample_now.wheel_load_n = truth_.wheel_load_n;
    machine_.tree.update(q_, workspace_);
    for (int i = 0; i < kNumWheels; ++i) {
      const WheeledLeg& leg = machine_.legs[i];
      sample_now.wheel_m[i] =
          machine_.tree.position(workspace_, leg.carrier_body, leg.p_carrier_wheel).head<2>();
    }
    const ContactFlags scheduled =
        trajectory_.empty() ? kDrivingContacts : sample(trajectory_, now_s()).contacts;
    sample_now.scheduled_margin_m = support_margin_m(machine_, q_, scheduled);
    sample_now.loaded_margin_m = truth_.stability_margin_m;
    sample_now.reference_time_s = progress_.time_s();
    sample_now.reference_error_m = progress_.error_m(sample_now.base);
    sample_now.goal_distance_m = goal_distance_m();
    DriveExtremes& x = record_.extremes;
    x.min_scheduled_margin_m = std::min(x.min_scheduled_margin_m, sample_now.scheduled_margin_m);
    x.min_loaded_margin_m = std::min(x.min_loaded_margin_m, sample_now.loaded_margin_m);
    x.max_reference_error_m = std::max(x.max_reference_error_m, sample_now.reference_error_m);
    record_.samples.push_back(std::move(sample_now));
  }

  double goal_distance_m() const {
    return std::hypot(q_[kBaseX] - goal_.x_m, q_[kBaseY] - goal_.y_m);
  }
  double goal_yaw_error_rad() const { return std::abs(wrap_angle(q_[kBaseYaw] - goal_.yaw_rad)); }

  void check_limits() {
    const double tilt = std::max(std::abs(q_[kBaseRoll]), std::abs(q_[kBasePitch]));
    if (!q_.allFinite()) {
      end(ErrorCode::kInternal, format("the machine's state is not finite at %.1f s", elapsed_s()));
    } else if (tilt > settings_.max_tilt_rad) {
      end(ErrorCode::kOutOfLimits,
          format("tipped: %.1f degrees of tilt after %.1f s (limit %.0f)", tilt / kDegree,
                 elapsed_s(), settings_.max_tilt_rad / kDegree));
    } else if (truth_.body_contact) {
      end(ErrorCode::kOutOfLimits, format("the body touched the ground after %.1f s", elapsed_s()));
    }
  }

  void check_arrival() {
    const bool standing = state_.base_velocity.head<3>().norm() < settings_.standing_m_s;
    const double distance_m = goal_distance_m(), yaw_rad = goal_yaw_error_rad();
    if (progress_.finished()) {
      if (!reference_end_s_) reference_end_s_ = elapsed_s();
      const bool exact = distance_m < settings_.arrival_m && yaw_rad < settings_.arrival_rad;
      const bool close =
          distance_m < settings_.goal_tolerance_m && yaw_rad < settings_.goal_tolerance_rad;
      const bool patience_over = elapsed_s() - *reference_end_s_ > settings_.arrival_patience_s;
      if (standing && (exact || (close && patience_over))) {
        finished_ = true;
        return;
      }
    }
    const double allowed_s = std::max(settings_.max_duration_factor * planned_duration_s_,
                                      settings_.least_max_duration_s);
    if (elapsed_s() > allowed_s) {
      end(ErrorCode::kStoppedSafely,
          format("stopped safely: time ran out after %.0f s (planned: %.1f s), %.2f m and %.1f "
                 "degrees from the goal",
                 elapsed_s(), planned_duration_s_, distance_m, yaw_rad / kDegree));
    }
  }

  void take_pending_result() {
    if (!pending_ || tick_ < pending_->applied_tick) return;
    trajectory_ = std::move(pending_->nodes);
    pending_.reset();
  }

  /// The delay a solve is expected to have: the fixed one, or the worst of the recent ones.
  int expected_delay_ticks() const {
    if (settings_.solve_delay_s) return ticks(*settings_.solve_delay_s);
    const auto worst = std::max_element(recent_cpu_s_.begin(), recent_cpu_s_.end());
    return ticks(worst == recent_cpu_s_.end() ? settings_.mpc_period_s : *worst);
  }

  void solve() {
    const int expected = expected_delay_ticks();

    HorizonInput input;
    input.t_s = now_s() + expected * settings_.control_period_s;
    input.q = predict(q_, trajectory_, state_.t_s, input.t_s - state_.t_s);
    input.qdot =
        trajectory_.empty() ? Eigen::VectorXd::Zero(q_.size()) : rates(trajectory_, input.t_s);
    input.reference_time_s = progress_.time_s() + expected * settings_.control_period_s;
    input.height_bias_m = bias_.value_m();
    const double cpu_begin_s = thread_cpu_time_s();
    HorizonResult result = instruments_.solve(input);
    const double cpu_s = thread_cpu_time_s() - cpu_begin_s;
    recent_cpu_s_.push_back(cpu_s);
    if (recent_cpu_s_.size() > kRecentSolves) recent_cpu_s_.pop_front();

    // A result is there when its delay is over, and not before the moment it was computed for.
    const int delay = settings_.solve_delay_s ? expected : std::max(expected, ticks(cpu_s));
    next_solve_tick_ = tick_ + std::max(delay, ticks(settings_.mpc_period_s));
    record_.solves.push_back({elapsed_s(), elapsed_s() + delay * settings_.control_period_s, cpu_s,
                              result.report.iterations, result.report.feasible, result.usable});
    if (result.usable) {
      for (const auto& [name, residual] : result.report.worst_residual) {
        double& worst = record_.worst_residual[name];
        worst = std::max(worst, residual);
      }
      pending_ = Pending{tick_ + delay, std::move(result.nodes)};
    } else {
      last_status_ = result.report.status;
    }
    if (instruments_.on_progress) {
      instruments_.on_progress(progress_.fraction(), record_.samples.back().scheduled_margin_m);
    }
  }

  /// An old trajectory is better than none until it nears its end; then the machine is stopped.
  void check_trajectory_age() {
    const double good_until_s = trajectory_.empty()
                                    ? t0_s_ + kFirstSolutionS
                                    : trajectory_.back().t_s - settings_.stale_before_end_s;
    if (now_s() <= good_until_s) return;
    end(ErrorCode::kStoppedSafely,
        format(
            "stopped safely after %.1f s: the receding-horizon optimizer has no usable result (%s)",
            elapsed_s(), last_status_.c_str()));
  }

  void hold() {
    io_.stop();
    const double stop_s = elapsed_s();
    while (elapsed_s() - stop_s < settings_.hold_s) {
      next_tick();
      observe();
      if (elapsed_s() - stop_s > settings_.hold_settle_s) {
        double& worst = record_.extremes.hold_vertical_rate_m_s;
        worst = std::max(worst, std::abs(truth_.base_vertical_rate_m_s));
      }
      if (!record_.failure) check_limits();
    }
  }

  void judge() {
    record_.goal_error_m = goal_distance_m();
    record_.goal_error_rad = goal_yaw_error_rad();
    const bool reached = record_.goal_error_m <= settings_.goal_tolerance_m &&
                         record_.goal_error_rad <= settings_.goal_tolerance_rad;
    if (record_.failure || reached) return;
    end(ErrorCode::kStoppedSafely,
        format("stopped safely, but drifted to %.2f m and %.1f degrees from the goal while holding",
               record_.goal_error_m, record_.goal_error_rad / kDegree));
  }

  struct Pending {
    int applied_tick = 0;
    std::vector<WholeBodyNode> nodes;
  };
  static constexpr std::size_t kRecentSolves = 10;
  static constexpr double kFirstSolutionS = 3.0;  ///< patience for the first usable result

  const MachineModel& machine_;
  Pose2 goal_;
  MachineIo& io_;
  const DriveInstruments& instruments_;
  DriveSettings settings_;
  HeightBias bias_;
  ReferenceProgress progress_;
  double planned_duration_s_;
  KinematicTree::Workspace workspace_;

  double t0_s_ = 0.0;
  double yaw_turns_rad_ = 0.0;
  int tick_ = 0, next_solve_tick_ = 0;
  MachineState state_;
  Eigen::VectorXd q_;
  GroundTruth truth_, truth_at_start_;
  std::vector<WholeBodyNode> trajectory_;  ///< under way, absolute machine time
  std::optional<Pending> pending_;
  std::deque<double> recent_cpu_s_;
  std::optional<double> reference_end_s_;
  std::string last_status_ = "none yet";
  bool finished_ = false;
  DriveRecord record_;
};

}  // namespace

DriveRecord drive(const TerrainMap& terrain, const MachineModel& machine,
                  const RefinedTrajectory& reference, const Pose2& goal, MachineIo& io,
                  const DriveInstruments& instruments, const DriveSettings& settings) {
  WEX_EXPECTS(!reference.nodes.empty());
  WEX_EXPECTS(instruments.solve && instruments.ground_truth && instruments.scalar_joints);
  return Loop(terrain, machine, reference, goal, io, instruments, settings).run();
}

}  // namespace wex::app
